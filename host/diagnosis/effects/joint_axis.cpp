#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

namespace {

/// The two axes of the joint's frame that lie most across its axis, in their order.
std::array<int, 2> across(const Vector3<double>& axis) {
  int along = 0;
  axis.cwiseAbs().maxCoeff(&along);
  return {along == 0 ? 1 : 0, along == 2 ? 1 : 2};
}

}  // namespace

// A joint's axis is tilted in the link before it: two small rotations of the joint's frame across
// the axis. It is the parameter that Denavit and Hartenberg's lack for axes that are nearly
// parallel (Hayati and Mirmirani 1985), and their twist elsewhere. The axis of joint 1 is the base
// frame's. Needs the TCP, and motion of the joints beyond.
std::vector<Hypothesis> joint_axis(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (!observations.has(simulation::tcp_position)) {
    return all;
  }
  constexpr std::array<const char*, 3> kNames = {"tilt_x", "tilt_y", "tilt_z"};
  for (int joint = 2; joint <= 6; ++joint) {
    const auto index = static_cast<std::size_t>(joint - 1);
    const std::array<int, 2> axes = across(observations.machine.robot.elastic.joints[index].axis);
    Hypothesis hypothesis;
    hypothesis.effect = "joint_axis";
    hypothesis.joint = joint;
    for (const int axis : axes) {
      hypothesis.parameters.push_back(
          {kNames[static_cast<std::size_t>(axis)], "rad", -0.1, 0.1, 1e-4});
    }
    hypothesis.linear = 2;
    if (!observations.spans_workspace()) {
      hypothesis.starts.clear();  // known of the machine it may be, but not found here
    }
    hypothesis.alters_model = true;
    hypothesis.statement = fmt::format("the axis of joint {} is tilted", joint);
    hypothesis.apply = [index, axes](const Values& values, Machine* machine) {
      Matrix3<double>& rotation = machine->robot.elastic.joints[index].origin.rotation;
      for (std::size_t i = 0; i < axes.size(); ++i) {
        rotation *= Eigen::AngleAxisd(values[i], Vector3<double>::Unit(axes[i])).toRotationMatrix();
      }
    };
    all.push_back(hypothesis);
  }
  return all;
}

}  // namespace flexcomp::diagnosis
