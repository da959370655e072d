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

double softest_of(const ChainJoint& joint) { return joint.slides() ? kMostShift : kMostTurn; }

double softest_cubic_of(const ChainJoint& joint) {
  return joint.slides() ? kMostCubicShift : kMostCubicTurn;
}

bool has_plausible_springs(const Chain& chain) {
  return is_plausible(chain.base_compliance) && is_plausible(chain.tool_compliance) &&
         std::all_of(chain.joints.begin(), chain.joints.end(), [](const ChainJoint& joint) {
           return joint.compliance <= softest_of(joint) &&
                  std::abs(joint.cubic_compliance) <= softest_cubic_of(joint) &&
                  is_plausible(joint.link_compliance);
         });
}

}  // namespace flexcomp::model
