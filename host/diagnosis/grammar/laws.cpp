#include "diagnosis/grammar/laws.hpp"

#include <algorithm>

#include "diagnosis/grammar/compose.hpp"
#include "diagnosis/select/grow.hpp"
#include "diagnosis/select/standards.hpp"

namespace flexcomp::diagnosis::grammar {
namespace {

constexpr std::size_t kMostLaws = 5;
constexpr int kLawSteps = 20;
constexpr std::size_t kTried = 3;  // composed laws that are fitted before the best is taken

/// What the search of laws needs of the observations, whatever is fitted.
struct Material {
  explicit Material(const Inquiry& inquiry)
      : rows(inquiry.observations), drivers(drivers_of(inquiry.observations, rows)) {
    for (const Hypothesis& each : inquiry.dictionary.hypotheses) {
      effects.insert(each.effect());
    }
  }

  Rows rows;
  std::vector<Driver> drivers;
  std::set<std::string> effects;
};

/// A fit with one law more that holds; nothing chosen where there is none.
Fit with_law(const Inquiry& inquiry, const Material& material, const Fit& before) {
  const Observations& observations = inquiry.observations;
  const std::vector<Seat> seats = seats_of(observations, material.rows, before);
  std::size_t looked_at = inquiry.dictionary.entries.size();
  const std::vector<Lead> leads = screen(seats, material.drivers, &looked_at);
  const std::vector<Composed> laws =
      compose(observations, material.rows, leads, material.effects, &looked_at);
  for (std::size_t i = 0; i < std::min(laws.size(), kTried); ++i) {
    Fit grown = fit_with(inquiry, before, chosen_of(observations, laws[i]), kLawSteps);
    const Evidence evidence = weigh(observations, before, grown, static_cast<double>(looked_at));
    if (holds(inquiry, evidence)) {
      return grown;
    }
  }
  return {};
}

/// A fit with one effect of the catalogue more that holds; nothing chosen where there is none.
Fit with_effect(const Inquiry& inquiry, const Fit& before) {
  const Fit grown = best_beside(inquiry, {before, seek(inquiry, before)}, kShortlist);
  return !grown.chosen.empty() && holds(inquiry, weigh_last(inquiry, before, grown)) ? grown
                                                                                     : Fit{};
}

/// The better of a law and an effect, by strong evidence for the law.
Fit better_of(const Observations& observations, Fit law, Fit effect) {
  if (law.chosen.empty() || effect.chosen.empty()) {
    return effect.chosen.empty() ? law : effect;
  }
  return bic_gain(observations, effect, law) > kStrongEvidence ? law : effect;
}

}  // namespace

bool is_law(const Hypothesis& hypothesis) { return hypothesis.law->written != nullptr; }

Choice choose_laws(const Inquiry& inquiry, const Fit& begun, const Tell& tell) {
  const Material material(inquiry);
  Fit grown = begun;
  for (std::size_t i = 0; i < kMostLaws; ++i) {
    Fit next = better_of(inquiry.observations, with_law(inquiry, material, grown),
                         with_effect(inquiry, grown));
    if (next.chosen.empty()) {
      break;
    }
    grown = std::move(next);
    tell(grown.chosen.size(), kMostFindings);
  }
  Choice choice = conclude(inquiry, {grown, seek(inquiry, grown)});
  const bool has_law =
      std::any_of(choice.findings.begin(), choice.findings.end(),
                  [](const Finding& each) { return is_law(each.chosen.hypothesis); });
  return has_law ? choice : Choice{};
}

}  // namespace flexcomp::diagnosis::grammar
