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

/// A fit with one effect of the catalogue more that holds; nothing chosen where there is none.
Fit with_effect(const Inquiry& inquiry, const Attempt& before) {
  const Fit grown = best_beside(inquiry, before, kShortlist);
  return !grown.chosen.empty() && holds(inquiry, weigh_last(inquiry, before.fit, grown)) ? grown
                                                                                         : Fit{};
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

/// Are the same laws chosen at the same places with the same values?
bool are_alike(const std::vector<Chosen>& one, const std::vector<Chosen>& other) {
  return std::equal(
      one.begin(), one.end(), other.begin(), other.end(), [](const Chosen& a, const Chosen& b) {
        return a.hypothesis.law == b.hypothesis.law && a.hypothesis.joint == b.hypothesis.joint &&
               a.hypothesis.when == b.hypothesis.when && a.values == b.values;
      });
}

/// What was found beside a fit, or what `find()` finds now.
template <typename Found, typename Find>
const Found& remembered(const Fit& before, Find find,
                        std::vector<std::pair<std::vector<Chosen>, Found>>* memory) {
  const auto known = std::find_if(memory->begin(), memory->end(), [&](const auto& each) {
    return are_alike(each.first, before.chosen);
  });
  if (known != memory->end()) {
    return known->second;
  }
  memory->emplace_back(before.chosen, find());
  return memory->back().second;
}

}  // namespace

bool has_law(const Choice& choice) {
  return std::any_of(choice.findings.begin(), choice.findings.end(),
                     [](const Finding& each) { return each.chosen.hypothesis.is_law(); });
}

LawSearch::LawSearch(const Inquiry& inquiry, Budget* budget, TellStage tell)
    : inquiry_(inquiry), budget_(budget), tell_(std::move(tell)), material_(inquiry.observations) {}

const LawSearch::WithLaw& LawSearch::with_law(const Fit& before) {
  return remembered(
      before, [&] { return new_law(before); }, &laws_);
}

LawSearch::WithLaw LawSearch::new_law(const Fit& before) const {
  const Observations& observations = inquiry_.observations;
  const std::vector<Seat> seats = seats_of(observations, material_.rows, before);
  std::size_t looked_at = inquiry_.dictionary.entries.size();
  const std::vector<Lead> leads = screen(material_, seats, &looked_at);
  std::vector<Composed> laws = compose(material_, leads, effects_of(inquiry_), &looked_at);
  WithLaw best;
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const Composed law = laws[i];
    Fit grown = fit_with(inquiry_, before, chosen_of(observations, law), kSteps);
    const Evidence evidence = weigh(observations, before, grown, static_cast<double>(looked_at));
    if (!holds(inquiry_, evidence) || evidence.share <= kLeastLawShare) {
      // A constant may be of the one recording that was fitted to.
      if (law.form.has_constant && evidence.confirmation < kConfirmed) {
        laws.insert(laws.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                    without_constant(material_, law));
      }
    } else if (best.fit.chosen.empty() ||
               bic_gain(observations, best.fit, grown) > kStrongEvidence) {
      best = {std::move(grown), constant_of(material_, law)};
    }
  }
  return best;
}

/// A fit with the effect that the law's constant or factor is by itself, at the joint where it does
/// most, if that is most of what the law does, counted by how many times less is left: the law of
/// what is left is sought beside it. Else nothing chosen.
Fit LawSearch::with_constant(const Attempt& before, const WithLaw& law) const {
  constexpr double kMost = 0.5;
  Fit best;
  for (const Candidate& each : propose(inquiry_, before)) {
    if (each.chosen.hypothesis.effect() == law.constant) {
      Fit grown = fit_with(inquiry_, before.fit, each.chosen, kSteps);
      if (best.chosen.empty() || grown.train_sum < best.train_sum) {
        best = std::move(grown);
      }
    }
  }
  const bool is_most =
      !best.chosen.empty() && std::log(before.fit.train_sum / best.train_sum) >
                                  kMost * std::log(before.fit.train_sum / law.fit.train_sum);
  return is_most && holds(inquiry_, weigh_last(inquiry_, before.fit, best)) ? best : Fit{};
}

const Fit& LawSearch::with_one(const Fit& before) {
  return remembered(
      before, [&] { return new_one(before); }, &ones_);
}

Fit LawSearch::new_one(const Fit& before) {
  const Attempt attempt{before, seek(inquiry_, before)};
  const WithLaw& law = with_law(before);
  Fit best = better_of(inquiry_.observations, before, law.fit, with_effect(inquiry_, attempt));
  const bool is_law = !best.chosen.empty() && best.chosen.back().hypothesis.is_law();
  Fit constant = is_law && !law.constant.empty() ? with_constant(attempt, law) : Fit{};
  return constant.chosen.empty() ? best : constant;
}

/// A choice anew in the place of one of a fit, if it does better; else nothing chosen.
Fit LawSearch::chosen_anew(const Fit& grown, std::size_t index) {
  const Observations& observations = inquiry_.observations;
  Fit again = with_one(fit_without(inquiry_, grown, index));
  const bool is_simpler = again.parameters() < grown.parameters();
  const bool is_better = !again.chosen.empty() &&
                         bic_gain(observations, grown, again) > (is_simpler ? 0 : kStrongEvidence);
  return is_better ? again : Fit{};
}

/// Chooses anew, once, each that `is_due` of what was chosen before the last, beside all others.
/// What comes anew is the last then. Returns whether something did.
bool LawSearch::choose_anew(Fit* grown, const IsDue& is_due) {
  const std::size_t count = grown->chosen.size();
  bool has_changed = false;
  for (std::size_t i = inquiry_.given.chosen.size(), at = i; i + 1 < count && !budget_->is_spent();
       ++i) {
    Fit again = is_due(*grown, at) ? chosen_anew(*grown, at) : Fit{};
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
Fit LawSearch::revised(Fit grown) {
  constexpr int kRounds = 3;  // time: none took more
  const auto meets_the_last = [&](const Fit& fit, std::size_t index) {
    return meet(directions(inquiry_.observations, fit, index),
                directions(inquiry_.observations, fit, fit.chosen.size() - 1));
  };
  for (int round = 0; round < kRounds && choose_anew(&grown, meets_the_last); ++round) {
  }
  return grown;
}

/// Effects are chosen anew once more at the end, at whatever joint: a law may look no better than
/// an effect for as long as another joint is off.
Fit LawSearch::without_half_truths(Fit grown) {
  const auto is_effect = [](const Fit& fit, std::size_t index) {
    return !fit.chosen[index].hypothesis.is_law();
  };
  choose_anew(&grown, is_effect);
  return grown;
}

Choice LawSearch::choose(const Fit& begun, First first) {
  std::vector<Fit> stages = {begun};
  while (stages.size() <= kMostLaws && !budget_->is_spent()) {
    tell_("composing laws");
    const bool is_law = first == First::law && stages.size() == 1;
    Fit next = is_law ? with_law(begun).fit : with_one(stages.back());
    if (next.chosen.empty()) {
      break;
    }
    stages.push_back(revised(std::move(next)));
    if (more_than_noise(inquiry_.observations, stages.back().remainder).empty()) {
      break;
    }
  }
  if (stages.size() > 2) {
    stages.push_back(without_half_truths(stages.back()));
  }
  // What came last may take away what the law before it stood on.
  for (; stages.size() > 1; stages.pop_back()) {
    Choice choice = conclude(inquiry_, {stages.back(), seek(inquiry_, stages.back())});
    if (has_law(choice)) {
      return choice;
    }
  }
  return {};
}

}  // namespace flexcomp::diagnosis::grammar
