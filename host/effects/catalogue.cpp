#include <algorithm>

#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

Effect named(const char* name, Forms forms) {
  Effect effect{name, {}, std::move(forms.apply_keys)};
  for (Law& law : forms.laws) {
    law.effect = name;
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
