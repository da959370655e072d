#pragma once

#include <array>
#include <optional>
#include <vector>

#include "simulation/machine.hpp"

namespace flexcomp::diagnosis {

using simulation::Channel;
using simulation::Machine;
using simulation::Prediction;
using simulation::Scene;
using simulation::Scenes;
using simulation::Simulation;

/// One scalar that was measured: a component of a channel in a row of a scene.
struct Sample {
  std::size_t scene;
  Eigen::Index row;
  Channel channel;
  Eigen::Index component;
};

/// Samples that follow each other, from the first to before the end.
struct Part {
  Eigen::Index first, end;
};

/// Stretches of time into which a recording is divided: errors within one may hang together.
constexpr Eigen::Index kHoldoutStretches = 20;

/// The part, from zero, that a row of a recording is in, of so many that are equally long.
constexpr Eigen::Index equal_part_of(Eigen::Index row, Eigen::Index rows, Eigen::Index parts) {
  return row * parts / rows;
}
/// The stretch, from zero, that a row of a recording is in.
Eigen::Index stretch_of(Eigen::Index row, Eigen::Index rows);

/// Noise that the motion's differentiation brings into predictions, by channel; empty without any.
struct PredictionNoise {
  std::array<Eigen::RowVectorXd, 3> deviation;  ///< by the encoders' noise, of each component
  std::array<Eigen::MatrixXd, 3> doubt;         ///< rows × components, by too abrupt motion
};

/// A component of a channel in a scene, in its own space: a joint's angle or torque.
struct JointResidual {
  Eigen::VectorXd product;  ///< n, lever · residual over variance, the measured minus the predicted
  Eigen::VectorXd weight;   ///< n, lever² over variance; zero in rows that are held out or missing
};

/// Recordings of one machine beside what its model predicts for them.
class Observations {
 public:
  /// Simulates the scenes; the last `holdouts` of them are to check with. Without any, a quarter of
  /// each recording is held out: whole stretches of its time.
  Observations(Machine model, std::vector<Scene> all, std::size_t holdouts);

  Machine machine;  ///< the model that is doubted
  std::vector<Scene> scenes;
  std::vector<simulation::RigidTorque> rigid;  ///< of that model; empty where no torque shows
  std::vector<Simulation> simulations;         ///< of that model
  std::vector<Prediction> predictions;         ///< with its terms
  /// Measured samples: those to fit to, then those held out; within each part samples of one
  /// component follow in time.
  std::vector<Sample> samples;
  Eigen::Index train = 0;        ///< how many of the samples are there to fit to
  std::size_t train_scenes = 0;  ///< how many of the scenes these are in
  /// Standard deviation of each sample, SI: of its measurement, and of what no model here explains
  /// where that was added.
  Eigen::VectorXd noise;
  Eigen::VectorXd floor;         ///< that of the measurement alone
  Eigen::VectorXd residual;      ///< measured less predicted, over the noise
  std::size_t outliers = 0;      ///< samples that were left out
  bool noise_is_known = true;    ///< false in a load test, whose noise only a fit can tell
  double noise_uncertainty = 0;  ///< of a load test's noise: relative standard deviation
  bool is_static = false;

  Eigen::Index size() const { return residual.size(); }
  /// A sample's value over its noise as one over the noise of its measurement alone.
  double over_floor(Eigen::Index sample, double value) const {
    return value * noise[sample] / floor[sample];
  }
  Eigen::Index fewest_rows() const;  ///< of any scene
  bool has(Channel channel) const;
  std::vector<Channel> channels() const;  ///< those that it has
  bool has_weight() const;
  bool has_wrench() const;
  bool follows_command() const;
  double largest_load(int joint) const;    ///< N·m
  double largest_torque(int joint) const;  ///< N·m, predicted or, about, measured
  double largest_speed(int joint) const;   ///< rad/s
  double range(int joint) const;           ///< rad
  /// Do the TCP's places lie apart: by far in two directions, in all three, or over most of the
  /// reach of an arm that works in a plane? On a small path a shift and a turn of everything
  /// imitate whatever is smooth.
  bool spans_workspace() const;

  /// The scenes with samples to fit to.
  Scenes scenes_to_fit() const { return {scenes, train_scenes}; }
  /// What the samples to fit to would be wrong by (over the noise, a column a joint) if one joint's
  /// accelerations were all too small by what no remainder shows: a window that smooths angles cuts
  /// from all of them alike.
  Eigen::MatrixXd acceleration_error() const;
  /// Predictions as one column over the noise: of all scenes, or of those to fit to.
  Eigen::VectorXd stacked(const std::vector<Prediction>& values) const;
  /// Residual of other predictions, over the noise.
  Eigen::VectorXd residual_of(const std::vector<Prediction>& values) const;
  /// The samples to fit to, or those that are held out.
  Part part(bool held_out) const { return held_out ? Part{train, size()} : Part{0, train}; }
  /// Root mean square of values that are over the noise, SI: of a channel or one component of it,
  /// in the samples to fit to or in those held out. Zero without samples.
  double rms(const Eigen::VectorXd& values, Channel channel, bool held_out,
             std::optional<Eigen::Index> component = std::nullopt) const;
  /// A residual (all samples, over the noise) as an error of a joint's angle, at the TCP and at the
  /// link encoders, by scene.
  std::vector<JointResidual> angle_residual(int joint, const Eigen::VectorXd& unexplained) const;
  /// A residual as an error of a joint's torque, by scene.
  std::vector<JointResidual> torque_residual(int joint, const Eigen::VectorXd& unexplained) const;

  /// Leaves out the samples of some rows of a scene.
  void leave_out(std::size_t scene, Part rows);
  /// Leaves out samples whose `values` (over the noise) are beyond `limit`, as outliers.
  void drop_outliers(const Eigen::VectorXd& values, double limit);
  /// Sets the noise of a load test from what the fullest fit leaves.
  void set_noise(double factor);
  /// Counts for noise what is left of the samples all the same; `factors` are of each one's noise.
  void add_model_error(const Eigen::VectorXd& factors);

 private:
  /// Keeps the samples of a sign.
  void keep(const std::vector<bool>& kept);
  /// Change of the predictions, by channel, for another course of a scene's motion.
  std::array<Eigen::MatrixXd, 3> change_with(const Scene& other, std::size_t scene) const;
  PredictionNoise prediction_noise(std::size_t scene) const;
  void find_acceleration_error();
  void collect(std::size_t holdouts);
  void add_component(const Sample& first, const PredictionNoise& predicted, bool splits,
                     bool is_holdout, std::array<std::vector<Sample>, 2>* parts,
                     std::array<std::vector<double>, 2>* noises);
  void renew_residual();

  /// By scene and joint: change of the predictions by the error of that joint's accelerations.
  std::vector<std::vector<std::array<Eigen::MatrixXd, 3>>> acceleration_error_;
};

/// Torques (N·m, a column a joint) on the joints' springs as what was measured shows them: with
/// inertia where only link encoders do, else at rest.
const Eigen::MatrixXd& shown_load(const Scene& scene, const Prediction& prediction);

}  // namespace flexcomp::diagnosis
