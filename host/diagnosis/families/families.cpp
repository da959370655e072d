#include "diagnosis/families/families.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "diagnosis/evidence.hpp"
#include "diagnosis/families/candidates.hpp"
#include "diagnosis/families/elimination.hpp"
#include "diagnosis/families/extras.hpp"
#include "diagnosis/families/latecomers.hpp"
#include "diagnosis/families/regression.hpp"
#include "diagnosis/families/settle.hpp"
#include "diagnosis/gains.hpp"
#include "diagnosis/plausible.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr int kRoundsAnew = 5;     // of choosing the numbers about those that were fitted
constexpr int kRoundsSmaller = 2;  // of these, in which they may be smaller and predict worse
constexpr double kClearlyBetter =
    0.97;                            // of the held-out error, that bodies which cannot be are worth
constexpr int kExtraSteps = 0;       // before the numbers are beside them
constexpr double kLeastGain = 0.01;  // of the sum of squares, that a coupling is worth trying for

Start start_of(Elimination families) {
  std::vector<Chosen> chosen = families.best();
  return {std::move(chosen), families.deviation()};
}

/// Chooses the numbers anew about those that were fitted. A torque's gain multiplies what masses
/// and friction do, which the model's own derivatives do not know.
Fit fit_anew(const Observations& observations, const Fit& fitted, std::size_t findings,
             const std::vector<Hypothesis>& hypotheses) {
  std::vector<Hypothesis> members;
  std::copy_if(hypotheses.begin(), hypotheses.end(), std::back_inserter(members),
               [](const Hypothesis& each) { return each.traits().is_in_family; });
  Dictionary dictionary(observations, members, fitted.machine, [](std::size_t, std::size_t) {});
  dictionary.gains = gains_of(fitted.chosen, observations.machine.robot.joints());
  const Fit about = fit(observations, fitted.chosen, 0, &dictionary);
  return settle(observations, start_of({observations, about, findings, members, dictionary}),
                findings, dictionary);
}

/// Sum of the squares of the numbers behind the findings, each over its usual size. Torques tell
/// their numbers well enough to be believed, but for the gains: with all of them larger and all
/// masses smaller, a machine gives the same torques.
double size_of_numbers(const Observations& observations, const Fit& fit, std::size_t findings) {
  const bool is_by_gains = observations.has(simulation::joint_torque);
  double sum = 0;
  for (std::size_t i = findings; i < fit.chosen.size(); ++i) {
    const Chosen& chosen = fit.chosen[i];
    if (is_by_gains && !chosen.hypothesis.traits().is_gain) {
      continue;
    }
    for (std::size_t k = 0; k < chosen.values.size(); ++k) {
      const double usual = usual_width(observations, chosen.hypothesis, k);
      sum += std::pow(chosen.values[k] / usual, 2);
    }
  }
  return sum;
}

/// Do the samples that both fits were fitted to speak strongly against the second one, and more
/// than what was held out speaks for it? Both are squares of deviations.
bool is_refuted(const Observations& observations, const Fit& before, const Fit& after) {
  const double against = independent_samples(observations, before.remainder) *
                         std::log(after.train_sum / before.train_sum);
  const double in_favour =
      std::max(0.0, confirmation_of(observations, before.remainder, after.remainder));
  return against > kStrongEvidence && against > in_favour * in_favour;
}

/// Do smaller numbers make up for a worse prediction of what was held out? Both are squares of
/// deviations: of the numbers from the model, and of the change of the error from chance.
bool is_likelier(const Observations& observations, const Fit& before, const Fit& after,
                 std::size_t findings) {
  const double worse = confirmation_of(observations, after.remainder, before.remainder);
  return size_of_numbers(observations, before, findings) -
             size_of_numbers(observations, after, findings) >
         worse * std::max(worse, 0.0);
}

/// The fit made anew, as often as it predicts better or is likelier with smaller numbers.
Fit refined(const Observations& observations, Fit best, std::size_t findings,
            const std::vector<Hypothesis>& hypotheses) {
  for (int round = 0; round < kRoundsAnew; ++round) {
    Fit anew = fit_anew(observations, best, findings, hypotheses);
    const bool is_wanted =
        predicts_better(observations, best, anew) ||
        (round < kRoundsSmaller && is_likelier(observations, best, anew, findings));
    if (!is_wanted || is_refuted(observations, best, anew)) {
      break;
    }
    best = std::move(anew);
  }
  return best;
}

