#include "simulation/differentiation.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace flexcomp::simulation {
namespace {

constexpr int kOrder = kPolynomialOrder;
constexpr double kStandingStill = 1e-5;  // rad/s, far below any programmed motion
constexpr double kBeyondNoise = 4;       // deviations
constexpr double kTiny = 1e-300;

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

/// Finds standing joints where angles' steps drown in noise: a joint stands where it has not moved
/// beyond the noise before or after a row.
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

constexpr double kHalf = 0.45;  // of the longer side of a window

/// The side of a window that has less time, over the other.
double evenness(const Eigen::VectorXd& time, const Window& window) {
  const double before = time[window.row] - time[window.first];
  const double after = time[window.last] - time[window.row];
  return std::min(before, after) / std::max(before, after);
}

/// Order of the polynomials about a row, near an end those that suit it there. There the fifth
/// order would amplify the noise up to 75 times as much as in the middle; the fourth does not more
/// than half as much again while a window has half of its other side.
int order_at(double even, const JointPolynomials& suited) {
  constexpr double kNearlyWhole = 0.9;
  const bool noise_rules = suited.inner.half_window > kHalfWindows.front();
  if (even > kNearlyWhole || (even > kHalf && !noise_rules)) {
    return suited.inner.order;
  }
  return even > kHalf ? suited.inner.order - 1 : suited.end.order;
}

/// Products of the powers of time, one order beyond the polynomials'.
using Powers = Eigen::Matrix<double, kOrder + 2, kOrder + 2>;

/// Normal equations, or their right sides, whose powers beyond an order neither act nor vary.
Powers up_to(int order, Powers gram) {
  for (int k = order + 1; k < gram.rows(); ++k) {
    gram.row(k).setZero();
    gram.col(k).setZero();
    gram(k, k) = 1;
  }
  return gram;
}

Columns<double, kOrder + 2> up_to(int order, Columns<double, kOrder + 2> moment) {
  moment.bottomRows(moment.rows() - order - 1).setZero();
  return moment;
}

}  // namespace

Window window_about(const Eigen::VectorXd& time, double half_window, Eigen::Index row) {
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
  return {first, row, last};
}

LocalMotion differentiate(const Eigen::VectorXd& time, const recording::Samples& q,
                          const Eigen::RowVectorXd& angle_noise, const Window& window, int order) {
  constexpr int kCount = kOrder + 1;
  const Eigen::Index row = window.row;
  const double span = std::max(time[window.last] - time[row], time[row] - time[window.first]);
  Eigen::Matrix<double, 2 * kCount + 1, 1> sums;  // of the powers of time
  sums.setZero();
  Columns<double, kCount + 1> moment = Columns<double, kCount + 1>::Zero(kCount + 1, q.cols());
  Eigen::Index used = 0;
  for (Eigen::Index i = window.first; i <= window.last; ++i) {
    if (q.row(i).allFinite()) {
      const double s = (time[i] - time[row]) / span;
      double power = 1;
      for (int k = 0; k <= 2 * kCount; ++k, power *= s) {
        sums[k] += power;
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
  Powers gram;
  for (int i = 0; i <= kCount; ++i) {
    for (int j = 0; j <= kCount; ++j) {
      gram(i, j) = sums[i + j];
    }
  }
  using Square = Eigen::Matrix<double, kCount, kCount>;
  const Square used_gram = up_to(order, gram).topLeftCorner<kCount, kCount>();
  const auto factors = used_gram.ldlt();
  const Columns<double, kCount> fit = factors.solve(up_to(order, moment).topRows<kCount>());
  motion.values.row(0) = fit.row(1) / span;
  motion.values.row(1) = 2 * fit.row(2) / (span * span);
  const Square covariance = factors.solve(Square::Identity());
  motion.gain << std::sqrt(covariance(1, 1)) / span,
      2 * std::sqrt(covariance(2, 2)) / (span * span);
  if (used > order + 1) {
    const auto higher = up_to(order + 1, gram).ldlt();
    const Columns<double, 1> change = higher.solve(up_to(order + 1, moment)).row(2) - fit.row(2);
    // Nested least squares: the variance of the change is the difference of the variances.
    const double gained = higher.solve(Powers::Identity())(2, 2) - covariance(2, 2);
    const Eigen::RowVectorXd limit = kBeyondNoise * std::sqrt(std::max(gained, 0.0)) * angle_noise;
    motion.doubt = (change.array().abs() > limit.array()).select(2 * change / (span * span), 0.0);
  }
  return motion;
}

LocalMotion local_motion(const Eigen::VectorXd& time, const recording::Samples& q,
                         const Eigen::RowVectorXd& angle_noise, const JointPolynomials& suited,
                         Eigen::Index row) {
  Window window = window_about(time, suited.inner.half_window, row);
  if (evenness(time, window) <= kHalf) {
    window = window_about(time, suited.end.half_window, row);
  }
  LocalMotion motion =
      differentiate(time, q, angle_noise, window, order_at(evenness(time, window), suited));
  if (suited.inner.half_window > kHalfWindows.front()) {  // noise rules
    find_standing_in_noise(time, q, angle_noise, window, &motion);
  } else {
    find_standing(time, q, angle_noise, window, &motion);
  }
  return motion;
}

Eigen::VectorXd smoothed(const Eigen::VectorXd& time, const Eigen::VectorXd& values,
                         double half_window) {
  Eigen::VectorXd smooth(values.size());
  for (Eigen::Index row = 0; row < values.size(); ++row) {
    const Window window = window_about(time, half_window, row);
    const Eigen::Index count = window.last - window.first + 1;
    const Eigen::ArrayXd from = time.segment(window.first, count).array() - time[row];
    const Eigen::ArrayXd scaled = from / std::max(from.abs().maxCoeff(), kTiny);
    Eigen::MatrixXd powers(count, kOrder + 1);
    powers.col(0).setOnes();
    for (int k = 1; k <= kOrder; ++k) {
      powers.col(k) = powers.col(k - 1).array() * scaled;
    }
    smooth[row] = powers.colPivHouseholderQr().solve(values.segment(window.first, count))[0];
  }
  return smooth;
}

}  // namespace flexcomp::simulation
