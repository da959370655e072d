#include "simulation/windows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace flexcomp::simulation {
namespace {

constexpr double kMostNoiseScale = 4;  // of the variance of the angles' noise, as it was estimated
constexpr double kCreep = 10;  // of the angles' noise in half a window: three counts of an encoder
constexpr double kEndless = std::numeric_limits<double>::infinity();

/// Accelerations (rad/s²) at rows (× joints) all over a recording, and their gain of the angles'
/// noise (1/s²). None is near an end, where polynomials of a lower order cut more of the motion.
struct Probes {
  Eigen::MatrixXd acceleration;
  Eigen::MatrixXd moved;  ///< rad, in half a window
  Eigen::VectorXd gain;
};

/// Rows all over a recording, but for the longest half window, or a quarter, at its ends.
std::vector<Eigen::Index> inner_rows(const Eigen::VectorXd& time) {
  constexpr Eigen::Index kMostProbes = 300;  // time; they tell a variance to a tenth
  const double duration = time[time.size() - 1] - time[0];
  const double end = std::min(kHalfWindows.back(), duration / 4);
  const auto row_at = [&time](double moment) {
    return std::lower_bound(time.begin(), time.end(), moment) - time.begin();
  };
  const Eigen::Index first = row_at(time[0] + end);
  const Eigen::Index last = row_at(time[time.size() - 1] - end);
  const Eigen::Index count = std::min(kMostProbes, last - first + 1);
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < count; ++i) {
    rows.push_back(first + i * (last - first) / std::max<Eigen::Index>(count - 1, 1));
  }
  return rows;
}

/// What polynomials see about a row.
enum Side { both_sides, one_side };

Probes probe(const Eigen::VectorXd& time, const recording::Samples& q, const Polynomials& through,
             Side side) {
  const std::vector<Eigen::Index> rows = inner_rows(time);
  const auto count = static_cast<Eigen::Index>(rows.size());
  const Eigen::RowVectorXd exact = Eigen::RowVectorXd::Zero(q.cols());
  Probes probes{Eigen::MatrixXd(count, q.cols()), Eigen::MatrixXd(count, q.cols()),
                Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    Window window = window_about(time, through.half_window, rows[static_cast<std::size_t>(i)]);
    if (side == one_side) {
      window.first = window.row;
      window.last = std::clamp(window.row + 2 * kFewestNeighbours, window.last, time.size() - 1);
    }
    const LocalMotion motion = differentiate(time, q, exact, window, through.order);
    probes.acceleration.row(i) = motion.values.row(1);
    probes.moved.row(i) = through.half_window * motion.values.row(0).cwiseAbs();
    probes.gain[i] = motion.gain[1];
  }
  return probes;
}

/// Mean square of what the angles' noise does to the accelerations, (rad/s²)².
Eigen::ArrayXd mean_square_noise(const Probes& probes, const Eigen::RowVectorXd& angle_noise) {
  return probes.gain.squaredNorm() / static_cast<double>(probes.gain.size()) *
         angle_noise.array().square().transpose();
}

std::vector<Eigen::Index> all_rows(const Probes& probes) {
  std::vector<Eigen::Index> rows(static_cast<std::size_t>(probes.gain.size()));
  std::iota(rows.begin(), rows.end(), Eigen::Index{0});
  return rows;
}

/// Rows that tell a window from longer ones: those where the joint does not creep, or all where
/// these are few. While a joint creeps, its encoder counts at an even pace. That is a tone, which a
/// window follows and all longer ones cut, as if it were motion.
std::vector<Eigen::Index> telling_rows(const Probes& probes, double angle_noise,
                                       Eigen::Index joint) {
  constexpr double kFew = 0.25;  // of all
  std::vector<Eigen::Index> telling = all_rows(probes);
  const double few = kFew * static_cast<double>(telling.size());
  const auto creeps = [&](Eigen::Index row) {
    return !(probes.moved(row, joint) > kCreep * angle_noise);
  };
  telling.erase(std::remove_if(telling.begin(), telling.end(), creeps), telling.end());
  return static_cast<double>(telling.size()) < few ? all_rows(probes) : telling;
}

