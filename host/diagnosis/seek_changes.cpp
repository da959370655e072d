#include "diagnosis/seek_changes.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "diagnosis/evaluator.hpp"
#include "diagnosis/find_spells.hpp"
#include "diagnosis/grammar/laws.hpp"
#include "diagnosis/select/standards.hpp"
#include "diagnosis/verdict.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr Eigen::Index kFewestToldRows = 200;  // of a recording: what is told in time
constexpr double kLeastByTurns = 0.3;          // of the squares beyond the noise, to be looked into
constexpr double kNearlyBest = 0.5;            // of the best gain, for spells to begin with
constexpr std::size_t kMostLeads = 3;          // spells to begin with
constexpr std::size_t kMostRivals = 30;        // that may act by those of a lead
constexpr int kTurnRounds = 3;                 // of a fit and its spells: the third changes little

/// The dictionary, and in it the place of what measures the TCP where it has none. On a small path
/// a turn and a shift of that imitate much, so that it is not sought; but a tracker whose tripod
/// was bumped shows on any. On a small path it only shifts.
Dictionary with_jump(const Inquiry& inquiry) {
  constexpr double kNoTurn = 1e-7;  // rad, a tolerance
  std::vector<Hypothesis> jumps;
  for (Hypothesis each : inquiry.dictionary.hypotheses) {
    if (each.traits().registers == effects::Registers::frame && each.starts.empty()) {
      each.starts = {{}};
      for (Parameter& parameter : each.parameters) {
        parameter.tolerance = parameter.unit == "rad" ? kNoTurn : parameter.tolerance;
      }
      jumps.push_back(std::move(each));
    }
  }
  const auto untold = [](std::size_t, std::size_t) {};
  const Observations& observations = inquiry.observations;
  return inquiry.dictionary.with(
      Dictionary(observations, std::move(jumps), inquiry.given.machine, untold), observations);
}

/// A fit with a hypothesis of a dictionary more that comes and goes: its moments by rows, its
/// values by these.
Fit fit_by_turns(const Inquiry& inquiry, const Dictionary& dictionary, const Fit& begun,
                 const Spelled& spelled) {
  const Observations& observations = inquiry.observations;
  const Entry& entry = dictionary.entries[spelled.entry];
  Hypothesis hypothesis = dictionary.hypotheses[entry.hypothesis];
  hypothesis.when = std::make_shared<const Spells>(spelled.spells);
  Values start(hypothesis.linear, 0.0);
  start.insert(start.end(), entry.start.begin(), entry.start.end());
  Chosen chosen{std::move(hypothesis), std::move(start)};
  Fit grown;
  for (int round = 0; round < kTurnRounds; ++round) {
    grown = fit_with(inquiry, begun, chosen, kSteps);
    const Fit without = fit(observations, steady(grown.chosen), 0);
    const Fit always = fit(observations, acting(grown.chosen), 0);
    Spells spells =
        spells_of(observations, without.remainder, without.remainder - always.remainder);
    if (spells.acts == grown.chosen.back().hypothesis.when->acts) {
      break;
    }
    chosen = grown.chosen.back();
    chosen.hypothesis.when = std::make_shared<const Spells>(std::move(spells));
  }
  return grown;
}

/// Those to begin with: of so many moments each the best, the fewest moments first; and the best of
/// all.
std::vector<const Spelled*> leads_of(const Observations& observations, const Fit& beside,
                                     const std::vector<Spelled>& all) {
  const double beyond = clipped(beside.remainder.head(observations.train)).squaredNorm() -
                        static_cast<double>(observations.train);
  std::map<std::size_t, const Spelled*> by_moments;
  for (const Spelled& each : all) {
    if (each.gain > std::max(kNearlyBest * all.front().gain, kLeastByTurns * beyond)) {
      by_moments.emplace(each.spells.changes(), &each);
    }
  }
  std::vector<const Spelled*> leads;
  for (const auto& [moments, lead] : by_moments) {
    if (leads.size() + 1 < kMostLeads || lead == &all.front()) {
      leads.push_back(lead);
    }
  }
  return leads;
}

