#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "programs/gcode_line.hpp"
#include "programs/gcode_modes.hpp"

namespace flexcomp::programs {

/// Where the axes of a program in G-code stand, as far as it tells. X, Y and Z are not known until
/// they are told; A, B and C are zero until then.
class GcodeAxes {
 public:
  /// Goes where a line's words say. An axis that is not known stays so if they are relative.
  void go(const GcodeLine& line, const GcodeModes& modes);

  /// A line sends axes to a place of the machine: those that it names, or all that were told where
  /// it names none.
  void lose_named(const GcodeLine& line, std::size_t number);

  /// A line changes the tool: where the new one's tip is, nobody knows.
  void lose_tip(std::size_t number);

  bool are_known() const { return first_unknown() == kCount; }

  /// Of the first axis that is not known: "Z is not known: …".
  std::string why_unknown() const;

  /// m
  const Vector3<double>& place() const { return at_; }

  /// A, B and C, rad
  const Vector3<double>& turn() const { return turn_; }

  /// Of the tool: turned about x by A, then about y by B, then about z by C; at zero it points
  /// against z.
  Matrix3<double> orientation() const;

 private:
  static constexpr std::size_t kCount = 6;

  struct Knowledge {
    bool is_known = false;
    bool is_told = false;      ///< at some time
    std::size_t lost_in = 0;   ///< line
    const char* lost_by = "";  ///< "goes to …"
  };

  std::size_t first_unknown() const;
  void lose(std::size_t axis, std::size_t number, const char* by);

  Vector3<double> at_ = Vector3<double>::Zero();
  Vector3<double> turn_ = Vector3<double>::Zero();
  std::array<Knowledge, kCount> axes_{{{}, {}, {}, {true}, {true}, {true}}};
};

}  // namespace flexcomp::programs
