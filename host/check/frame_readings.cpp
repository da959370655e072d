#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "check/readings.hpp"
#include "check/turns.hpp"

namespace flexcomp::check {
namespace {

/// m: of points that lie closer together than this along an axis no turn can be told.
constexpr double kFewestExtent = 0.02;
/// rad: tools that turn by less than this look like a frame that is shifted.
constexpr double kToolTurns = 0.1;
/// Poses: a frame has six numbers, and three points tell it; twice as many show a misfit.
constexpr Eigen::Index kFewestPoses = 6;

std::string vector_text(const Vector3<double>& vector) {
  return fmt::format("({:.3g}, {:.3g}, {:.3g})", vector.x(), vector.y(), vector.z());
}

std::string motion_text(const Registration& from_robot) {
  const double angle = angle_of(from_robot.rotation);
  std::string text;
  if (angle > 0.05 * kDegree) {
    const Eigen::AngleAxisd turn(from_robot.rotation);
    text = fmt::format("turned by {:.3g}° about {} and ", turn.angle() / kDegree,
                       vector_text(turn.axis()));
  }
  return text + "moved by " + vector_text(from_robot.translation) + " m";
}

bool tool_turns(const PoseRows& rows) {
  return std::any_of(rows.tcp.begin(), rows.tcp.end(), [&](const Pose<double>& tcp) {
    return angle_of(rows.tcp.front().rotation.transpose() * tcp.rotation) > kToolTurns;
  });
}

/// Where, in the tool frame, the measured points lie on average, seen from the TCP.
Vector3<double> offset_on_tool(const PoseRows& rows, const Points& measured) {
  Vector3<double> sum = Vector3<double>::Zero();
  for (Eigen::Index i = 0; i < measured.rows(); ++i) {
    const Pose<double>& tcp = rows.tcp[static_cast<std::size_t>(i)];
    sum += tcp.rotation.transpose() * (measured.row(i).transpose() - tcp.position);
  }
  return sum / static_cast<double>(measured.rows());
}

Points on_tool(const PoseRows& rows, const Vector3<double>& offset) {
  Points points(rows.predicted.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Pose<double>& tcp = rows.tcp[static_cast<std::size_t>(i)];
    points.row(i) = (tcp.position + tcp.rotation * offset).transpose();
  }
  return points;
}

Registration inverse(const Registration& of) {
  return {of.rotation.transpose(), -(of.rotation.transpose() * of.translation), 1};
}

void set_frame(const Registration& from_robot, Reading* reading) {
  reading->mend_positions = [back = inverse(from_robot)](Points* positions) {
    *positions = back.of(*positions);
  };
}

Reading frame(const PoseRows& rows, bool mirrored) {
  const Registration found = register_points(rows.predicted, rows.measured, mirrored);
  Reading reading;
  reading.steps = mirrored ? 4 : 2;
  reading.check = {
      mirrored ? Severity::error : Severity::warning, "recording", "frame.base",
      mirrored ? "the measured positions are mirrored: their axes are left-handed, from another "
                 "frame besides"
               : "the measured positions are in another frame than the robot's base: " +
                     motion_text(found),
      mirrored ? "turn the sign of one axis, then move the positions into the robot's base frame"
               : "move them into the robot's base frame"};
  reading.left = median_distance(found.of(rows.predicted), rows.measured);
  set_frame(found, &reading);
  return reading;
}

Reading tool(const model::Robot& robot, const PoseRows& rows) {
  const Vector3<double> offset = offset_on_tool(rows, rows.measured);
  const bool is_flange = robot.elastic.tool.position.norm() < 1e-6;
  const bool turns = tool_turns(rows);
  Reading reading;
  reading.steps = 2;
  reading.check = {
      Severity::warning, "recording", is_flange || turns ? "tool.missing" : "frame.base",
      fmt::format(
          "the measured point lies {} mm from the model's TCP, seen in the tool's frame{}{}",
          vector_text(1e3 * offset), is_flange ? "; the model's TCP is at the flange" : "",
          turns ? "" : " (or the base frame is shifted: this recording's tool never turns)"),
      "put the model's TCP (tool_link) where the positions are measured, or give the positions of "
      "the TCP"};
  reading.left = median_distance(on_tool(rows, offset), rows.measured);
  return reading;
}

Reading frame_and_tool(const PoseRows& rows) {
  constexpr int kRounds = 60;  // of two fits in turn
  Registration found;
  Vector3<double> offset = Vector3<double>::Zero();
  for (int round = 0; round < kRounds; ++round) {
    found = register_points(on_tool(rows, offset), rows.measured);
    offset = offset_on_tool(rows, inverse(found).of(rows.measured));
  }
  Reading reading;
  reading.steps = 3;
  reading.check = {
      Severity::warning, "recording", "frame.base",
      fmt::format("the measured positions are in another frame than the robot's base: "
                  "{}; and of a point that lies {} mm from the model's TCP, seen in the "
                  "tool's frame",
                  motion_text(found), vector_text(1e3 * offset)),
      "move them into the robot's base frame, and put the model's TCP (tool_link) "
      "where they are measured"};
  reading.left = median_distance(found.of(on_tool(rows, offset)), rows.measured);
  set_frame(found, &reading);
  return reading;
}

}  // namespace

Readings frame_readings(const model::Robot& robot, const PoseRows& rows) {
  Readings readings = {tool(robot, rows)};
  const Vector3<double> extent = extents(rows.predicted);
  if (extent[1] > kFewestExtent && rows.q.rows() >= kFewestPoses) {
    readings.push_back(frame(rows, false));
    if (extent[2] > kFewestExtent) {
      readings.push_back(frame(rows, true));
    }
    if (tool_turns(rows) && rows.q.rows() >= 2 * kFewestPoses) {
      readings.push_back(frame_and_tool(rows));
    }
  }
  return readings;
}

}  // namespace flexcomp::check
