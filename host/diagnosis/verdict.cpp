#include "diagnosis/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "diagnosis/grammar/laws.hpp"
#include "diagnosis/jump.hpp"
#include "diagnosis/rest.hpp"
#include "diagnosis/select/standards.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr double kNearNoise = 1.05;  // times the noise: nothing that a rival could better

void find_groups(Diagnosis* diagnosis) {
  for (std::size_t i = 0; i < diagnosis->choice.findings.size(); ++i) {
    const Hypothesis& chosen = diagnosis->choice.findings[i].chosen.hypothesis;
    std::vector<Place> group = {{chosen.effect(), chosen.joint}};
    for (const Alternative& other : diagnosis->choice.findings[i].alternatives) {
      const Place place{other.effect, other.joint};
      const bool is_in = std::find(group.begin(), group.end(), place) != group.end();
      if (other.delta_bic < kSameEvidence && !is_in) {
        group.push_back(place);
      }
    }
    if (group.size() > 1) {
      diagnosis->indistinguishable.push_back(group);
    }
  }
}

void add_nearest(const std::vector<Chosen>& chosen, Diagnosis* diagnosis) {
  for (const Chosen& each : chosen) {
    diagnosis->nearest.push_back({each.hypothesis.effect(), each.hypothesis.joint});
  }
}

/// Does a form without physics, of no more numbers, account for more than findings do? Then what
/// they have in common with the mismatch is no proof of them. `left`: the sum of squares that it
/// leaves, of so many independent samples.
bool is_outdone(const Fit& findings, std::size_t numbers, double left, double samples) {
  return numbers <= findings.parameters() &&
         bic_gain(samples, findings.train_sum, left, 0) > kFarMoreEvidence;
}

bool is_outdone(const Observations& observations, const Fit& findings, const Jump& rival) {
  return is_outdone(findings, rival.numbers, rival.left,
                    independent_samples(observations, findings.remainder));
}

bool is_outdone(const Observations& observations, const Fit& findings, const Proposal& rival) {
  return !rival.terms.empty() && is_outdone(findings, rival.fit.parameters(), rival.fit.train_sum,
                                            independent_samples(observations, rival.fit.remainder));
}

/// Withdraws findings that a form without physics outdoes.
void withdraw_outdone(const Observations& observations, Diagnosis* diagnosis) {
  const Fit nothing = fit(observations, {}, 0);
  const Jump jump = jump_of_place(observations, nothing);
  if (is_outdone(observations, diagnosis->choice.fit, jump)) {
    withdraw(
        observations,
        fmt::format("a jump of the measured place at {:.4g} s accounts for more of it", jump.time),
        diagnosis);
    return;
  }
  Proposal rival = propose(observations, nothing);
  if (is_outdone(observations, diagnosis->choice.fit, rival)) {
    withdraw(observations, "a form that no known effect has accounts for more of it", diagnosis);
    diagnosis->proposal = std::move(rival.terms);
  }
}

std::string reason_of_nothing(const Choice& choice) {
  if (choice.mispredicts) {
    return "what fits the recordings does not predict what was held out";
  }
  return choice.withdrawn.empty() ? "no known effect accounts for it"
                                  : fmt::format("known effects account for {:.0f} % of it at most",
                                                100 * std::max(choice.explained, 0.0));
}

}  // namespace

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::no_mismatch:
      return "no_mismatch";
    case Verdict::explained:
      return "explained";
    case Verdict::partly_explained:
      return "partly_explained";
    case Verdict::unexplained:
      break;
  }
  return "unexplained";
}

bool is_open(const Diagnosis& diagnosis) {
  return diagnosis.verdict == Verdict::unexplained ||
         diagnosis.verdict == Verdict::partly_explained;
}

void withdraw(const Observations& observations, const std::string& reason, Diagnosis* diagnosis) {
  add_nearest(diagnosis->choice.fit.chosen, diagnosis);
  diagnosis->choice.findings.clear();
  diagnosis->choice.fit = fit(observations, {}, 0);
  diagnosis->indistinguishable.clear();
  diagnosis->verdict = Verdict::unexplained;
  diagnosis->reason = reason;
}

Diagnosis with_choice(const Observations& observations, Diagnosis diagnosis, Choice choice) {
  choice.ranking = std::move(diagnosis.choice.ranking);
  diagnosis.choice = std::move(choice);
  diagnosis.nearest.clear();
  diagnosis.indistinguishable.clear();
  diagnosis.proposal.clear();
  judge(observations, &diagnosis);
  return diagnosis;
}

void judge(const Observations& observations, Diagnosis* diagnosis) {
  find_groups(diagnosis);
  const Fit& found = diagnosis->choice.fit;
  diagnosis->cancellation = cancellation(observations, found);
  add_nearest(diagnosis->choice.withdrawn, diagnosis);
  const double after = largest_ratio(observations, found.remainder);
  const std::string more = more_than_noise(observations, found.remainder);
  const bool is_noise = more.empty();
  if (found.chosen.empty()) {
    diagnosis->verdict = is_noise ? Verdict::no_mismatch : Verdict::unexplained;
    diagnosis->reason = is_noise ? "" : reason_of_nothing(diagnosis->choice);
  } else if (found.chosen.size() > 1 && diagnosis->cancellation > kMostCancellation) {
    withdraw(observations,
             "only a sum of large effects that cancel each other comes near, which imitates what "
             "is not there",
             diagnosis);
  } else {
    diagnosis->verdict = is_noise ? Verdict::explained : Verdict::partly_explained;
    diagnosis->reason = more;
    // A law is such a form itself, with proof.
    if (found.chosen.size() > 1 && after > kNearNoise && !grammar::has_law(diagnosis->choice)) {
      withdraw_outdone(observations, diagnosis);
    }
  }
}

}  // namespace flexcomp::diagnosis