/// What is chosen if effects may act at the times of one only, beside all others; no findings
/// unless one of them does. Several that come and go together imitate much. `all`: of `possible`.
Choice chosen_by_turns(const Inquiry& inquiry, const Dictionary& possible, const Fit& begun,
                       const std::vector<Spelled>& all, const Spelled& lead,
                       const TellStage& tell) {
  const Observations& observations = inquiry.observations;
  const Fit grown = fit_by_turns(inquiry, possible, begun, lead);
  std::vector<std::size_t> rivals;
  for (const Spelled& each : all) {
    if (rivals.size() < kMostRivals) {
      rivals.push_back(each.entry);
    }
  }
  const Dictionary both = inquiry.dictionary.with(
      possible.by_turns(rivals, grown.chosen.back().hypothesis.when, observations), observations);
  const Inquiry changed{observations, both, inquiry.false_discovery, inquiry.given};
  Choice choice = conclude(changed, grow(changed, {begun, seek(changed, begun)}, tell));
  return steady(choice.fit.chosen).size() + 1 == choice.fit.chosen.size() ? choice : Choice{};
}

/// The diagnosis by what is chosen, if no more than noise is left; else nothing.
std::optional<Diagnosis> explained_by(const Observations& observations, const Diagnosis& before,
                                      Choice choice) {
  if (choice.findings.empty()) {
    return std::nullopt;
  }
  Diagnosis changed = with_choice(observations, before, std::move(choice));
  return is_open(changed) ? std::nullopt : std::make_optional(std::move(changed));
}

/// The diagnosis with what comes and goes beside a fit, if that explains all.
std::optional<Diagnosis> explained_beside(const Inquiry& inquiry, const Dictionary& possible,
                                          const Fit& begun, const Diagnosis& before,
                                          const TellStage& tell) {
  const Observations& observations = inquiry.observations;
  const std::vector<Spelled> all = find_spells(observations, possible, begun);
  for (const Spelled* lead : leads_of(observations, begun, all)) {
    Choice choice = chosen_by_turns(inquiry, possible, begun, all, *lead, tell);
    if (std::optional<Diagnosis> found = explained_by(observations, before, std::move(choice))) {
      return found;
    }
  }
  return std::nullopt;
}

/// The same, and once more beside what of it always acts: until that was known, what comes and goes
/// had to say some of it.
std::optional<Diagnosis> explained_twice(const Inquiry& inquiry, const Dictionary& possible,
                                         const Fit& begun, const Diagnosis& before,
                                         const TellStage& tell) {
  std::optional<Diagnosis> first = explained_beside(inquiry, possible, begun, before, tell);
  if (!first || steady(first->choice.fit.chosen).size() == begun.chosen.size()) {
    return first;
  }
  const Fit known = fit(inquiry.observations, steady(first->choice.fit.chosen), kSteps);
  std::optional<Diagnosis> second = explained_beside(inquiry, possible, known, before, tell);
  const bool is_better =
      second && criterion(inquiry.observations, second->choice.fit) <
                    criterion(inquiry.observations, first->choice.fit) + kIndifferent;
  return is_better ? second : first;
}

}  // namespace

void seek_changes(const Inquiry& inquiry, const TellStage& tell, Diagnosis* diagnosis) {
  const Observations& observations = inquiry.observations;
  if (!is_open(*diagnosis) || observations.is_static ||
      observations.fewest_rows() < kFewestToldRows) {
    return;
  }
  tell("seeking what changed meanwhile");
  const Dictionary possible = with_jump(inquiry);
  const Fit& found = diagnosis->choice.fit;
  std::optional<Diagnosis> changed;
  if (!grammar::has_law(diagnosis->choice)) {  // a law beside what comes and goes imitates much
    changed = explained_twice(inquiry, possible, found, *diagnosis, tell);
  }
  if (!changed && found.chosen.size() > inquiry.given.chosen.size()) {
    changed = explained_twice(inquiry, possible, inquiry.given, *diagnosis, tell);
  }
  if (changed) {
    *diagnosis = std::move(*changed);
  }
}

}  // namespace flexcomp::diagnosis
