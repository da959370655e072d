#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "flexcomp/types.hpp"
#include "programs/krl_aggregate.hpp"

namespace flexcomp::programs {

/// A point as KRL writes it: {X 1, Y 2, Z 3, A 0, B 90, C 0}, in mm and degrees, what is left out
/// as it was; or joint angles.
struct KrlPoint {
  std::array<std::optional<double>, 6> frame{};     ///< X, Y, Z, A, B, C
  bool has_axes = false;                            ///< A1 to A6
  std::array<std::optional<double>, 6> external{};  ///< E1 to E6
  bool has_posture = false;                         ///< S or T

  bool is_whole() const;

  /// Fills what is left out from another point.
  void fill_from(const KrlPoint& other);

  /// The pose, m; angles A, B and C turn about z, y and x in this order. Whole points only.
  Pose<double> pose() const;
};

/// The point of an aggregate; nothing where a component is none of a point's (X to C, S, T, A1 to
/// A6, E1 to E6), stands twice, or is no number. `why` is then told, if it can be said.
std::optional<KrlPoint> krl_point_of(const std::vector<KrlComponent>& aggregate, std::string* why);

/// A point at a pose.
KrlPoint krl_point_at(const Pose<double>& pose);

/// A, B and C (degrees) of an orientation; A is zero where B is upright.
std::array<double, 3> krl_angles(const Matrix3<double>& rotation);

}  // namespace flexcomp::programs
