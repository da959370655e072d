#include "diagnosis/evaluator.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/gains.hpp"
#include "error.hpp"
#include "parallel/in_parallel.hpp"

namespace flexcomp::diagnosis {
namespace {

std::vector<Simulation> simulate_scenes(const Scenes& scenes, const Machine& machine,
                                        const std::vector<simulation::RigidTorque>& rigid,
                                        const std::vector<Simulation>& near) {
  return simulate(machine, scenes, rigid, simulation::Levers::of_terms, near);
}

}  // namespace

Evaluator::Evaluator(const Observations& observations, std::vector<Chosen> chosen,
                     const Dictionary* dictionary)
    : observations_(observations),
      chosen_(std::move(chosen)),
      dictionary_(dictionary),
      train_scenes_(observations.train_scenes) {
  for (const Chosen& each : chosen_) {
    const bool alters = each.hypothesis.traits().alters_model;
    const bool is_linear = each.hypothesis.linear == each.hypothesis.parameters.size() &&
                           !each.hypothesis.traits().is_curved;
    const Entry* entry =
        alters && is_linear && dictionary != nullptr ? dictionary->find(each.hypothesis) : nullptr;
    for (std::size_t i = 0; i < each.hypothesis.parameters.size(); ++i) {
      alters_.push_back(alters);
      known_.push_back(entry != nullptr ? entry->first + static_cast<Eigen::Index>(i) : -1);
    }
    when_ = each.hypothesis.when ? each.hypothesis.when : when_;
  }
  if (when_) {
    acting_ = std::make_unique<Evaluator>(observations, acting(chosen_), dictionary);
    idle_ = std::make_unique<Evaluator>(observations, steady(chosen_), dictionary);
  }
}

const Parameter& Evaluator::parameter(std::size_t index) const {
  for (const Chosen& each : chosen_) {
    if (index < each.hypothesis.parameters.size()) {
      return each.hypothesis.parameters[index];
    }
    index -= each.hypothesis.parameters.size();
  }
  return chosen_.front().hypothesis.parameters.front();
}

Eigen::VectorXd Evaluator::precisions() const {
  Eigen::VectorXd all(static_cast<Eigen::Index>(size()));
  for (std::size_t i = 0; i < size(); ++i) {
    all[static_cast<Eigen::Index>(i)] = std::pow(parameter(i).tolerance, -2);
  }
  return all;
}

Eigen::VectorXd Evaluator::widenings() const {
  Eigen::VectorXd all(static_cast<Eigen::Index>(size()));
  for (std::size_t i = 0; i < size(); ++i) {
    all[static_cast<Eigen::Index>(i)] = parameter(i).widening;
  }
  return all;
}

Values Evaluator::values() const {
  Values all;
  for (const Chosen& each : chosen_) {
    all.insert(all.end(), each.values.begin(), each.values.end());
  }
  return all;
}

void Evaluator::set(const Values& all) {
  auto at = all.begin();
  for (Chosen& each : chosen_) {
    const auto count = static_cast<std::ptrdiff_t>(each.values.size());
    each.values.assign(at, at + count);
    at += count;
  }
}

void Evaluator::keep_within_bounds() {
  for (Chosen& each : chosen_) {
    for (std::size_t i = 0; i < each.values.size(); ++i) {
      const Parameter& bounds = each.hypothesis.parameters[i];
      each.values[i] = std::clamp(each.values[i], bounds.lower, bounds.upper);
    }
  }
}

void Evaluator::simulate_all() {
  train_scenes_ = observations_.scenes.size();
  for (Evaluator* each : {acting_.get(), idle_.get()}) {
    if (each != nullptr) {
      each->simulate_all();
    }
  }
}

void Evaluator::halve_amplitudes() {
  for (Chosen& each : chosen_) {
    for (std::size_t i = 0; i < each.hypothesis.linear; ++i) {
      each.values[i] *= 0.5;
    }
  }
}

std::vector<effects::Placed> Evaluator::placed_at(const Values& values) const {
  std::vector<effects::Placed> placed;
  placed.reserve(chosen_.size());
  auto at = values.begin();
  for (const Chosen& each : chosen_) {
    const auto end = at + static_cast<std::ptrdiff_t>(each.values.size());
    placed.push_back({each.hypothesis.law, each.hypothesis.joint, Values(at, end)});
    at = end;
  }
  return placed;
}

Machine Evaluator::machine_at(const Values& values) const {
  Machine machine = observations_.machine;
  effects::add_effects(placed_at(values), &machine);
  return machine;
}

/// Terms leave the robot as it is.
model::Robot Evaluator::robot_with(const Values& values) const {
  std::vector<effects::Placed> placed = placed_at(values);
  placed.erase(
      std::remove_if(placed.begin(), placed.end(),
                     [](const effects::Placed& each) { return !each.law->traits.alters_model; }),
      placed.end());
  Machine machine = observations_.machine;
  effects::add_effects(placed, &machine);
  return machine.robot;
}

bool Evaluator::alters_any() const {
  return std::any_of(chosen_.begin(), chosen_.end(),
                     [](const Chosen& each) { return each.hypothesis.traits().alters_model; });
}

/// Rigid-body torques of a machine near which derivatives are wanted; most parameters leave them as
/// they are.
const std::vector<simulation::RigidTorque>& Evaluator::rigid_torques(const Scenes& scenes,
                                                                     const Machine& machine) {
  const std::vector<simulation::RigidTorque>& known = observations_.rigid;
  if (known.empty() || !alters_any() || known.front().holds_for(machine)) {
    return known;
  }
  // A step that is taken is evaluated once for its remainder, and again for its derivative.
  if (rigid_.size() < scenes.size() || !rigid_.front().holds_for(machine)) {
    rigid_ = simulation::rigid_torques(machine, scenes);
  }
  return rigid_;
}

/// The values of parameters that alter the model.
Values Evaluator::altering() const {
  Values all = values();
  for (std::size_t i = all.size(); i-- > 0;) {
    if (!alters_[i]) {
      all.erase(all.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  return all;
}

/// Of the machine at the present values. The last are kept: a step that is taken is evaluated once
/// for its remainder, and again for its derivative.
const std::vector<Simulation>& Evaluator::simulations(const Scenes& scenes,
                                                      const Machine& machine) {
  if (!alters_any()) {
    return observations_.simulations;
  }
  const Values here = altering();
  const bool has_all = simulations_.size() >= scenes.size();
  if (!has_all || here != simulated_at_) {
    simulations_ = simulate_scenes(scenes, machine, rigid_torques(scenes, machine),
                                   has_all ? simulations_ : observations_.simulations);
    simulated_at_ = here;
  }
  return simulations_;
}

Eigen::VectorXd Evaluator::prediction(const Scenes& scenes, const Machine& machine,
                                      const std::vector<Simulation>& simulations) const {
  return observations_.stacked(with_terms(machine.terms, scenes, simulations));
}

/// The prediction with one parameter a step further, from simulations without the step.
Eigen::VectorXd Evaluator::stepped(const Scenes& scenes, const Values& values, std::size_t index,
                                   double step, const std::vector<Simulation>& simulations,
                                   const std::vector<simulation::RigidTorque>& rigid) const {
  Values other = values;
  other[index] += step;
  const Machine changed = machine_at(other);
  return alters_[index]
             ? prediction(scenes, changed, simulate_scenes(scenes, changed, rigid, simulations))
             : prediction(scenes, changed, simulations);
}

/// The machine while some act in the rows in which they do, and the machine without them in all
/// others. All that come and go do so together.
Eigen::VectorXd Evaluator::evaluate_by_turns(bool all, const Values& values,
                                             Eigen::MatrixXd* derivative) {
  set(values);
  Values of_others;
  for (const Chosen& each : steady(chosen_)) {
    of_others.insert(of_others.end(), each.values.begin(), each.values.end());
  }
  const auto evaluate_one = all ? &Evaluator::evaluate : &Evaluator::evaluate_to_fit;
  Eigen::MatrixXd idle_slope;
  Eigen::VectorXd predicted = (acting_.get()->*evaluate_one)(values, derivative);
  const Eigen::VectorXd idle =
      (idle_.get()->*evaluate_one)(of_others, derivative != nullptr ? &idle_slope : nullptr);
  const Eigen::VectorXd acts = when_->by_sample(observations_, predicted.size());
  predicted = idle + acts.cwiseProduct(predicted - idle);
  if (derivative != nullptr) {
    Eigen::Index of_all = 0;
    Eigen::Index of_idle = 0;
    for (const Chosen& each : chosen_) {
      for (std::size_t i = 0; i < each.values.size(); ++i, ++of_all) {
        auto column = derivative->col(of_all);
        column = column.cwiseProduct(acts).eval();
        if (!each.hypothesis.when) {
          column += (1 - acts.array()).matrix().cwiseProduct(idle_slope.col(of_idle++));
        }
      }
    }
  }
  return predicted;
}

Eigen::VectorXd Evaluator::evaluate_to_fit(const Values& values, Eigen::MatrixXd* derivative) {
  if (when_) {
    return evaluate_by_turns(false, values, derivative);
  }
  return evaluate_in({observations_.scenes, train_scenes_}, values, derivative);
}

Eigen::VectorXd Evaluator::evaluate(const Values& values, Eigen::MatrixXd* derivative) {
  if (when_) {
    return evaluate_by_turns(true, values, derivative);
  }
  return evaluate_in(observations_.scenes, values, derivative);
}

/// What chosen gains multiply the first samples by beyond what the dictionary knows: its columns
/// are of a machine with gains of its own.
Eigen::VectorXd Evaluator::gains_over_dictionary(Eigen::Index count) const {
  Eigen::VectorXd gains = gains_of(chosen_, observations_.machine.robot.joints());
  if (dictionary_ != nullptr && dictionary_->gains.size() > 0) {
    gains = gains.cwiseQuotient(dictionary_->gains);
  }
  return by_sample(observations_, gains, count);
}

Eigen::VectorXd Evaluator::evaluate_in(const Scenes& scenes, const Values& values,
                                       Eigen::MatrixXd* derivative) {
  set(values);
  const Machine machine = machine_at(values);
  const std::vector<Simulation>& at = simulations(scenes, machine);
  Eigen::VectorXd base = prediction(scenes, machine, at);
  if (derivative == nullptr) {
    return base;
  }
  const std::vector<simulation::RigidTorque>& rigid = rigid_torques(scenes, machine);
  const Eigen::VectorXd gains = gains_over_dictionary(base.size());
  derivative->resize(base.size(), static_cast<Eigen::Index>(size()));
  in_parallel(
      size(), [](std::size_t, std::size_t) {},
      [&](std::size_t i) {
        if (known_[i] >= 0) {
          derivative->col(static_cast<Eigen::Index>(i)) =
              gains.cwiseProduct(dictionary_->columns.col(known_[i]).head(base.size()));
          return;
        }
        const Parameter& bounds = parameter(i);
        double step = kRelativeStep * bounds.step;
        if (values[i] + step > bounds.upper) {
          step = -step;
        }
        Eigen::VectorXd other;
        try {
          other = stepped(scenes, values, i, step, at, rigid);
        } catch (const InputError&) {
          step = -step;  // a spring that may get no softer may get stiffer
          other = stepped(scenes, values, i, step, at, rigid);
        }
        derivative->col(static_cast<Eigen::Index>(i)) = (other - base) / step;
      });
  return base;
}

}  // namespace flexcomp::diagnosis
