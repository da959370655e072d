#include "diagnosis/learned.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "error.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Effects that the keys of a robot's file can say; link flexibility only as springs.
bool has_key(const Hypothesis& hypothesis) {
  constexpr const char* kEffects[] = {
      "joint_stiffness", "nonlinear_stiffness", "base_compliance",  "tool_compliance",
      "payload",         "coulomb_friction",    "viscous_friction", "rotor_inertia"};
  const bool is_plain =
      hypothesis.form.empty() &&
      std::find(std::begin(kEffects), std::end(kEffects), hypothesis.effect) != std::end(kEffects);
  return is_plain || (hypothesis.effect == "link_flexibility" && hypothesis.form == "springs");
}

/// Play by the key `backlash`: driven by the load where the joint carries one, with a drag of a
/// hundredth of it, else by the motion.
model::LearnedEffect keyed_play(const Observations& observations, int joint, double gap) {
  const double load = observations.largest_load(joint);
  if (load > 1) {
    return {"backlash", joint, "load", {{"gap", gap}, {"hold", 0.01 * load}}};
  }
  return {"backlash", joint, "motion", {{"gap", gap}}};
}

std::vector<model::LearnedEffect> effects_of(const model::Robot& robot,
                                             const Observations& observations) {
  std::vector<model::LearnedEffect> all = robot.effects;
  for (int joint = 1; joint <= 6; ++joint) {
    const double gap = robot.dynamics[static_cast<std::size_t>(joint - 1)].backlash;
    const bool is_learnt = std::any_of(all.begin(), all.end(), [&](const auto& each) {
      return each.effect == "backlash" && each.joint == joint;
    });
    const bool shows = observations.has(simulation::tcp_position) ||
                       observations.has(simulation::joint_deflection);
    const bool moves = !observations.is_static || observations.largest_load(joint) > 1;
    if (gap > 0 && !is_learnt && shows && moves) {
      all.push_back(keyed_play(observations, joint, gap));
    }
  }
  return all;
}

bool is_known(const std::vector<Hypothesis>& hypotheses, const std::string& effect) {
  return std::any_of(hypotheses.begin(), hypotheses.end(),
                     [&](const Hypothesis& hypothesis) { return hypothesis.effect == effect; });
}

/// Applies an effect if it is one that alters the model, or one that does not.
void apply(const model::LearnedEffect& learned, const std::vector<Hypothesis>& hypotheses,
           bool alters, const model::Robot& robot, Machine* machine) {
  for (const Hypothesis& hypothesis : hypotheses) {
    if (hypothesis.alters_model != alters || hypothesis.effect != learned.effect ||
        hypothesis.joint != learned.joint || hypothesis.form != learned.form) {
      continue;
    }
    Values values;
    for (const Parameter& parameter : hypothesis.parameters) {
      const auto at = learned.parameters.find(parameter.name);
      if (at == learned.parameters.end()) {
        throw InputError(fmt::format("{}: effects: {} needs the parameter '{}' ({})",
                                     robot.yaml.string(), learned.effect, parameter.name,
                                     parameter.unit));
      }
      values.push_back(at->second);
    }
    hypothesis.apply(values, machine);
    return;
  }
  // Of an effect that these recordings cannot show there is no hypothesis, and no trace either.
  if (!alters && is_known(hypotheses, learned.effect) && learned.effect == "thermal_drift") {
    throw InputError(
        fmt::format("{}: effects: a thermal_drift by {} cannot be simulated for these "
                    "recordings",
                    robot.yaml.string(), learned.form));
  }
}

void refuse_unknown_form(const model::Robot& robot, const model::LearnedEffect& learned) {
  const auto effect = std::find_if(registry().begin(), registry().end(),
                                   [&](const Effect& each) { return each.name == learned.effect; });
  const std::vector<std::string>& forms = effect->forms;
  if (forms.empty() ? learned.form.empty()
                    : std::find(forms.begin(), forms.end(), learned.form) != forms.end()) {
    return;
  }
  throw InputError(fmt::format(
      "{}: effects: {} has no form '{}'; expected {}", robot.yaml.string(), learned.effect,
      learned.form, forms.empty() ? "none" : fmt::format("one of: {}", fmt::join(forms, ", "))));
}

void refuse_unknown(const model::Robot& robot) {
  std::vector<std::string> known;
  for (const Effect& effect : registry()) {
    known.emplace_back(effect.name);
  }
  for (const model::LearnedEffect& learned : robot.effects) {
    if (std::find(known.begin(), known.end(), learned.effect) == known.end()) {
      throw InputError(fmt::format("{}: effects: '{}' is unknown; expected one of: {}",
                                   robot.yaml.string(), learned.effect, fmt::join(known, ", ")));
    }
    refuse_unknown_form(robot, learned);
  }
}

}  // namespace

Machine machine_of(const model::Robot& robot, const std::vector<Scene>& scenes) {
  refuse_unknown(robot);
  Machine machine;
  machine.robot = robot;
  const bool has_play = std::any_of(robot.dynamics.begin(), robot.dynamics.end(),
                                    [](const auto& joint) { return joint.backlash > 0; });
  if (robot.effects.empty() && !has_play) {
    return machine;
  }
  const Observations observations(machine, scenes, 0);
  const std::vector<Hypothesis> hypotheses = all_hypotheses(observations);
  const std::vector<model::LearnedEffect> effects = effects_of(robot, observations);
  // Terms may hold a copy of the robot: what alters it comes first.
  for (const bool alters : {true, false}) {
    for (const model::LearnedEffect& learned : effects) {
      apply(learned, hypotheses, alters, robot, &machine);
    }
  }
  return machine;
}

model::Robot updated_robot(const Observations& observations, const Fit& fit) {
  Machine machine;
  machine.robot = observations.machine.robot;
  // Effects that altered the model when it was read stand in its list: start from its file again.
  std::vector<model::LearnedEffect> effects = machine.robot.effects;
  for (const Chosen& chosen : fit.chosen) {
    const Hypothesis& hypothesis = *chosen.hypothesis;
    if (has_key(hypothesis)) {
      hypothesis.apply(chosen.values, &machine);
      continue;
    }
    model::LearnedEffect learned{hypothesis.effect, hypothesis.joint, hypothesis.form, {}};
    for (std::size_t i = 0; i < chosen.values.size(); ++i) {
      learned.parameters[hypothesis.parameters[i].name] = chosen.values[i];
    }
    if (hypothesis.effect == "backlash") {
      machine.robot.dynamics[static_cast<std::size_t>(hypothesis.joint - 1)].backlash +=
          chosen.values[0];
    }
    effects.push_back(std::move(learned));
  }
  machine.robot.effects = std::move(effects);
  return machine.robot;
}

}  // namespace flexcomp::diagnosis
