#include "diagnosis/held_remainder.hpp"

#include <algorithm>

namespace flexcomp::diagnosis {
namespace {

Values over_steps(const Evaluator& evaluator) {
  Values scaled = evaluator.values();
  for (std::size_t i = 0; i < scaled.size(); ++i) {
    const Parameter& bounds = evaluator.parameter(i);
    scaled[i] = std::clamp(scaled[i], bounds.lower, bounds.upper) / bounds.step;
  }
  return scaled;
}

}  // namespace

HeldRemainder::HeldRemainder(Eigen::Index rows, Evaluator* evaluator)
    : evaluator_(evaluator), rows_(rows), bodies_(evaluator->bodies()) {
  set_num_residuals(static_cast<int>(rows + bodies_.size()) + static_cast<int>(evaluator->size()));
  mutable_parameter_block_sizes()->push_back(static_cast<int>(evaluator->size()));
}

bool HeldRemainder::Evaluate(double const* const* parameters, double* residuals,
                             double** jacobians) const {
  Values values(evaluator_->size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = parameters[0][i] * evaluator_->parameter(i).step;
  }
  const bool wants = jacobians != nullptr && jacobians[0] != nullptr;
  Eigen::MatrixXd slope;
  Eigen::Map<Eigen::VectorXd> all(residuals, num_residuals());
  if (!leave(values, all.head(rows_), wants ? &slope : nullptr)) {
    return false;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    all[rows_ + static_cast<Eigen::Index>(i)] = -values[i] / evaluator_->parameter(i).tolerance;
  }
  Eigen::VectorXd outside;
  if (bodies_.size() > 0) {
    outside = bodies_.outside(evaluator_->robot_with(values));
    all.tail(bodies_.size()) = outside;
  }
  if (wants) {
    differentiate(values, slope, outside, jacobians[0]);
  }
  return all.head(rows_).allFinite();
}

void HeldRemainder::differentiate(const Values& values, const Eigen::MatrixXd& slope,
                                  const Eigen::VectorXd& outside, double* target) const {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  constexpr Eigen::Index kBlock = 64;  // rows that stay in the cache while they are turned
  const auto columns = static_cast<Eigen::Index>(values.size());
  Eigen::Map<RowMajor> jacobian(target, num_residuals(), columns);
  Eigen::VectorXd step(columns);
  for (Eigen::Index i = 0; i < columns; ++i) {
    step[i] = evaluator_->parameter(static_cast<std::size_t>(i)).step;
  }
  for (Eigen::Index row = 0; row < rows_; row += kBlock) {
    const Eigen::Index count = std::min(kBlock, rows_ - row);
    jacobian.middleRows(row, count) = slope.middleRows(row, count) * step.asDiagonal();
  }
  jacobian.bottomRows(columns + bodies_.size()).setZero();
  for (Eigen::Index i = 0; i < columns; ++i) {
    const Parameter& parameter = evaluator_->parameter(static_cast<std::size_t>(i));
    jacobian(rows_ + i, i) = -step[i] / parameter.tolerance;
    if (bodies_.size() > 0) {
      Values other = values;
      other[static_cast<std::size_t>(i)] += kRelativeStep * step[i];
      jacobian.col(i).tail(bodies_.size()) =
          (bodies_.outside(evaluator_->robot_with(other)) - outside) / kRelativeStep;
    }
  }
}

void minimise(HeldRemainder* cost, const Steps& steps, Evaluator* evaluator) {
  Values scaled = over_steps(*evaluator);
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  problem.AddResidualBlock(cost, nullptr, scaled.data());
  for (std::size_t i = 0; i < scaled.size(); ++i) {
    const Parameter& bounds = evaluator->parameter(i);
    problem.SetParameterLowerBound(scaled.data(), static_cast<int>(i), bounds.lower / bounds.step);
    problem.SetParameterUpperBound(scaled.data(), static_cast<int>(i), bounds.upper / bounds.step);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = steps.most;
  options.function_tolerance = steps.least_change;
  options.max_num_line_search_step_size_iterations = steps.most_shortenings;
  options.logging_type = ceres::SILENT;
  // Along a step that bounds cut, values alone are enough. The edge of what a body can be is steep:
  // there the search asks for slopes too, or it stops before it.
  if (!cost->holds_bodies()) {
    options.line_search_interpolation_type = ceres::QUADRATIC;
  }
  options.initial_trust_region_radius = 1e6;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  Values values(scaled.size());
  for (std::size_t i = 0; i < scaled.size(); ++i) {
    values[i] = scaled[i] * evaluator->parameter(i).step;
  }
  evaluator->set(values);
  evaluator->keep_within_bounds();
}

}  // namespace flexcomp::diagnosis
