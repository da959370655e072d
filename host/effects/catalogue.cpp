#include <algorithm>
#include <limits>

#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

Effect named(const char* name, Forms forms) {
  Effect effect{name, "", {}, std::move(forms.apply_keys)};
  for (Law& law : forms.laws) {
    law.effect = name;
    effect.words = effect.words.empty() ? law.words : effect.words;
    for (const ParameterRange& range : forms.ranges) {
      if (*range.form == 0 || law.form == range.form) {
        law.ranges.push_back(range);
      }
    }
    effect.forms.push_back(std::make_shared<const Law>(std::move(law)));
  }
  return effect;
}

}  // namespace

const std::vector<Effect>& catalogue() {
  static const std::vector<Effect> kEffects = {
#define FLEXCOMP_EFFECT(name) named(#name, laws::name()),
#include "effects/catalogue.inc"
#undef FLEXCOMP_EFFECT
  };
  return kEffects;
}

Range plausible_range(const Law& law, const model::Robot& robot, const MachineSize& size, int joint,
                      const std::string& parameter) {
  for (const ParameterRange& row : law.ranges) {
    if (std::string(row.parameters).find(" " + parameter + " ") != std::string::npos) {
      Range range = row.range({robot, size, joint, parameter});
      range.source = row.source;
      return range;
    }
  }
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  return {-kEndless, kEndless, Rest::nowhere, ""};
}

LawPointer find_law(const std::string& effect, const std::string& form) {
  for (const Effect& each : catalogue()) {
    for (const LawPointer& law : each.forms) {
      if (law->effect == effect && law->form == form) {
        return law;
      }
    }
  }
  return nullptr;
}

}  // namespace flexcomp::effects
