#include "effects/law_place.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include "effects/terms.hpp"
#include "files/one_line.hpp"

namespace flexcomp::effects {
namespace {

enum Needs { kNothing, kJoint, kAxis, kAxisOrTurn };

struct NamedPlace {
  const char* name;
  PlaceKind kind;
  Needs needs;
  int axis;  ///< where the name has it
};

constexpr std::array<NamedPlace, 17> kPlaces = {
    {{"joint_torque", PlaceKind::joint_torque, kJoint, 0},
     {"joint_angle", PlaceKind::joint_angle, kJoint, 0},
     {"joint_windup", PlaceKind::joint_windup, kJoint, 0},
     {"tcp_base", PlaceKind::tcp_base, kAxis, 0},
     {"tcp_tool", PlaceKind::tcp_tool, kAxis, 0},
     {"base", PlaceKind::base, kAxisOrTurn, 0},
     {"sensor fx", PlaceKind::sensor_wrench, kNothing, 0},
     {"sensor fy", PlaceKind::sensor_wrench, kNothing, 1},
     {"sensor fz", PlaceKind::sensor_wrench, kNothing, 2},
     {"sensor mx", PlaceKind::sensor_wrench, kNothing, 3},
     {"sensor my", PlaceKind::sensor_wrench, kNothing, 4},
     {"sensor mz", PlaceKind::sensor_wrench, kNothing, 5},
     {"sensor x", PlaceKind::sensor_position, kNothing, 0},
     {"sensor y", PlaceKind::sensor_position, kNothing, 1},
     {"sensor z", PlaceKind::sensor_position, kNothing, 2},
     {"sensor tau", PlaceKind::sensor_torque, kJoint, 0},
     {"sensor q_link", PlaceKind::sensor_deflection, kJoint, 0}}};

constexpr std::array<const char*, 6> kAxes = {"x", "y", "z", "rx", "ry", "rz"};
constexpr std::array<const char*, 6> kWrench = {"fx", "fy", "fz", "mx", "my", "mz"};

[[noreturn]] void refuse(const std::string& why) { throw std::invalid_argument(why); }

const NamedPlace& named(const std::string& place) {
  std::string known;
  for (const NamedPlace& each : kPlaces) {
    if (place == each.name) {
      return each;
    }
    known += fmt::format("{}{}", known.empty() ? "" : ", ", each.name);
  }
  refuse(fmt::format("place '{}' is unknown; expected one of: {}", files::one_line(place), known));
}

int read_axis(const NamedPlace& place, const std::string& axis) {
  if (place.needs != kAxis && place.needs != kAxisOrTurn) {
    if (!axis.empty()) {
      refuse(fmt::format("{} has no axis", place.name));
    }
    return place.axis;
  }
  const std::size_t count = place.needs == kAxis ? 3 : kAxes.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (axis == kAxes[i]) {
      return static_cast<int>(i);
    }
  }
  refuse(fmt::format("{} needs axis: {}", place.name,
                     place.needs == kAxis ? "x, y or z" : "x, y, z, rx, ry or rz"));
}

Vector3<double> direction(const simulation::Simulation& at, Eigen::Index row,
                          const LawPlace& place) {
  const Pose<double>& tcp = at.bent[static_cast<std::size_t>(row)].tcp;
  const int axis = place.axis % 3;
  if (place.kind == PlaceKind::tcp_tool) {
    return tcp.rotation.col(axis);
  }
  const Vector3<double> along = Vector3<double>::Unit(axis);
  return place.axis < 3 ? along : Vector3<double>(along.cross(tcp.position));
}

void move_tcp(const LawPlace& place, const Eigen::VectorXd& values,
              const simulation::Simulation& at, simulation::Prediction* prediction) {
  Eigen::MatrixXd& position = prediction->channel[simulation::tcp_position];
  for (Eigen::Index row = 0; row < position.rows() && position.cols() > 0; ++row) {
    position.row(row) += values[row] * direction(at, row, place).transpose();
  }
}

/// A sensor that shows more than acts: the wrench that acts is so much less.
void lower_wrench(const LawPlace& place, const Eigen::VectorXd& values,
                  const simulation::Simulation& at, simulation::Prediction* prediction) {
  Eigen::MatrixXd change = Eigen::MatrixXd::Zero(values.size(), 6);
  const int first = place.axis < 3 ? 0 : 3;
  for (Eigen::Index row = 0; row < values.size(); ++row) {
    const Matrix3<double>& tool = at.bent[static_cast<std::size_t>(row)].tcp.rotation;
    change.row(row).segment<3>(first) = -values[row] * tool.col(place.axis - first).transpose();
  }
  add_wrench(at, change, prediction);
}

}  // namespace

