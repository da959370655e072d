#pragma once

#include "core/test_robots.hpp"
#include "recording/recording.hpp"

namespace flexcomp::test {

constexpr double kTurn = 6.28318530717958647692;

/// A loop of the program in one second, from 5 s on, with a steady wrench.
inline recording::Recording loop_path(bool backwards = false) {
  constexpr Eigen::Index kRows = 200;
  recording::Recording path;
  path.file = "loop";
  path.time = Eigen::VectorXd::LinSpaced(kRows, 5, 6);
  path.q_cmd = recording::Samples(kRows, 6);
  path.wrench = recording::Samples(kRows, 6);
  for (Eigen::Index i = 0; i < kRows; ++i) {
    const double phase = kTurn * static_cast<double>(i) / (kRows - 1);
    path.q_cmd->row(i) = loop_angles<double>(backwards ? -phase : phase).transpose();
    path.wrench->row(i) << 400, 300, -500, 0, 1, 2;
  }
  return path;
}

}  // namespace flexcomp::test
