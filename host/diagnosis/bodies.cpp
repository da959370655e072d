#include "diagnosis/bodies.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/plausible.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr double kMargin = 0.02;  // of a body's size, in which it is held already

}  // namespace

Bodies::Bodies(const Observations& observations, const std::vector<Chosen>& chosen)
    : model_(observations.machine.robot) {
  for (const Chosen& each : chosen) {
    if (each.hypothesis.law->excess && std::isfinite(each.hypothesis.edge)) {
      bodies_.push_back(each.hypothesis);
    }
  }
  if (!bodies_.empty()) {
    size_of_machine_ = size_of(observations);
  }
}

Eigen::VectorXd Bodies::outside(const model::Robot& altered) const {
  Eigen::VectorXd outside(size());
  for (Eigen::Index i = 0; i < size(); ++i) {
    const Hypothesis& body = bodies_[static_cast<std::size_t>(i)];
    const double excess = body.law->excess(model_, altered, size_of_machine_, body.joint);
    outside[i] = std::max(excess + kMargin, 0.0) / body.edge;
  }
  return outside;
}

}  // namespace flexcomp::diagnosis
