#include "diagnosis/grammar/laws.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/grammar/compose.hpp"
#include "diagnosis/grammar/known.hpp"
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

/// A fit with one law more, and the effect of the catalogue that its constant, or its factor with a
/// constant in the place of the shape, is by itself; empty where it has none.
struct WithLaw {
  Fit fit;
  std::string constant;
};

/// The effect that a law's constant is by itself, or its factor, if that is the direction of
/// motion: other factors vary as a whole, as a torque's gain does with heat. A law of few numbers
/// says hardly more than an effect, and stands for itself; so does friction by the course of its
/// own speed, of which dry friction is but one part.
std::string constant_of(const Material& material, const Composed& law) {
  constexpr std::size_t kFew = 2;
  if (law.form.has_constant) {
    return constant_as(law.lead);
  }
  const bool is_by_direction =
      law.lead.factor.text != law.lead.factor.signal && !law.lead.is_of_itself();
  return is_by_direction && law.numbers() > kFew ? factor_as(material, law.lead) : "";
}

/// A fit with one law more that holds; nothing chosen where there is none.
WithLaw with_law(const Inquiry& inquiry, const Material& material, const Fit& before) {
  const Observations& observations = inquiry.observations;
  const std::vector<Seat> seats = seats_of(observations, material.rows, before);
  std::size_t looked_at = inquiry.dictionary.entries.size();
  const std::vector<Lead> leads = screen(material, seats, &looked_at);
  std::vector<Composed> laws = compose(material, leads, effects_of(inquiry), &looked_at);
  WithLaw best;
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const Composed law = laws[i];
    Fit grown = fit_with(inquiry, before, chosen_of(observations, law), kSteps);
    const Evidence evidence = weigh(observations, before, grown, static_cast<double>(looked_at));
    if (!holds(inquiry, evidence) || evidence.share <= kLeastLawShare) {
      // A constant may be of the one recording that was fitted to.
      if (law.form.has_constant && evidence.confirmation < kConfirmed) {
        laws.insert(laws.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                    without_constant(material, law));
      }
    } else if (best.fit.chosen.empty() ||
               bic_gain(observations, best.fit, grown) > kStrongEvidence) {
      best = {std::move(grown), constant_of(material, law)};
    }
  }
  return best;
}

/// A fit with one effect of the catalogue more that holds; nothing chosen where there is none.
Fit with_effect(const Inquiry& inquiry, const Attempt& before) {
  const Fit grown = best_beside(inquiry, before, kShortlist);
  return !grown.chosen.empty() && holds(inquiry, weigh_last(inquiry, before.fit, grown)) ? grown
                                                                                         : Fit{};
}

/// A fit with the effect that the law's constant or factor is by itself, at the joint where it does
/// most, if that is most of what the law does, counted by how many times less is left: the law of
/// what is left is sought beside it. Else nothing chosen.
Fit with_constant(const Inquiry& inquiry, const Attempt& before, const WithLaw& law) {
  constexpr double kMost = 0.5;
  Fit best;
  for (const Candidate& each : propose(inquiry, before)) {
    if (each.chosen.hypothesis.effect() == law.constant) {
      Fit grown = fit_with(inquiry, before.fit, each.chosen, kSteps);
      if (best.chosen.empty() || grown.train_sum < best.train_sum) {
        best = std::move(grown);
      }
    }
  }
  const bool is_most =
      !best.chosen.empty() && std::log(before.fit.train_sum / best.train_sum) >
                                  kMost * std::log(before.fit.train_sum / law.fit.train_sum);
  return is_most && holds(inquiry, weigh_last(inquiry, before.fit, best)) ? best : Fit{};
}

/// The better of a law and an effect. For the law there must be strong evidence, and a share of
/// what there is for the effect if that is a usual one.
Fit better_of(const Observations& observations, const Fit& before, Fit law, Fit effect) {
  if (law.chosen.empty() || effect.chosen.empty()) {
    return effect.chosen.empty() ? law : effect;
  }
  const double share = effect.chosen.back().hypothesis.traits().is_of_few ? 0 : kUnusual;
  const double needed = std::max(kStrongEvidence, share * bic_gain(observations, before, effect));
  return bic_gain(observations, effect, law) > needed ? law : effect;
}