/// With what joins the families late, as long as that predicts better: what one of them explains
/// may have hidden another.
Fit joined(const Observations& observations, Fit best, std::size_t findings,
           const Dictionary& dictionary) {
  while (true) {
    const std::vector<Chosen> late = latecomers(observations, best, dictionary);
    if (late.empty()) {
      return best;
    }
    std::vector<Chosen> all = best.chosen;
    all.insert(all.end(), late.begin(), late.end());
    Fit with = settle(observations, {std::move(all), deviation_of(observations, best.remainder)},
                      findings, dictionary);
    if (!predicts_better(observations, best, with)) {
      return best;
    }
    best = std::move(with);
  }
}

/// Findings, and behind them the numbers of the families that stay beside them.
Fit fit_beside(const Observations& observations, const Fit& findings,
               const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary) {
  return settle(observations, start_of({observations, findings, hypotheses, dictionary}),
                findings.chosen.size(), dictionary);
}

/// The families beside findings and extras, as far as the search for extras has come.
struct Progress {
  std::vector<Chosen> given;  ///< findings, and behind them extras
  Dictionary dictionary;      ///< with the numbers as they act beside the extras
  Fit best;
};

/// The families fitted beside extras as well.
Progress with_extras(const Observations& observations, Progress progress,
                     const std::vector<Chosen>& extras, const std::vector<Hypothesis>& hypotheses) {
  for (const Chosen& extra : extras) {
    progress.given.push_back(extra);
    if (!extra.hypothesis.traits().is_clock) {
      progress.dictionary = with_coupled_drive(observations, progress.dictionary, extra);
    }
  }
  const Fit start = fit(observations, progress.given, kExtraSteps, &progress.dictionary);
  progress.best = fit_beside(observations, start, hypotheses, progress.dictionary);
  return progress;
}

/// Adds one extra after another, as long as there is strong evidence for it. Gives the one that
/// was refused in the end; one that was `refused` before is not tried again.
std::optional<Hypothesis> add_extras(const Observations& observations,
                                     const std::vector<Hypothesis>& hypotheses,
                                     const std::optional<Hypothesis>& refused, Progress* progress) {
  while (true) {
    const Fit& best = progress->best;
    const std::vector<Extra> extras = propose_extras(observations, best, hypotheses);
    if (extras.empty() || extras.front().gain < kLeastGain * best.train_sum) {
      return std::nullopt;
    }
    const Chosen& first = extras.front().chosen;
    if (refused && are_the_same(first.hypothesis, *refused)) {
      return refused;
    }
    Progress next = with_extras(observations, *progress, {first}, hypotheses);
    if (!(bic_gain(observations, best, next.best) > kStrongEvidence) ||
        !predicts_better(observations, best, next.best) ||
        !is_real(observations, next.best, next.given.size() - 1)) {
      return first.hypothesis;
    }
    *progress = std::move(next);
  }
}

void settle_numbers(const Observations& observations, const std::vector<Hypothesis>& hypotheses,
                    Progress* progress) {
  progress->best =
      refined(observations, std::move(progress->best), progress->given.size(), hypotheses);
}

/// Adds extras, and settles the numbers beside them. What the numbers leave before they are settled
/// may hide an extra, or imitate one, so that the search goes on afterwards if it was refused one.
void settle_with_extras(const Observations& observations, const std::vector<Hypothesis>& hypotheses,
                        Progress* progress) {
  const auto refused = add_extras(observations, hypotheses, std::nullopt, progress);
  settle_numbers(observations, hypotheses, progress);
  const std::size_t extras = progress->given.size();
  if (refused) {
    add_extras(observations, hypotheses, refused, progress);
  }
  if (progress->given.size() > extras) {
    settle_numbers(observations, hypotheses, progress);
  }
}

