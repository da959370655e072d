#pragma once

#include <Eigen/Core>

#include "simulation/machine.hpp"

namespace flexcomp::effects {

/// Where a hose is held that runs from the link before a joint to the tool.
struct HoseEnds {
  Vector3<double> arm;   ///< m, frame of the link before the joint
  Vector3<double> tool;  ///< m, tool frame
};

/// Rows of a simulation from the first on, `step` apart.
struct Rows {
  Eigen::Index step = 1;
  Eigen::Index count = 0;
};

/// A hose along a simulation, drawn straight from end to end.
struct HoseCourse {
  Eigen::VectorXd length;  ///< m
  /// Rows × joints, m/rad: by how much a joint lengthens it. A tension turns the joint by minus the
  /// product. Zero for joints that it does not span.
  Eigen::MatrixXd slope;
  Eigen::VectorXi direction;  ///< 1 where it lengthens, −1 where it shortens, or 0
};

/// By how much it is longer than when it is slack, m; zero where it is slack.
Eigen::VectorXd stretch(const HoseCourse& course, double slack_length);

/// The course of a hose from the link before `joint` (from 2 on) at some rows. The simulation needs
/// levers.
HoseCourse hose_course(const simulation::Simulation& simulation, int joint, const HoseEnds& ends,
                       const Rows& rows);

}  // namespace flexcomp::effects
