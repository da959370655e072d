#include "effects/learned.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <tuple>
#include <unordered_map>

#include "effects/formula_law.hpp"
#include "error.hpp"

namespace flexcomp::effects {
namespace {

[[noreturn]] void refuse(const std::string& place, const std::string& why) {
  throw InputError(fmt::format("{}: {}", place, why));
}

std::string list_of(const model::Robot& robot) { return robot.yaml.string() + ": effects"; }

[[noreturn]] void refuse(const model::Robot& robot, const model::LearnedEffect& learned,
                         const std::string& why) {
  refuse(learned.place.empty() ? list_of(robot) : learned.place, why);
}

const Effect& effect_of(const model::Robot& robot, const model::LearnedEffect& learned) {
  std::vector<std::string> known;
  for (const Effect& effect : catalogue()) {
    if (effect.name == learned.effect) {
      return effect;
    }
    known.push_back(effect.name);
  }
  refuse(robot, learned,
         fmt::format("'{}' is unknown; expected one of: {}, {}", learned.effect,
                     fmt::join(known, ", "), model::kLaw));
}

LawPointer known_law(const model::Robot& robot, const model::LearnedEffect& learned) {
  std::vector<std::string> forms;
  for (const LawPointer& law : effect_of(robot, learned).forms) {
    if (law->form == learned.form) {
      return law;
    }
    forms.push_back(law->form);
  }
  const bool has_one = forms.size() == 1 && forms.front().empty();
  const std::string found =
      learned.form.empty() ? "needs a form" : fmt::format("has no form '{}'", learned.form);
  refuse(robot, learned,
         fmt::format("{} {}; expected {}", learned.effect, found,
                     has_one ? "none" : fmt::format("one of: {}", fmt::join(forms, ", "))));
}

LawPointer written_law(const model::Robot& robot, const model::LearnedEffect& learned) {
  std::vector<std::string> names;
  for (const auto& [name, value] : learned.parameters) {
    names.push_back(name);
  }
  return formula_law(
      std::make_shared<const BoundFormula>(bind_law(*learned.law, robot, learned.joint, names)),
      Unvalued::refuse);
}

void refuse_wrong_joint(const model::Robot& robot, const model::LearnedEffect& learned,
                        const Law& law) {
  const std::vector<int> known = law.joints(robot.joints());
  if (std::find(known.begin(), known.end(), learned.joint) == known.end()) {
    const std::string found =
        learned.joint == 0 ? "has no joint" : fmt::format("has joint {}", learned.joint);
    const bool has_none = known.empty() || known.back() == 0;
    refuse(robot, learned,
           fmt::format("{} {}; expected {}", learned.effect, found,
                       has_none ? "none" : fmt::format("one of: {}", fmt::join(known, ", "))));
  }
  const std::string why = law.impossible ? law.impossible(robot, learned.joint) : "";
  if (!why.empty()) {
    refuse(robot, learned,
           fmt::format("{} cannot be at joint {}: {}", learned.effect, learned.joint, why));
  }
}

Values values_of(const model::Robot& robot, const model::LearnedEffect& learned,
                 const std::vector<Parameter>& parameters) {
  Values values;
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters) {
    const auto at = learned.parameters.find(parameter.name);
    if (at == learned.parameters.end()) {
      refuse(robot, learned,
             fmt::format("{} needs the parameter '{}' ({})", learned.effect, parameter.name,
                         parameter.unit));
    }
    values.push_back(at->second);
    names.push_back(parameter.name);
  }
  for (const auto& [name, value] : learned.parameters) {
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      refuse(robot, learned,
             fmt::format("{} has no parameter '{}'; expected {}", learned.effect, name,
                         fmt::join(names, ", ")));
    }
  }
  return values;
}

/// Play by a key, and whatever else a key says that only terms can simulate.
void apply_keys(const model::Robot& robot, Machine* machine) {
  for (const Effect& effect : catalogue()) {
    for (int joint = 1; effect.apply_keys && joint <= robot.joints(); ++joint) {
      const bool is_listed = std::any_of(
          robot.effects.begin(), robot.effects.end(),
          [&](const auto& each) { return each.effect == effect.name && each.joint == joint; });
      if (!is_listed) {
        effect.apply_keys(robot, joint, machine);
      }
    }
  }
}

