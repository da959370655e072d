#pragma once

#include <string>
#include <vector>

#include "diagnosis/fit.hpp"
#include "effects/law_place.hpp"

namespace flexcomp::diagnosis::grammar {

/// Rows of all scenes, one scene after the other: courses of signals and of laws are such columns.
struct Rows {
  explicit Rows(const Observations& observations);

  Eigen::Index count = 0;
  std::vector<Eigen::Index> first;  ///< of each scene
  std::vector<int> stretch;         ///< of each row; no two scenes share one
  int stretches = 0;
};

/// A place where a law may act, and how what a fit leaves shows there.
///
/// A law whose value is u in a row moves each sample of that row by lever · u. So least squares
/// over the samples to fit to become sums over rows: those of w·u² and of p·u. Samples that are far
/// off count as if they were less so.
struct Seat {
  effects::LawPlace place;
  std::string name;         ///< as robot.yaml has it
  std::string axis;         ///< the same; empty where it has none
  Eigen::VectorXd weight;   ///< w: squares of the levers; zero in rows that are held out
  Eigen::VectorXd product;  ///< p: levers times remainder
  Eigen::MatrixXd fitted;   ///< levers times an orthonormal base of what is fitted already
};

/// The places at which what was recorded could show a law, beside a fit.
std::vector<Seat> seats_of(const Observations& observations, const Rows& rows, const Fit& fit);

}  // namespace flexcomp::diagnosis::grammar
