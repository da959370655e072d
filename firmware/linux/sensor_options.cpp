#include "linux/sensor_options.hpp"

#include <algorithm>
#include <cmath>

#include "linux/option_list.hpp"

namespace flexcomp {
namespace {

using Vector = Vector3<double>;

constexpr std::size_t kJointNumbers = 9;

Vector vector_at(const std::vector<double>& numbers, std::size_t first) {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

/// From x, y, z (m), roll, pitch, yaw (rad), as in a URDF.
Pose<double> pose_at(const std::vector<double>& numbers) {
  Pose<double> pose;
  pose.position = vector_at(numbers, 0);
  pose.rotation = axis_rotation<double>(Vector::UnitZ(), numbers[5]) *
                  axis_rotation<double>(Vector::UnitY(), numbers[4]) *
                  axis_rotation<double>(Vector::UnitX(), numbers[3]);
  return pose;
}

std::string joint_option(std::size_t joint) {
  return "--sensor-joint-" + std::to_string(joint + 1);
}

/// A length in metres or an angle in radians: more is a mistake in units.
const CLI::Validator kSmall = CLI::Range(-20.0, 20.0);

void add_vector(OptionList* app, const std::string& name, std::vector<double>* numbers, int count,
                const std::string& help, const CLI::Validator& range) {
  app->add_fixed(name, numbers, help)->check(range)->expected(count)->delimiter(',');
}

void add_load(OptionList* app, SensorOptions* options) {
  add_vector(
      app, "--sensor-counts", &options->counts, 2,
      "counts for a newton and for a newton metre; a million each, unless the sensor's own page\n"
      "says otherwise",
      CLI::Range(1e-3, 1e9));
  add_vector(app, "--sensor-zero", &options->zero, 6,
             "N and N m that the sensor shows with no load on it, sensor frame",
             CLI::Range(-1e6, 1e6));
  app->add_fixed("--sensor-mass", &options->mass, "kg, of all that hangs on the sensor")
      ->check(CLI::Range(0.0, 1e4));
  add_vector(app, "--sensor-center-of-mass", &options->center_of_mass, 3,
             "m, of what hangs on the sensor, in the last link's frame", kSmall);
}

}  // namespace

void add_sensor(OptionList* app, SensorOptions* options) {
  app->add_fixed("--sensor", &options->address,
                 "take the wrench from a force sensor of ATI (Net F/T, Ethernet Axia) at this\n"
                 "address, such as udp://192.168.1.1:49152 (SENSOR.md)");
  add_load(app, options);
  add_vector(app, "--sensor-frame", &options->frame, 6,
             "x,y,z,roll,pitch,yaw of the sensor in the last link's frame, m and rad", kSmall);
  add_vector(app, "--sensor-tcp", &options->tcp, 3, "m, the TCP in the last link's frame", kSmall);
  add_vector(app, "--sensor-gravity", &options->gravity, 3, "m/s2, in the robot's base frame",
             kSmall);
  for (std::size_t joint = 0; joint < options->joints.size(); ++joint) {
    add_vector(app, joint_option(joint), &options->joints[joint], kJointNumbers,
               "x,y,z,roll,pitch,yaw of the joint as in the URDF, and its axis", kSmall);
  }
}

std::optional<OptionFault> fault_in(const SensorOptions& options) {
  constexpr const char* kMissing =
      "expected it with --sensor; flexcomp configure --sensor writes the arm's geometry";
  constexpr double kRounding = 1e-3;
  for (std::size_t joint = 0; joint < options.joints.size(); ++joint) {
    const std::vector<double>& numbers = options.joints[joint];
    if (numbers.empty()) {
      return OptionFault{joint_option(joint), kMissing};
    }
    if (std::abs(vector_at(numbers, 6).norm() - 1) > kRounding) {
      return OptionFault{joint_option(joint), "expected an axis of length 1 in the last three"};
    }
  }
  return options.tcp.empty() ? std::optional(OptionFault{"--sensor-tcp", kMissing}) : std::nullopt;
}

RdtConfig to_config(const SensorOptions& options) {
  RdtConfig config;
  config.counts_per_newton = options.counts[0];
  config.counts_per_newton_metre = options.counts[1];
  std::copy_n(options.zero.begin(), config.zero.size(), config.zero.begin());
  SensorMounting& mounting = config.mounting;
  for (std::size_t joint = 0; joint < options.joints.size(); ++joint) {
    mounting.arm.joints[joint].origin = pose_at(options.joints[joint]);
    mounting.arm.joints[joint].axis = vector_at(options.joints[joint], 6).normalized();
  }
  mounting.arm.tool.position = vector_at(options.tcp, 0);
  mounting.arm.gravity = vector_at(options.gravity, 0);
  mounting.frame = pose_at(options.frame);
  mounting.mass = options.mass;
  mounting.center_of_mass = vector_at(options.center_of_mass, 0);
  return config;
}

}  // namespace flexcomp
