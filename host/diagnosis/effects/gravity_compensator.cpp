#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

namespace {

/// Torque by the joint's angle; values: stiffness torque K, pull torque P, anchor ratio r, zero
/// angle.
double balancing_torque(const Values& values, double q) {
  const double lean = q + values[3];
  const double length = std::sqrt(1 + values[2] * values[2] - 2 * values[2] * std::cos(lean));
  return -std::sin(lean) * (values[0] + values[1] / length);
}

/// To first order: the drives and springs carry so much less.
simulation::Term balancer(int joint, const Values& values) {
  return {simulation::Term::wrench,
          [=](const Scene&, const Simulation& at, Prediction* prediction) {
            const Eigen::Index column = joint - 1;
            const Eigen::VectorXd torque =
                at.q.col(column).unaryExpr([&](double q) { return balancing_torque(values, q); });
            add_joint_angle(at, joint, at.joint_compliance[column] * torque, prediction);
            prediction->load.col(column) += torque;
            if (prediction->dynamic_load.cols() > 0) {
              prediction->dynamic_load.col(column) += torque;
            }
            add_torque(joint, -torque, prediction);
          }};
}

/// Torque -(sine sin q + cosine cos q), linear in both.
Hypothesis sine_balancer(int joint) {
  Hypothesis hypothesis;
  hypothesis.effect = "gravity_compensator";
  hypothesis.joint = joint;
  hypothesis.form = "sine";
  hypothesis.is_shape_only = true;  // a link's mass pulls by the same sine
  hypothesis.parameters = {{"sine_torque", "N·m", -1e6, 1e6, 100},
                           {"cosine_torque", "N·m", -1e6, 1e6, 100}};
  hypothesis.linear = 2;
  hypothesis.statement = fmt::format("a balancer acts on joint {}", joint);
  hypothesis.alters_model = true;
  hypothesis.apply = [joint](const Values& values, Machine* machine) {
    machine->balancers.emplace_back([joint, values](const JointVector<double, 6>& q) {
      JointVector<double, 6> torque = JointVector<double, 6>::Zero();
      const double angle = q[joint - 1];
      torque[joint - 1] = -values[0] * std::sin(angle) - values[1] * std::cos(angle);
      return torque;
    });
  };
  return hypothesis;
}

}  // namespace

// A coil spring or gas balancer between two links, missing from the model: anchored at distances a
// and b from the joint's axis, l apart, it pulls with F0 + k (l - l0); its torque is -sin(lean) (K
// + P / l'), with l' = sqrt(1 + r^2 - 2 r cos(lean)), lean the angle from where it does nothing, r
// = b/a. The form `sine` is P = 0, a spring that pulls in proportion to its whole length: all that
// small ranges of the angle can tell. Needs gravity in the model.
std::vector<Hypothesis> gravity_compensator(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (!observations.has_weight()) {
    return all;
  }
  for (const int joint : {2, 3}) {
    Hypothesis hypothesis;
    hypothesis.effect = "gravity_compensator";
    hypothesis.joint = joint;
    hypothesis.parameters = {{"stiffness_torque", "N·m", -1e6, 1e6, 100},
                             {"pull_torque", "N·m", -1e6, 1e6, 100},
                             {"anchor_ratio", "1", 0.05, 0.95, 0.05},
                             {"zero_angle", "rad", -4, 4, 0.05}};
    hypothesis.linear = 2;
    hypothesis.starts.clear();
    for (const double ratio : {0.3, 0.45, 0.65}) {
      for (int sector = 0; sector < 12; ++sector) {
        hypothesis.starts.push_back({ratio, (sector - 6) * M_PI / 6});
      }
    }
    hypothesis.statement = fmt::format("a balancer acts on joint {}", joint);
    hypothesis.alters_model = true;
    hypothesis.apply = [joint](const Values& values, Machine* machine) {
      machine->balancers.emplace_back([joint, values](const JointVector<double, 6>& q) {
        JointVector<double, 6> torque = JointVector<double, 6>::Zero();
        torque[joint - 1] = balancing_torque(values, q[joint - 1]);
        return torque;
      });
    };
    hypothesis.sketch = [joint](const Values& values) { return balancer(joint, values); };
    all.push_back(hypothesis);
    all.push_back(sine_balancer(joint));
  }
  return all;
}

}  // namespace flexcomp::diagnosis
