#include "diagnosis/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/grammar/causes.hpp"
#include "diagnosis/grammar/laws.hpp"
#include "diagnosis/refit.hpp"
#include "diagnosis/registration.hpp"
#include "diagnosis/seek_changes.hpp"
#include "diagnosis/seek_laws.hpp"
#include "diagnosis/select/confounders.hpp"
#include "diagnosis/select/forms.hpp"
#include "diagnosis/select/standards.hpp"
#include "diagnosis/verdict.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr Eigen::Index kFewestSamples = 24;  // to fit to: eight poses of a tracker
constexpr Eigen::Index kLeastFreedom = 8;    // it tells a standard deviation to a quarter
constexpr double kExact = 1e-4;              // of the noise: exact data still need a scale
constexpr int kNoiseRounds = 2;              // each is a whole diagnosis: time

bool has_enough(const Observations& observations) {
  return observations.train >= kFewestSamples && observations.size() > observations.train;
}

/// Why there is not enough.
std::string what_lacks(const Observations& observations) {
  const std::string counts =
      fmt::format("too little data: {} samples to fit to and {} to check with", observations.train,
                  observations.size() - observations.train);
  return observations.has(simulation::joint_torque)
             ? counts + " (a joint that stands still counts for none: friction hides its torque)"
             : counts;
}

/// A load test's noise is what the fullest fit leaves; single samples far from it are outliers.
void learn_noise(Observations* observations, const std::vector<Hypothesis>& hypotheses,
                 const Dictionary& dictionary, const Fit& given) {
  const FullestFit full = fit_all(*observations, hypotheses, dictionary, given.remainder);
  if (full.freedom < kLeastFreedom) {
    return;
  }
  const double deviation =
      std::sqrt(full.remainder.squaredNorm() / static_cast<double>(full.freedom));
  Eigen::VectorXd values = Eigen::VectorXd::Zero(observations->size());
  values.head(observations->train) = full.remainder;
  observations->drop_outliers(values, kFarOff * deviation);
  observations->set_noise(std::max(deviation, kExact));
  observations->noise_is_known = true;
  observations->noise_uncertainty = 1 / std::sqrt(2 * static_cast<double>(full.freedom));
}

/// A load test's noise was learnt from a fit that takes all effects for linear: what is chosen, as
/// it is, may leave less. Was the noise lowered to that?
bool lower_noise(Observations* observations, const Fit& chosen) {
  const Eigen::Index freedom = observations->train - static_cast<Eigen::Index>(chosen.parameters());
  if (!observations->is_static || !observations->noise_is_known || chosen.chosen.empty() ||
      freedom < kLeastFreedom) {
    return false;
  }
  const double deviation = std::sqrt(chosen.remainder.head(observations->train).squaredNorm() /
                                     static_cast<double>(freedom));
  if (deviation > kMuchLess) {
    return false;
  }
  observations->set_noise(std::max(deviation, kExact));
  return true;
}

/// Judges what was chosen, and seeks laws for what it leaves.
void settle(const Inquiry& inquiry, const Settings& settings, Diagnosis* diagnosis) {
  judge(inquiry.observations, diagnosis);
  seek_laws(inquiry, settings, diagnosis);
}

/// The frame in which positions were measured, as it was registered, and the hypotheses about it.
struct Basis {
  Fit given;
  Dictionary dictionary;
};

/// Fits the registered frame again, and simulates the hypotheses about it: the noise has changed.
void renew(const Observations& observations, const std::vector<Hypothesis>& hypotheses,
           const Settings& settings, Basis* basis) {
  basis->given = fit(observations, basis->given.chosen, kSteps);
  basis->dictionary =
      Dictionary(observations, hypotheses, basis->given.machine, settings.simulating);
}

Basis basis_of(Observations* observations, const std::vector<Hypothesis>& hypotheses,
               const Settings& settings) {
  Fit given = register_frame(*observations, hypotheses);
  Dictionary dictionary(*observations, hypotheses, given.machine, settings.simulating);
  Basis basis{std::move(given), std::move(dictionary)};
  if (observations->is_static) {
    learn_noise(observations, hypotheses, basis.dictionary, basis.given);
    renew(*observations, hypotheses, settings, &basis);
  }
  return basis;
}

/// Fits anew where the findings leave something, or are many.
void refit_open(const Inquiry& inquiry, const std::vector<Hypothesis>& hypotheses,
                const TellStage& tell, Diagnosis* diagnosis) {
  const Observations& observations = inquiry.observations;
  const bool leaves_something = is_open(*diagnosis);
  if (!leaves_something && !are_many(inquiry, diagnosis->choice.fit)) {
    return;
  }
  if (leaves_something && diagnosis->proposal.empty()) {
    diagnosis->proposal = propose(observations, diagnosis->choice.fit).terms;
  }
  refit(inquiry, hypotheses, tell, diagnosis);
  diagnosis->left = locate(observations, diagnosis->choice.fit.remainder);
}