model::LearnedEffect entry_of(const model::Robot& robot, const Placed& placed) {
  model::LearnedEffect entry{placed.law->effect, placed.joint, placed.law->form, {}, {}};
  if (placed.law->written) {
    entry.law = *placed.law->written;
  }
  const std::vector<Parameter> parameters = placed.law->parameters(robot, placed.joint);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (!parameters[i].is_of_recording) {
      entry.parameters[parameters[i].name] = placed.values[i];
    }
  }
  return entry;
}

/// Is the effect found the same formula at the same place as one listed, with parameters that all
/// act in proportion? Then their parameters add up.
bool adds_up(const model::LearnedEffect& listed, const Placed& found) {
  return listed.law && found.law->bound && listed.joint == found.joint &&
         listed.law->place == found.law->written->place &&
         listed.law->axis == found.law->written->axis &&
         listed.law->formula == found.law->written->formula &&
         found.law->traits.linear_in == found.law->bound->parameters.size();
}

void add_entry(model::LearnedEffect entry, const Placed& found, model::Robot* robot) {
  for (model::LearnedEffect& listed : robot->effects) {
    if (adds_up(listed, found)) {
      for (const auto& [name, value] : entry.parameters) {
        listed.parameters[name] += value;
      }
      return;
    }
  }
  robot->effects.push_back(std::move(entry));
}

/// Place of a law among all forms of all effects; behind them for one that is not among them.
std::size_t place_in_catalogue(const Law& law) {
  static const std::unordered_map<const Law*, std::size_t> kLaws = [] {
    std::unordered_map<const Law*, std::size_t> all;
    for (const Effect& effect : catalogue()) {
      for (const LawPointer& form : effect.forms) {
        all.emplace(form.get(), all.size());
      }
    }
    return all;
  }();
  const auto at = kLaws.find(&law);
  return at == kLaws.end() ? kLaws.size() : at->second;
}

}  // namespace

LawPointer law_of(const model::Robot& robot, const model::LearnedEffect& learned) {
  return learned.law ? written_law(robot, learned) : known_law(robot, learned);
}

void add_effects(const std::vector<Placed>& effects, Machine* machine) {
  using Rank = std::tuple<bool, std::size_t, int>;
  std::vector<std::pair<Rank, const Placed*>> ordered;
  ordered.reserve(effects.size());
  for (const Placed& each : effects) {
    const Rank rank{!each.law->traits.alters_model, place_in_catalogue(*each.law), each.joint};
    ordered.emplace_back(rank, &each);
  }
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [rank, each] : ordered) {
    each->law->apply(each->values, each->joint, machine);
  }
}

std::vector<Placed> listed_effects(const model::Robot& robot) {
  std::vector<Placed> all;
  for (const model::LearnedEffect& learned : robot.effects) {
    const LawPointer law = law_of(robot, learned);
    if (!learned.law) {
      refuse_wrong_joint(robot, learned, *law);
    }
    all.push_back(
        {law, learned.joint, values_of(robot, learned, law->parameters(robot, learned.joint))});
  }
  return all;
}

Machine machine_of(const model::Robot& robot) {
  Machine machine(robot);
  add_effects(listed_effects(robot), &machine);
  apply_keys(robot, &machine);
  return machine;
}

Machine machine_of(const model::Robot& robot, const std::vector<Scene>& scenes) {
  for (const Placed& each : listed_effects(robot)) {
    for (const Scene& scene : scenes) {
      if (each.law->traits.needs_temperature && scene.temperature.size() == 0) {
        refuse(list_of(robot),
               fmt::format("a {} by {} cannot be simulated for {}, which has no temp_c",
                           each.law->effect, each.law->written ? "temperature" : each.law->form,
                           scene.file));
      }
    }
  }
  return machine_of(robot);
}

model::Robot with_learned(model::Robot robot, const std::vector<Placed>& found) {
  for (const Placed& each : found) {
    if (!each.law->keys_say_all) {
      add_entry(entry_of(robot, each), each, &robot);
    }
    if (each.law->write_keys) {
      each.law->write_keys(each.values, each.joint, &robot);
    }
  }
  return robot;
}

}  // namespace flexcomp::effects
