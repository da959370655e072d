#include "diagnosis/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/grammar/causes.hpp"
#include "diagnosis/grammar/laws.hpp"
#include "diagnosis/jump.hpp"
#include "diagnosis/refit.hpp"
#include "diagnosis/registration.hpp"
#include "diagnosis/rest.hpp"
#include "diagnosis/select/confounders.hpp"
#include "diagnosis/select/forms.hpp"
#include "diagnosis/select/standards.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr double kNearNoise = 1.05;          // times the noise: nothing that a rival could better
constexpr double kFarMoreEvidence = 20;      // of BIC: twice what proves a finding takes it back
constexpr Eigen::Index kFewestSamples = 24;  // to fit to: eight poses of a tracker
constexpr Eigen::Index kLeastFreedom = 8;    // it tells a standard deviation to a quarter
constexpr double kExact = 1e-4;              // of the noise: exact data still need a scale
constexpr int kNoiseRounds = 2;              // each is a whole diagnosis: time

bool has_enough(const Observations& observations) {
  return observations.train >= kFewestSamples && observations.size() > observations.train;
}

/// A load test's noise is what the fullest fit leaves; single samples far from it are outliers.
void learn_noise(Observations* observations, const std::vector<Hypothesis>& hypotheses,
                 const Dictionary& dictionary, const Fit& given) {
  const FullestFit full = fit_all(*observations, hypotheses, dictionary, given.remainder);
  if (full.freedom < kLeastFreedom) {
    return;
  }
  const double deviation =
      std::sqrt(full.remainder.squaredNorm() / static_cast<double>(full.freedom));
  Eigen::VectorXd values = Eigen::VectorXd::Zero(observations->size());
  values.head(observations->train) = full.remainder;
  observations->drop_outliers(values, kFarOff * deviation);
  observations->set_noise(std::max(deviation, kExact));
  observations->noise_is_known = true;
  observations->noise_uncertainty = 1 / std::sqrt(2 * static_cast<double>(full.freedom));
}

/// A load test's noise was learnt from a fit that takes all effects for linear: what is chosen, as
/// it is, may leave less. Was the noise lowered to that?
bool lower_noise(Observations* observations, const Fit& chosen) {
  const Eigen::Index freedom = observations->train - static_cast<Eigen::Index>(chosen.parameters());
  if (!observations->is_static || !observations->noise_is_known || chosen.chosen.empty() ||
      freedom < kLeastFreedom) {
    return false;
  }
  const double deviation = std::sqrt(chosen.remainder.head(observations->train).squaredNorm() /
                                     static_cast<double>(freedom));
  if (deviation > kMuchLess) {
    return false;
  }
  observations->set_noise(std::max(deviation, kExact));
  return true;
}

void find_groups(Diagnosis* diagnosis) {
  for (std::size_t i = 0; i < diagnosis->choice.findings.size(); ++i) {
    const Hypothesis& chosen = diagnosis->choice.findings[i].chosen.hypothesis;
    std::vector<Place> group = {{chosen.effect(), chosen.joint}};
    for (const Alternative& other : diagnosis->choice.findings[i].alternatives) {
      const Place place{other.effect, other.joint};
      const bool is_in = std::find(group.begin(), group.end(), place) != group.end();
      if (other.delta_bic < kSameEvidence && !is_in) {
        group.push_back(place);
      }
    }
    if (group.size() > 1) {
      diagnosis->indistinguishable.push_back(group);
    }
  }
}

void add_nearest(const std::vector<Chosen>& chosen, Diagnosis* diagnosis) {
  for (const Chosen& each : chosen) {
    diagnosis->nearest.push_back({each.hypothesis.effect(), each.hypothesis.joint});
  }
}

/// Takes all findings back.
void withdraw(const Observations& observations, const std::string& reason, Diagnosis* diagnosis) {
  add_nearest(diagnosis->choice.fit.chosen, diagnosis);
  diagnosis->choice.findings.clear();
  diagnosis->choice.fit = fit(observations, {}, 0);
  diagnosis->indistinguishable.clear();
  diagnosis->verdict = Verdict::unexplained;
  diagnosis->reason = reason;
}

