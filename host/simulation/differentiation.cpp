#include "simulation/differentiation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace flexcomp::simulation {
namespace {

constexpr Eigen::Index kFewestNeighbours = 3;
constexpr int kOrder = 5;
constexpr double kStandingStill = 1e-5;  // rad/s, far below any programmed motion
constexpr double kBeyondNoise = 4;       // deviations

struct Window {
  Eigen::Index first, row, last;
};

/// A joint that stands still all the while has no speed, whatever a polynomial says.
void find_standing(const Eigen::VectorXd& time, const recording::Samples& q,
                   const Eigen::RowVectorXd& angle_noise, const Window& window,
                   LocalMotion* motion) {
  for (Eigen::Index joint = 0; joint < q.cols(); ++joint) {
    Eigen::Index standing = 0;
    for (Eigen::Index i = window.first; i < window.last; ++i) {
      const double moved = std::abs(q(i + 1, joint) - q(i, joint));
      standing +=
          moved <= kStandingStill * (time[i + 1] - time[i]) + kBeyondNoise * angle_noise[joint] ? 1
                                                                                                : 0;
    }
    motion->stands[joint] = standing > 0 ? 1 : 0;
    if (standing == window.last - window.first) {
      motion->values.col(joint).setZero();
      motion->doubt[joint] = 0;
    }
  }
}

/// Of angles whose steps drown in noise: a joint stands where it has not moved beyond it before or
/// after a row.
void find_standing_in_noise(const Eigen::VectorXd& time, const recording::Samples& q,
                            const Eigen::RowVectorXd& angle_noise, const Window& window,
                            LocalMotion* motion) {
  const auto [first, row, last] = window;
  const auto stands = [&, &q = q, &time = time](Eigen::Index from, Eigen::Index to,
                                                Eigen::Index joint) {
    return std::abs(q(to, joint) - q(from, joint)) <=
           kStandingStill * (time[to] - time[from]) + kBeyondNoise * angle_noise[joint];
  };
  for (Eigen::Index joint = 0; joint < q.cols(); ++joint) {
    const bool before = row > first && stands(first, row, joint);
    const bool after = last > row && stands(row, last, joint);
    motion->stands[joint] = before || after ? 1 : 0;
    if (before && after) {
      motion->values.col(joint).setZero();
      motion->doubt[joint] = 0;
    }
  }
}

/// Polynomials about a row; what one order more would change of the acceleration, beyond noise, is
/// how far it may be wrong where the motion is too abrupt for the samples.
LocalMotion differentiate(const Eigen::VectorXd& time, const recording::Samples& q,
                          const Eigen::RowVectorXd& angle_noise, const Window& window) {
  constexpr int kCount = kOrder + 1;
  const Eigen::Index row = window.row;
  const double span = std::max(time[window.last] - time[row], time[row] - time[window.first]);
  std::array<double, 2 * kCount + 1> sums{};  // of the powers of time
  Columns<double, kCount + 1> moment = Columns<double, kCount + 1>::Zero(kCount + 1, q.cols());
  Eigen::Index used = 0;
  for (Eigen::Index i = window.first; i <= window.last; ++i) {
    if (q.row(i).allFinite()) {
      const double s = (time[i] - time[row]) / span;
      double power = 1;
      for (int k = 0; k <= 2 * kCount; ++k, power *= s) {
        sums[static_cast<std::size_t>(k)] += power;
        if (k <= kCount) {
          moment.row(k) += power * (q.row(i) - q.row(row));
        }
      }
      ++used;
    }
  }
  LocalMotion motion(q.cols());
  if (used < kCount) {
    return motion;
  }
  Eigen::Matrix<double, kCount + 1, kCount + 1> gram;
  for (int i = 0; i <= kCount; ++i) {
    for (int j = 0; j <= kCount; ++j) {
      gram(i, j) = sums[static_cast<std::size_t>(i + j)];
    }
  }
  using Square = Eigen::Matrix<double, kCount, kCount>;
  const auto factors = gram.topLeftCorner<kCount, kCount>().ldlt();
  const Columns<double, kCount> fit = factors.solve(moment.topRows<kCount>());
  motion.values.row(0) = fit.row(1) / span;
  motion.values.row(1) = 2 * fit.row(2) / (span * span);
  const Square covariance = factors.solve(Square::Identity());
  motion.gain << std::sqrt(covariance(1, 1)) / span,
      2 * std::sqrt(covariance(2, 2)) / (span * span);
  if (used > kCount) {
    const auto higher = gram.ldlt();
    const Columns<double, 1> change = higher.solve(moment).row(2) - fit.row(2);
    // Nested least squares: the variance of the change is the difference of the variances.
    const double gained =
        higher.solve(Eigen::Matrix<double, kCount + 1, kCount + 1>::Identity())(2, 2) -
        covariance(2, 2);
    const Eigen::RowVectorXd limit = kBeyondNoise * std::sqrt(std::max(gained, 0.0)) * angle_noise;
    motion.doubt = (change.array().abs() > limit.array()).select(2 * change / (span * span), 0.0);
  }
  return motion;
}

}  // namespace

