#include "diagnosis/families/possible_bodies.hpp"

#include <ceres/ceres.h>

#include <Eigen/QR>
#include <algorithm>

#include "diagnosis/evaluator.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr int kRounds = 20;       // of a tighter edge
constexpr double kTighter = 0.3;  // times the edge before
constexpr int kSteps = 50;        // of each round; one takes milliseconds

/// The weighted squares of a fit about where it is, rotated into as many rows as there are numbers.
struct Tangent {
  Eigen::VectorXd begin;  ///< the numbers there
  Eigen::MatrixXd slope;  ///< of the prediction by the numbers
  Eigen::VectorXd left;   ///< of the remainder

  Tangent(const Observations& observations, const Fit& fit) {
    const Eigen::Index n = observations.train;
    const Eigen::Index columns = fit.derivative.cols();
    const Eigen::VectorXd root = huber_weights(fit.remainder.head(n)).cwiseSqrt();
    Eigen::MatrixXd whole(n, columns + 1);
    whole.leftCols(columns) = root.asDiagonal() * fit.derivative.topRows(n);
    whole.col(columns) = root.cwiseProduct(fit.remainder.head(n));
    const Eigen::HouseholderQR<Eigen::MatrixXd> factors(whole);
    const Eigen::MatrixXd upper =
        factors.matrixQR().topRows(columns).triangularView<Eigen::Upper>();
    slope = upper.leftCols(columns);
    left = upper.col(columns);
    begin.resize(columns);
    Eigen::Index next = 0;
    for (const Chosen& each : fit.chosen) {
      for (const double value : each.values) {
        begin[next++] = value;
      }
    }
  }
};

/// Ceres' view of it: the rows of the tangent, then what the tolerances hold, then the bodies'
/// edges; in numbers over their steps.
class HeldRemainder : public ceres::CostFunction {
 public:
  HeldRemainder(const Tangent& tangent, const Evaluator& evaluator)
      : tangent_(tangent), evaluator_(evaluator), bodies_(evaluator.bodies()) {
    const auto columns = static_cast<int>(evaluator.size());
    set_num_residuals(2 * columns + static_cast<int>(bodies_.size()));
    mutable_parameter_block_sizes()->push_back(columns);
    for (const Chosen& each : evaluator.chosen()) {
      is_body_.insert(is_body_.end(), each.values.size(), each.hypothesis.traits().is_body);
    }
  }

  Values values_of(const double* scaled) const {
    Values values(evaluator_.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Parameter& bounds = evaluator_.parameter(i);
      values[i] = std::clamp(scaled[i] * bounds.step, bounds.lower, bounds.upper);
    }
    return values;
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Index columns = tangent_.begin.size();
    const Values values = values_of(parameters[0]);
    const Eigen::VectorXd outside = bodies_.outside(evaluator_.robot_with(values));
    Eigen::Map<Eigen::VectorXd> all(residuals, num_residuals());
    all.head(columns) =
        tangent_.left -
        tangent_.slope *
            (Eigen::Map<const Eigen::VectorXd>(values.data(), columns) - tangent_.begin);
    for (Eigen::Index i = 0; i < columns; ++i) {
      all[columns + i] = -values[static_cast<std::size_t>(i)] / parameter(i).tolerance;
    }
    all.tail(bodies_.size()) = outside;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      differentiate(values, outside, jacobians[0]);
    }
    return all.allFinite();
  }

 private:
  void differentiate(const Values& values, const Eigen::VectorXd& outside, double* target) const {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Eigen::Index columns = tangent_.begin.size();
    Eigen::Map<RowMajor> jacobian(target, num_residuals(), columns);
    jacobian.setZero();
    for (Eigen::Index i = 0; i < columns; ++i) {
      const Parameter& bounds = parameter(i);
      jacobian.col(i).head(columns) = -bounds.step * tangent_.slope.col(i);
      jacobian(columns + i, i) = -bounds.step / bounds.tolerance;
      if (is_body_[static_cast<std::size_t>(i)]) {
        Values other = values;
        other[static_cast<std::size_t>(i)] += kRelativeStep * bounds.step;
        jacobian.col(i).tail(bodies_.size()) =
            (bodies_.outside(evaluator_.robot_with(other)) - outside) / kRelativeStep;
      }
    }
  }

  const Parameter& parameter(Eigen::Index i) const {
    return evaluator_.parameter(static_cast<std::size_t>(i));
  }

  const Tangent& tangent_;
  const Evaluator& evaluator_;
  Bodies bodies_;
  std::vector<bool> is_body_;
};

/// Moves the evaluator's numbers to where the tangent, the tolerances and the edges agree best.
void settle(const Tangent& tangent, Evaluator* evaluator) {
  HeldRemainder cost(tangent, *evaluator);
  Values scaled = evaluator->values();
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  for (std::size_t i = 0; i < scaled.size(); ++i) {
    scaled[i] /= evaluator->parameter(i).step;
  }
  problem.AddResidualBlock(&cost, nullptr, scaled.data());
  for (std::size_t i = 0; i < scaled.size(); ++i) {
    const Parameter& bounds = evaluator->parameter(i);
    problem.SetParameterLowerBound(scaled.data(), static_cast<int>(i), bounds.lower / bounds.step);
    problem.SetParameterUpperBound(scaled.data(), static_cast<int>(i), bounds.upper / bounds.step);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = kSteps;
  options.function_tolerance = 1e-9;
  options.logging_type = ceres::SILENT;
  options.initial_trust_region_radius = 1e6;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  evaluator->set(cost.values_of(scaled.data()));
}

}  // namespace

bool bodies_can_be(const Observations& observations, const Fit& fit) {
  return Bodies(observations, fit.chosen).can_be(fit.machine.robot);
}

std::vector<Chosen> with_possible_bodies(const Observations& observations, const Fit& fit) {
  const Tangent tangent(observations, fit);
  std::vector<Chosen> chosen = fit.chosen;
  for (int round = 0; round < kRounds; ++round) {
    for (Chosen& each : chosen) {
      each.hypothesis.edge *= kTighter;
    }
    Evaluator evaluator(observations, chosen, nullptr);
    settle(tangent, &evaluator);
    chosen = evaluator.chosen();
    if (evaluator.bodies().can_be(evaluator.robot_with(evaluator.values()))) {
      break;
    }
  }
  return chosen;
}

}  // namespace flexcomp::diagnosis