/// Does a form without physics, of no more numbers, account for more than findings do? Then what
/// they have in common with the mismatch is no proof of them. `left`: the sum of squares that it
/// leaves, of so many independent samples.
bool is_outdone(const Fit& findings, std::size_t numbers, double left, double samples) {
  return numbers <= findings.parameters() &&
         bic_gain(samples, findings.train_sum, left, 0) > kFarMoreEvidence;
}

bool is_outdone(const Observations& observations, const Fit& findings, const Jump& rival) {
  return is_outdone(findings, rival.numbers, rival.left,
                    independent_samples(observations, findings.remainder));
}

bool is_outdone(const Observations& observations, const Fit& findings, const Proposal& rival) {
  return !rival.terms.empty() && is_outdone(findings, rival.fit.parameters(), rival.fit.train_sum,
                                            independent_samples(observations, rival.fit.remainder));
}

/// Withdraws findings that a form without physics outdoes.
void withdraw_outdone(const Observations& observations, Diagnosis* diagnosis) {
  const Fit nothing = fit(observations, {}, 0);
  const Jump jump = jump_of_place(observations, nothing);
  if (is_outdone(observations, diagnosis->choice.fit, jump)) {
    withdraw(
        observations,
        fmt::format("a jump of the measured place at {:.4g} s accounts for more of it", jump.time),
        diagnosis);
    return;
  }
  Proposal rival = propose(observations, nothing);
  if (is_outdone(observations, diagnosis->choice.fit, rival)) {
    withdraw(observations, "a form that no known effect has accounts for more of it", diagnosis);
    diagnosis->proposal = std::move(rival.terms);
  }
}

bool has_law(const Diagnosis& diagnosis) {
  const std::vector<Finding>& findings = diagnosis.choice.findings;
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& each) { return grammar::is_law(each.chosen.hypothesis); });
}

std::string reason_of_nothing(const Choice& choice) {
  if (choice.mispredicts) {
    return "what fits the recordings does not predict what was held out";
  }
  return choice.withdrawn.empty() ? "no known effect accounts for it"
                                  : fmt::format("known effects account for {:.0f} % of it at most",
                                                100 * std::max(choice.explained, 0.0));
}

void judge(const Observations& observations, Diagnosis* diagnosis) {
  const Fit& found = diagnosis->choice.fit;
  diagnosis->cancellation = cancellation(observations, found);
  add_nearest(diagnosis->choice.withdrawn, diagnosis);
  const double after = largest_ratio(observations, found.remainder);
  const std::string more = more_than_noise(observations, found.remainder);
  const bool is_noise = more.empty();
  if (found.chosen.empty()) {
    diagnosis->verdict = is_noise ? Verdict::no_mismatch : Verdict::unexplained;
    diagnosis->reason = is_noise ? "" : reason_of_nothing(diagnosis->choice);
  } else if (found.chosen.size() > 1 && diagnosis->cancellation > kMostCancellation) {
    withdraw(observations,
             "only a sum of large effects that cancel each other comes near, which imitates what "
             "is not there",
             diagnosis);
  } else {
    diagnosis->verdict = is_noise ? Verdict::explained : Verdict::partly_explained;
    diagnosis->reason = more;
    // A law is such a form itself, with proof.
    if (found.chosen.size() > 1 && after > kNearNoise && !has_law(*diagnosis)) {
      withdraw_outdone(observations, diagnosis);
    }
  }
}

bool is_open(const Diagnosis& diagnosis) {
  return diagnosis.verdict == Verdict::unexplained ||
         diagnosis.verdict == Verdict::partly_explained;
}

