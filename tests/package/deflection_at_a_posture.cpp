#include <cstdio>
#include <flexcomp/compliance.hpp>

// A single soft shoulder: joint 2 of a six-joint chain with one 1 m arm along x.
int main() {
  flexcomp::RobotModel<double, 6> model;
  for (auto& joint : model.joints) {
    joint.lower = -3;
    joint.upper = 3;
  }
  model.joints[1].axis = flexcomp::Vector3<double>::UnitY();
  model.joints[1].compliance = 1e-6;
  model.tool.position = flexcomp::Vector3<double>(1, 0, 0);
  flexcomp::Wrench<double> wrench;
  wrench << 0, 0, 1000, 0, 0, 0;
  const auto bent =
      flexcomp::deflection<double, 6>(model, flexcomp::JointVector<double, 6>::Zero(), wrench);
  std::printf("%.3f mm\n", 1e3 * bent.tcp[2]);
  return bent.tcp[2] > 0.999e-3 && bent.tcp[2] < 1.001e-3 ? 0 : 1;
}
