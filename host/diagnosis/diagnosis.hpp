#pragma once

#include <functional>
#include <string>
#include <vector>

#include "diagnosis/clock_check.hpp"
#include "diagnosis/event.hpp"
#include "diagnosis/excitation.hpp"
#include "diagnosis/locate.hpp"
#include "diagnosis/proposal.hpp"
#include "diagnosis/retune.hpp"
#include "diagnosis/select/choose.hpp"
#include "diagnosis/trial.hpp"

namespace flexcomp::diagnosis {

enum class Verdict {
  no_mismatch,       ///< the residual is noise
  explained,         ///< what the findings leave is noise
  partly_explained,  ///< they leave more
  unexplained,       ///< a mismatch without findings
};

/// The verdict's name in `diagnosis.json`.
const char* name_of(Verdict verdict);

/// The mismatch between a model and its recordings, and its causes.
struct Diagnosis {
  Verdict verdict = Verdict::unexplained;
  std::string reason;  ///< why not explained; empty where it is
  std::vector<ClockCheck> clocks;
  std::vector<Excitation> excitation;  ///< of each joint
  std::vector<Event> events;  ///< that happened once; their samples are left out of all else
  Choice choice;
  double cancellation = 1;     ///< power of the findings' shares over that of their sum
  std::vector<Place> nearest;  ///< what comes nearest to an unexplained mismatch, without proof
  Location location;           ///< of the mismatch
  Location left;               ///< of what is unexplained
  std::vector<ProposedTerm> proposal;  ///< a form of what is unexplained; empty where none is found
  /// The findings, fitted anew, and behind them those of the model's own numbers that stand in for
  /// what is unexplained; nothing chosen where none do.
  Fit retuned;
  bool is_weighed_whole = false;  ///< the findings were weighed beside what stands in
  std::vector<std::vector<Place>> indistinguishable;
  std::string suggested_experiment;  ///< empty where none is needed
  std::vector<Trial> trials;         ///< of laws that a person suspected
  bool laws_stopped = false;         ///< the search for laws ended for want of time

  /// The fit behind the updated model: the findings, and the numbers that stand in for the rest.
  const Fit& updated() const { return retuned.chosen.empty() ? choice.fit : retuned; }
  /// The fit in which the findings were weighed.
  const Fit& weighed() const { return is_weighed_whole ? updated() : choice.fit; }
};

struct Settings {
  double false_discovery = 0.01;
  /// Processor time (s) in which laws are composed (grammar/laws.hpp) where there is a mismatch:
  /// beside what was found and in its place; none are for 0.
  double law_seconds = 40;  // tests/campaigns/concealed: more found no more laws
  std::function<void(std::size_t done, std::size_t count)> simulating;  ///< told of hypotheses
  TellStage choosing;  ///< told what is done with them
};

/// Diagnoses what was observed by the hypotheses of `all_hypotheses`. The noise of a load test is
/// learnt on the way.
Diagnosis diagnose(Observations* observations, const std::vector<Hypothesis>& hypotheses,
                   const Settings& settings);

/// The load test or motion, among several dozen simulated, in which the first two of a group differ
/// most as fitted so far; empty where none tells them apart.
std::string suggest_experiment(const Observations& observations, const Diagnosis& diagnosis,
                               std::size_t finding);

}  // namespace flexcomp::diagnosis
