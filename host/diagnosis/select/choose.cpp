#include "diagnosis/select/choose.hpp"

#include <algorithm>

#include "diagnosis/select/merge.hpp"
#include "diagnosis/select/prune.hpp"
#include "diagnosis/select/standards.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Is so little left that two effects could not share it better?
bool is_settled(const Inquiry& inquiry, const Fit& fit) {
  return fit.parameters() <= inquiry.given.parameters() + 2 &&
         largest_ratio(inquiry.observations, fit.remainder) < kSettled;
}

/// A fit that grows from a pair of hypotheses beside others may end better than one that grows from
/// a single. In a load test, whose fits are quick, the best pair grows even if it is not better
/// yet.
Attempt best_of_pairs(const Inquiry& inquiry, const Fit& before, Attempt best,
                      const TellStage& tell) {
  tell("trying pairs of causes");
  const std::vector<Fit> pairs = propose_pairs(inquiry, before);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (is_better(inquiry, pairs[i], best.fit) || (inquiry.observations.is_static && i == 0)) {
      Attempt rival = grow(inquiry, {pairs[i], seek(inquiry, pairs[i])}, tell);
      best = better_of(inquiry, std::move(best), std::move(rival));
    }
  }
  return best;
}

/// Pairs beside what is given, and then beside the first finding as well: where it is far larger,
/// it hides which two of the others belong together.
Attempt with_pairs(const Inquiry& inquiry, Attempt best, const TellStage& tell) {
  const std::size_t first = inquiry.given.chosen.size();
  best = best_of_pairs(inquiry, inquiry.given, std::move(best), tell);
  if (best.fit.chosen.size() < first + 2) {
    return best;
  }
  const Fit before = fit_with(inquiry, inquiry.given, best.fit.chosen[first], kSteps);
  return best_of_pairs(inquiry, before, std::move(best), tell);
}

void strongest_first(std::vector<Finding>* findings) {
  std::sort(findings->begin(), findings->end(), [](const Finding& a, const Finding& b) {
    return a.evidence.delta_bic > b.evidence.delta_bic;
  });
}

/// Fits the findings in their order, and gives each its part of the covariance.
Fit fit_of(const Observations& observations, std::vector<Finding>* findings) {
  std::vector<Chosen> chosen;
  for (const Finding& finding : *findings) {
    chosen.push_back(finding.chosen);
  }
  Fit whole = fit(observations, std::move(chosen), 0);
  for (std::size_t i = 0; i < findings->size(); ++i) {
    (*findings)[i].chosen = whole.chosen[i];
    (*findings)[i].covariance = whole.covariance_of(i);
  }
  return whole;
}

/// Is a finding one number, whose interval holds nothing? Several numbers together are less sure to
/// be so: their covariance has many more.
bool may_be_nothing(const Finding& finding) {
  return finding.chosen.hypothesis.linear == 1 &&
         !are_told_from_nothing(finding.chosen, finding.covariance);
}

/// The weakest finding that may be nothing; null where there is none.
const Finding* untold(const std::vector<Finding>& findings) {
  const auto weakest = std::find_if(findings.rbegin(), findings.rend(), may_be_nothing);
  return weakest == findings.rend() ? nullptr : &*weakest;
}

Choice concluded(const Inquiry& inquiry, const std::vector<Chosen>& chosen, const Sought& sought) {
  const Observations& observations = inquiry.observations;
  Proved proved = prove(inquiry, prune(inquiry, fit(observations, chosen, kLastSteps)));
  Choice choice;
  choice.findings = simplify(inquiry, sought, std::move(proved.selection)).findings;
  strongest_first(&choice.findings);
  choice.fit = fit_of(observations, &choice.findings);
  choice.withdrawn = std::move(proved.withdrawn);
  choice.explained = proved.explained;
  choice.mispredicts = proved.mispredicts;
  return choice;
}

}  // namespace

Choice conclude(const Inquiry& inquiry, const Attempt& grown) {
  std::vector<Chosen> chosen = grown.fit.chosen;
  std::vector<Chosen> left_out;
  while (true) {
    Choice choice = concluded(inquiry, chosen, grown.sought);
    const Finding* const weakest = untold(choice.findings);
    if (weakest == nullptr) {
      choice.withdrawn.insert(choice.withdrawn.end(), left_out.begin(), left_out.end());
      return choice;
    }
    left_out.push_back(weakest->chosen);
    chosen.clear();
    for (const Finding& finding : choice.findings) {
      if (&finding != weakest) {
        chosen.push_back(finding.chosen);
      }
    }
  }
}

Choice choose(const Inquiry& inquiry, const TellStage& tell) {
  const bool is_fresh = inquiry.given.chosen.empty();
  Attempt best{inquiry.given, is_fresh ? nullptr : seek(inquiry, inquiry.given)};
  Choice choice;
  choice.ranking = rank(propose(inquiry, best));
  best = grow(inquiry, std::move(best), tell);
  if (!is_settled(inquiry, best.fit)) {
    best = with_pairs(inquiry, std::move(best), tell);
  }
  if (best.is_of_families) {
    choice.begun = best.fit;
  }
  Choice last = conclude(inquiry, best);
  last.ranking = std::move(choice.ranking);
  last.begun = std::move(choice.begun);
  return last;
}

}  // namespace flexcomp::diagnosis
