#include "diagnosis/families/families.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "diagnosis/evidence.hpp"
#include "diagnosis/families/candidates.hpp"
#include "diagnosis/families/elimination.hpp"
#include "diagnosis/families/latecomers.hpp"
#include "diagnosis/families/possible_bodies.hpp"
#include "diagnosis/families/regression.hpp"
#include "diagnosis/plausible.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr int kHoldingRounds = 4;         // of holding closer, before a body is left out after all
constexpr int kPossibleRounds = 8;        // without what cannot be, others may become impossible
constexpr int kRoundsAnew = 2;            // of choosing the numbers about those that were fitted
constexpr Bounds kCouplings{-3, 3, 0.1};  // turns of a motor a turn of the joint before its own
constexpr double kLeastCoupling = 0.2;    // turns: below it friction of another form is imitated
constexpr double kDelays[] = {-0.03, -0.02, -0.012, -0.006, -0.003,
                              0.003, 0.006, 0.012,  0.02,   0.03};
constexpr double kHopeless = 1.1;  // of the held-out error, that choosing anew does not make up for
constexpr double kClearlyBetter =
    0.97;                            // of the held-out error, that bodies which cannot be are worth
constexpr int kExtraSteps = 0;       // before the numbers are beside them
constexpr double kLeastGain = 0.01;  // of the sum of squares, that a coupling is worth trying for

/// Physics that is far from linear, so that it must be there before the numbers are fitted.
struct Extra {
  Chosen chosen;
  double gain = 0;  ///< fall of the sum of squares, to first order
};

/// A fit, and what of its machine's torques stays when a drive or a clock is changed.
struct Known {
  const Observations& observations;
  const Fit& fit;
  std::vector<simulation::RigidTorque> rigid;
};

/// Change of a fit's prediction by a machine, in the samples to fit to.
Eigen::VectorXd change_by(const Known& known, const Machine& machine) {
  const Observations& observations = known.observations;
  return known.fit.remainder.head(observations.train) -
         (observations.residual + observations.stacked(observations.predictions) -
          observations.stacked(
              predict(machine, observations.scenes, known.rigid, observations.simulations)))
             .head(observations.train);
}

/// A drive that turns with the joint before its own, by one turn or against it, its friction and
/// rotor as they are.
void propose_coupling(const Known& known, const effects::LawPointer& law, int joint,
                      std::vector<Extra>* all) {
  const auto left = known.fit.remainder.head(known.observations.train);
  Hypothesis hypothesis(law, joint, known.observations.machine.robot);
  hypothesis.set_bounds({kCouplings});
  for (const double ratio : {1.0, -1.0}) {
    Machine coupled = known.fit.machine;
    hypothesis.apply({ratio}, &coupled);
    const Eigen::VectorXd change = change_by(known, coupled);
    const double product = change.dot(left);
    const double gain = product > 0 ? product * product / change.squaredNorm() : 0;
    all->push_back({{hypothesis, {ratio}}, gain});
  }
}

void propose_couplings(const Known& known, std::vector<Extra>* all) {
  const model::Robot& robot = known.fit.machine.robot;
  for (const effects::Effect& effect : effects::catalogue()) {
    for (const effects::LawPointer& law : effect.forms) {
      if (!law->traits.couples_drives) {
        continue;
      }
      for (const int joint : law->joints(robot.joints())) {
        if (robot.transmission(joint - 1, joint - 2) == 0) {
          propose_coupling(known, law, joint, all);
        }
      }
    }
  }
}

/// Torques whose clock is late or early.
void propose_clocks(const Known& known, const std::vector<Hypothesis>& hypotheses,
                    std::vector<Extra>* all) {
  const auto left = known.fit.remainder.head(known.observations.train);
  for (const Hypothesis& hypothesis : hypotheses) {
    if (!hypothesis.traits().is_clock || hypothesis.linear > 0 ||
        hypothesis.traits().alters_model || is_chosen(known.fit.chosen, hypothesis)) {
      continue;
    }
    Extra best{{hypothesis, {}}, 0};
    for (const double delay : kDelays) {
      Machine late = known.fit.machine;
      hypothesis.apply({delay}, &late);
      const double gain = left.squaredNorm() - (left - change_by(known, late)).squaredNorm();
      if (gain > best.gain) {
        best = {{hypothesis, {delay}}, gain};
      }
    }
    if (best.gain > 0) {
      all->push_back(best);
    }
  }
}

