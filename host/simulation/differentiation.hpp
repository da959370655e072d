#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "model/chain.hpp"
#include "recording/recording.hpp"

/// Velocities and accelerations from recorded joint angles.
namespace flexcomp::simulation {

/// Half of the time that a polynomial spans, s; the first is a little more than 16 ms, for times
/// that are rounded. The others are for angles whose noise would drown the acceleration.
constexpr std::array<double, 8> kHalfWindows = {0.0161, 0.025, 0.035, 0.05, 0.07, 0.1, 0.14, 0.2};

/// Order of the polynomials.
constexpr int kPolynomialOrder = 5;

/// So many numbers of every joint.
template <typename Scalar, int Rows>
using Columns =
    Eigen::Matrix<Scalar, Rows, Eigen::Dynamic, Rows == 1 ? Eigen::RowMajor : Eigen::ColMajor, Rows,
                  model::kMostJoints>;

/// Motion at one row, and how much of the angles' noise gets into it.
struct LocalMotion {
  explicit LocalMotion(Eigen::Index joints)
      : values(Columns<double, 2>::Zero(2, joints)),
        doubt(Columns<double, 1>::Zero(joints)),
        stands(Columns<int, 1>::Zero(joints)) {}

  Columns<double, 2> values;                       ///< velocity, acceleration
  Eigen::Vector2d gain = Eigen::Vector2d::Zero();  ///< 1/s, 1/s²
  Columns<double, 1> doubt;                        ///< of the acceleration, rad/s²
  Columns<int, 1> stands;
};

/// Motion at a row: polynomials of fifth order through the neighbours within half a window (s), at
/// their true times (Savitzky and Golay 1964); without delay. `angle_noise` (rad) is of each joint.
LocalMotion local_motion(const Eigen::VectorXd& time, const recording::Samples& q,
                         const Eigen::RowVectorXd& angle_noise, double half_window,
                         Eigen::Index row);

/// Half windows of the joints' polynomials (indices of kHalfWindows) by which the accelerations are
/// least wrong: a short one lets the angles' noise through, a long one cuts the motion's corners.
///
/// Both are measured. The noise of an acceleration is that of the angles times the polynomial's
/// gain. What a window differs by from any shorter one beyond their noise is what it cuts (Lepski
/// 1991; Goldenshluger and Lepski 2011): of nested least squares the variance of the difference is
/// the difference of the variances. The shortest alone would not do, since its noise hides what
/// the longer ones cut. Where all windows differ from the shortest by the same part of that
/// variance, the noise is larger than it was taken for. The shortest is kept unless noise rules it.
std::vector<std::size_t> best_windows(const Eigen::VectorXd& time, const recording::Samples& q,
                                      const Eigen::RowVectorXd& angle_noise);

/// Values through the same polynomials: what of them is as slow as a motion that was differentiated
/// over half a window (s). Rows as they are; three neighbours on either side at least.
Eigen::VectorXd smoothed(const Eigen::VectorXd& time, const Eigen::VectorXd& values,
                         double half_window);

/// Frequency (Hz) at which they pass half of the power, where a window holds many samples: that of
/// the least-squares kernel of fourth order (in the middle of a window the fifth power adds
/// nothing).
constexpr double half_power_frequency(double half_window) { return 0.8463 / half_window; }

}  // namespace flexcomp::simulation
