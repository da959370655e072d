#include "diagnosis/trial.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "diagnosis/output/words.hpp"
#include "diagnosis/select/standards.hpp"

namespace flexcomp::diagnosis {
namespace {

bool is_found(const Choice& choice, const Hypothesis& hypothesis) {
  return std::any_of(choice.findings.begin(), choice.findings.end(), [&](const Finding& each) {
    return are_the_same(each.chosen.hypothesis, hypothesis);
  });
}

/// The standard that the evidence for a law by itself does not meet; empty where it meets all.
std::string why_not(const Inquiry& inquiry, const Evidence& evidence) {
  if (!evidence.impossible.empty()) {
    return evidence.impossible;
  }
  if (!(evidence.delta_bic > kStrongEvidence)) {
    return fmt::format("the evidence is too weak: BIC falls by {:.1f}, and {:g} is strong",
                       evidence.delta_bic, kStrongEvidence);
  }
  if (!(evidence.p_value < inquiry.false_discovery)) {
    return fmt::format("chance does as well, with a probability of {:.2g}", evidence.p_value);
  }
  if (!(evidence.confirmation > kConfirmed) || !evidence.lowers_held_out) {
    return "what was held out does not confirm it";
  }
  if (!(evidence.strength > kLeastStrength)) {
    return fmt::format("it does too little: {:.2g} times the noise where it shows most",
                       evidence.strength);
  }
  const double least = evidence.left > kFarFromNoise ? kLeastExplained : kExplainedNearNoise;
  if (!(evidence.explained >= least)) {
    return fmt::format(
        "it accounts for {:.0f} % of the mismatch where it shows, and {:.0f} % is asked "
        "for",
        100 * std::max(evidence.explained, 0.0), 100 * least);
  }
  return holds(inquiry, evidence) ? "" : "it does not stand out of what else is left";
}

std::string findings_in_words(const Choice& choice) {
  constexpr std::size_t kFew = 3;  // that a sentence bears
  std::string text;
  for (std::size_t i = 0; i < std::min(choice.findings.size(), kFew); ++i) {
    const Hypothesis& found = choice.findings[i].chosen.hypothesis;
    text += fmt::format("{}{}", i == 0 ? "" : ", ", place_in_words(found.effect(), found.joint));
  }
  return text + (choice.findings.size() > kFew ? " and more" : "");
}

/// Why a law that holds by itself is not among the findings.
std::string why_others(const Inquiry& inquiry, const Choice& choice, const Chosen& chosen) {
  if (choice.findings.empty()) {
    return "it does not stand beside what else the recordings show";
  }
  const Fit beside = fit_with(inquiry, choice.fit, chosen, kSteps);
  const double more = weigh_last(inquiry, choice.fit, beside).delta_bic;
  return more > kStrongEvidence
             ? fmt::format("it does not stand beside {}", findings_in_words(choice))
             : fmt::format(
                   "what it does is known by name: {}; beside that the evidence for it is "
                   "{:.1f} of BIC, and {:g} is strong",
                   findings_in_words(choice), more, kStrongEvidence);
}

/// Why no values of a law promise anything.
std::string why_not_tried(const Inquiry& inquiry, const Hypothesis& hypothesis) {
  return inquiry.dictionary.find(hypothesis) == nullptr
             ? "within its ranges it has no value in some row, or changes nothing that was recorded"
             : "within its ranges the recordings show nothing of it";
}

Trial weighed(const Inquiry& inquiry, const Choice& choice,
              const std::vector<Candidate>& candidates, const Hypothesis& hypothesis) {
  Trial trial{hypothesis, is_found(choice, hypothesis), "", {}, {}, {}};
  const auto candidate = std::find_if(
      candidates.begin(), candidates.end(),
      [&](const Candidate& each) { return are_the_same(each.chosen.hypothesis, hypothesis); });
  if (candidate == candidates.end()) {
    trial.why = trial.stands ? "" : why_not_tried(inquiry, hypothesis);
    return trial;
  }
  const Fit alone = fit_with(inquiry, inquiry.given, candidate->chosen, kLastSteps);
  trial.chosen = {alone.chosen.back()};
  trial.covariance = alone.covariance_of(alone.chosen.size() - 1);
  trial.evidence = weigh_last(inquiry, inquiry.given, alone);
  if (!trial.stands) {
    trial.why = why_not(inquiry, trial.evidence);
    trial.why = trial.why.empty() ? why_others(inquiry, choice, trial.chosen.front()) : trial.why;
  }
  return trial;
}

}  // namespace

std::vector<Trial> weigh_trials(const Inquiry& inquiry, const Choice& choice) {
  std::vector<Trial> trials;
  std::vector<Candidate> candidates;
  for (const Hypothesis& hypothesis : inquiry.dictionary.hypotheses) {
    if (hypothesis.law->written) {
      if (candidates.empty()) {
        candidates = propose(inquiry, {inquiry.given, nullptr});
      }
      trials.push_back(weighed(inquiry, choice, candidates, hypothesis));
    }
  }
  return trials;
}

}  // namespace flexcomp::diagnosis
