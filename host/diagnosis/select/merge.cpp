#include "diagnosis/select/merge.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "diagnosis/select/grow.hpp"
#include "diagnosis/select/prune.hpp"
#include "diagnosis/select/standards.hpp"

namespace flexcomp::diagnosis {
namespace {

/// The selection of hypotheses, the one at an index new among them; nothing where that does not
/// stand. Others may fall, which stood for what it accounts for.
std::optional<Selection> if_it_stands(const Inquiry& inquiry, Fit fit, std::size_t index) {
  const Hypothesis added = fit.chosen[index].hypothesis;
  Selection selection = prune(inquiry, std::move(fit));
  return is_chosen(selection.fit.chosen, added) ? std::optional(std::move(selection))
                                                : std::nullopt;
}

/// The selection with one hypothesis in the place of two that are not far better than it; nothing
/// where no two are.
std::optional<Selection> merged(const Inquiry& inquiry, const Sought& sought,
                                const Selection& selection) {
  const std::size_t count = selection.findings.size();
  for (std::size_t i = 0; count <= kMany && i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      const Attempt others{fit_without(inquiry, selection.findings[j].without, i), sought};
      const Fit one = best_beside(inquiry, others, kShortlist);
      if (!one.chosen.empty() && is_as_good(inquiry, one, selection.fit) &&
          !is_confirmed(inquiry, one, selection.fit) &&
          holds(inquiry, weigh_last(inquiry, others.fit, one))) {
        Fit whole = fit(inquiry.observations, one.chosen, kLastSteps);
        if (auto next = if_it_stands(inquiry, std::move(whole), one.chosen.size() - 1)) {
          return next;
        }
      }
    }
  }
  return std::nullopt;
}

/// The largest of a hypothesis' parameters, in sizes that matter.
double change(const Chosen& chosen) {
  double most = 0;
  for (std::size_t i = 0; i < chosen.values.size(); ++i) {
    most = std::max(most, std::abs(chosen.values[i]) / chosen.hypothesis.parameters[i].step);
  }
  return most;
}

/// Evidence (in BIC) that two hypotheses must differ by to be told apart. Payload and link mass are
/// bodies that are simplified in different ways: between them more evidence is needed.
double same_evidence(const Chosen& one, const Finding& finding) {
  const bool are_bodies =
      one.hypothesis.traits().is_body && finding.chosen.hypothesis.traits().is_body;
  const double negligible = are_bodies ? kNegligible * finding.evidence.delta_bic : 0;
  return std::max(kSameEvidence, negligible);
}

bool is_unusual(const Hypothesis& hypothesis) {
  return hypothesis.is_law() || hypothesis.traits().is_of_few;
}

/// Is an alternative an effect that machines have more often, at the same joint, and does the
/// finding do hardly better?
bool is_more_usual(const Alternative& one, const Finding& finding) {
  const Chosen& other = finding.chosen;
  return is_unusual(other.hypothesis) && !is_unusual(one.chosen.hypothesis) &&
         one.joint == other.hypothesis.joint && one.chosen.values.size() <= other.values.size() &&
         one.delta_bic < std::max(kSameEvidence, kUnusual * finding.evidence.delta_bic);
}

/// Does one number of an alternative do nearly what the many of a finding do? A body has up to ten,
/// some of which fit what other errors leave.
bool is_far_plainer(const Alternative& one, const Finding& finding) {
  constexpr std::size_t kFewer = 3;
  return one.chosen.values.size() + kFewer <= finding.chosen.values.size() &&
         finding.chosen.hypothesis.traits().is_body &&
         one.delta_bic < kFarPlainer * finding.evidence.delta_bic;
}

/// Is an alternative plainer than the finding? Three cases:
/// - it has fewer parameters, and no evidence speaks for the finding;
/// - it has as many, acts on the whole machine instead of one joint (the payload, not the last
///   link's mass), and no strong evidence speaks for the finding;
/// - it has as many at the same joint, does the same in numbers, and changes less (the rotor half
///   as heavy again, not the link ten times as heavy), and is no rarer.
bool is_plainer(const Alternative& one, const Finding& finding) {
  const Chosen& other = finding.chosen;
  if (one.chosen.hypothesis.traits().is_curve_only) {
    return false;
  }
  const bool has_fewer = one.chosen.values.size() < other.values.size();
  const bool has_as_many = one.chosen.values.size() == other.values.size();
  const bool is_of_whole = has_as_many && one.delta_bic < same_evidence(one.chosen, finding) &&
                           one.joint == 0 && other.hypothesis.joint != 0;
  const bool is_rarer = is_unusual(one.chosen.hypothesis) && !is_unusual(other.hypothesis);
  const bool changes_less = has_as_many && !is_rarer && one.delta_bic < kIdentical &&
                            one.joint == other.hypothesis.joint &&
                            change(one.chosen) < change(other);
  return (has_fewer && one.delta_bic <= 0) || is_of_whole || changes_less;
}

/// Is an alternative the law of which the finding is a mere curve? At the same joint it must fit as
/// well; that it has more parameters, some of which do not show, says nothing against it.
bool is_the_law(const Alternative& one, const Finding& finding) {
  const Chosen& other = finding.chosen;
  const double more =
      static_cast<double>(one.chosen.values.size()) - static_cast<double>(other.values.size());
  return other.hypothesis.traits().is_curve_only && one.joint == other.hypothesis.joint &&
         one.delta_bic - more * std::log(finding.evidence.effective_samples) < kIndifferent;
}

/// Alternatives that would do nearly as well in the place of a finding, the best first.
std::vector<Alternative> alternatives_of(const Inquiry& inquiry, const Sought& sought,
                                         const Fit& whole, std::size_t index,
                                         const Finding& finding) {
  const Observations& observations = inquiry.observations;
  const Attempt others{finding.without, sought};
  const Eigen::MatrixXd shown = directions(observations, whole, index);
  const std::size_t most = whole.chosen.size() < kMany ? kShortlist : kShortShortlist;
  std::vector<Alternative> all;
  std::size_t looked_at = 0;
  for (const Candidate& candidate : propose(inquiry, others)) {
    const Hypothesis& other = candidate.chosen.hypothesis;
    if (looked_at == most) {
      break;
    }
    if (!meet(shown, directions(inquiry, others, candidate))) {
      continue;
    }
    ++looked_at;
    if (are_the_same(other, finding.chosen.hypothesis)) {
      continue;
    }
    const Fit tried = fit_with(inquiry, others.fit, candidate.chosen, kQuickSteps);
    const double gain = bic_gain(finding.evidence.effective_samples, others.fit.train_sum,
                                 tried.train_sum, other.numbers());
    if (gain > kStrongEvidence && can_be(inquiry, tried) &&
        meet(shown, directions(observations, tried, tried.chosen.size() - 1))) {
      all.push_back({other.effect(), other.joint, std::max(finding.evidence.delta_bic - gain, 0.0),
                     tried.chosen.back()});
    }
  }
  std::sort(all.begin(), all.end(),
            [](const Alternative& a, const Alternative& b) { return a.delta_bic < b.delta_bic; });
  return all;
}

/// The selection with a plainer hypothesis, or the law itself, in the place of a finding; nothing
/// where there is none. A finding may have been taken for an error that others account for by now.
std::optional<Selection> plainer(const Inquiry& inquiry, const Selection& selection) {
  for (std::size_t i = 0; i < selection.findings.size(); ++i) {
    const Finding& finding = selection.findings[i];
    for (const Alternative& other : finding.alternatives) {
      const bool is_usual = is_more_usual(other, finding) || is_far_plainer(other, finding);
      if (is_usual || is_plainer(other, finding) || is_the_law(other, finding)) {
        std::vector<Chosen> chosen = selection.fit.chosen;
        chosen[i] = other.chosen;
        Fit plain = fit(inquiry.observations, std::move(chosen), kLastSteps);
        if (is_usual || !is_confirmed(inquiry, plain, selection.fit)) {
          if (auto next = if_it_stands(inquiry, std::move(plain), i)) {
            return next;
          }
        }
      }
    }
  }
  return std::nullopt;
}

using Kinds = std::vector<std::pair<effects::LawPointer, int>>;  // laws, each at its joint

Kinds kinds_of(const Selection& selection) {
  Kinds kinds;
  for (const Chosen& each : selection.fit.chosen) {
    kinds.emplace_back(each.hypothesis.law, each.hypothesis.joint);
  }
  std::sort(kinds.begin(), kinds.end());
  return kinds;
}

}  // namespace

Selection simplify(const Inquiry& inquiry, const Sought& sought, Selection selection) {
  std::set<Kinds> seen;  // what takes each other's place in turn would never end
  while (true) {
    seen.insert(kinds_of(selection));
    std::optional<Selection> next = merged(inquiry, sought, selection);
    if (!next) {
      for (std::size_t i = 0; i < selection.findings.size(); ++i) {
        selection.findings[i].alternatives =
            alternatives_of(inquiry, sought, selection.fit, i, selection.findings[i]);
      }
      next = plainer(inquiry, selection);
    }
    if (!next || seen.count(kinds_of(*next)) > 0) {
      return selection;
    }
    selection = std::move(*next);
  }
}

}  // namespace flexcomp::diagnosis