/// Where the search for extras begins: from those that were known, if all are real.
Progress begin(const Observations& observations, const Fit& findings,
               const std::vector<Chosen>& known, const std::vector<Hypothesis>& hypotheses,
               const Dictionary& dictionary) {
  if (!known.empty()) {
    Progress progress =
        with_extras(observations, {findings.chosen, dictionary, {}}, known, hypotheses);
    bool are_real = true;
    for (std::size_t i = findings.chosen.size(); i < progress.given.size(); ++i) {
      are_real = are_real && is_real(observations, progress.best, i);
    }
    if (are_real) {
      return progress;
    }
  }
  return {findings.chosen, dictionary, fit_beside(observations, findings, hypotheses, dictionary)};
}

bool is_gain(const Chosen& chosen) { return chosen.hypothesis.traits().is_gain; }

/// Are gains among the numbers?
bool has_gains(const Progress& progress) {
  const auto& chosen = progress.best.chosen;
  const auto numbers = chosen.begin() + static_cast<std::ptrdiff_t>(progress.given.size());
  return std::any_of(numbers, chosen.end(), is_gain);
}

/// The plain refit beside what is given; nothing where the families have no gains and leave no more
/// than noise, so that it could show nothing.
std::optional<Fit> plain_refit(const Observations& observations, const Progress& progress,
                               const std::vector<Hypothesis>& hypotheses) {
  if (!has_gains(progress) && largest_ratio(observations, progress.best.remainder) < kLikeNoise) {
    return std::nullopt;
  }
  const auto& chosen = progress.best.chosen;
  const auto end = chosen.begin() + static_cast<std::ptrdiff_t>(progress.given.size());
  const Fit stays = fit(observations, {chosen.begin(), end}, 0);
  return fit_regression(observations, stays, hypotheses, progress.dictionary);
}

/// Root mean square error (N·m) of what was held out.
double held_out_torque(const Observations& observations, const Fit& fit) {
  return observations.rms(fit.remainder, simulation::joint_torque, true);
}

/// Does a plain refit leave far less than bodies that can be?
bool is_clearly_better(const Observations& observations, const Fit& plain, const Fit& best) {
  return held_out_torque(observations, plain) <
         kClearlyBetter * held_out_torque(observations, best);
}

/// Are gains among the numbers though a plain refit, which has none, predicts as well? With all
/// gains larger and all bodies lighter torques are the same, and what keeps the bodies from
/// predicting better holds them less. The model's bodies are off more often than its unit of
/// torque.
bool has_idle_gains(const Observations& observations, const Progress& progress, const Fit& plain) {
  return has_gains(progress) && !predicts_better(observations, plain, progress.best);
}

std::vector<Hypothesis> without_gains(const std::vector<Hypothesis>& hypotheses) {
  std::vector<Hypothesis> others;
  std::copy_if(hypotheses.begin(), hypotheses.end(), std::back_inserter(others),
               [](const Hypothesis& each) { return !each.traits().is_gain; });
  return others;
}

/// A fit, its first choices the findings and, behind them, the extras.
Families families_of(Fit fit, std::size_t findings, std::size_t given) {
  const auto first = fit.chosen.begin();
  std::vector<Chosen> extras(first + static_cast<std::ptrdiff_t>(findings),
                             first + static_cast<std::ptrdiff_t>(given));
  return {std::move(fit), std::move(extras)};
}

}  // namespace

Families fit_families(const Observations& observations, const Fit& findings,
                      const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary,
                      const std::vector<Chosen>& known) {
  Progress progress = begin(observations, findings, known, hypotheses, dictionary);
  if (!observations.has(simulation::joint_torque)) {
    settle_numbers(observations, hypotheses, &progress);
    return families_of(std::move(progress.best), findings.chosen.size(), progress.given.size());
  }
  settle_with_extras(observations, hypotheses, &progress);
  const std::optional<Fit> plain = plain_refit(observations, progress, hypotheses);
  if (plain && has_idle_gains(observations, progress, *plain)) {
    return fit_families(observations, findings, without_gains(hypotheses), dictionary, known);
  }
  const std::size_t given = progress.given.size();
  Fit best = joined(observations, std::move(progress.best), given, dictionary);
  if (plain && is_clearly_better(observations, *plain, best)) {
    best = *plain;
  }
  return families_of(std::move(best), findings.chosen.size(), given);
}

}  // namespace flexcomp::diagnosis
