#include "control/lyapunov_bound.hpp"

#include <cmath>

namespace flexcomp::control {

double LyapunovBound::at(double start, double time) const {
  return residual() + (start - residual()) * std::exp(-decay * time);
}

double LyapunovBound::time_to(double level, double start) const {
  return start <= level ? 0 : std::log((start - residual()) / (level - residual())) / decay;
}

}  // namespace flexcomp::control
