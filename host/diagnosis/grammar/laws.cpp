#include "diagnosis/grammar/laws.hpp"

#include <algorithm>

#include "diagnosis/grammar/written.hpp"
#include "diagnosis/rest.hpp"
#include "diagnosis/select/grow.hpp"
#include "diagnosis/select/standards.hpp"

namespace flexcomp::diagnosis::grammar {
namespace {

constexpr std::size_t kMostLaws = 3;    // beside each other: more take minutes
constexpr double kLeastLawShare = 0.3;  // of the power beyond the noise where it shows

/// The effects of the catalogue that are sought.
std::set<std::string> effects_of(const Inquiry& inquiry) {
  std::set<std::string> effects;
  for (const Hypothesis& each : inquiry.dictionary.hypotheses) {
    effects.insert(each.effect());
  }
  return effects;
}

/// A fit with one law more that holds; nothing chosen where there is none.
Fit with_law(const Inquiry& inquiry, const Material& material, const Fit& before) {
  const Observations& observations = inquiry.observations;
  const std::vector<Seat> seats = seats_of(observations, material.rows, before);
  std::size_t looked_at = inquiry.dictionary.entries.size();
  const std::vector<Lead> leads = screen(material, seats, &looked_at);
  Fit best;
  for (const Composed& law : compose(material, leads, effects_of(inquiry), &looked_at)) {
    Fit grown = fit_with(inquiry, before, chosen_of(observations, law), kSteps);
    const Evidence evidence = weigh(observations, before, grown, static_cast<double>(looked_at));
    if (holds(inquiry, evidence) && evidence.share > kLeastLawShare &&
        (best.chosen.empty() || bic_gain(observations, best, grown) > kStrongEvidence)) {
      best = std::move(grown);
    }
  }
  return best;
}

/// A fit with one effect of the catalogue more that holds; nothing chosen where there is none.
Fit with_effect(const Inquiry& inquiry, const Fit& before) {
  const Fit grown = best_beside(inquiry, {before, seek(inquiry, before)}, kShortlist);
  return !grown.chosen.empty() && holds(inquiry, weigh_last(inquiry, before, grown)) ? grown
                                                                                     : Fit{};
}

/// The better of a law and an effect. For the law there must be strong evidence, and a share of
/// what there is for the effect.
Fit better_of(const Observations& observations, const Fit& before, Fit law, Fit effect) {
  if (law.chosen.empty() || effect.chosen.empty()) {
    return effect.chosen.empty() ? law : effect;
  }
  const double needed =
      std::max(kStrongEvidence, kUnusual * bic_gain(observations, before, effect));
  return bic_gain(observations, effect, law) > needed ? law : effect;
}

/// A fit with one law or effect more; nothing chosen where none holds.
Fit with_one(const Inquiry& inquiry, const Material& material, const Fit& before) {
  return better_of(inquiry.observations, before, with_law(inquiry, material, before),
                   with_effect(inquiry, before));
}

/// A choice anew in the place of one of a fit, if it does better; else nothing chosen.
Fit chosen_anew(const Inquiry& inquiry, const Material& material, const Fit& grown,
                std::size_t index) {
  const Observations& observations = inquiry.observations;
  if (!meet(directions(observations, grown, index),
            directions(observations, grown, grown.chosen.size() - 1))) {
    return {};
  }
  Fit again = with_one(inquiry, material, fit_without(inquiry, grown, index));
  const bool is_simpler = again.parameters() < grown.parameters();
  const bool is_better = !again.chosen.empty() &&
                         bic_gain(observations, grown, again) > (is_simpler ? 0 : kStrongEvidence);
  return is_better ? again : Fit{};
}

/// Chooses anew what was chosen before the last, each beside all others: what was chosen early had
/// to say what others say by now. What comes anew is the last then, and the others are seen to once
/// more.
Fit revised(const Inquiry& inquiry, const Material& material, Fit grown, Budget* budget) {
  constexpr int kRounds = 3;  // time: none took more
  bool has_changed = true;
  for (int round = 0; round < kRounds && has_changed; ++round) {
    has_changed = false;
    for (std::size_t i = inquiry.given.chosen.size();
         i + 1 < grown.chosen.size() && !budget->is_spent(); ++i) {
      Fit again = chosen_anew(inquiry, material, grown, i);
      if (!again.chosen.empty()) {
        grown = std::move(again);
        has_changed = true;
      }
    }
  }
  return grown;
}

}  // namespace

bool has_law(const Choice& choice) {
  return std::any_of(choice.findings.begin(), choice.findings.end(),
                     [](const Finding& each) { return each.chosen.hypothesis.is_law(); });
}

Choice choose_laws(const Inquiry& inquiry, const Fit& begun, Budget* budget,
                   const TellStage& tell) {
  const Material material(inquiry.observations);
  std::vector<Fit> stages = {begun};
  while (stages.size() <= kMostLaws && !budget->is_spent()) {
    tell("composing laws");
    Fit next = with_one(inquiry, material, stages.back());
    if (next.chosen.empty()) {
      break;
    }
    stages.push_back(revised(inquiry, material, std::move(next), budget));
    if (more_than_noise(inquiry.observations, stages.back().remainder).empty()) {
      break;
    }
  }
  // What came last may take away what the law before it stood on.
  for (; stages.size() > 1; stages.pop_back()) {
    Choice choice = conclude(inquiry, {stages.back(), seek(inquiry, stages.back())});
    if (has_law(choice)) {
      return choice;
    }
  }
  return {};
}

}  // namespace flexcomp::diagnosis::grammar