/// A fit with one law or effect more; nothing chosen where none holds.
Fit with_one(const Inquiry& inquiry, const Material& material, const Fit& before) {
  const Attempt attempt{before, seek(inquiry, before)};
  WithLaw law = with_law(inquiry, material, before);
  Fit best = better_of(inquiry.observations, before, law.fit, with_effect(inquiry, attempt));
  const bool is_law = !best.chosen.empty() && best.chosen.back().hypothesis.is_law();
  Fit constant = is_law && !law.constant.empty() ? with_constant(inquiry, attempt, law) : Fit{};
  return constant.chosen.empty() ? best : constant;
}

/// A choice anew in the place of one of a fit, if it does better; else nothing chosen.
Fit chosen_anew(const Inquiry& inquiry, const Material& material, const Fit& grown,
                std::size_t index) {
  const Observations& observations = inquiry.observations;
  Fit again = with_one(inquiry, material, fit_without(inquiry, grown, index));
  const bool is_simpler = again.parameters() < grown.parameters();
  const bool is_better = !again.chosen.empty() &&
                         bic_gain(observations, grown, again) > (is_simpler ? 0 : kStrongEvidence);
  return is_better ? again : Fit{};
}

/// Chooses anew, once, each that `is_due` of what was chosen before the last, beside all others.
/// What comes anew is the last then. Returns whether something did.
template <typename IsDue>
bool choose_anew(const Inquiry& inquiry, const Material& material, Fit* grown, IsDue is_due,
                 Budget* budget) {
  const std::size_t count = grown->chosen.size();
  bool has_changed = false;
  for (std::size_t i = inquiry.given.chosen.size(), at = i; i + 1 < count && !budget->is_spent();
       ++i) {
    Fit again = is_due(*grown, at) ? chosen_anew(inquiry, material, *grown, at) : Fit{};
    if (again.chosen.empty()) {
      ++at;
    } else {
      *grown = std::move(again);
      has_changed = true;
    }
  }
  return has_changed;
}

/// What was chosen early had to say what others say by now: it is chosen anew where the last choice
/// meets it, until nothing changes.
Fit revised(const Inquiry& inquiry, const Material& material, Fit grown, Budget* budget) {
  constexpr int kRounds = 3;  // time: none took more
  const auto meets_the_last = [&](const Fit& fit, std::size_t index) {
    return meet(directions(inquiry.observations, fit, index),
                directions(inquiry.observations, fit, fit.chosen.size() - 1));
  };
  for (int round = 0;
       round < kRounds && choose_anew(inquiry, material, &grown, meets_the_last, budget); ++round) {
  }
  return grown;
}

/// Effects are chosen anew once more at the end, at whatever joint: a law may look no better than
/// an effect for as long as another joint is off.
Fit without_half_truths(const Inquiry& inquiry, const Material& material, Fit grown,
                        Budget* budget) {
  const auto is_effect = [](const Fit& fit, std::size_t index) {
    return !fit.chosen[index].hypothesis.is_law();
  };
  choose_anew(inquiry, material, &grown, is_effect, budget);
  return grown;
}

}  // namespace

bool has_law(const Choice& choice) {
  return std::any_of(choice.findings.begin(), choice.findings.end(),
                     [](const Finding& each) { return each.chosen.hypothesis.is_law(); });
}

Choice choose_laws(const Inquiry& inquiry, const Fit& begun, First first, Budget* budget,
                   const TellStage& tell) {
  const Material material(inquiry.observations);
  std::vector<Fit> stages = {begun};
  while (stages.size() <= kMostLaws && !budget->is_spent()) {
    tell("composing laws");
    const bool is_law = first == First::law && stages.size() == 1;
    Fit next = is_law ? with_law(inquiry, material, begun).fit
                      : with_one(inquiry, material, stages.back());
    if (next.chosen.empty()) {
      break;
    }
    stages.push_back(revised(inquiry, material, std::move(next), budget));
    if (more_than_noise(inquiry.observations, stages.back().remainder).empty()) {
      break;
    }
  }
  if (stages.size() > 2) {
    stages.push_back(without_half_truths(inquiry, material, stages.back(), budget));
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