/// The diagnosis with laws that nobody listed in the place of its findings, if these leave much
/// less; else as it was.
Diagnosis with_laws(const Inquiry& inquiry, const Diagnosis& before, Choice laws) {
  const Observations& observations = inquiry.observations;
  const Fit& found = before.choice.fit;
  if (laws.findings.empty() || bic_gain(observations, found, laws.fit) < kFarMoreEvidence ||
      !is_confirmed(inquiry, found, laws.fit)) {
    return before;
  }
  laws.ranking = before.choice.ranking;
  Diagnosis diagnosis = before;
  diagnosis.choice = std::move(laws);
  diagnosis.nearest.clear();
  diagnosis.indistinguishable.clear();
  diagnosis.proposal.clear();
  find_groups(&diagnosis);
  judge(observations, &diagnosis);
  return diagnosis.verdict == Verdict::unexplained ? before : diagnosis;
}

/// Which of two diagnoses with laws: the second only by strong evidence, or with fewer numbers that
/// none speaks against.
Diagnosis better_of(const Observations& observations, Diagnosis one, Diagnosis other) {
  const Fit& a = one.choice.fit;
  const Fit& b = other.choice.fit;
  const double gain = bic_gain(observations, a, b);
  const bool is_other = gain > kStrongEvidence || (gain > 0 && b.parameters() < a.parameters());
  return is_other ? std::move(other) : std::move(one);
}

/// Seeks laws that nobody listed in the place of what was found, which may stand for a law, and
/// beside it. Where a machine's numbers together account for more than any finding, laws must
/// account for all.
void seek_laws(const Inquiry& inquiry, const Settings& settings, Diagnosis* diagnosis) {
  const Observations& observations = inquiry.observations;
  grammar::Budget budget(settings.law_seconds);
  const bool is_of_families = !diagnosis->choice.begun.chosen.empty();
  const Diagnosis afresh =
      with_laws(inquiry, *diagnosis,
                grammar::choose_laws(inquiry, inquiry.given, &budget, settings.choosing));
  if (is_open(afresh) && !is_of_families && !diagnosis->choice.findings.empty()) {
    *diagnosis =
        with_laws(inquiry, *diagnosis,
                  grammar::choose_laws(inquiry, diagnosis->choice.fit, &budget, settings.choosing));
  }
  if (!is_of_families || !is_open(afresh)) {
    *diagnosis = better_of(observations, *diagnosis, afresh);
  }
  diagnosis->laws_stopped = budget.has_stopped();
}

/// May a law be missing? A load test's noise is learnt from what effects leave, and holds what they
/// cannot say: there findings are weighed against laws too. Where a machine is off in many numbers,
/// no law accounts for all, and looking for it takes long.
bool asks_for_laws(const Observations& observations, const Diagnosis& diagnosis) {
  constexpr std::size_t kMany = 8;  // findings: one law or two never looked like so many
  if (!diagnosis.choice.begun.chosen.empty() && diagnosis.choice.findings.size() > kMany) {
    return false;
  }
  return is_open(diagnosis) || (observations.is_static && !diagnosis.choice.findings.empty());
}

/// Judges what was chosen, and seeks laws for what it leaves.
void settle(const Inquiry& inquiry, const Settings& settings, Diagnosis* diagnosis) {
  find_groups(diagnosis);
  judge(inquiry.observations, diagnosis);
  if (settings.law_seconds > 0 && asks_for_laws(inquiry.observations, *diagnosis)) {
    seek_laws(inquiry, settings, diagnosis);
  }
}

/// The frame in which positions were measured, as it was registered, and the hypotheses about it.
struct Basis {
  Fit given;
  Dictionary dictionary;
};

/// Fits the registered frame again, and simulates the hypotheses about it: the noise has changed.
void renew(const Observations& observations, const std::vector<Hypothesis>& hypotheses,
           const Settings& settings, Basis* basis) {
  basis->given = fit(observations, basis->given.chosen, kSteps);
  basis->dictionary =
      Dictionary(observations, hypotheses, basis->given.machine, settings.simulating);
}

Basis basis_of(Observations* observations, const std::vector<Hypothesis>& hypotheses,
               const Settings& settings) {
  Fit given = register_frame(*observations, hypotheses);
  Dictionary dictionary(*observations, hypotheses, given.machine, settings.simulating);
  Basis basis{std::move(given), std::move(dictionary)};
  if (observations->is_static) {
    learn_noise(observations, hypotheses, basis.dictionary, basis.given);
    renew(*observations, hypotheses, settings, &basis);
  }
  return basis;
}

