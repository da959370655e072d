#include "controller/sensor_lines.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <vector>

#include "model/frame_numbers.hpp"

namespace flexcomp::controller {
namespace {

/// Any numbers as a list of the configuration.
template <typename Numbers>
std::string bracketed(const Numbers& numbers) {
  return fmt::format("[{:.9g}]", fmt::join(numbers, ", "));
}

std::string joint_line(std::size_t joint, const Joint<double>& of) {
  const std::array<double, 6> origin = model::frame_numbers(of.origin);
  std::vector<double> numbers(origin.begin(), origin.end());
  numbers.insert(numbers.end(), of.axis.begin(), of.axis.end());
  return fmt::format("sensor-joint-{} = {}\n", joint + 1, bracketed(numbers));
}

/// The frame of the tool link in that of the last link.
Pose<double> flange_of(const model::Robot& robot) {
  if (!robot.tool) {
    return robot.elastic.tool;
  }
  return robot.elastic.tool * inverse(robot.tool->mounting());
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
      address, bracketed(model::frame_numbers(flange * frame)), bracketed(arm.tool.position),
      tool.mass,
      bracketed(
          Vector3<double>(flange.rotation * Vector3<double>(tool.com.data()) + flange.position)),
      bracketed(arm.gravity));
  for (std::size_t joint = 0; joint < arm.joints.size(); ++joint) {
    text += joint_line(joint, arm.joints[joint]);
  }
  return text;
}

}  // namespace flexcomp::controller