/// Mean square of what two windows' accelerations of a joint differ by, (rad/s²)². The largest
/// fiftieth of the squares does not count: where a motion is abrupt for a moment, its acceleration
/// is doubted, and all the rest need not be as noisy as a window that follows it.
double mean_square_between(const Probes& one, const Probes& other,
                           const std::vector<Eigen::Index>& rows, Eigen::Index joint) {
  constexpr double kCounted = 0.98;
  constexpr double kPower = 0.856;  // of independent normal errors, that these have
  Eigen::ArrayXd squares =
      (one.acceleration(rows, joint) - other.acceleration(rows, joint)).array().square();
  const auto counted = static_cast<Eigen::Index>(kCounted * static_cast<double>(squares.size()));
  std::nth_element(squares.begin(), squares.begin() + counted, squares.end());
  return squares.head(counted).sum() / (kPower * static_cast<double>(squares.size()));
}

/// The same of every joint, at the rows that tell the shorter window from others.
Eigen::ArrayXd mean_square_from(const Probes& shorter, const Probes& longer,
                                const Eigen::RowVectorXd& angle_noise) {
  Eigen::ArrayXd mean(angle_noise.size());
  for (Eigen::Index joint = 0; joint < mean.size(); ++joint) {
    mean[joint] = mean_square_between(shorter, longer,
                                      telling_rows(shorter, angle_noise[joint], joint), joint);
  }
  return mean;
}

/// Probes by ever longer windows, up to those that clearly cut all joints' motion.
std::vector<Probes> probes_of(const Eigen::VectorXd& time, const recording::Samples& q,
                              const Eigen::RowVectorXd& angle_noise) {
  std::vector<Probes> all;
  for (const double half_window : kHalfWindows) {
    all.push_back(probe(time, q, {half_window, kPolynomialOrder}, both_sides));
    const Eigen::ArrayXd clearly =
        (2 * kMostNoiseScale + 1) * mean_square_noise(all.front(), angle_noise);
    if ((mean_square_from(all.front(), all.back(), angle_noise) > clearly).all()) {
      break;
    }
  }
  return all;
}

/// Mean squares of what the windows from one on differ from it by, the first of them zero.
std::vector<Eigen::ArrayXd> differences_from(const std::vector<Probes>& probes,
                                             const Eigen::RowVectorXd& angle_noise,
                                             std::size_t window) {
  std::vector<Eigen::ArrayXd> all;
  for (std::size_t longer = window; longer < probes.size(); ++longer) {
    all.push_back(mean_square_from(probes[window], probes[longer], angle_noise));
  }
  return all;
}

/// How much larger a window's noise is, as a variance, than independent readings would make it: an
/// encoder's counts follow one another. Of the windows that have hardly any of the noise, the one
/// that differs least tells it, since what that one cuts can only add. All of them may cut: then it
/// is hardly more than `last`, that of the shorter window before. The longest windows tell nothing,
/// and have that of the last.
Eigen::ArrayXd noise_scale(const std::vector<Eigen::ArrayXd>& differs,
                           const std::vector<Eigen::ArrayXd>& noise, std::size_t window,
                           const Eigen::ArrayXd& last) {
  constexpr double kNearlyAll = 0.9;  // of the noise's variance, that is gone
  constexpr double kHardlyMore = 1.5;
  Eigen::ArrayXd told = Eigen::ArrayXd::Constant(last.size(), kEndless);
  for (std::size_t longer = window + 1; longer < noise.size(); ++longer) {
    const Eigen::ArrayXd gone = noise[window] - noise[longer];
    if ((gone > kNearlyAll * noise[window]).all()) {
      told = told.min(differs[longer - window] / gone);
    }
  }
  return (told < kEndless).select(told.min(kHardlyMore * last), last);
}

/// How far a variance that probes tell may be off by chance, as a factor: those within half a
/// window (s) have noise in common.
double chance_of(const Probes& probes, double duration, double half_window) {
  constexpr double kDeviations = 3;  // pairs of windows are many
  const double independent =
      std::min(static_cast<double>(probes.gain.size()), std::max(duration / half_window, 1.0));
  return 1 + kDeviations * std::sqrt(2 / independent);
}

/// What a window cuts at least, where noise hides it, by what the next longer one does: of a second
/// derivative, polynomials of fourth order (in the middle of a window the fifth power adds nothing)
/// cut as the fourth power of a short window.
void cut_less(std::vector<Eigen::ArrayXd>* cut) {
  constexpr double kPower = 8;  // of mean squares
  for (std::size_t k = cut->size() - 1; k > 0; --k) {
    const double less = std::pow(kHalfWindows[k - 1] / kHalfWindows[k], kPower);
    (*cut)[k - 1] = (*cut)[k - 1].max(less * (*cut)[k]);
  }
}

