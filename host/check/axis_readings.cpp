#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "check/readings.hpp"

namespace flexcomp::check {
namespace {

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

using Order = std::array<int, 3>;

/// Content of the column of an axis: "y" or "−y".
std::string column(int axis, double sign) {
  return std::string(sign < 0 ? "−" : "") + kAxes[static_cast<std::size_t>(axis)];
}

/// In words what was done: `order[i]`, `sign[i]`: the robot's axis i stands in column order[i].
std::string in_words(const Order& order, const Vector3<double>& sign) {
  int moved = 0;
  std::string turned;
  for (int axis = 0; axis < 3; ++axis) {
    moved += order[static_cast<std::size_t>(axis)] != axis ? 1 : 0;
    if (sign[axis] < 0) {
      turned +=
          (turned.empty() ? "" : " and ") + std::string(kAxes[static_cast<std::size_t>(axis)]);
    }
  }
  std::string words;
  if (moved == 2) {
    std::string pair;
    for (int axis = 0; axis < 3; ++axis) {
      if (order[static_cast<std::size_t>(axis)] != axis) {
        pair += (pair.empty() ? "" : " and ") + std::string(kAxes[static_cast<std::size_t>(axis)]);
      }
    }
    words = pair + " are swapped";
  } else if (moved == 3) {
    words = fmt::format(
        "the axes are in another order (the columns x, y, z hold the robot's {}, "
        "{}, {})",
        kAxes[static_cast<std::size_t>(std::find(order.begin(), order.end(), 0) - order.begin())],
        kAxes[static_cast<std::size_t>(std::find(order.begin(), order.end(), 1) - order.begin())],
        kAxes[static_cast<std::size_t>(std::find(order.begin(), order.end(), 2) - order.begin())]);
  }
  if (turned.empty()) {
    return words;
  }
  const std::string pointing = turned == "z"        ? "z points down"
                               : turned.size() == 1 ? turned + " points the other way"
                                                    : turned + " point the other way";
  return words.empty() ? pointing : words + ", and " + pointing;
}

Reading reading_of(const PoseRows& rows, const Order& order, const Vector3<double>& sign) {
  Matrix3<double> turn = Matrix3<double>::Zero();
  std::string columns;
  int changes = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const int from = order[static_cast<std::size_t>(axis)];
    turn(axis, from) = sign[axis];
    columns += (axis > 0 ? ", " : "") + column(from, sign[axis]);
    changes += from != axis ? 1 : 0;
    changes += sign[axis] < 0 ? 1 : 0;
  }
  Reading reading;
  reading.check = {
      Severity::error, "recording", "frame.base",
      "in the measured positions " + in_words(order, sign),
      fmt::format("give positions in the robot's base frame: write {} as x, y, z", columns)};
  // Among several that fit equally, as on a plane path, the one that changes least wins.
  reading.left = median_distance(rows.measured * turn.transpose(), rows.predicted) + 1e-9 * changes;
  reading.mend_positions = [turn](Points* positions) { *positions *= turn.transpose(); };
  return reading;
}

}  // namespace

Readings axis_readings(const PoseRows& rows) {
  Readings readings;
  Order order = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      const Vector3<double> sign((signs & 1) != 0 ? -1 : 1, (signs & 2) != 0 ? -1 : 1,
                                 (signs & 4) != 0 ? -1 : 1);
      if (order != Order{0, 1, 2} || signs != 0) {
        readings.push_back(reading_of(rows, order, sign));
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return readings;
}

}  // namespace flexcomp::check
