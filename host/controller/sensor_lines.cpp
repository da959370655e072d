#include "controller/sensor_lines.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "model/frame_numbers.hpp"

namespace flexcomp::controller {
namespace {

std::string list_of(const std::vector<double>& numbers) {
  return fmt::format("[{:.9g}]", fmt::join(numbers, ", "));
}

std::string list_of(const Vector3<double>& vector) {
  return list_of(std::vector<double>{vector.x(), vector.y(), vector.z()});
}

std::string list_of(const Pose<double>& pose) {
  const auto numbers = model::frame_numbers(pose);
  return list_of(std::vector<double>(numbers.begin(), numbers.end()));
}

std::string joint_line(std::size_t joint, const Joint<double>& of) {
  const auto origin = model::frame_numbers(of.origin);
  std::vector<double> numbers(origin.begin(), origin.end());
  numbers.insert(numbers.end(), {of.axis.x(), of.axis.y(), of.axis.z()});
  return fmt::format("sensor-joint-{} = {}\n", joint + 1, list_of(numbers));
}

/// The frame of the tool link in that of the last link.
Pose<double> flange_of(const model::Robot& robot) {
  if (!robot.tool) {
    return robot.elastic.tool;
  }
  const Pose<double> tool = robot.tool->mounting();
  const Matrix3<double> back = tool.rotation.transpose();
  return robot.elastic.tool * Pose<double>{back, back * -tool.position};
}

}  // namespace

std::string sensor_lines(const std::string& address, const Pose<double>& frame,
                         const model::Robot& robot) {
  const RobotModel<double, 6> arm = model::six_axis_model(robot);
  const Pose<double> flange = flange_of(robot);
  const model::Tool tool = robot.tool.value_or(model::Tool());
  std::string text = fmt::format(
      "\n# the force sensor; its frame, the TCP and what hangs on it are in the last link's frame\n"
      "sensor = \"udp://{}\"\nsensor-frame = {}\nsensor-tcp = {}\n"
      "sensor-mass = {:.9g}\nsensor-center-of-mass = {}\nsensor-gravity = {}\n"
      "# the arm: x, y, z, roll, pitch, yaw of each joint, and its axis\n",
      address, list_of(flange * frame), list_of(arm.tool.position), tool.mass,
      list_of(
          Vector3<double>(flange.rotation * Vector3<double>(tool.com.data()) + flange.position)),
      list_of(arm.gravity));
  for (std::size_t joint = 0; joint < arm.joints.size(); ++joint) {
    text += joint_line(joint, arm.joints[joint]);
  }
  return text;
}

}  // namespace flexcomp::controller
