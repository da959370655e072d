#pragma once

#include <string>

#include "programs/program.hpp"

namespace flexcomp::programs {

/// Where a G2 or G3 goes.
struct ArcRequest {
  Vector3<double> start;
  Vector3<double> end;
  int normal = 2;             ///< axis across the plane: 2 for G17, 1 for G18, 0 for G19
  bool is_clockwise = false;  ///< seen from where that axis points
};

/// The arc about a middle; a full circle where start and end are one point in the plane. The radii
/// of start and end may differ by rounding: by 5 µm, or by a thousandth up to half a millimetre.
///
/// Returns nothing, or a sentence that says why there is no such arc.
std::string arc_by_center(const ArcRequest& request, const Vector3<double>& center, Arc* arc);

/// The arc of a radius: the shorter one if that is above zero, the longer one if below.
std::string arc_by_radius(const ArcRequest& request, double radius, Arc* arc);

}  // namespace flexcomp::programs