LawPlace read_place(const std::string& place, const std::string& axis, int joint) {
  const NamedPlace& found = named(place);
  if ((found.needs == kJoint) != (joint > 0)) {
    refuse(fmt::format("{} {}", found.name, joint > 0 ? "has no joint" : "needs a joint"));
  }
  return {found.kind, joint, read_axis(found, axis)};
}

std::string unit_at(const LawPlace& place, const model::Robot& robot) {
  const auto of_joint = [&](const char* unit) {
    return model::unit_of(robot.elastic.joint(place.joint - 1), unit);
  };
  switch (place.kind) {
    case PlaceKind::joint_torque:
    case PlaceKind::sensor_torque:
      return of_joint("N·m");
    case PlaceKind::joint_angle:
    case PlaceKind::joint_windup:
    case PlaceKind::sensor_deflection:
      return of_joint("rad");
    case PlaceKind::base:
      return place.axis < 3 ? "m" : "rad";
    case PlaceKind::sensor_wrench:
      return place.axis < 3 ? "N" : "N·m";
    default:
      return "m";
  }
}

simulation::Term::Stage stage_at(const LawPlace& place) {
  switch (place.kind) {
    case PlaceKind::sensor_wrench:
      return simulation::Term::wrench;
    case PlaceKind::joint_windup:
      return simulation::Term::load;
    case PlaceKind::sensor_position:
    case PlaceKind::sensor_torque:
    case PlaceKind::sensor_deflection:
      return simulation::Term::instrument;
    default:
      return simulation::Term::output;
  }
}

bool moves_the_robot(const LawPlace& place) {
  return stage_at(place) != simulation::Term::instrument;
}

std::string in_words(const LawPlace& place) {
  const char* const axis = kAxes[static_cast<std::size_t>(place.axis % 3)];
  switch (place.kind) {
    case PlaceKind::joint_torque:
      return fmt::format("joint {} has a torque", place.joint);
    case PlaceKind::joint_angle:
      return fmt::format("joint {} stands off by an angle", place.joint);
    case PlaceKind::joint_windup:
      return fmt::format("joint {} has a wind-up", place.joint);
    case PlaceKind::tcp_base:
      return fmt::format("the TCP moves along the base's {} by something", axis);
    case PlaceKind::tcp_tool:
      return fmt::format("the TCP moves along the tool's {} by something", axis);
    case PlaceKind::base:
      return fmt::format("the base {} {} by something",
                         place.axis < 3 ? "moves along" : "turns about", axis);
    case PlaceKind::sensor_wrench:
      return fmt::format("the force sensor's {} has an error",
                         kWrench[static_cast<std::size_t>(place.axis)]);
    case PlaceKind::sensor_position:
      return fmt::format("the measured {} of the TCP has an error", axis);
    case PlaceKind::sensor_torque:
      return fmt::format("the measured torque of joint {} has an error", place.joint);
    case PlaceKind::sensor_deflection:
      return fmt::format("the link encoder of joint {} has an error", place.joint);
  }
  return "";
}

void add_at(const LawPlace& place, const Eigen::VectorXd& values,
            const Eigen::VectorXd& with_inertia, const simulation::Simulation& at,
            simulation::Prediction* prediction) {
  switch (place.kind) {
    case PlaceKind::joint_torque:
    case PlaceKind::sensor_torque:
      add_torque(place.joint, values, prediction);
      break;
    case PlaceKind::joint_angle:
    case PlaceKind::joint_windup:
      simulation::add_joint_angle(at, place.joint, values, with_inertia, prediction);
      break;
    case PlaceKind::sensor_deflection:
      if (prediction->channel[simulation::joint_deflection].cols() > 0) {
        prediction->channel[simulation::joint_deflection].col(place.joint - 1) += with_inertia;
      }
      break;
    case PlaceKind::sensor_wrench:
      lower_wrench(place, values, at, prediction);
      break;
    case PlaceKind::sensor_position:
    case PlaceKind::tcp_base:
    case PlaceKind::tcp_tool:
    case PlaceKind::base:
      move_tcp(place, values, at, prediction);
      break;
  }
}

}  // namespace flexcomp::effects
