#pragma once

#include <vector>

#include "flexcomp/types.hpp"

namespace flexcomp::study {

/// Coefficients of a material and a cutting edge (Altintas, Manufacturing Automation, 2nd ed. 2012,
/// ch. 2): force = shear coefficient × chip area + edge coefficient × edge length.
struct CuttingCoefficients {
  double tangential = 0;       ///< Ktc, N/m²
  double radial = 0;           ///< Krc, N/m²
  double axial = 0;            ///< Kac, N/m²
  double tangential_edge = 0;  ///< Kte, N/m
  double radial_edge = 0;      ///< Kre, N/m
  double axial_edge = 0;       ///< Kae, N/m
};

enum class MillingMode {
  slot,  ///< the whole width of the tool is in the material
  up,    ///< conventional: chips begin thin
  down,  ///< climb: chips begin thick
};

/// A cylindrical end mill in its cut.
struct EndMilling {
  double diameter = 0.01;  ///< m
  int teeth = 3;
  double helix = 0;              ///< rad
  double depth = 0.005;          ///< m, axial
  double width = 0.01;           ///< m, radial; not used for slots
  double feed_per_tooth = 1e-4;  ///< m
  MillingMode mode = MillingMode::slot;
  double runout = 0;        ///< m, by which the tool's axis lies off the spindle's
  double runout_angle = 0;  ///< rad, from the first tooth to the runout
  CuttingCoefficients coefficients;
};

/// Checks that sizes are above zero and finite, coefficients and runout not below zero and finite,
/// the helix below 1.5 rad, the width no more than the diameter. Throws InputError.
void check(const EndMilling& milling);

/// Angles (rad) at which a tooth enters the material and leaves it, clockwise from the normal y.
struct Engagement {
  double entry;
  double exit;
};
Engagement engagement(const EndMilling& milling);

/// Wrench on the tool at the spindle angle `angle` (rad, of the first tooth at the tip): x along
/// the feed of the tool, z from the tip up the spindle, y = z × x; moment at the tip.
///
/// The edge is integrated along its helix over where it is engaged. With runout a tooth cuts what
/// the teeth before it left.
Wrench<double> instantaneous_wrench(const EndMilling& milling, double angle);

/// Mean over a revolution of the force (N), x, y and z, in closed form (Altintas, ch. 2):
/// helix and runout do not change it while every tooth cuts.
Vector3<double> mean_force(const EndMilling& milling);

/// Mean of the whole wrench over a revolution, by the midpoint rule over `steps` angles.
Wrench<double> mean_wrench(const EndMilling& milling, int steps = 720);

}  // namespace flexcomp::study
