#include "diagnosis/held_remainder.hpp"

#include "linear_algebra/gram.hpp"

namespace flexcomp::diagnosis {

HeldRemainder::HeldRemainder(Evaluator* evaluator)
    : evaluator_(evaluator), bodies_(evaluator->bodies()) {
  const auto count = static_cast<Eigen::Index>(evaluator->size());
  step_.resize(count);
  hold_.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Parameter& parameter = evaluator->parameter(static_cast<std::size_t>(i));
    step_[i] = parameter.step;
    hold_[i] = parameter.step / parameter.tolerance;
  }
}

Values HeldRemainder::values_of(const Eigen::VectorXd& numbers) const {
  const Eigen::VectorXd values = numbers.cwiseProduct(step_);
  return {values.begin(), values.end()};
}

Eigen::VectorXd HeldRemainder::outside(const Values& values) const {
  return bodies_.size() > 0 ? bodies_.outside(evaluator_->robot_with(values)) : Eigen::VectorXd();
}

Eigen::MatrixXd HeldRemainder::outside_slope(const Values& values,
                                             const Eigen::VectorXd& here) const {
  Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(bodies_.size(), step_.size());
  Values other = values;
  for (Eigen::Index i = 0; i < step_.size() && bodies_.size() > 0; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (evaluator_->alters(at)) {
      other[at] += kRelativeStep * step_[i];
      slope.col(i) = (outside(other) - here) / kRelativeStep;
      other[at] = values[at];
    }
  }
  return slope;
}

double HeldRemainder::half_of(const Eigen::VectorXd& remainder, const Eigen::VectorXd& numbers,
                              const Eigen::VectorXd& beyond) const {
  return 0.5 * (remainder.squaredNorm() + numbers.cwiseProduct(hold_).squaredNorm() +
                beyond.squaredNorm());
}

std::optional<double> HeldRemainder::half(const Eigen::VectorXd& numbers) {
  const Values values = values_of(numbers);
  const std::optional<Eigen::VectorXd> remainder = left(values, nullptr);
  if (!remainder) {
    return std::nullopt;
  }
  return half_of(*remainder, numbers, outside(values));
}

std::optional<Quadratic> HeldRemainder::quadratic(const Eigen::VectorXd& numbers) {
  const Values values = values_of(numbers);
  Eigen::MatrixXd slope;
  const std::optional<Eigen::VectorXd> remainder = left(values, &slope);
  if (!remainder) {
    return std::nullopt;
  }
  const Eigen::VectorXd beyond = outside(values);
  const Eigen::MatrixXd beyond_slope = outside_slope(values, beyond);
  const auto rows = slope.topRows(remainder->size());
  Eigen::MatrixXd curvature =
      step_.asDiagonal() * linear_algebra::gram_of(rows) * step_.asDiagonal();
  curvature += beyond_slope.transpose() * beyond_slope;
  curvature.diagonal() += hold_.cwiseAbs2();
  Quadratic all;
  all.half = half_of(*remainder, numbers, beyond);
  all.gradient = step_.cwiseProduct(rows.transpose() * *remainder) +
                 numbers.cwiseProduct(hold_.cwiseAbs2()) + beyond_slope.transpose() * beyond;
  all.curvature = std::move(curvature);
  return all;
}

void minimise(HeldRemainder* cost, const Steps& steps, Evaluator* evaluator) {
  const auto count = static_cast<Eigen::Index>(evaluator->size());
  const Values begin = evaluator->values();
  Box box{Eigen::VectorXd(count), Eigen::VectorXd(count)};
  Eigen::VectorXd numbers(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Parameter& bounds = evaluator->parameter(at);
    box.lower[i] = bounds.lower / bounds.step;
    box.upper[i] = bounds.upper / bounds.step;
    numbers[i] = begin[at] / bounds.step;
  }
  numbers = least_squares(cost, box, box.nearest(numbers), steps);
  evaluator->set(cost->values_of(numbers));
  evaluator->keep_within_bounds();
}

}  // namespace flexcomp::diagnosis
