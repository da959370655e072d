#pragma once

#include <string>
#include <vector>

#include "diagnosis/fit.hpp"
#include "effects/law_place.hpp"

namespace flexcomp::diagnosis::grammar {

/// Rows of all scenes, one scene after the other, evenly thinned where there are many: courses of
/// signals and of laws are such columns.
struct Rows {
  explicit Rows(const Observations& observations);

  /// Values of all rows of a scene, thinned.
  Eigen::VectorXd of(const Eigen::VectorXd& values) const;
  /// Place of a scene's row among those that are taken; −1 where it is left out.
  Eigen::Index at(std::size_t scene, Eigen::Index row) const;
  Eigen::Index rows(std::size_t scene) const;

  Eigen::Index each = 1;            ///< one row in so many is taken
  Eigen::Index count = 0;           ///< of those that are taken
  std::vector<Eigen::Index> first;  ///< of each scene
  Eigen::VectorXd time;             ///< s
  std::vector<int> stretch;         ///< of each row; no two scenes share one
  int stretches = 0;
};

/// A place where a law may act, with the remainder of a fit as it shows there.
///
/// A law whose value is u in a row moves each sample of that row by lever · u. Least squares over
/// the samples to fit to therefore become sums over rows, of w·u² and of p·u. Outliers count as if
/// they were just no outliers.
struct Seat {
  effects::LawPlace place;
  std::string name;         ///< as robot.yaml has it
  std::string axis;         ///< the same; empty where it has none
  Eigen::VectorXd weight;   ///< w: squares of the levers; zero in rows that are held out
  Eigen::VectorXd product;  ///< p: levers times remainder
  Eigen::MatrixXd fitted;   ///< levers times an orthonormal base of what is fitted already

  /// Is it a sensor's? An error that follows no recorded signal shows there, as an error of the
  /// measurement in time: nobody knows whether the machine moved.
  bool is_sensor() const;
  /// Root mean square of the remainder there, over the noise.
  double left() const;
  /// Squares of the remainder there beyond those of the noise.
  double beyond_noise() const;
};

/// Change of each sample (over the noise) by a law at a place whose value is one.
Eigen::VectorXd levers_of(const Observations& observations, const effects::LawPlace& place);

/// The places at which the recordings could show a law beside a fit. Places where the fit leaves
/// little more than noise are left out.
std::vector<Seat> seats_of(const Observations& observations, const Rows& rows, const Fit& fit);

}  // namespace flexcomp::diagnosis::grammar
