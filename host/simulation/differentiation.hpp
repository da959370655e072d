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
constexpr std::array<double, 11> kHalfWindows = {0.0161, 0.025, 0.035, 0.05, 0.07, 0.1,
                                                 0.14,   0.2,   0.28,  0.4,  0.56};

/// Order of the polynomials.
constexpr int kPolynomialOrder = 5;

/// Rows on either side that are enough for a polynomial's six numbers.
constexpr Eigen::Index kFewestNeighbours = 3;

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

/// Rows from the first to the last through which a polynomial about one of them goes.
struct Window {
  Eigen::Index first, row, last;
};

/// Rows within half a window (s), and so many at least that a polynomial is held.
Window window_about(const Eigen::VectorXd& time, double half_window, Eigen::Index row);

/// Motion by polynomials of an order (kPolynomialOrder at most) through the rows of a window, at
/// their true times (Savitzky and Golay 1964); without delay. `angle_noise` (rad) is of each joint.
/// What one order more would change of the acceleration, beyond noise, is how far it may be wrong
/// where the motion is too abrupt for the samples.
LocalMotion differentiate(const Eigen::VectorXd& time, const recording::Samples& q,
                          const Eigen::RowVectorXd& angle_noise, const Window& window, int order);

/// Polynomials of an order over half a window (s).
struct Polynomials {
  double half_window = kHalfWindows.front();
  int order = kPolynomialOrder;

  bool operator==(const Polynomials& other) const {
    return half_window == other.half_window && order == other.order;
  }
};

/// Polynomials that suit a joint: all along a recording, and at its ends, where a window has one
/// side alone.
struct JointPolynomials {
  Polynomials inner, end;
  /// Of the accelerations' noise all along, over that by independent readings of the angles.
  double noise_scale = 1;

  /// Are they the same polynomials?
  bool operator==(const JointPolynomials& other) const {
    return inner == other.inner && end == other.end;
  }
};

/// Motion at a row of a recording, at its ends too.
LocalMotion local_motion(const Eigen::VectorXd& time, const recording::Samples& q,
                         const Eigen::RowVectorXd& angle_noise, const JointPolynomials& suited,
                         Eigen::Index row);

/// Values through the same polynomials: what of them is as slow as a motion that was differentiated
/// over half a window (s). Rows as they are; three neighbours on either side at least.
Eigen::VectorXd smoothed(const Eigen::VectorXd& time, const Eigen::VectorXd& values,
                         double half_window);

/// Frequency (Hz) at which they pass half of the power, where a window holds many samples: that of
/// the least-squares kernel of fourth order (in the middle of a window the fifth power adds
/// nothing).
constexpr double half_power_frequency(double half_window) { return 0.8463 / half_window; }

}  // namespace flexcomp::simulation
