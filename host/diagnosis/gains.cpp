#include "diagnosis/gains.hpp"

namespace flexcomp::diagnosis {

Eigen::VectorXd gains_of(const std::vector<Chosen>& chosen, int joints) {
  Eigen::VectorXd gains = Eigen::VectorXd::Ones(joints);
  for (const Chosen& each : chosen) {
    if (each.hypothesis.traits().is_gain) {
      gains[each.hypothesis.joint - 1] *= 1 + each.values.front();
    }
  }
  return gains;
}

Eigen::VectorXd by_sample(const Observations& observations, const Eigen::VectorXd& factors,
                          Eigen::Index count) {
  Eigen::VectorXd all = Eigen::VectorXd::Ones(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    if (at.channel == simulation::joint_torque) {
      all[i] = factors[at.component];
    }
  }
  return all;
}

}  // namespace flexcomp::diagnosis
