#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "diagnosis/bodies.hpp"
#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// Finite differences, over a parameter's size (`Bounds::step`).
constexpr double kRelativeStep = 0.02;

/// Predictions as a function of the parameters of chosen hypotheses, in their order.
class Evaluator {
 public:
  /// With a dictionary, derivatives by parameters that alter the model in proportion are its own.
  Evaluator(const Observations& observations, std::vector<Chosen> chosen,
            const Dictionary* dictionary);

  std::size_t size() const { return alters_.size(); }
  const Parameter& parameter(std::size_t index) const;
  /// Precisions by which the parameters are held: one over the square of each tolerance.
  Eigen::VectorXd precisions() const;
  /// Factors of the parameters' standard deviations (Parameter::widening).
  Eigen::VectorXd widenings() const;
  const std::vector<Chosen>& chosen() const { return chosen_; }
  Values values() const;
  void set(const Values& all);
  /// Moves what is beyond a parameter's bounds to them.
  void keep_within_bounds();
  /// Simulates also scenes that are held out whole, when the samples to fit to are wanted.
  void simulate_all();
  /// Halves what acts in proportion.
  void halve_amplitudes();

  Bodies bodies() const { return Bodies(observations_, chosen_); }
  /// Does a parameter alter the model?
  bool alters(std::size_t index) const { return alters_[index]; }
  /// The robot with the chosen hypotheses at other values.
  model::Robot robot_with(const Values& values) const;
  /// Sets the values. Stacked prediction of the samples to fit to, and its derivative where wanted.
  /// Throws InputError where the machine has no rest.
  Eigen::VectorXd evaluate_to_fit(const Values& values, Eigen::MatrixXd* derivative);
  /// The same of all samples.
  Eigen::VectorXd evaluate(const Values& values, Eigen::MatrixXd* derivative);

 private:
  Eigen::VectorXd evaluate_in(const Scenes& scenes, const Values& values,
                              Eigen::MatrixXd* derivative);
  Eigen::VectorXd evaluate_by_turns(bool all, const Values& values, Eigen::MatrixXd* derivative);
  Eigen::VectorXd gains_over_dictionary(Eigen::Index count) const;
  /// The chosen hypotheses at other values, and the machine with them.
  std::vector<effects::Placed> placed_at(const Values& values) const;
  Machine machine_at(const Values& values) const;
  bool alters_any() const;
  const std::vector<simulation::RigidTorque>& rigid_torques(const Scenes& scenes,
                                                            const Machine& machine);
  Values altering() const;
  const std::vector<Simulation>& simulations(const Scenes& scenes, const Machine& machine);
  /// Stacked prediction of a machine that was simulated so.
  Eigen::VectorXd prediction(const Scenes& scenes, const Machine& machine,
                             const std::vector<Simulation>& simulations) const;
  Eigen::VectorXd stepped(const Scenes& scenes, const Values& values, std::size_t index,
                          double step, const std::vector<Simulation>& simulations,
                          const std::vector<simulation::RigidTorque>& rigid) const;

  const Observations& observations_;
  std::vector<Chosen> chosen_;
  const Dictionary* dictionary_;
  std::size_t train_scenes_;  ///< to simulate for the samples to fit to
  std::vector<bool> alters_;
  std::vector<Eigen::Index> known_;             ///< column of the dictionary, or −1
  std::vector<simulation::RigidTorque> rigid_;  ///< of the machine evaluated last
  Values simulated_at_;                         ///< values that alter the model, and what it does
  std::vector<Simulation> simulations_;         ///< with them; none yet at first
  /// Where some come and go: the machine while they act, the machine while they do not, and when.
  std::unique_ptr<Evaluator> acting_, idle_;
  std::shared_ptr<const Spells> when_;
};

}  // namespace flexcomp::diagnosis