LocalMotion local_motion(const Eigen::VectorXd& time, const recording::Samples& q,
                         const Eigen::RowVectorXd& angle_noise, double half_window,
                         Eigen::Index row) {
  const Eigen::Index end = time.size() - 1;
  Eigen::Index first = row;
  Eigen::Index last = row;
  while (first > 0 &&
         (row - first < kFewestNeighbours || time[row] - time[first - 1] <= half_window)) {
    --first;
  }
  while (last < end &&
         (last - row < kFewestNeighbours || time[last + 1] - time[row] <= half_window)) {
    ++last;
  }
  // At the ends of a recording one side makes up for the other.
  while (last - first < 2 * kFewestNeighbours && (first > 0 || last < end)) {
    first -= first > 0 && last == end ? 1 : 0;
    last += last < end ? 1 : 0;
  }
  LocalMotion motion = differentiate(time, q, angle_noise, {first, row, last});
  if (half_window > kHalfWindows.front()) {
    find_standing_in_noise(time, q, angle_noise, {first, row, last}, &motion);
    return motion;
  }
  find_standing(time, q, angle_noise, {first, row, last}, &motion);
  return motion;
}

std::vector<std::size_t> best_windows(const Eigen::VectorXd& time, const recording::Samples& q,
                                      const Eigen::RowVectorXd& angle_noise) {
  constexpr Eigen::Index kMostProbes = 300;
  constexpr double kMuchBetter = 0.5;  // of the mean square error of the shortest
  const Eigen::Index joints = q.cols();
  const Eigen::Index count = std::min(kMostProbes, time.size());
  std::vector<std::size_t> best(static_cast<std::size_t>(joints), 0);
  Eigen::MatrixXd shortest(count, joints);
  Eigen::VectorXd shortest_gain(count);
  Eigen::RowVectorXd least(joints);
  for (std::size_t k = 0; k < kHalfWindows.size(); ++k) {
    Eigen::RowVectorXd cut = Eigen::RowVectorXd::Zero(joints);
    double gain_square = 0;
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Index row = i * (time.size() - 1) / std::max<Eigen::Index>(count - 1, 1);
      const LocalMotion motion = local_motion(time, q, angle_noise, kHalfWindows[k], row);
      const double gain = motion.gain[1];
      gain_square += gain * gain / static_cast<double>(count);
      if (k == 0) {
        shortest.row(i) = motion.values.row(1);
        shortest_gain[i] = gain;
      }
      const double gained = std::max(shortest_gain[i] * shortest_gain[i] - gain * gain, 0.0);
      cut += ((motion.values.row(1) - shortest.row(i)).array().square() -
              gained * angle_noise.array().square())
                 .matrix() /
             static_cast<double>(count);
    }
    const Eigen::RowVectorXd error = cut.cwiseMax(0) + gain_square * angle_noise.cwiseAbs2();
    for (Eigen::Index joint = 0; joint < joints; ++joint) {
      const auto at = static_cast<std::size_t>(joint);
      if (k == 0 || error[joint] < (best[at] == 0 ? kMuchBetter : 1.0) * least[joint]) {
        least[joint] = error[joint];
        best[at] = k;
      }
    }
    // A longer window cuts more still.
    if ((cut.array() > least.array()).all()) {
      break;
    }
  }
  return best;
}

}  // namespace flexcomp::simulation