/// Fits anew where the findings leave something, or are many.
void refit_open(const Inquiry& inquiry, const std::vector<Hypothesis>& hypotheses,
                const TellStage& tell, Diagnosis* diagnosis) {
  const Observations& observations = inquiry.observations;
  const bool leaves_something = is_open(*diagnosis);
  if (!leaves_something && !are_many(inquiry, diagnosis->choice.fit)) {
    return;
  }
  if (leaves_something && diagnosis->proposal.empty()) {
    diagnosis->proposal = propose(observations, diagnosis->choice.fit).terms;
  }
  refit(inquiry, hypotheses, tell, diagnosis);
  diagnosis->left = locate(observations, diagnosis->choice.fit.remainder);
}

/// Suggests what to record next: what tells a finding from its nearest alternative, else what shows
/// the cause of a law in time.
void suggest(const Observations& observations, Diagnosis* diagnosis) {
  for (std::size_t i = 0; i < diagnosis->choice.findings.size(); ++i) {
    const std::vector<Alternative>& others = diagnosis->choice.findings[i].alternatives;
    if (diagnosis->suggested_experiment.empty() && !others.empty() &&
        others.front().delta_bic < kSameEvidence) {
      diagnosis->suggested_experiment = suggest_experiment(observations, *diagnosis, i);
    }
  }
  for (const Finding& finding : diagnosis->choice.findings) {
    if (diagnosis->suggested_experiment.empty()) {
      diagnosis->suggested_experiment = grammar::next_recording(finding.chosen);
    }
  }
}

}  // namespace

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::no_mismatch:
      return "no_mismatch";
    case Verdict::explained:
      return "explained";
    case Verdict::partly_explained:
      return "partly_explained";
    case Verdict::unexplained:
      break;
  }
  return "unexplained";
}

Diagnosis diagnose(Observations* observations, const std::vector<Hypothesis>& hypotheses,
                   const Settings& settings) {
  Diagnosis diagnosis;
  if (!has_enough(*observations)) {
    withdraw(*observations,
             fmt::format("too little data: {} samples to fit to and {} to check with",
                         observations->train, observations->size() - observations->train),
             &diagnosis);
    return diagnosis;
  }
  Basis basis = basis_of(observations, hypotheses, settings);
  const Inquiry inquiry{*observations, basis.dictionary, settings.false_discovery, basis.given};
  diagnosis.clocks = check_clocks(*observations, hypotheses, basis.dictionary, basis.given);
  diagnosis.excitation = excitation(*observations, hypotheses, basis.dictionary);
  diagnosis.location = locate(*observations, basis.given.remainder);
  diagnosis.choice = choose(inquiry, settings.choosing);
  const auto choose_anew = [&] {
    renew(*observations, hypotheses, settings, &basis);
    diagnosis.choice = choose(inquiry, settings.choosing);
  };
  for (int round = 0; round < kNoiseRounds && lower_noise(observations, diagnosis.choice.fit);
       ++round) {
    choose_anew();
  }
  settle(inquiry, settings, &diagnosis);
  for (int round = 0; round < kNoiseRounds && has_law(diagnosis) &&
                      lower_noise(observations, diagnosis.choice.fit);
       ++round) {
    choose_anew();
    diagnosis.nearest.clear();
    diagnosis.indistinguishable.clear();
    settle(inquiry, settings, &diagnosis);
  }
  refit_open(inquiry, hypotheses, settings.choosing, &diagnosis);
  if (!diagnosis.is_weighed_whole) {
    settle_forms(inquiry, &diagnosis.choice);
    widen_by_confounders(inquiry, &diagnosis.choice);
  }
  diagnosis.trials = weigh_trials(inquiry, diagnosis.choice);
  suggest(*observations, &diagnosis);
  return diagnosis;
}

}  // namespace flexcomp::diagnosis
