#include "diagnosis/seek_laws.hpp"

#include <algorithm>
#include <utility>

#include "diagnosis/grammar/laws.hpp"
#include "diagnosis/select/standards.hpp"
#include "diagnosis/verdict.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Numbers that are off: one law or two never looked like more.
constexpr std::size_t kMostNumbers = 8;

/// Do laws of many numbers stand where nothing else was found? They imitate a machine that is off
/// in many numbers, of which none shows by itself.
bool imitate_many(const Choice& choice, const Fit& laws) {
  return choice.findings.empty() && laws.parameters() > choice.fit.parameters() + kMostNumbers;
}

/// Do known effects account for more of what was fitted to, which were withdrawn because the
/// recording that was held out is unlike? A law is not for what one recording alone has.
bool are_outdone_by_withdrawn(const Inquiry& inquiry, const Choice& choice, const Fit& laws) {
  if (!choice.mispredicts || choice.withdrawn.empty()) {
    return false;
  }
  std::vector<Chosen> all = choice.fit.chosen;
  all.insert(all.end(), choice.withdrawn.begin(), choice.withdrawn.end());
  return bic_gain(inquiry.observations, laws, fit(inquiry.observations, std::move(all), kSteps)) >
         0;
}

/// Do as many laws and effects say with fewer numbers what findings say by an effect that few
/// machines have?
bool are_plainer(const Choice& laws, const Choice& found) {
  return laws.findings.size() == found.findings.size() &&
         laws.fit.parameters() < found.fit.parameters() &&
         std::any_of(found.findings.begin(), found.findings.end(),
                     [](const Finding& each) { return each.chosen.hypothesis.traits().is_of_few; });
}

/// Does the evidence speak for laws in the place of findings? Findings that leave no more than
/// noise need much to fall, others have something to say yet; what was held out must confirm the
/// laws. Simpler laws need less, and no contradiction by what was held out.
bool take_the_place(const Inquiry& inquiry, const Diagnosis& before, const Choice& laws) {
  const Fit& found = before.choice.fit;
  const double gain = bic_gain(inquiry.observations, found, laws.fit);
  const bool are_fewer = laws.findings.size() < before.choice.findings.size();
  if (are_fewer || are_plainer(laws, before.choice)) {
    return gain > (are_fewer ? -kIndifferent : kStrongEvidence) &&
           confirmation_of(inquiry.observations, found.remainder, laws.fit.remainder) > -kConfirmed;
  }
  const double needed = is_open(before) ? kStrongEvidence : kFarMoreEvidence;
  return gain >= needed && is_confirmed(inquiry, found, laws.fit);
}

/// The diagnosis with laws that nobody listed in the place of its findings, if these leave much
/// less; else as it was.
Diagnosis with_laws(const Inquiry& inquiry, const Diagnosis& before, Choice laws) {
  if (laws.findings.empty() || imitate_many(before.choice, laws.fit) ||
      !take_the_place(inquiry, before, laws) ||
      are_outdone_by_withdrawn(inquiry, before.choice, laws.fit)) {
    return before;
  }
  Diagnosis diagnosis = with_choice(inquiry.observations, before, std::move(laws));
  return diagnosis.verdict == Verdict::unexplained ? before : diagnosis;
}

/// Which of two diagnoses with laws: the second only by strong evidence, or with fewer numbers that
/// none speaks against.
Diagnosis better_of(const Observations& observations, Diagnosis one, Diagnosis other) {
  const Fit& a = one.choice.fit;
  const Fit& b = other.choice.fit;
  const double gain = bic_gain(observations, a, b);
  const bool is_other = gain > kStrongEvidence || (gain > 0 && b.parameters() < a.parameters());
  return is_other ? std::move(other) : std::move(one);
}

/// Fits with one effect more that holds, the one first that what was held out confirms most.
std::vector<Fit> single_effects(const Inquiry& inquiry) {
  std::vector<std::pair<double, Fit>> all;
  for (const Fit& tried :
       tried_beside(inquiry, {inquiry.given, seek(inquiry, inquiry.given)}, kShortlist)) {
    Fit whole = fit(inquiry.observations, tried.chosen, kSteps, &inquiry.dictionary);
    const Evidence evidence = weigh_last(inquiry, inquiry.given, whole);
    if (holds(inquiry, evidence)) {
      all.emplace_back(evidence.confirmation, std::move(whole));
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Fit> fits;
  for (auto& [confirmation, whole] : all) {
    fits.push_back(std::move(whole));
  }
  return fits;
}

/// The diagnosis with laws beside an effect by which alone nothing came to stand, if any do; else
/// as it was. Of two causes a third effect may imitate more than either is, and leave what no law
/// is.
Diagnosis beside_an_effect(const Inquiry& inquiry, const Diagnosis& before,
                           grammar::LawSearch* laws) {
  for (const Fit& begun : single_effects(inquiry)) {
    Diagnosis found = with_laws(inquiry, before, laws->choose(begun, grammar::First::any));
    if (!found.choice.findings.empty()) {
      return found;
    }
  }
  return before;
}

/// May a law be missing? Any finding may stand for one that looks like it. Where a machine is off
/// in many numbers, no law accounts for all, and looking for it takes long.
bool asks_for_laws(const Diagnosis& diagnosis) {
  const bool is_of_many =
      !diagnosis.choice.begun.chosen.empty() && diagnosis.choice.findings.size() > kMostNumbers;
  return !is_of_many && (is_open(diagnosis) || !diagnosis.choice.findings.empty());
}

}  // namespace

void seek_laws(const Inquiry& inquiry, const Settings& settings, Diagnosis* diagnosis) {
  if (settings.law_seconds <= 0 || !asks_for_laws(*diagnosis)) {
    return;
  }
  const Observations& observations = inquiry.observations;
  grammar::Budget budget(settings.law_seconds);
  const bool is_of_families = !diagnosis->choice.begun.chosen.empty();
  grammar::LawSearch laws(inquiry, &budget, settings.choosing);
  Diagnosis afresh =
      with_laws(inquiry, *diagnosis, laws.choose(inquiry.given, grammar::First::any));
  if (is_open(afresh) && !is_of_families && !diagnosis->choice.findings.empty()) {
    *diagnosis =
        with_laws(inquiry, *diagnosis, laws.choose(diagnosis->choice.fit, grammar::First::any));
  }
  if (!is_of_families || !is_open(afresh)) {
    *diagnosis = grammar::has_law(diagnosis->choice)
                     ? better_of(observations, *diagnosis, std::move(afresh))
                     : std::move(afresh);
  }
  if (is_open(*diagnosis)) {
    Diagnosis other =
        with_laws(inquiry, *diagnosis, laws.choose(inquiry.given, grammar::First::law));
    if (!is_open(other)) {
      *diagnosis = std::move(other);
    }
  }
  if (diagnosis->choice.findings.empty()) {
    *diagnosis = beside_an_effect(inquiry, *diagnosis, &laws);
  }
  diagnosis->laws_stopped = budget.has_stopped();
}

}  // namespace flexcomp::diagnosis
