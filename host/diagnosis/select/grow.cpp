#include "diagnosis/select/grow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "diagnosis/families/elimination.hpp"
#include "diagnosis/select/standards.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Numbers of findings by the place where they show.
using Places = std::map<Group, int>;

int most_in_place(const Observations& observations) {
  return observations.is_static ? kMostInLoadTest : kMostInGroup;
}

/// Adds the best hypothesis that holds; false where none does. Where the best one fails on what was
/// held out, or cannot be, the next best is tried.
bool add_one(const Inquiry& inquiry, Places* found_in, Attempt* current) {
  const std::size_t most = current->fit.chosen.size() < kMany ? kShortlist : kShortShortlist;
  for (const Fit& tried : tried_beside(inquiry, *current, most)) {
    Fit grown = fit(inquiry.observations, tried.chosen, kSteps, &inquiry.dictionary);
    const Evidence evidence = weigh_last(inquiry, current->fit, grown);
    if (holds(inquiry, evidence)) {
      if (++(*found_in)[evidence.group] > most_in_place(inquiry.observations)) {
        return false;
      }
      current->fit = std::move(grown);
      return true;
    }
    const bool is_possible = evidence.impossible.empty();
    if (is_possible &&
        (evidence.confirmation > kConfirmed || evidence.delta_bic < kStrongEvidence)) {
      return false;
    }
  }
  return false;
}

/// Replaces the earliest choice for which there is a better one, among those that show where the
/// last one does.
Fit revised(const Inquiry& inquiry, const Attempt& current) {
  const Observations& observations = inquiry.observations;
  const Fit& fit = current.fit;
  for (std::size_t i = 0; i + 1 < fit.chosen.size(); ++i) {
    if (!meet(directions(observations, fit, i),
              directions(observations, fit, fit.chosen.size() - 1))) {
      continue;
    }
    const Attempt others{fit_without(inquiry, fit, i), current.sought};
    Fit replaced = best_beside(inquiry, others, kShortlist / 2);
    if (replaced.chosen.empty()) {
      continue;
    }
    const double fall = criterion(observations, fit) - criterion(observations, replaced);
    const bool is_better = replaced.train_sum < fit.train_sum && fall > kStrongEvidence;
    const bool is_simpler = replaced.parameters() < fit.parameters() && fall > 0;
    if ((is_better || is_simpler) && holds(inquiry, weigh_last(inquiry, others.fit, replaced))) {
      return replaced;
    }
  }
  return fit;
}

/// Do all of a machine's numbers that act in proportion together account for more, of what many
/// findings leave, than another finding could? Single findings would come to no end then.
bool is_of_families(const Inquiry& inquiry, const Fit& fit) {
  if (inquiry.observations.is_static || fit.chosen.size() < kMany) {
    return false;
  }
  Elimination families(inquiry.observations, fit, inquiry.dictionary.hypotheses,
                       inquiry.dictionary);
  return families.least_error() < kLeftByFamilies * fit.train_sum;
}

}  // namespace

std::vector<Fit> tried_beside(const Inquiry& inquiry, const Attempt& before, std::size_t most) {
  std::vector<Fit> all;
  std::size_t looked_at = 0;
  for (const Candidate& candidate : propose(inquiry, before)) {
    if (looked_at++ == kLongShortlist * most || all.size() == most) {
      break;
    }
    Fit tried = fit_with(inquiry, before.fit, candidate.chosen, kQuickSteps);
    if (can_be(inquiry, tried)) {
      all.push_back(std::move(tried));
    }
  }
  std::stable_sort(all.begin(), all.end(), [&](const Fit& a, const Fit& b) {
    return criterion(inquiry.observations, a) < criterion(inquiry.observations, b);
  });
  return all;
}

Fit best_beside(const Inquiry& inquiry, const Attempt& before, std::size_t most) {
  const std::vector<Fit> tried = tried_beside(inquiry, before, most);
  return tried.empty()
             ? Fit{}
             : fit(inquiry.observations, tried.front().chosen, kSteps, &inquiry.dictionary);
}

Attempt grow(const Inquiry& inquiry, Attempt attempt, const TellStage& tell) {
  Places found_in;
  while (attempt.fit.chosen.size() < kMostFindings && add_one(inquiry, &found_in, &attempt)) {
    tell(fmt::format("choosing causes, {} so far", attempt.fit.chosen.size()));
    attempt.fit = revised(inquiry, attempt);
    attempt.sought = seek(inquiry, attempt.fit);
    attempt.is_of_families = is_of_families(inquiry, attempt.fit);
    if (attempt.is_of_families) {
      break;
    }
  }
  return attempt;
}

}  // namespace flexcomp::diagnosis
