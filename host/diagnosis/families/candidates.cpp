#include "diagnosis/families/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/plausible.hpp"
#include "diagnosis/search/search.hpp"
#include "linear_algebra/span.hpp"

namespace flexcomp::diagnosis {

bool is_candidate(const Observations& observations, const Hypothesis& hypothesis) {
  // Torques tell one encoder's zero from masses; all zeros beside all masses they do not.
  const bool is_seen =
      hypothesis.traits().measures != effects::Measures::zero || sees_angles(observations);
  return hypothesis.traits().is_in_family && is_seen &&
         hypothesis.linear == hypothesis.parameters.size() &&
         (!hypothesis.traits().is_body || observations.has(simulation::joint_torque));
}

bool could_matter(const Hypothesis& hypothesis, const Eigen::MatrixXd& columns,
                  const Eigen::VectorXd& target) {
  constexpr double kNoticeable = 0.1;  // of what is to be explained
  if (hypothesis.traits().is_gain) {
    return true;
  }
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    const Parameter& parameter = hypothesis.parameters[static_cast<std::size_t>(i)];
    const double most = std::max(std::abs(parameter.lower), std::abs(parameter.upper));
    if (most * columns.col(i).norm() > kNoticeable * target.norm()) {
      return true;
    }
  }
  return false;
}

Eigen::MatrixXd what_is_said(const Fit& fit, std::size_t findings, Eigen::Index train) {
  const Eigen::Index count = fit.first_parameter(findings);
  return count == 0 ? Eigen::MatrixXd(train, 0)
                    : linear_algebra::orthonormal_basis(fit.derivative.topLeftCorner(train, count));
}

bool is_said(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& said) {
  constexpr double kSame = 0.99;  // of what it does
  if (said.cols() == 0) {
    return false;
  }
  const Eigen::MatrixXd shares = said.transpose() * columns;
  return (shares.colwise().squaredNorm().array() > kSame * columns.colwise().squaredNorm().array())
      .all();
}

double usual_width(const Observations& observations, const Hypothesis& hypothesis,
                   std::size_t parameter) {
  constexpr double kWidths = 4;  // standard deviations that a plausible range is wide
  if (hypothesis.is_regression) {
    return std::numeric_limits<double>::infinity();
  }
  const Parameter& own = hypothesis.parameters[parameter];
  const model::Robot& robot = observations.machine.robot;
  const double usual =
      effects::plausible_range(*hypothesis.law, robot, size_of(robot), hypothesis.joint, own.name)
          .usual;
  return std::min((own.upper - own.lower) / kWidths, usual);
}

std::string kind_of(const Hypothesis& hypothesis, std::size_t parameter) {
  return (hypothesis.joint > 0 ? "joints " : hypothesis.effect() + " ") +
         hypothesis.parameters[parameter].unit;
}

}  // namespace flexcomp::diagnosis
