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
  size_ = outside(model_).size();
}

Eigen::VectorXd Bodies::outside(const model::Robot& altered) const {
  Eigen::VectorXd all;
  for (const Hypothesis& body : bodies_) {
    const Eigen::VectorXd own =
        body.law->excess(model_, altered, size_of_machine_, body.joint, kMargin);
    all.conservativeResize(all.size() + own.size());
    all.tail(own.size()) = own / body.edge;
  }
  return all;
}

bool Bodies::can_be(const model::Robot& altered) const {
  return std::all_of(bodies_.begin(), bodies_.end(), [&](const Hypothesis& body) {
    return body.law->excess(model_, altered, size_of_machine_, body.joint, 0).isZero(0);
  });
}

}  // namespace flexcomp::diagnosis
