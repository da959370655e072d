#include "diagnosis/select/members.hpp"

#include <algorithm>
#include <map>

#include "diagnosis/families/without.hpp"
#include "diagnosis/select/standards.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Squares over the noise of a channel's samples.
struct Squares {
  double before = 0, after = 0, count = 0;
};

/// Least part of a channel's power beyond the noise that a fit accounts for, of what was fitted to
/// or held out; one where no channel shows a mismatch.
double explained_everywhere(const Observations& observations, const Fit& whole) {
  constexpr double kMostNoise = 2;  // of the noise's power: below it a channel shows no mismatch
  std::map<std::pair<Channel, bool>, Squares> parts;
  for (Eigen::Index i = 0; i < observations.size(); ++i) {
    const Channel channel = observations.samples[static_cast<std::size_t>(i)].channel;
    Squares& part = parts[{channel, i >= observations.train}];
    part.before += observations.residual[i] * observations.residual[i];
    part.after += whole.remainder[i] * whole.remainder[i];
    part.count += 1;
  }
  double least = 1;
  for (const auto& [place, part] : parts) {
    if (part.before > kMostNoise * part.count) {
      least = std::min(least, 1 - std::max(part.after - part.count, 0.0) / part.before);
    }
  }
  return least;
}

/// Weighs one choice of a fit of many, all others being there, to first order.
Finding judge_linearly(const Inquiry& inquiry, const Fit& whole, const Without& without,
                       std::size_t index) {
  const auto at = static_cast<std::ptrdiff_t>(index);
  Fit others = without(index);
  Fit last = whole;  // the same fit, its last hypothesis the one that is weighed
  std::rotate(last.chosen.begin() + at, last.chosen.begin() + at + 1, last.chosen.end());
  Evidence evidence = weigh_last(inquiry, others, last);
  return {whole.chosen[index], {}, std::move(evidence), std::move(others), {}};
}

/// On a small path errors of geometry, which are smooth along it, imitate whatever else is: only
/// what shows elsewhere stands there.
bool shows_on_small_path(const Observations& observations, const Evidence& evidence) {
  return evidence.group.first == simulation::tcp_position && !observations.spans_workspace();
}

/// The held-out error is asked of each, and no share of the mismatch: many have a small one.
bool stands_as_member(const Inquiry& inquiry, const Evidence& evidence) {
  return evidence.impossible.empty() && evidence.delta_bic > kStrongEvidence &&
         evidence.p_value < inquiry.false_discovery && evidence.confirmation > kConfirmed &&
         evidence.lowers_held_out && !shows_on_small_path(inquiry.observations, evidence);
}

}  // namespace

std::vector<Finding> members_that_stand(const Inquiry& inquiry, const Fit& whole) {
  std::vector<Finding> standing;
  if (whole.chosen.size() < kLeastMembers ||
      explained_everywhere(inquiry.observations, whole) < kLeastByFamilies) {
    return standing;
  }
  const Without without(inquiry.observations, whole);
  for (std::size_t i = 0; i < whole.chosen.size(); ++i) {
    Finding finding = judge_linearly(inquiry, whole, without, i);
    if (stands_as_member(inquiry, finding.evidence)) {
      finding.covariance = whole.covariance_of(i);
      standing.push_back(std::move(finding));
    }
  }
  if (standing.size() < kLeastMembers) {
    standing.clear();
  }
  std::sort(standing.begin(), standing.end(), [](const Finding& a, const Finding& b) {
    return a.evidence.delta_bic > b.evidence.delta_bic;
  });
  return standing;
}

}  // namespace flexcomp::diagnosis
