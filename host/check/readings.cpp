#include "check/readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "check/arm.hpp"

namespace flexcomp::check {

namespace {

struct Unit {
  const char* name;
  double count;  ///< of them in a metre
};

constexpr std::array<Unit, 5> kUnits = {{{"millimetres", 1e3},
                                         {"inches", 1 / 0.0254},
                                         {"centimetres", 100},
                                         {"micrometres", 1e6},
                                         {"kilometres (metres divided by 1000)", 1e-3}}};

}  // namespace

Points positions_at(const model::Robot& robot, const Eigen::MatrixXd& q) {
  Points positions(q.rows(), 3);
  for (Eigen::Index row = 0; row < q.rows(); ++row) {
    positions.row(row) = tcp_at(robot, q.row(row)).position.transpose();
  }
  return positions;
}

Readings unit_readings(const PoseRows& rows) {
  Readings readings;
  for (const Unit& unit : kUnits) {
    Reading reading;
    reading.check = {Severity::error, "recording", "units.position",
                     fmt::format("the positions x, y, z look like {}", unit.name),
                     fmt::format("give x, y and z in metres: divide them by {:.6g}", unit.count)};
    reading.left = median_distance(rows.measured / unit.count, rows.predicted);
    reading.mend_positions = [count = unit.count](Points* positions) { *positions /= count; };
    readings.push_back(reading);

    Reading elsewhere = reading;
    elsewhere.steps = 3;
    elsewhere.check.what += ", in another base frame";
    elsewhere.check.fix += "; then move them into the robot's base frame";
    const Points scaled = rows.measured / unit.count;
    const Vector3<double> extent = extents(rows.predicted);
    const Registration free = register_points(scaled, rows.predicted, false, true);
    // Without its scale a registration tells nothing of a unit.
    if (extent[1] > 0.01 && std::abs(free.scale - 1) < 0.1) {
      const Registration found = register_points(scaled, rows.predicted);
      elsewhere.left = median_distance(found.of(scaled), rows.predicted);
      elsewhere.mend_positions = [count = unit.count, found](Points* positions) {
        *positions = found.of(*positions / count);
      };
      readings.push_back(elsewhere);
    }
  }
  return readings;
}

}  // namespace flexcomp::check