std::vector<Extra> propose_extras(const Observations& observations, const Fit& fit,
                                  const std::vector<Hypothesis>& hypotheses) {
  const Known known{observations, fit, simulation::rigid_torques(fit.machine, observations.scenes)};
  std::vector<Extra> all;
  propose_couplings(known, &all);
  propose_clocks(known, hypotheses, &all);
  std::sort(all.begin(), all.end(), [](const Extra& a, const Extra& b) { return a.gain > b.gain; });
  return all;
}

/// Is an extra, as fitted, one that can be, and no mere touch of it?
bool is_real(const Observations& observations, const Fit& fit, std::size_t index) {
  const Chosen& extra = fit.chosen[index];
  return why_impossible(observations, fit, index).empty() &&
         (extra.hypothesis.traits().is_clock || std::abs(extra.values.front()) > kLeastCoupling);
}

/// The dictionary with the numbers of a coupled drive as they act through its coupling.
Dictionary with_coupled_drive(const Observations& observations, const Dictionary& dictionary,
                              const Chosen& coupling) {
  Dictionary coupled = dictionary;
  Machine machine = observations.machine;
  coupling.hypothesis.apply(coupling.values, &machine);
  const Eigen::VectorXd base = observations.stacked(
      predict(machine, observations.scenes, observations.rigid, observations.simulations));
  for (const Entry& entry : coupled.entries) {
    const Hypothesis& hypothesis = coupled.hypotheses[entry.hypothesis];
    if (hypothesis.joint != coupling.hypothesis.joint || !hypothesis.traits().is_in_family) {
      continue;
    }
    for (Eigen::Index i = 0; i < entry.count; ++i) {
      const auto parameter = static_cast<std::size_t>(i);
      Values values(hypothesis.parameters.size(), 0.0);
      values[parameter] = hypothesis.parameters[parameter].step;
      Machine changed = machine;
      hypothesis.apply(values, &changed);
      coupled.columns.col(entry.first + i) =
          (observations.stacked(predict(changed, observations.scenes, observations.rigid,
                                        observations.simulations)) -
           base) /
          values[parameter];
    }
  }
  return coupled;
}

/// The fit with its numbers held as what it leaves asks for. Their tolerances are scaled to what a
/// linear choice of them left, which is more where gains multiply and motors are coupled.
Fit held_as_fitted(const Observations& observations, Fit whole, std::size_t findings,
                   double deviation, const Dictionary& dictionary) {
  constexpr double kMuchLess = 0.8;  // time: a tolerance matters by its size alone
  const double less = deviation_of(observations, whole.remainder) / deviation;
  if (less > kMuchLess) {
    return whole;
  }
  for (std::size_t i = findings; i < whole.chosen.size(); ++i) {
    for (Parameter& parameter : whole.chosen[i].hypothesis.parameters) {
      parameter.tolerance /= less;
    }
  }
  return fit(observations, std::move(whole.chosen), kSimulatedSteps, &dictionary);
}

/// Numbers that a linear choice ends with, and the deviation to which their tolerances are scaled.
struct Start {
  std::vector<Chosen> chosen;
  double deviation = 1;
};

Start start_of(Elimination families) {
  std::vector<Chosen> chosen = families.best();
  return {std::move(chosen), families.deviation()};
}

/// Fits by simulation from numbers close by on, until all that stay behind the findings can be.
Fit settle(const Observations& observations, Start start, std::size_t findings,
           const Dictionary& dictionary) {
  Fit whole = fit(observations, std::move(start.chosen), kSimulatedSteps, &dictionary);
  whole = held_as_fitted(observations, std::move(whole), findings, start.deviation, dictionary);
  std::vector<Chosen> possible;
  for (int round = 0; round < kPossibleRounds; ++round) {
    if (round < kHoldingRounds && !bodies_can_be(observations, whole)) {
      possible = with_possible_bodies(observations, whole);
    } else if (auto all =
                   without_impossible(observations, whole, findings, round < kHoldingRounds)) {
      possible = std::move(*all);
    } else {
      break;
    }
    whole = fit(observations, possible, kSimulatedSteps, &dictionary);
  }
  return whole;
}

