#include "diagnosis/select/members.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "diagnosis/families/without.hpp"
#include "diagnosis/select/standards.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Squares of a channel's samples, over the noise of the measurement alone.
struct ChannelSquares {
  double before = 0, after = 0, count = 0;
};

/// Share of the power beyond the noise that a fit accounts for, in the channel and the part (fitted
/// to, or held out) where it is least. One where no channel shows a mismatch.
double explained_everywhere(const Observations& observations, const Fit& whole) {
  constexpr double kMostNoise = 2;  // of the noise's power: below it a channel shows no mismatch
  std::map<std::pair<Channel, bool>, ChannelSquares> parts;
  for (Eigen::Index i = 0; i < observations.size(); ++i) {
    const Channel channel = observations.samples[static_cast<std::size_t>(i)].channel;
    ChannelSquares& part = parts[{channel, i >= observations.train}];
    part.before += std::pow(observations.over_floor(i, observations.residual[i]), 2);
    part.after += std::pow(observations.over_floor(i, whole.remainder[i]), 2);
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

/// Weighs one choice of a large fit to first order, beside all but those in `together`, which go
/// with it. `together`: ascending; holds `index`.
Finding judge_linearly(const Inquiry& inquiry, const Fit& whole, const Without& without,
                       std::size_t index, const std::vector<std::size_t>& together) {
  const auto at = static_cast<std::ptrdiff_t>(index);
  Fit others = without(together);
  Fit last = whole;  // the same fit, its last hypothesis the one that is weighed
  std::rotate(last.chosen.begin() + at, last.chosen.begin() + at + 1, last.chosen.end());
  Evidence evidence = weigh_last(inquiry, others, last);
  return {whole.chosen[index],
          whole.covariance_of(index),
          std::move(evidence),
          std::move(others),
          {},
          {},
          {}};
}

/// Does an effect show at the TCP alone, on a small path? Errors of geometry are smooth along it,
/// and imitate any other effect there: nothing stands by it.
bool shows_on_small_path(const Observations& observations, const Evidence& evidence) {
  return evidence.group.first == simulation::tcp_position && !observations.spans_workspace();
}

/// Does a member stand by its evidence? Each must lower the held-out error. None must explain a
/// share of the mismatch, since each of many has a small one.
bool stands_as_member(const Inquiry& inquiry, const Evidence& evidence) {
  return evidence.impossible.empty() && evidence.delta_bic > kStrongEvidence &&
         evidence.p_value < inquiry.false_discovery && evidence.confirmation > kConfirmed &&
         evidence.lowers_held_out && !shows_on_small_path(inquiry.observations, evidence);
}

/// Is a number known to differ from zero, beside all others and those that were left out for them?
/// Otherwise the error that it takes away may be another's. A number that is in no family was found
/// by itself, and counts as told apart.
bool is_told_apart(const Fit& whole, std::size_t index) {
  const effects::Traits& traits = whole.chosen[index].hypothesis.traits();
  return !(traits.is_in_family || traits.joins_family) ||
         are_told_from_nothing(whole.chosen[index], whole.covariance_of(index));
}

/// Members that stand each beside all others.
std::vector<Finding> standing_alone(const Inquiry& inquiry, const Fit& whole,
                                    const Without& without) {
  std::vector<Finding> standing;
  for (std::size_t i = 0; i < whole.chosen.size(); ++i) {
    if (whole.chosen[i].hypothesis.is_regression || !is_told_apart(whole, i)) {
      continue;
    }
    Finding finding = judge_linearly(inquiry, whole, without, i, {i});
    if (stands_as_member(inquiry, finding.evidence)) {
      standing.push_back(std::move(finding));
    }
  }
  return standing;
}

/// Forms of friction that a fit has at each joint.
std::map<int, std::vector<std::size_t>> friction_by_joint(const Fit& whole) {
  std::map<int, std::vector<std::size_t>> all;
  for (std::size_t i = 0; i < whole.chosen.size(); ++i) {
    const Hypothesis& hypothesis = whole.chosen[i].hypothesis;
    if (hypothesis.traits().is_friction) {
      all[hypothesis.joint].push_back(i);
    }
  }
  return all;
}

bool has_friction_at(const std::vector<Finding>& findings, int joint) {
  return std::any_of(findings.begin(), findings.end(), [&](const Finding& each) {
    const Hypothesis& hypothesis = each.chosen.hypothesis;
    return hypothesis.joint == joint && hypothesis.traits().is_friction;
  });
}

/// The one of several choices that is the most standard deviations from zero.
std::size_t surest_of(const Fit& whole, const std::vector<std::size_t>& indices) {
  const auto deviations = [&](std::size_t index) {
    const double variance = whole.covariance_of(index)(0, 0);
    return std::abs(whole.chosen[index].values.front()) / std::sqrt(std::max(variance, 1e-300));
  };
  return *std::max_element(indices.begin(), indices.end(), [&](std::size_t a, std::size_t b) {
    return deviations(a) < deviations(b);
  });
}

/// Adds the friction of joints whose forms of friction stand together, but none beside the others:
/// in a small range of speeds they share what they explain. The surest form becomes the finding, as
/// uncertain as it is beside the others, if it is told from nothing.
void add_friction_as_whole(const Inquiry& inquiry, const Fit& whole, const Without& without,
                           std::vector<Finding>* standing) {
  for (const auto& [joint, forms] : friction_by_joint(whole)) {
    if (forms.size() < 2 || has_friction_at(*standing, joint)) {
      continue;
    }
    const std::size_t surest = surest_of(whole, forms);
    if (!is_told_apart(whole, surest)) {
      continue;
    }
    Finding finding = judge_linearly(inquiry, whole, without, surest, forms);
    if (stands_as_member(inquiry, finding.evidence)) {
      standing->push_back(std::move(finding));
    }
  }
}

/// Adds the gains that are told from one, if all of them together stand: without one of them the
/// others, and all masses, make up for it.
void add_gains_as_whole(const Inquiry& inquiry, const Fit& whole, const Without& without,
                        std::vector<Finding>* standing) {
  std::vector<std::size_t> gains;
  for (std::size_t i = 0; i < whole.chosen.size(); ++i) {
    if (whole.chosen[i].hypothesis.traits().is_gain) {
      gains.push_back(i);
    }
  }
  for (const std::size_t gain : gains) {
    const Hypothesis& own = whole.chosen[gain].hypothesis;
    const bool is_in = std::any_of(standing->begin(), standing->end(), [&](const Finding& each) {
      return are_the_same(each.chosen.hypothesis, own);
    });
    if (is_in || !is_told_apart(whole, gain)) {
      continue;
    }
    Finding finding = judge_linearly(inquiry, whole, without, gain, gains);
    if (stands_as_member(inquiry, finding.evidence)) {
      standing->push_back(std::move(finding));
    }
  }
}

}  // namespace

std::vector<Finding> members_that_stand(const Inquiry& inquiry, const Fit& whole) {
  if (whole.chosen.size() < kLeastMembers ||
      explained_everywhere(inquiry.observations, whole) < kLeastByFamilies) {
    return {};
  }
  const Without without(inquiry.observations, whole);
  std::vector<Finding> standing = standing_alone(inquiry, whole, without);
  add_friction_as_whole(inquiry, whole, without, &standing);
  add_gains_as_whole(inquiry, whole, without, &standing);
  if (standing.size() < kLeastMembers) {
    return {};
  }
  std::sort(standing.begin(), standing.end(), [](const Finding& a, const Finding& b) {
    return a.evidence.delta_bic > b.evidence.delta_bic;
  });
  return standing;
}

}  // namespace flexcomp::diagnosis