/// The window whose noise and cut together are least, of mean squares. What is cut counts twice as
/// an error: it is systematic, and nobody knows of it where it is taken for torque.
std::size_t best_of(Eigen::Index joint, const std::vector<Eigen::ArrayXd>& noise,
                    const std::vector<Eigen::ArrayXd>& cut) {
  constexpr double kSystematic = 2;
  constexpr double kMuchBetter = 0.5;  // of the mean square error of the shortest
  std::size_t best = 0;
  double least = kMuchBetter * noise[0][joint];
  for (std::size_t k = 1; k < noise.size(); ++k) {
    const double error = kSystematic * kSystematic * cut[k][joint] + noise[k][joint];
    if (error < least) {
      least = error;
      best = k;
    }
  }
  return best;
}

/// Chooses the polynomials for the ends: those that err least where they are given one side of rows
/// whose acceleration is known, by both sides.
void choose_ends(const Eigen::VectorXd& time, const recording::Samples& q,
                 const std::vector<Probes>& probes, const std::vector<std::size_t>& inner,
                 std::vector<JointPolynomials>* best) {
  constexpr int kOrders[] = {2, kPolynomialOrder};
  const std::vector<Eigen::Index> rows = all_rows(probes.front());
  std::vector<double> least(inner.size(), kEndless);
  for (const double half_window : kHalfWindows) {
    for (const int order : kOrders) {
      const Polynomials tried{half_window, order};
      const Probes at_end = probe(time, q, tried, one_side);
      for (std::size_t joint = 0; joint < inner.size(); ++joint) {
        const auto column = static_cast<Eigen::Index>(joint);
        const double error = mean_square_between(at_end, probes[inner[joint]], rows, column);
        if (error < least[joint]) {
          least[joint] = error;
          (*best)[joint].end = tried;
        }
      }
    }
  }
}

}  // namespace

std::vector<JointPolynomials> best_polynomials(const Eigen::VectorXd& time,
                                               const recording::Samples& q,
                                               const Eigen::RowVectorXd& angle_noise) {
  const std::vector<Probes> probes = probes_of(time, q, angle_noise);
  std::vector<Eigen::ArrayXd> noise;
  for (const Probes& each : probes) {
    noise.push_back(mean_square_noise(each, angle_noise));
  }
  const double duration = time[time.size() - 1] - time[0];
  std::vector<Eigen::ArrayXd> cut(probes.size(), Eigen::ArrayXd::Zero(q.cols()));
  std::vector<Eigen::ArrayXd> scales;
  Eigen::ArrayXd scale = Eigen::ArrayXd::Constant(q.cols(), kMostNoiseScale);
  for (std::size_t shorter = 0; shorter < probes.size(); ++shorter) {
    const std::vector<Eigen::ArrayXd> all = differences_from(probes, angle_noise, shorter);
    scale = noise_scale(all, noise, shorter, scale);
    const double chance = chance_of(probes[shorter], duration, kHalfWindows[shorter]);
    for (std::size_t k = shorter + 1; k < probes.size(); ++k) {
      const Eigen::ArrayXd& differs = all[k - shorter];
      const Eigen::ArrayXd gone = scale * (noise[shorter] - noise[k]).max(0);
      cut[k] = (differs > chance * gone).select(cut[k].max(differs - gone), cut[k]);
    }
    noise[shorter] *= scale;
    scales.push_back(scale);
  }
  cut_less(&cut);
  std::vector<std::size_t> inner;
  std::vector<JointPolynomials> best(static_cast<std::size_t>(q.cols()));
  for (Eigen::Index joint = 0; joint < q.cols(); ++joint) {
    inner.push_back(best_of(joint, noise, cut));
    JointPolynomials& own = best[static_cast<std::size_t>(joint)];
    own.inner.half_window = kHalfWindows[inner.back()];
    // The window in use cuts little: it tells the noise of the one that has ten times as much.
    constexpr std::size_t kShorter = 2;
    own.noise_scale =
        inner.back() >= kShorter ? std::sqrt(scales[inner.back() - kShorter][joint]) : 1;
  }
  choose_ends(time, q, probes, inner, &best);
  return best;
}

}  // namespace flexcomp::simulation