/// Chooses the numbers anew about those that were fitted. A torque's gain multiplies what masses
/// and friction do, which the model's own derivatives do not know.
Fit fit_anew(const Observations& observations, const Fit& fitted, std::size_t findings,
             const std::vector<Hypothesis>& hypotheses) {
  std::vector<Hypothesis> members;
  std::copy_if(hypotheses.begin(), hypotheses.end(), std::back_inserter(members),
               [](const Hypothesis& each) { return each.traits().is_in_family; });
  const Dictionary dictionary(observations, members, fitted.machine,
                              [](std::size_t, std::size_t) {});
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
    if (!predicts_better(observations, best, anew) &&
        !is_likelier(observations, best, anew, findings)) {
      break;
    }
    best = std::move(anew);
  }
  return best;
}

/// With what joins the families late, if that predicts better.
Fit joined(const Observations& observations, Fit best, std::size_t findings,
           const Dictionary& dictionary) {
  const std::vector<Chosen> late = latecomers(observations, best, dictionary);
  if (late.empty()) {
    return best;
  }
  std::vector<Chosen> all = best.chosen;
  all.insert(all.end(), late.begin(), late.end());
  Fit with = settle(observations, {std::move(all), deviation_of(observations, best.remainder)},
                    findings, dictionary);
  return predicts_better(observations, best, with) ? with : best;
}

/// Root mean square error (N·m) of what was held out.
double held_out_torque(const Observations& observations, const Fit& fit) {
  return observations.rms(fit.remainder, simulation::joint_torque, true);
}

/// The plain refit in the place of a fit whose bodies can be, where that leaves far more. Its first
/// `given` stay.
Fit or_regression(const Observations& observations, Fit best, std::size_t given,
                  const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary) {
  if (largest_ratio(observations, best.remainder) < kLikeNoise) {
    return best;
  }
  const auto end = best.chosen.begin() + static_cast<std::ptrdiff_t>(given);
  const Fit stays = fit(observations, {best.chosen.begin(), end}, 0);
  Fit plain = fit_regression(observations, stays, hypotheses, dictionary);
  return held_out_torque(observations, plain) < kClearlyBetter * held_out_torque(observations, best)
             ? plain
             : best;
}

/// Findings, and behind them the numbers of the families that stay beside them.
Fit fit_beside(const Observations& observations, const Fit& findings,
               const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary) {
  return settle(observations, start_of({observations, findings, hypotheses, dictionary}),
                findings.chosen.size(), dictionary);
}

}  // namespace

Fit fit_families(const Observations& observations, const Fit& findings,
                 const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary) {
  Fit best = refined(observations, fit_beside(observations, findings, hypotheses, dictionary),
                     findings.chosen.size(), hypotheses);
  if (!observations.has(simulation::joint_torque)) {
    return best;
  }
  std::vector<Chosen> given = findings.chosen;
  Dictionary current = dictionary;
  while (true) {
    const std::vector<Extra> extras = propose_extras(observations, best, hypotheses);
    if (extras.empty() || extras.front().gain < kLeastGain * best.train_sum) {
      break;
    }
    std::vector<Chosen> more = given;
    more.push_back(extras.front().chosen);
    Dictionary next_dictionary = more.back().hypothesis.traits().is_clock
                                     ? current
                                     : with_coupled_drive(observations, current, more.back());
    Fit next = fit_beside(observations, fit(observations, more, kExtraSteps, &next_dictionary),
                          hypotheses, next_dictionary);
    if (held_out_torque(observations, next) > kHopeless * held_out_torque(observations, best)) {
      break;
    }
    next = refined(observations, std::move(next), more.size(), hypotheses);
    if (!(bic_gain(observations, best, next) > kStrongEvidence) ||
        !predicts_better(observations, best, next) ||
        !is_real(observations, next, more.size() - 1)) {
      break;
    }
    best = std::move(next);
    given = std::move(more);
    current = std::move(next_dictionary);
  }
  best = joined(observations, std::move(best), given.size(), dictionary);
  return or_regression(observations, std::move(best), given.size(), hypotheses, current);
}

}  // namespace flexcomp::diagnosis
