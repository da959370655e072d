#include "diagnosis/least_squares.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace flexcomp::diagnosis {
namespace {

constexpr double kFirstDamping = 1e-6;   // of the curvature: nearly a full step
constexpr double kLeastDamping = 1e-10;  // below it rounding would decide
constexpr double kLeastRatio = 1e-3;     // of a step's gain to the expected, that it is taken by
constexpr int kMostRefusals = 12;        // of one step, each more damped: to the 2^78th part

/// How strongly steps are held to where they begin.
class Damping {
 public:
  double of_curvature() const { return value_; }

  /// A step gained so much of what was expected of it.
  void relax(double ratio) {
    value_ = std::max(kLeastDamping, value_ * std::max(1.0 / 3, 1 - std::pow(2 * ratio - 1, 3)));
    growth_ = 2;
  }

  void tighten() {
    value_ *= growth_;
    growth_ *= 2;
  }

 private:
  double value_ = kFirstDamping;
  double growth_ = 2;
};

/// The numbers that change something, but for those at a bound that would leave the box.
std::vector<Eigen::Index> free_numbers(const Quadratic& at, const Box& room) {
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < at.gradient.size(); ++i) {
    const bool leaves = at.gradient[i] > 0 ? room.lower[i] >= 0 : room.upper[i] <= 0;
    if (at.curvature(i, i) > 0 && !leaves) {
      free.push_back(i);
    }
  }
  return free;
}

/// The damped step of the free numbers, where the others' step is given and their own is zero.
Eigen::VectorXd free_step(const Quadratic& at, double damping,
                          const std::vector<Eigen::Index>& free, const Eigen::VectorXd& others) {
  const Eigen::VectorXd diagonal = at.curvature.diagonal();
  const Eigen::VectorXd unit = diagonal(free).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd damped = unit.asDiagonal() * at.curvature(free, free) * unit.asDiagonal();
  damped.diagonal().array() += damping;
  const Eigen::VectorXd slope = at.gradient(free) + at.curvature(free, Eigen::all) * others;
  return unit.cwiseProduct(damped.ldlt().solve(-unit.cwiseProduct(slope)));
}

/// The damped step that stays in the box: numbers that it would take out of it stop at their
/// bounds, and the others follow.
Eigen::VectorXd step_within(const Quadratic& at, double damping, const Box& room) {
  Eigen::VectorXd step = Eigen::VectorXd::Zero(at.gradient.size());
  std::vector<Eigen::Index> free = free_numbers(at, room);
  while (!free.empty()) {
    const Eigen::VectorXd own = free_step(at, damping, free, step);
    std::vector<Eigen::Index> inside;
    for (std::size_t k = 0; k < free.size(); ++k) {
      const double to = own[static_cast<Eigen::Index>(k)];
      const Eigen::Index i = free[k];
      if (to >= room.lower[i] && to <= room.upper[i]) {
        inside.push_back(i);
      } else {
        step[i] = std::clamp(to, room.lower[i], room.upper[i]);
      }
    }
    if (inside.size() == free.size()) {
      step(free) = own;
      break;
    }
    free = std::move(inside);
  }
  return step;
}

double expected_gain(const Quadratic& at, const Eigen::VectorXd& step) {
  return -at.gradient.dot(step) - 0.5 * step.dot(at.curvature * step);
}

}  // namespace

Eigen::VectorXd least_squares(SumOfSquares* squares, const Box& box, Eigen::VectorXd numbers,
                              const Steps& steps) {
  std::optional<Quadratic> at = squares->quadratic(numbers);
  Damping damping;
  int refusals = 0;
  for (int taken = 0; at && taken < steps.most && refusals < kMostRefusals;) {
    const Box room{box.lower - numbers, box.upper - numbers};
    const Eigen::VectorXd step = step_within(*at, damping.of_curvature(), room);
    const double expected = expected_gain(*at, step);
    if (std::abs(expected) <= steps.least_change * at->half) {
      break;
    }
    const Eigen::VectorXd next = box.nearest(numbers + step);
    const std::optional<double> half = expected > 0 ? squares->half(next) : std::nullopt;
    const double ratio = half ? (at->half - *half) / expected : 0;
    if (!(ratio > kLeastRatio)) {
      damping.tighten();
      ++refusals;
      continue;
    }
    numbers = next;
    damping.relax(ratio);
    refusals = 0;
    if (at->half - *half <= steps.least_change * at->half || ++taken == steps.most) {
      break;
    }
    at = squares->quadratic(numbers);
  }
  return numbers;
}

}  // namespace flexcomp::diagnosis
