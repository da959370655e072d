#include "diagnosis/families/extras.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/plausible.hpp"
#include "effects/law.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr Bounds kCouplings{-3, 3, 0.1};  // turns of a motor a turn of the joint before its own
constexpr double kLeastCoupling = 0.2;    // turns: below it friction of another form is imitated
constexpr double kDelays[] = {-0.03, -0.02, -0.012, -0.006, -0.003,
                              0.003, 0.006, 0.012,  0.02,   0.03};

/// A fit, and what of its machine's torques stays when a drive or a clock is changed.
struct Fitted {
  const Observations& observations;
  const Fit& fit;
  std::vector<simulation::RigidTorque> rigid;
};

/// Change of a fit's prediction by a machine, in the samples to fit to.
Eigen::VectorXd change_by(const Fitted& known, const Machine& machine) {
  const Observations& observations = known.observations;
  const Eigen::VectorXd predicted = observations.stacked(
      predict(machine, observations.scenes_to_fit(), known.rigid, observations.simulations));
  const Eigen::VectorXd before =
      observations.residual + observations.stacked(observations.predictions) - known.fit.remainder;
  return predicted.head(observations.train) - before.head(observations.train);
}

/// A drive that turns with the joint before its own, by one turn or against it, its friction and
/// rotor as they are.
void propose_coupling(const Fitted& known, const effects::LawPointer& law, int joint,
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

void propose_couplings(const Fitted& known, std::vector<Extra>* all) {
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
void propose_clocks(const Fitted& known, const std::vector<Hypothesis>& hypotheses,
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

}  // namespace

std::vector<Extra> propose_extras(const Observations& observations, const Fit& fit,
                                  const std::vector<Hypothesis>& hypotheses) {
  const Fitted known{observations, fit,
                     simulation::rigid_torques(fit.machine, observations.scenes_to_fit())};
  std::vector<Extra> all;
  propose_couplings(known, &all);
  propose_clocks(known, hypotheses, &all);
  std::sort(all.begin(), all.end(), [](const Extra& a, const Extra& b) { return a.gain > b.gain; });
  return all;
}

bool is_real(const Observations& observations, const Fit& fit, std::size_t index) {
  const Chosen& extra = fit.chosen[index];
  return why_impossible(observations, fit, index).empty() &&
         (extra.hypothesis.traits().is_clock || std::abs(extra.values.front()) > kLeastCoupling);
}

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

}  // namespace flexcomp::diagnosis
