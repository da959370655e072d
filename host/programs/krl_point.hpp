#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "flexcomp/types.hpp"
#include "programs/scanner.hpp"

namespace flexcomp::programs {

/// A point as KRL writes it: {X 1, Y 2, Z 3, A 0, B 90, C 0}, in mm and degrees, what is left out
/// as it was; or joint angles.
struct KrlPoint {
  std::array<std::optional<double>, 6> frame;  ///< X, Y, Z, A, B, C
  bool has_axes = false;                       ///< A1 to A6

  bool is_whole() const;

  /// Fills what is left out from another point.
  void fill_from(const KrlPoint& other);

  /// The pose, m; angles A, B and C turn about z, y and x in this order. Whole points only.
  Pose<double> pose() const;
};

/// A line of KRL without its comment, which a semicolon begins outside of quotation marks.
std::string_view krl_code(std::string_view line);

/// Reads an aggregate such as `{E6POS: X 1,Y 2,S 2,T 35,E1 0.0}`; nothing if it is none. Components
/// other than the above are passed over.
std::optional<KrlPoint> read_krl_point(Scanner* scanner);

/// A, B and C (degrees) of an orientation; A is zero where B is upright.
std::array<double, 3> krl_angles(const Matrix3<double>& rotation);

}  // namespace flexcomp::programs
