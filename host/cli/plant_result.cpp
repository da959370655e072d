#include "cli/plant_result.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "linux/fault_words.hpp"
#include "node/reply.hpp"
#include "recording/recording.hpp"

namespace flexcomp::cli {
namespace {

std::string faults_of(std::uint32_t status, std::uint16_t node_status) {
  const std::string words = fault_words(status, node_status);
  return words.empty() ? "no fault reported" : words;
}

/// Warns of what went on but should not have.
void warn(const PlantOptions& options, const GainLimit& limit, const simulation::PlantRun& run) {
  if (run.gain > limit.safe * (1 + 1e-6)) {
    fmt::print(stderr, "flexcomp: {}: the gain {:.4g} is {} above the largest safe one, {:.4g}\n",
               options.path, run.gain, run.gain > limit.stable ? "unstable," : "stable but",
               limit.safe);
  }
  if (run.was_lost) {
    fmt::print(stderr, "flexcomp: {}: the correction did not last, it faded out on the way: {}\n",
               options.path, faults_of(run.status, run.node_status));
  }
}

nlohmann::ordered_json summary(const simulation::PlantRun& run) {
  return {{"ticks", run.ticks},
          {"unanswered", run.unanswered},
          {"armed", run.armed},
          {"unstable", run.is_unstable},
          {"lost", run.was_lost},
          {"arm_reply", describe_reply(run.arm_reply)},
          {"largest_gain", run.largest_gain},
          {"status", run.status},
          {"node_status", run.node_status},
          {"least_engagement", run.least_engagement},
          {"most_engagement", run.most_engagement}};
}

void print_json(const PlantOptions& options, const GainLimit& limit,
                const simulation::PlantRun& result) {
  nlohmann::ordered_json json = summary(result);
  json["largest_stable_gain"] =
      std::isfinite(limit.stable) ? nlohmann::ordered_json(limit.stable) : nullptr;
  json["largest_safe_gain"] = limit.safe;
  json["process"] = to_json(options.process);
  fmt::print("{}\n", json.dump(2));
}

std::string why_not_armed(const simulation::PlantRun& result) {
  if (result.unanswered == result.ticks) {
    return "nobody answers";
  }
  if (result.arm_reply != 0) {
    return describe_reply(result.arm_reply);
  }
  const std::string inactive = "nothing was refused, but the correction did not become active";
  return result.latched == 0 && result.node_latched == 0
             ? inactive
             : inactive + ": " + faults_of(result.latched, result.node_latched);
}

void print_refusal(const simulation::PlantRun& result) {
  const std::string why = why_not_armed(result);
  fmt::print("not armed: {}; largest safe gain {:.4g}\n", why, result.largest_gain);
}

void print_summary(const PlantOptions& options, const GainLimit& limit,
                   const simulation::PlantRun& result) {
  fmt::print("{} ticks, {} without an answer; engagement {:.3f} to {:.3f} of the nominal depth\n",
             result.ticks, result.unanswered, result.least_engagement, result.most_engagement);
  fmt::print("largest safe gain {:.4g}, with a cut {:g} mm deep\n", limit.safe,
             1e3 * options.process.process.depth_of_cut);
}

/// Did the cut become so deep that the tool was stopped? Then it says so.
bool has_run_away(const PlantOptions& options, const simulation::PlantRun& result) {
  constexpr double kStopped = 0.999;  // of the engagement at which the tool is stopped: rounding
  if (options.allow_unstable ||
      result.most_engagement <= kStopped * simulation::RobotInCut::kMostEngagement) {
    return false;
  }
  fmt::print(stderr,
             "flexcomp: {}: the cut became {:g} times as deep as it should be, and was stopped "
             "there, as a spindle would stall: a deeper cut (--depth-of-cut) or less force\n",
             options.path, simulation::RobotInCut::kMostEngagement);
  return true;
}

}  // namespace

std::string unstable_text(const GainLimit& limit) {
  return limit.digs_in()
             ? fmt::format("no stable gain is safe: {}; --allow-unstable mills all the same",
                           describe_digging_in(limit))
             : fmt::format(
                   "unstable: with this process the largest stable gain is {:.4g}, the largest "
                   "safe one {:.4g}: make the table for it (flexcomp table --depth-of-cut) and "
                   "configure anew, or give --gain; --allow-unstable mills all the same",
                   limit.stable, limit.safe);
}

int finish_plant(const PlantOptions& options, const GainLimit& limit,
                 const simulation::PlantRun& result) {
  const bool refused = !options.without_compensation && (!result.armed || result.is_unstable);
  if (!refused && !options.out.empty()) {
    recording::write_recording(options.out, result.recording);
  }
  if (result.is_unstable) {
    fmt::print(stderr, "flexcomp: {}: {}\n", options.path, unstable_text(limit));
  }
  if (options.json) {
    print_json(options, limit, result);
  } else if (result.is_unstable) {
    return kDoesNotHold;
  } else if (refused) {
    print_refusal(result);
  } else {
    print_summary(options, limit, result);
  }
  if (refused) {
    return kDoesNotHold;
  }
  const bool ran_away = has_run_away(options, result);
  warn(options, limit, result);
  return ran_away ? kDoesNotHold : kDone;
}

}  // namespace flexcomp::cli
