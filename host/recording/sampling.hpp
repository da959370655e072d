#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "recording/recording.hpp"

namespace flexcomp::recording {

/// Which rows of a log hold a sample of their own, and when that was taken.
///
/// A log that asks a robot faster than the robot answers shows the same sample again, and the time
/// of a row is when it was asked for, not when the sample was taken. Differentiated twice, both
/// are accelerations that never were.
struct Sampling {
  std::vector<Eigen::Index> rows;     ///< that hold a sample of their own
  std::vector<Eigen::Index> repeats;  ///< that show the sample of the row before once more
  Eigen::VectorXd time;               ///< s, of `rows`
  double period = 0;                  ///< s between samples where times were evened; 0 as they are
};

/// Finds the rows that repeat the angles before though the joints move: every angle stays the same
/// to the bit, where before and after it moves on steadily. A joint that stands or creeps by an
/// encoder's steps repeats nothing.
///
/// Times become evenly spaced between gaps (a straight line through the stamps) where the angles
/// are much smoother over them, for the joints in the middle of all; else they stay as they are.
Sampling sampling_of(const Eigen::VectorXd& time, const Samples& angles);

/// The sampling of a recording's joint angles, which it has: rows that lack any of them are in
/// neither list. Load tests and commands have no repeats, and keep their times: a command that
/// stays the same is meant so.
Sampling sampling_of(const Recording& recording);

/// The usual step, in rows, from one sample of a sensor to its next in a log that is faster than
/// the sensor: the median, if nine tenths of the steps are at most one row longer. Empty where they
/// are not, or there are none.
std::optional<Eigen::Index> regular_step(std::vector<Eigen::Index> steps);

/// Some rows of a recording.
Recording picked(const Recording& recording, const std::vector<Eigen::Index>& rows);

}  // namespace flexcomp::recording
