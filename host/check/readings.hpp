#pragma once

#include <functional>
#include <string>
#include <vector>

#include "check/check.hpp"
#include "check/registration.hpp"
#include "model/robot.hpp"

/// Ways to read positions and angles: what a recording means if its writer made a certain slip.
namespace flexcomp::check {

/// Rows of a recording that have angles and a measured position.
struct PoseRows {
  Eigen::MatrixXd q;              ///< n×joints, rad
  Points measured;                ///< n×3, m
  std::vector<Pose<double>> tcp;  ///< of the stiff model
  Points predicted;               ///< n×3, where that puts the TCP
};

/// A reading under which angles and positions may fit.
struct Reading {
  Check check;      ///< what to say if it is the one; without the recording's file
  int steps = 1;    ///< how much has to be assumed
  double left = 0;  ///< m, median distance that stays
  /// Makes of angles (n×joints) and positions (n×3) what they mean.
  std::function<void(Eigen::MatrixXd* q)> mend_angles;
  std::function<void(Points* positions)> mend_positions;
};

using Readings = std::vector<Reading>;

/// Positions at angles.
Points positions_at(const model::Robot& robot, const Eigen::MatrixXd& q);

/// Positions in other units: mm, cm, inches, feet.
Readings unit_readings(const PoseRows& rows);

/// Positions with axes swapped or turned round.
Readings axis_readings(const PoseRows& rows);

/// Positions from another base frame, and mirrored ones; of a point elsewhere on the tool.
Readings frame_readings(const model::Robot& robot, const PoseRows& rows);

/// Angles in degrees, turned in sign, in another order, from another zero.
Readings joint_readings(const model::Robot& robot, const PoseRows& rows);

}  // namespace flexcomp::check
