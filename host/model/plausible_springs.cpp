#include "model/plausible_springs.hpp"

#include <algorithm>
#include <cmath>

namespace flexcomp::model {
namespace {

bool is_plausible(const DiagonalCompliance<double>& compliance) {
  return compliance.head<3>().maxCoeff() <= kMostShift &&
         compliance.tail<3>().maxCoeff() <= kMostTurn;
}

}  // namespace

bool has_plausible_springs(const RobotModel<double, 6>& model) {
  return is_plausible(model.base_compliance) && is_plausible(model.tool_compliance) &&
         std::all_of(model.joints.begin(), model.joints.end(), [](const Joint<double>& joint) {
           return joint.compliance <= kMostTurn &&
                  std::abs(joint.cubic_compliance) <= kMostCubicTurn &&
                  is_plausible(joint.link_compliance);
         });
}

}  // namespace flexcomp::model
