#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>

#include "client/correction_follower.hpp"
#include "recording/recording.hpp"
#include "simulation/milling.hpp"
#include "simulation/plant_bus.hpp"

namespace flexcomp::simulation {

struct PlantOptions {
  double period = 0.004;    ///< s, from one setpoint to the next
  bool lockstep = false;    ///< as fast as answers come, else in real time
  bool compensate = true;   ///< arm the compensator and move by what it sends back
  double hold_time = 0.25;  ///< s, without an answer before the robot fades the correction out
  /// Moves by whatever correction comes; else one that ends by itself is not taken.
  bool obeys = false;
  double load_time = 0.3;        ///< s, in which the tool enters the cut
  double settling_time = 0.5;    ///< s, in the cut before it moves
  double force_noise = 1;        ///< N, standard deviation of the sensor
  double moment_noise = 0.05;    ///< N·m
  std::uint64_t seed = 1;        ///< of the noise
  std::uint64_t model_hash = 0;  ///< that the plant announces
  /// At most, of the compensator; a table that it was armed with may allow less.
  double gain = 1;
  /// Above it the correction and the process make an unstable loop: then the tool stays out of the
  /// cut.
  double stable_gain = std::numeric_limits<double>::infinity();
};

/// The result of a run.
struct PlantRun {
  /// Along the contour: q_cmd, q_meas (what the robot moved by), wrench (with noise), position.
  recording::Recording recording;
  bool armed = false;
  std::uint8_t arm_reply = 0;  ///< Result or Reply, where it was not armed
  double largest_gain = 0;     ///< that came with it
  double gain = 0;             ///< at most that of the correction
  bool was_lost = false;       ///< armed, but not active all along the contour
  bool is_unstable = false;    ///< armed, but with a gain that may be above the stable one
  std::uint64_t ticks = 0;
  std::uint64_t unanswered = 0;  ///< setpoints without an answer in their period
  std::uint32_t status = 0;      ///< all status bits seen on the contour
  std::uint16_t node_status = 0;
  std::uint32_t latched = 0;  ///< faults that led to the last fade-out, as it last said
  std::uint16_t node_latched = 0;
  std::uint8_t last_state = 0;
  double least_engagement = 1;
  double most_engagement = 1;
};

/// In lock-step nobody has answered for some seconds. `what()` is one line.
class NobodyAnswers : public std::runtime_error {
 public:
  NobodyAnswers() : std::runtime_error("nobody answers") {}
};

/// The plant on the bus: stands at the beginning of the contour, has the compensator armed, enters
/// the cut, follows the contour, and leaves. Every period it sends what the robot's sensors say and
/// the next setpoint, and moves by the correction that comes back (CorrectionFollower).
class Plant {
 public:
  Plant(std::unique_ptr<RobotInCut> robot, Contour contour, const PlantOptions& options,
        PlantBus* bus);

  /// `progress` is told the share that is done, 0 to 1. Throws NobodyAnswers.
  PlantRun run(const std::function<void(double)>& progress);

 private:
  void stand_still(double seconds);
  bool arm();
  bool may_become_ready() const;
  void follow_contour(const std::function<void(double)>& progress);
  void tick(double time, double load);
  void exchange();
  void take(const Message& message);
  Wrench<double> measured(const Wrench<double>& wrench);
  void record(double time, const Contour::Point& point, const Wrench<double>& wrench);

  Contour contour_;
  std::unique_ptr<RobotInCut> robot_;
  PlantOptions options_;
  PlantBus* bus_;
  std::mt19937_64 random_;
  CorrectionFollower follower_;
  RobotInCut::State state_{};
  std::int64_t next_ = 0;  ///< ns, when the next setpoint is due
  std::uint64_t corrected_ = 0;
  int silent_ = 0;  ///< setpoints in a row without an answer
  bool replied_ = false;
  bool on_contour_ = false;
  PlantRun run_;
  std::vector<double> time_;
  std::vector<Eigen::Matrix<double, 21, 1>> rows_;
};

}  // namespace flexcomp::simulation
