#include "control/lyapunov_bound.hpp"

#include <cmath>

namespace flexcomp::control {

double LyapunovBound::at(double start, double time) const {
  return residual() + (start - residual()) * std::exp(-decay * time);
}

double LyapunovBound::time_to(double level, double start) const {
  return start <= level ? 0 : std::log((start - residual()) / (level - residual())) / decay;
}

double layer_drift(double weight, double layer) { return weight * layer / 4; }

double leak_drift(double weight, double leak, const Eigen::Ref<const Eigen::VectorXd>& parameters,
                  const Eigen::Ref<const Eigen::VectorXd>& rates) {
  return weight * leak / 2 * parameters.cwiseAbs2().cwiseQuotient(rates).sum();
}

double filter_drift(double stiffness_factor, double lag_squared, double damping, double inertia) {
  return stiffness_factor * stiffness_factor * lag_squared / (damping * inertia);
}

}  // namespace flexcomp::control
