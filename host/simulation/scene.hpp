#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "recording/recording.hpp"

namespace flexcomp::simulation {

enum Channel : std::size_t { tcp_position, joint_torque, joint_deflection };
constexpr std::array<const char*, 3> kChannels = {"tcp_position", "joint_torque",
                                                  "joint_deflection"};
/// Units for joints that turn; those that slide have N and m.
constexpr std::array<const char*, 3> kChannelUnits = {"m", "N·m", "rad"};

/// A recording made ready for simulation: what drove the robot, and what was measured of it. SI
/// units, base frame, one row a sample, and a column a joint where it is about joints; what is said
/// of angles and torques holds for travels (m) and forces (N) of joints that slide.
struct Scene {
  std::string file;
  std::vector<Eigen::Index> recorded;  ///< n, the row of the recording that each came from
  Eigen::VectorXd time;                ///< n, s, when samples were taken
  bool is_static = false;        ///< a load test: one row a pose and load, no motion between rows
  bool follows_command = false;  ///< `q` is the command, because there are no encoders
  bool has_wrench = false;
  Eigen::MatrixXd q;             ///< motor side, rad
  Eigen::MatrixXd velocity;      ///< rad/s; zero in a static test
  Eigen::MatrixXd acceleration;  ///< rad/s²
  Eigen::MatrixXd wrench;        ///< n×6, zero where none was recorded
  /// 1 where a joint stands, starts, stops or creeps: friction may hold any torque up to
  /// break-away there, so that its torque tells nothing of the speed.
  Eigen::MatrixXi stands;
  /// s, half of the longest time that a joint was differentiated over; zero in a static test.
  double half_window = 0;
  /// Standard deviations that the encoders' noise leaves in velocity (rad/s) and acceleration
  /// (rad/s²) of each joint.
  Eigen::RowVectorXd velocity_noise, acceleration_noise;
  /// rad/s²: by how much the acceleration may be wrong where the motion is too abrupt for the
  /// samples; zero elsewhere.
  Eigen::MatrixXd acceleration_doubt;
  Eigen::VectorXd temperature;  ///< n, °C, gaps filled; empty where not recorded
  /// Measurements, by channel (TCP: n×3): no columns where not recorded, NaN where a
  /// sample is missing. Joint deflection is q_link − q_meas.
  std::array<Eigen::MatrixXd, 3> measured;

  Eigen::Index rows() const { return time.size(); }
  Eigen::Index joints() const { return q.cols(); }
  bool has(Channel channel) const { return measured[channel].cols() > 0; }
};

/// A scene, or the first ones of a vector, that outlives this view of it.
class Scenes {
 public:
  Scenes(const Scene& one) : first_(&one), count_(1) {}
  Scenes(const std::vector<Scene>& all) : Scenes(all, all.size()) {}
  Scenes(const std::vector<Scene>& all, std::size_t count) : first_(all.data()), count_(count) {}

  std::size_t size() const { return count_; }
  const Scene& operator[](std::size_t index) const { return first_[index]; }
  const Scene* begin() const { return first_; }
  const Scene* end() const { return first_ + count_; }

 private:
  const Scene* first_;
  std::size_t count_;
};

/// Steps that made a recording usable.
struct Preparation {
  Eigen::Index rows = 0;        ///< in the file
  Eigen::Index incomplete = 0;  ///< left out: without all joint angles or without the whole wrench
  std::vector<Eigen::Index> repeats;  ///< left out: rows that show the sample of the row before
  double period = 0;                  ///< s, by which times were evened; 0 where they are as given
  Eigen::Index kept_each = 1;         ///< of the rest, one row of so many is used
  double largest_gap = 0;             ///< s, between rows that follow each other
  double median_step = 0;             ///< s
};

/// Makes a recording ready; with more than `most_rows` usable rows, ones that are spread over them
/// are taken, those that show most of a few.
///
/// Velocities and accelerations come from all rows: polynomials of fifth order through the
/// neighbours within 16 ms, at their true times (Savitzky and Golay 1964), or within as much more
/// as a joint's noise asks for. They have no delay. Of a sensor slower than the log that repeats
/// its last sample, the first of each counts; of angles so, at the times at which they were taken
/// (recording/sampling.hpp). Throws InputError where the recording has no joint
/// angles or nothing to compare a simulation with.
Scene prepare(const recording::Recording& recording, Eigen::Index most_rows,
              Preparation* preparation);

}  // namespace flexcomp::simulation