/// Suggests what to record next: what tells a finding from its nearest alternative, else what shows
/// the cause of a law in time, or of what came and went.
void suggest(const Observations& observations, Diagnosis* diagnosis) {
  for (std::size_t i = 0; i < diagnosis->choice.findings.size(); ++i) {
    const std::vector<Alternative>& others = diagnosis->choice.findings[i].alternatives;
    if (diagnosis->suggested_experiment.empty() && !others.empty() &&
        others.front().delta_bic < kSameEvidence) {
      diagnosis->suggested_experiment = suggest_experiment(observations, *diagnosis, i);
    }
  }
  for (const Finding& finding : diagnosis->choice.findings) {
    if (diagnosis->suggested_experiment.empty()) {
      diagnosis->suggested_experiment =
          finding.chosen.hypothesis.when
              ? "Record the same motion twice, as the machine was before the change and as it was "
                "after it: each alone tells its numbers."
              : grammar::next_recording(finding.chosen);
    }
  }
}

/// Leaves out the checks of clocks that a finding is about: they knew nothing of it, and its number
/// is the better one.
void leave_out_found_clocks(Diagnosis* diagnosis) {
  std::vector<ClockCheck>* clocks = &diagnosis->clocks;
  for (const Finding& finding : diagnosis->choice.findings) {
    const Hypothesis& found = finding.chosen.hypothesis;
    clocks->erase(std::remove_if(clocks->begin(), clocks->end(),
                                 [&](const ClockCheck& clock) {
                                   return found.traits().is_clock && found.law->form == clock.group;
                                 }),
                  clocks->end());
  }
}

std::vector<Event> events_left(const Observations& observations, const Diagnosis& diagnosis) {
  return is_open(diagnosis) ? find_events(observations, diagnosis.choice.fit.remainder)
                            : std::vector<Event>();
}

/// The diagnosis of all but events, and these: what is left beside them may be noise, and is then
/// explained by them.
Diagnosis diagnose_without(const std::vector<Event>& events, Observations* observations,
                           const std::vector<Hypothesis>& hypotheses, const Settings& settings) {
  for (const Event& event : events) {
    observations->leave_out(event.scene, event.rows);
  }
  Diagnosis rest = diagnose(observations, hypotheses, settings);
  rest.events.insert(rest.events.begin(), events.begin(), events.end());
  if (rest.verdict == Verdict::no_mismatch) {
    rest.verdict = Verdict::explained;
  }
  return rest;
}

}  // namespace

Diagnosis diagnose(Observations* observations, const std::vector<Hypothesis>& hypotheses,
                   const Settings& settings) {
  Diagnosis diagnosis;
  if (!has_enough(*observations)) {
    withdraw(*observations, what_lacks(*observations), &diagnosis);
    return diagnosis;
  }
  Basis basis = basis_of(observations, hypotheses, settings);
  const Inquiry inquiry{*observations, basis.dictionary, settings.false_discovery, basis.given};
  diagnosis.clocks = check_clocks(*observations, hypotheses, basis.dictionary, basis.given);
  diagnosis.excitation = excitation(*observations, hypotheses, basis.dictionary);
  diagnosis.location = locate(*observations, basis.given.remainder);
  diagnosis.choice = choose(inquiry, settings.choosing);
  const auto choose_anew = [&] {
    renew(*observations, hypotheses, settings, &basis);
    diagnosis.choice = choose(inquiry, settings.choosing);
  };
  for (int round = 0; round < kNoiseRounds && lower_noise(observations, diagnosis.choice.fit);
       ++round) {
    choose_anew();
  }
  settle(inquiry, settings, &diagnosis);
  for (int round = 0; round < kNoiseRounds && grammar::has_law(diagnosis.choice) &&
                      lower_noise(observations, diagnosis.choice.fit);
       ++round) {
    choose_anew();
    diagnosis.nearest.clear();
    diagnosis.indistinguishable.clear();
    settle(inquiry, settings, &diagnosis);
  }
  if (const auto events = events_left(*observations, diagnosis); !events.empty()) {
    return diagnose_without(events, observations, hypotheses, settings);
  }
  seek_changes(inquiry, settings.choosing, &diagnosis);
  refit_open(inquiry, hypotheses, settings.choosing, &diagnosis);
  if (!diagnosis.is_weighed_whole) {
    settle_forms(inquiry, &diagnosis.choice);
    widen_by_confounders(inquiry, &diagnosis.choice);
  }
  leave_out_found_clocks(&diagnosis);
  diagnosis.trials = weigh_trials(inquiry, diagnosis.choice);
  suggest(*observations, &diagnosis);
  return diagnosis;
}

}  // namespace flexcomp::diagnosis
