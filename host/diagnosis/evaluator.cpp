#include "diagnosis/evaluator.hpp"

#include <algorithm>
#include <cmath>

#include "parallel/in_parallel.hpp"

namespace flexcomp::diagnosis {

Evaluator::Evaluator(const Observations& observations, std::vector<Chosen> chosen,
                     const Dictionary* dictionary)
    : observations_(observations), chosen_(std::move(chosen)), dictionary_(dictionary) {
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

model::Robot Evaluator::robot_with(const Values& values) const {
  Evaluator moved(observations_, chosen_, nullptr);
  moved.set(values);
  return machine_with(observations_, moved.chosen_).robot;
}

bool Evaluator::alters_any() const {
  return std::any_of(chosen_.begin(), chosen_.end(),
                     [](const Chosen& each) { return each.hypothesis.traits().alters_model; });
}

/// Rigid-body torques of a machine near which derivatives are wanted; most parameters leave them as
/// they are.
const std::vector<simulation::RigidTorque>& Evaluator::rigid_torques(const Machine& machine) {
  const std::vector<simulation::RigidTorque>& known = observations_.rigid;
  if (known.empty() || !alters_any() || known.front().holds_for(machine)) {
    return known;
  }
  // A step that is taken is evaluated once for its remainder, and again for its derivative.
  if (rigid_.empty() || !rigid_.front().holds_for(machine)) {
    rigid_ = simulation::rigid_torques(machine, observations_.scenes);
  }
  return rigid_;
}

std::vector<Simulation> Evaluator::simulate_scenes(
    const Machine& machine, const std::vector<simulation::RigidTorque>& rigid) const {
  if (!alters_any()) {
    return observations_.simulations;
  }
  return simulate(machine, observations_.scenes, rigid, simulation::Levers::of_terms);
}

Eigen::VectorXd Evaluator::prediction(const Machine& machine,
                                      const std::vector<Simulation>& simulations) const {
  return observations_.stacked(with_terms(machine.terms, observations_.scenes, simulations));
}

Eigen::VectorXd Evaluator::evaluate(const Values& values, Eigen::MatrixXd* derivative) {
  set(values);
  const Machine machine = machine_with(observations_, chosen_);
  const std::vector<simulation::RigidTorque>& rigid = rigid_torques(machine);
  const std::vector<Simulation> simulations = simulate_scenes(machine, rigid);
  Eigen::VectorXd base = prediction(machine, simulations);
  if (derivative == nullptr) {
    return base;
  }
  derivative->resize(base.size(), static_cast<Eigen::Index>(size()));
  in_parallel(
      size(), [](std::size_t, std::size_t) {},
      [&](std::size_t i) {
        if (known_[i] >= 0) {
          derivative->col(static_cast<Eigen::Index>(i)) = dictionary_->columns.col(known_[i]);
          return;
        }
        const Parameter& bounds = parameter(i);
        double step = kRelativeStep * bounds.step;
        if (values[i] + step > bounds.upper) {
          step = -step;
        }
        Evaluator moved(observations_, chosen_, nullptr);
        Values other = values;
        other[i] += step;
        moved.set(other);
        const Machine changed = machine_with(observations_, moved.chosen_);
        const Eigen::VectorXd predicted =
            alters_[i] ? prediction(changed, moved.simulate_scenes(changed, rigid))
                       : prediction(changed, simulations);
        derivative->col(static_cast<Eigen::Index>(i)) = (predicted - base) / step;
      });
  return base;
}

}  // namespace flexcomp::diagnosis
