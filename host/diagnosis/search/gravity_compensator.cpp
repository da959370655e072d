#include <cmath>

#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs gravity in the model. Balancers are built for the joints that lift the arm.
bool prepare_gravity_compensator(const Observations& observations, Hypothesis* hypothesis) {
  const bool lifts = hypothesis->joint == 2 || hypothesis->joint == 3;
  if (!observations.has_weight() || !lifts) {
    return false;
  }
  const Bounds torque{-1e6, 1e6, 100};
  if (hypothesis->law->traits.is_curve_only) {
    hypothesis->set_bounds({torque, torque});
    return true;
  }
  hypothesis->set_bounds({torque, torque, {0.05, 0.95, 0.05}, {-4, 4, 0.05}});
  hypothesis->starts.clear();
  for (const double ratio : {0.3, 0.45, 0.65}) {
    for (int sector = 0; sector < 12; ++sector) {
      hypothesis->starts.push_back({ratio, (sector - 6) * M_PI / 6});
    }
  }
  return true;
}

}  // namespace

Search search::gravity_compensator() { return {prepare_gravity_compensator}; }

}  // namespace flexcomp::diagnosis
