#pragma once

#include <array>
#include <cmath>

#include "flexcomp/compensator.hpp"
#include "flexcomp/model.hpp"

namespace flexcomp::test {

/// A six-axis robot with the proportions, joint limits and joint springs of a KUKA KR 270 (Klimchik
/// et al. 2017, table 2), written down here so that the core's tests need no files.
template <typename Scalar>
RobotModel<Scalar, 6> kr270() {
  using Vector = Vector3<Scalar>;
  const std::array<Vector, 6> origins = {Vector(0, 0, Scalar(0.675)), Vector(Scalar(0.35), 0, 0),
                                         Vector(Scalar(1.25), 0, 0),  Vector(0, 0, Scalar(-0.055)),
                                         Vector(Scalar(1.1), 0, 0),   Vector(0, 0, 0)};
  const std::array<Vector, 6> axes = {Vector(0, 0, -1), Vector(0, 1, 0), Vector(0, 1, 0),
                                      Vector(-1, 0, 0), Vector(0, 1, 0), Vector(-1, 0, 0)};
  const std::array<double, 6> compliance = {0.54e-6, 0.29e-6, 0.42e-6, 2.79e-6, 3.48e-6, 2.07e-6};
  const std::array<double, 6> limit = {3.2, 2.5, 2.7, 6.1, 2.1, 6.1};
  RobotModel<Scalar, 6> model;
  for (std::size_t i = 0; i < 6; ++i) {
    model.joints[i].origin.position = origins[i];
    model.joints[i].axis = axes[i];
    model.joints[i].compliance = static_cast<Scalar>(compliance[i]);
    model.joints[i].lower = static_cast<Scalar>(-limit[i]);
    model.joints[i].upper = static_cast<Scalar>(limit[i]);
  }
  model.tool.position = Vector(Scalar(0.23), 0, 0);
  return model;
}

/// The same with every spring, weight and offset that the model knows.
template <typename Scalar>
RobotModel<Scalar, 6> kr270_with_everything() {
  RobotModel<Scalar, 6> model = kr270<Scalar>();
  const std::array<double, 6> masses = {340, 260, 180, 60, 40, 10};
  for (std::size_t i = 0; i < 6; ++i) {
    model.joints[i].mass = static_cast<Scalar>(masses[i]);
    model.joints[i].center_of_mass =
        Vector3<Scalar>(Scalar(0.1) * static_cast<Scalar>(i), Scalar(0.02), Scalar(-0.03));
    model.joints[i].cubic_compliance = static_cast<Scalar>(2e-15);
  }
  model.joints[2].link_compliance << Scalar(2e-8), Scalar(3e-8), Scalar(4e-8), Scalar(5e-8),
      Scalar(6e-8), Scalar(7e-8);
  model.base_compliance << Scalar(1e-8), Scalar(2e-8), Scalar(1e-8), Scalar(3e-8), Scalar(4e-8),
      Scalar(1e-8);
  model.tool_compliance << Scalar(5e-8), Scalar(6e-8), Scalar(2e-8), Scalar(1e-7), Scalar(2e-7),
      Scalar(3e-7);
  model.gravity = Vector3<Scalar>(0, 0, Scalar(-9.81));
  model.payload_mass = 120;
  model.payload_center = Vector3<Scalar>(Scalar(0.05), Scalar(0.01), Scalar(0.2));
  model.tool.position = Vector3<Scalar>(Scalar(0.33), Scalar(0.02), Scalar(-0.1));
  model.tool.rotation << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  return model;
}

/// A stretch of program in joint space: a smooth loop of the arm joints, wrist turning along, well
/// away from singularities.
template <typename Scalar>
JointVector<Scalar, 6> loop_angles(double phase) {
  JointVector<Scalar, 6> q;
  q << static_cast<Scalar>(0.4 + 0.05 * std::cos(phase)),
      static_cast<Scalar>(-1.2 + 0.06 * std::sin(phase)),
      static_cast<Scalar>(1.3 + 0.07 * std::cos(phase + 0.5)),
      static_cast<Scalar>(0.3 + 0.1 * std::sin(phase)),
      static_cast<Scalar>(0.8 + 0.05 * std::cos(phase)),
      static_cast<Scalar>(-0.5 + 0.1 * std::cos(phase));
  return q;
}

/// A compensator for the KR 270 in ticks of 1 ms, with limits that nothing ordinary reaches.
inline CompensatorConfig<float, 6> compensator_config() {
  CompensatorConfig<float, 6> config;
  config.period = 1e-3F;
  config.model_hash = model_hash(kr270<float>());
  config.force_range = 5000;
  config.moment_range = 500;
  config.setpoint_age_limit = 0.004F;
  config.wrench_age_limit = 0.01F;
  config.joint_speed.setConstant(2);
  config.limits.fill({0.01F, 0.1F, 5.0F});
  config.deflection_limit = 0.01F;
  config.chart_margin = 0.01F;
  config.hold_time = 0.05F;
  config.fade_time = 0.2F;
  return config;
}

}  // namespace flexcomp::test
