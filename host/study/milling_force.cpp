#include "study/milling_force.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "error.hpp"

namespace flexcomp::study {
namespace {

/// Abscissae and weights of Gauss and Legendre on [−1, 1], eight points.
constexpr std::array<double, 4> kAbscissa = {0.1834346424956498, 0.5255324099163290,
                                             0.7966664774136267, 0.9602898564975363};
constexpr std::array<double, 4> kWeight = {0.3626837833783620, 0.3137066458778873,
                                           0.2223810344533745, 0.1012285362903763};

/// With runout the chip's thickness has corners: so many pieces of an edge keep them local.
constexpr int kPiecesWithRunout = 32;

double tooth_pitch(const EndMilling& milling) { return 2 * M_PI / milling.teeth; }

/// Distance of a tooth's edge from the spindle's axis.
double edge_radius(const EndMilling& milling, int tooth) {
  return milling.diameter / 2 +
         milling.runout * std::cos(tooth * tooth_pitch(milling) - milling.runout_angle);
}

/// Thickness of the chip that a tooth cuts: what the teeth before it, one revolution back at most,
/// have left.
double chip_thickness(const EndMilling& milling, int tooth, double angle) {
  const double feed = milling.feed_per_tooth * std::sin(angle);
  if (milling.runout == 0) {
    return feed;
  }
  const double own = edge_radius(milling, tooth);
  double thickness = feed * milling.teeth;
  for (int before = 1; before < milling.teeth; ++before) {
    // Teeth pass in ascending order.
    const int other = (tooth - before + milling.teeth) % milling.teeth;
    thickness = std::min(thickness, before * feed + own - edge_radius(milling, other));
  }
  return std::max(thickness, 0.0);
}

/// Force on the tool per length of depth, at an angle where the tooth is engaged.
Vector3<double> force_density(const EndMilling& milling, int tooth, double angle) {
  const CuttingCoefficients& k = milling.coefficients;
  const double thickness = chip_thickness(milling, tooth, angle);
  if (milling.runout > 0 && !(thickness > 0)) {
    return Vector3<double>::Zero();
  }
  const double tangential = k.tangential * thickness + k.tangential_edge;
  const double radial = k.radial * thickness + k.radial_edge;
  const double axial = k.axial * thickness + k.axial_edge;
  return {-tangential * std::cos(angle) - radial * std::sin(angle),
          tangential * std::sin(angle) - radial * std::cos(angle), axial};
}

/// Wrench on a tooth, along the part of its edge from `low` to `high` above the tip.
Wrench<double> edge_wrench(const EndMilling& milling, int tooth, double tip_angle, double lag,
                           double low, double high) {
  Wrench<double> sum = Wrench<double>::Zero();
  const int pieces = milling.runout > 0 ? kPiecesWithRunout : 1;
  const double half = (high - low) / (2 * pieces);
  for (int piece = 0; piece < pieces; ++piece) {
    const double middle = low + (2 * piece + 1) * half;
    for (std::size_t i = 0; i < 2 * kAbscissa.size(); ++i) {
      const double z = middle + (i % 2 == 0 ? half : -half) * kAbscissa[i / 2];
      const double angle = tip_angle - lag * z;
      const Vector3<double> force = half * kWeight[i / 2] * force_density(milling, tooth, angle);
      const double radius = milling.diameter / 2;
      const Vector3<double> at(radius * std::sin(angle), radius * std::cos(angle), z);
      sum.head<3>() += force;
      sum.tail<3>() += at.cross(force);
    }
  }
  return sum;
}

}  // namespace

void check(const EndMilling& milling) {
  const auto is_size = [](double value) { return value > 0 && std::isfinite(value); };
  if (!is_size(milling.diameter) || !is_size(milling.depth) || !is_size(milling.feed_per_tooth) ||
      milling.teeth < 1 || milling.teeth > 1000) {
    throw InputError("diameter, depth and feed per tooth must be above zero, teeth from 1 to 1000");
  }
  if (milling.mode != MillingMode::slot &&
      (!is_size(milling.width) || milling.width > milling.diameter)) {
    throw InputError("the width of the cut must be above zero and no more than the diameter");
  }
  if (!(milling.helix >= 0 && milling.helix < 1.5)) {
    throw InputError("the helix must be from 0 to 1.5 rad");
  }
  const CuttingCoefficients& k = milling.coefficients;
  for (const double value : {k.tangential, k.radial, k.axial, k.tangential_edge, k.radial_edge,
                             k.axial_edge, milling.runout}) {
    if (!(value >= 0) || !std::isfinite(value)) {
      throw InputError("cutting coefficients and runout must not be below zero");
    }
  }
  if (!(milling.runout < milling.diameter / 2) || !std::isfinite(milling.runout_angle)) {
    throw InputError("the runout must be less than the tool's radius");
  }
}

Engagement engagement(const EndMilling& milling) {
  const double swept = std::acos(std::clamp(1 - 2 * milling.width / milling.diameter, -1.0, 1.0));
  switch (milling.mode) {
    case MillingMode::up:
      return {0, swept};
    case MillingMode::down:
      return {M_PI - swept, M_PI};
    case MillingMode::slot:
      break;
  }
  return {0, M_PI};
}

Wrench<double> instantaneous_wrench(const EndMilling& milling, double angle) {
  const Engagement cut = engagement(milling);
  const double lag = 2 * std::tan(milling.helix) / milling.diameter;  // rad per m of depth
  Wrench<double> sum = Wrench<double>::Zero();
  for (int tooth = 0; tooth < milling.teeth; ++tooth) {
    // Tooth 1 passes after tooth 0: it is behind it.
    const double tip = angle - tooth * tooth_pitch(milling);
    if (lag == 0) {
      const double at = tip - 2 * M_PI * std::floor(tip / (2 * M_PI));
      if (at >= cut.entry && at <= cut.exit) {
        sum += edge_wrench(milling, tooth, at, 0, 0, milling.depth);
      }
      continue;
    }
    // Heights where the edge is at the exit and, above it, at the entry, turn by turn.
    const double turns = std::floor((tip - cut.entry) / (2 * M_PI));
    for (double turn = turns; turn >= turns - std::ceil(lag * milling.depth / (2 * M_PI)) - 1;
         --turn) {
      const double low = std::max((tip - 2 * M_PI * turn - cut.exit) / lag, 0.0);
      const double high = std::min((tip - 2 * M_PI * turn - cut.entry) / lag, milling.depth);
      if (high > low) {
        sum += edge_wrench(milling, tooth, tip - 2 * M_PI * turn, lag, low, high);
      }
    }
  }
  return sum;
}

Vector3<double> mean_force(const EndMilling& milling) {
  const CuttingCoefficients& k = milling.coefficients;
  const Engagement cut = engagement(milling);
  const double area = milling.teeth * milling.depth * milling.feed_per_tooth / (8 * M_PI);
  const double length = milling.teeth * milling.depth / (2 * M_PI);
  const auto upto = [&](double angle) {
    const double cosine = std::cos(angle);
    const double sine = std::sin(angle);
    const double twice = 2 * angle - std::sin(2 * angle);
    return Vector3<double>(
        area * (k.tangential * std::cos(2 * angle) - k.radial * twice) +
            length * (-k.tangential_edge * sine + k.radial_edge * cosine),
        area * (k.tangential * twice + k.radial * std::cos(2 * angle)) -
            length * (k.tangential_edge * cosine + k.radial_edge * sine),
        length * (-k.axial * milling.feed_per_tooth * cosine + k.axial_edge * angle));
  };
  return upto(cut.exit) - upto(cut.entry);
}

Wrench<double> mean_wrench(const EndMilling& milling, int steps) {
  Wrench<double> sum = Wrench<double>::Zero();
  for (int i = 0; i < steps; ++i) {
    sum += instantaneous_wrench(milling, 2 * M_PI * (i + 0.5) / steps);
  }
  return sum / steps;
}

}  // namespace flexcomp::study
