#include "diagnosis/search/hypothesis.hpp"

#include <algorithm>
#include <cmath>

namespace flexcomp::diagnosis {

Hypothesis::Hypothesis(effects::LawPointer law_there, int at_joint, const model::Robot& robot)
    : law(std::move(law_there)),
      joint(at_joint),
      linear(law->traits.linear_in),
      is_sketched(law->sketch != nullptr) {
  for (const effects::Parameter& each : law->parameters(robot, joint)) {
    parameters.push_back({each.name, each.unit, 0, 0, 1});
    parameters.back().is_of_recording = each.is_of_recording;
  }
}

std::size_t Hypothesis::numbers() const {
  return static_cast<std::size_t>(
      std::count_if(parameters.begin(), parameters.end(),
                    [](const Parameter& each) { return std::isinf(each.tolerance); }));
}

void Hypothesis::set_bounds(const std::vector<Bounds>& bounds) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    parameters[i].lower = bounds.at(i).lower;
    parameters[i].upper = bounds.at(i).upper;
    parameters[i].step = bounds.at(i).step;
  }
}

bool are_the_same(const Hypothesis& a, const Hypothesis& b) {
  const auto written = [](const Hypothesis& of) {
    return of.law->written
               ? of.law->written->place + of.law->written->axis + of.law->written->formula
               : std::string();
  };
  return a.effect() == b.effect() && a.joint == b.joint && a.when == b.when &&
         written(a) == written(b);
}

std::vector<Hypothesis> sought_anew(const Observations& observations,
                                    const Eigen::VectorXd& unexplained,
                                    const std::vector<Hypothesis>& hypotheses) {
  std::vector<Hypothesis> found;
  for (const Hypothesis& each : hypotheses) {
    if (each.seek != nullptr) {
      Hypothesis anew = each;
      anew.starts = each.seek(observations, unexplained, each);
      if (!anew.starts.empty()) {
        found.push_back(std::move(anew));
      }
    }
  }
  return found;
}

}  // namespace flexcomp::diagnosis
