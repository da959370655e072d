#include "simulation/differentiation.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace flexcomp::simulation {
namespace {

constexpr Eigen::Index kFewestNeighbours = 3;  // on either side: six numbers of a polynomial
constexpr int kOrder = kPolynomialOrder;
constexpr double kStandingStill = 1e-5;  // rad/s, far below any programmed motion
constexpr double kBeyondNoise = 4;       // deviations
constexpr double kMostNoiseScale = 4;  // of the variance of the angles' noise, as it was estimated
constexpr double kEnoughGone = 0.1;    // of the noise's variance, to tell its scale by
constexpr double kTiny = 1e-300;

struct Window {
  Eigen::Index first, row, last;
};

/// Rows within half a window (s), and so many at least that a polynomial is held.
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

/// Order of the polynomials about a row near an end of a recording, where a window has less on one
/// side. There a fifth order would amplify the noise up to 75 times as much as in the middle; of
/// these orders, none does more than half as much again.
int order_near_end(const Eigen::VectorXd& time, const Window& window) {
  constexpr double kNearlyWhole = 0.9;  // of the longer side
  constexpr double kHalf = 0.45;
  const double before = time[window.row] - time[window.first];
  const double after = time[window.last] - time[window.row];
  const double whole = std::min(before, after) / std::max(before, after);
  return whole > kNearlyWhole ? kOrder : whole > kHalf ? kOrder - 1 : 2;
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

/// Polynomials about a row; what one order more would change of the acceleration, beyond noise, is
/// how far it may be wrong where the motion is too abrupt for the samples.
LocalMotion differentiate(const Eigen::VectorXd& time, const recording::Samples& q,
                          const Eigen::RowVectorXd& angle_noise, const Window& window,
                          int order = kOrder) {
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

/// Accelerations (rad/s²) at rows all over a recording, and their gain of the angles' noise (1/s²).
struct Probes {
  Eigen::MatrixXd acceleration;
  Eigen::VectorXd gain;
};

Probes probe(const Eigen::VectorXd& time, const recording::Samples& q, double half_window) {
  constexpr Eigen::Index kMostProbes = 300;  // time; they tell a variance to a tenth
  const Eigen::Index count = std::min(kMostProbes, time.size());
  const Eigen::RowVectorXd exact = Eigen::RowVectorXd::Zero(q.cols());
  Probes probes{Eigen::MatrixXd(count, q.cols()), Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index row = i * (time.size() - 1) / std::max<Eigen::Index>(count - 1, 1);
    const LocalMotion motion = differentiate(time, q, exact, window_about(time, half_window, row));
    probes.acceleration.row(i) = motion.values.row(1);
    probes.gain[i] = motion.gain[1];
  }
  return probes;
}

/// Mean square of what the angles' noise does to the accelerations, (rad/s²)².
Eigen::ArrayXd mean_square_noise(const Probes& probes, const Eigen::RowVectorXd& angle_noise) {
  return probes.gain.squaredNorm() / static_cast<double>(probes.gain.size()) *
         angle_noise.array().square().transpose();
}

/// Mean square of what two windows' accelerations differ by, (rad/s²)².
Eigen::ArrayXd mean_square_between(const Probes& one, const Probes& other) {
  return (one.acceleration - other.acceleration).array().square().colwise().mean().transpose();
}

/// The part of that beyond their noise, whose variance is `scale` times as large as it was taken
/// for.
Eigen::ArrayXd cut_beyond(const Eigen::ArrayXd& differs, const Eigen::ArrayXd& gone,
                          const Eigen::ArrayXd& scale) {
  constexpr double kSlack = 1.2;  // of variances: probes tell them to a tenth
  return (differs - kSlack * scale * gone).max(0);
}

/// The window whose noise and cut together are least, of mean squares.
std::size_t best_of(Eigen::Index joint, const std::vector<Eigen::ArrayXd>& noise,
                    const std::vector<Eigen::ArrayXd>& cut) {
  constexpr double kMuchBetter = 0.5;  // of the mean square error of the shortest
  std::size_t best = 0;
  double least = kMuchBetter * noise[0][joint];
  for (std::size_t k = 1; k < noise.size(); ++k) {
    const double error = cut[k][joint] + noise[k][joint];
    if (error < least) {
      least = error;
      best = k;
    }
  }
  return best;
}

}  // namespace

LocalMotion local_motion(const Eigen::VectorXd& time, const recording::Samples& q,
                         const Eigen::RowVectorXd& angle_noise, double half_window,
                         Eigen::Index row) {
  const Window window = window_about(time, half_window, row);
  if (half_window > kHalfWindows.front()) {  // noise rules
    LocalMotion motion = differentiate(time, q, angle_noise, window, order_near_end(time, window));
    find_standing_in_noise(time, q, angle_noise, window, &motion);
    return motion;
  }
  LocalMotion motion = differentiate(time, q, angle_noise, window);
  find_standing(time, q, angle_noise, window, &motion);
  return motion;
}

std::vector<std::size_t> best_windows(const Eigen::VectorXd& time, const recording::Samples& q,
                                      const Eigen::RowVectorXd& angle_noise) {
  const Eigen::Index joints = q.cols();
  std::vector<Probes> probes = {probe(time, q, kHalfWindows[0])};
  std::vector<Eigen::ArrayXd> noise = {mean_square_noise(probes[0], angle_noise)};
  std::vector<Eigen::ArrayXd> from_shortest = {Eigen::ArrayXd::Zero(joints)};
  Eigen::ArrayXd scale = Eigen::ArrayXd::Constant(joints, kMostNoiseScale);
  for (std::size_t k = 1; k < kHalfWindows.size(); ++k) {
    probes.push_back(probe(time, q, kHalfWindows[k]));
    noise.push_back(mean_square_noise(probes[k], angle_noise));
    const Eigen::ArrayXd gone = (noise[0] - noise[k]).max(0);
    from_shortest.push_back(mean_square_between(probes[k], probes[0]));
    const Eigen::ArrayXd& differs = from_shortest[k];
    scale = scale.min(
        (gone > kEnoughGone * noise[0]).select((differs / gone.max(kTiny)).max(1), scale));
    // A longer window cuts more still.
    if ((differs > (2 * kMostNoiseScale + 1) * noise[0]).all()) {
      break;
    }
  }
  std::vector<Eigen::ArrayXd> cut(probes.size(), Eigen::ArrayXd::Zero(joints));
  for (std::size_t k = 1; k < probes.size(); ++k) {
    for (std::size_t shorter = 0; shorter < k; ++shorter) {
      const Eigen::ArrayXd gone = (noise[shorter] - noise[k]).max(0);
      const Eigen::ArrayXd differs =
          shorter == 0 ? from_shortest[k] : mean_square_between(probes[k], probes[shorter]);
      cut[k] = cut[k].max(cut_beyond(differs, gone, scale));
    }
  }
  for (Eigen::ArrayXd& each : noise) {
    each *= scale;
  }
  std::vector<std::size_t> best;
  for (Eigen::Index joint = 0; joint < joints; ++joint) {
    best.push_back(best_of(joint, noise, cut));
  }
  return best;
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
