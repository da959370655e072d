#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

namespace {

/// Share of the friction that acts, in −1…1, along a motion: after a reversal first the gap is
/// crossed without any, then the contact winds up over the slip, then it slides.
Eigen::VectorXd gripped(const Eigen::VectorXd& motion, double gap, double slip) {
  const Eigen::VectorXd strain =
      motion - simulation::play(motion, 0.5 * gap + slip);  // within ± (gap/2 + slip)
  return strain.unaryExpr([=](double z) {
    const double wound = std::clamp((std::abs(z) - 0.5 * gap) / slip, 0.0, 1.0);
    return z < 0 ? -wound : wound;
  });
}

using Grip = Eigen::VectorXd (*)(const Eigen::VectorXd&, const Values&);

Eigen::VectorXd with_play(const Eigen::VectorXd& motion, const Values& values) {
  return gripped(motion, values[2], values[1]);
}

Eigen::VectorXd without_play(const Eigen::VectorXd& motion, const Values& values) {
  return gripped(motion, 0, values[1]);
}

Eigen::VectorXd by_dahl(const Eigen::VectorXd& motion, const Values& values) {
  return simulation::bouc_wen(motion, values[1]);
}

std::vector<Values> starts_over(double range, bool has_gap) {
  std::vector<Values> starts;
  for (const double slip : {0.01, 0.03, 0.1}) {
    if (!has_gap) {
      starts.push_back({slip * range});
      continue;
    }
    for (const double gap : {0.01, 0.03, 0.1}) {
      starts.push_back({slip * range, gap * range});
    }
  }
  return starts;
}

}  // namespace

// Dry friction whose torque follows the motion in a loop: after a reversal it has to be built up
// over a slip, with or without play first. Forms: elastic slider with play (Iwan 1966, in series
// with a gap), elastic slider (Prandtl 1928), and Dahl's (1968), which is Bouc and Wen's along the
// motion. Needs torques, and reversals of motion.
std::vector<Hypothesis> friction_hysteresis(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (!(observations.has(simulation::joint_torque) && !observations.is_static)) {
    return all;
  }
  const std::pair<const char*, Grip> forms[] = {
      {"play", with_play}, {"slider", without_play}, {"dahl", by_dahl}};
  for (int joint = 1; joint <= 6; ++joint) {
    const double range = observations.range(joint);
    if (range < 1e-4) {
      continue;
    }
    const double size = std::max(0.02 * observations.largest_torque(joint), 0.01);
    for (const auto& [form, grip] : forms) {
      Hypothesis hypothesis;
      hypothesis.effect = "friction_hysteresis";
      hypothesis.joint = joint;
      hypothesis.form = form;
      hypothesis.parameters = {{"torque", "N·m", 0, 1e4 * size, size},
                               {"slip", "rad", 2e-3 * range, 0.5 * range, 1e-3 * range}};
      const bool has_gap = grip == with_play;
      if (has_gap) {
        hypothesis.parameters.push_back({"gap", "rad", 0, 0.5 * range, 1e-3 * range});
      }
      hypothesis.linear = 1;
      hypothesis.starts = starts_over(range, has_gap);
      hypothesis.statement =
          fmt::format("friction of joint {} builds up in a loop after every reversal", joint);
      hypothesis.apply = [joint, grip = grip](const Values& values, Machine* machine) {
        machine->terms.push_back({simulation::Term::output,
                                  [=](const Scene&, const Simulation& at, Prediction* prediction) {
                                    add_torque(joint, values[0] * grip(at.q.col(joint - 1), values),
                                               prediction);
                                  }});
      };
      all.push_back(hypothesis);
    }
  }
  return all;
}

}  // namespace flexcomp::diagnosis
