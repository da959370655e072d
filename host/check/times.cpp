#include "check/times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "check/arm.hpp"
#include "check/motion.hpp"
#include "recording/sampling.hpp"
#include "statistics/median.hpp"

namespace flexcomp::check {
namespace {

struct ClockUnit {
  const char* name;
  double count;  ///< of them in a second
};

constexpr ClockUnit kClockUnits[] = {
    {"milliseconds", 1e3}, {"microseconds", 1e6}, {"nanoseconds", 1e9}};
/// s: no log of a robot that moves smoothly from row to row is as slow as the slower, or as fast as
/// the faster.
constexpr double kSlowestStep = 0.15;
constexpr double kFastestStep = 5e-5;

/// Would any joint be faster than `most` times its limit if the times were divided by `count`?
bool is_too_fast(const model::Robot* robot, const Eigen::RowVectorXd& speed, double count,
                 double most) {
  for (Eigen::Index joint = 0; robot != nullptr && joint < speed.size(); ++joint) {
    const double limit = robot->dynamics[static_cast<std::size_t>(joint)].velocity;
    if (limit > 0 && speed[joint] * count > most * limit) {
      return true;
    }
  }
  return false;
}

Checks check_unit(const model::Robot* robot, double step, recording::Recording* recording) {
  constexpr Eigen::Index kFewestOfCounted = 100;  // rows: a load test may be as smooth by chance
  constexpr double kMostSpeed = 1.5;
  const recording::Samples* q = recording->angles();
  if (step < kSlowestStep || q == nullptr || !moves_smoothly(*q) ||
      (recording::counts_rows(recording->time) && recording->size() < kFewestOfCounted)) {
    return {};
  }
  const Eigen::RowVectorXd speed = usual_top_speed(recording->time, *q);
  for (const ClockUnit& unit : kClockUnits) {
    const double true_step = step / unit.count;
    if (true_step > kSlowestStep || true_step < kFastestStep ||
        is_too_fast(robot, speed, unit.count, kMostSpeed)) {
      continue;
    }
    recording->time /= unit.count;
    return {{Severity::error, "recording", "units.time",
             fmt::format("{}: the times look like {}: rows would be {:.3g} s apart, yet the joints "
                         "move smoothly from row to row",
                         recording->file, unit.name, step),
             fmt::format("give t in seconds: divide it by {:g}", unit.count)}};
  }
  return {};
}

Checks check_speed(const model::Robot* robot, const recording::Recording& recording) {
  constexpr double kFarTooFast = 5;  // times the limit: a wrong unit is off by 1000
  const recording::Samples* q = recording.angles();
  if (robot == nullptr || q == nullptr || recording::counts_rows(recording.time) ||
      !is_too_fast(robot, usual_top_speed(recording.time, *q), 1, kFarTooFast)) {
    return {};
  }
  return {{Severity::error, "recording", "units.time",
           fmt::format("{}: joints would move more than {:g} times as fast as they can: the times "
                       "are too close together, or no seconds",
                       recording.file, kFarTooFast),
           "give t in seconds, the true time of each sample"}};
}

Checks check_gaps(double step, const recording::Recording& recording) {
  constexpr double kGap = 0.5;   // s
  constexpr double kSteps = 50;  // usual ones
  Eigen::Index gaps = 0;
  Eigen::Index first = 0;
  for (Eigen::Index i = 1; i < recording.size(); ++i) {
    const double gap = recording.time[i] - recording.time[i - 1];
    if (gap > kGap && gap > kSteps * step) {
      first = gaps == 0 ? i : first;
      ++gaps;
    }
  }
  if (gaps == 0) {
    return {};
  }
  return {{Severity::note, "recording", "time.gap",
           fmt::format("{}: {} gap{} in time, the first of {:.3g} s", recording.place(first), gaps,
                       gaps > 1 ? "s" : "", recording.time[first] - recording.time[first - 1]),
           "better give stretches that do not hang together as recordings of their own"}};
}

/// Rows that repeat a sample, and times that are not those of the samples: `diagnose` and
/// `simulate` make up for both.
Checks check_sampling(const recording::Recording& recording) {
  if (recording.angles() == nullptr) {
    return {};
  }
  const recording::Sampling sampling = recording::sampling_of(recording);
  Checks checks;
  if (!sampling.repeats.empty()) {
    checks.push_back(
        {Severity::note, "recording", "time.repeated",
         fmt::format("{}: {} of {} rows show the sample of the row before once more, "
                     "though the joints move: the log is faster than what it asks",
                     recording.place(sampling.repeats.front()), sampling.repeats.size(),
                     recording.size()),
         "nothing, they are left out; better log each sample once, with its own time"});
  }
  if (sampling.period > 0) {
    checks.push_back({Severity::note, "recording", "time.uneven",
                      fmt::format("{}: the angles are smooth over evenly spaced times, {:.4g} ms "
                                  "apart, and not over those given, which are when rows were "
                                  "written",
                                  recording.file, 1e3 * sampling.period),
                      "nothing, times are taken to be even; better log the robot's own time"});
  }
  return checks;
}

}  // namespace

Checks check_order_of_times(recording::NumberTable* table) {
  const auto column = std::find(table->columns.begin(), table->columns.end(), "t");
  if (column == table->columns.end()) {
    return {};
  }
  const auto t = static_cast<std::size_t>(column - table->columns.begin());
  recording::NumberTable kept = *table;
  kept.rows.clear();
  kept.lines.clear();
  std::size_t repeated = 0;
  std::size_t backwards = 0;
  std::size_t line = 0;
  for (std::size_t row = 0; row < table->rows.size(); ++row) {
    const double time = table->rows[row][t];
    if (!kept.rows.empty() && time <= kept.rows.back()[t]) {
      line = repeated + backwards == 0 ? table->line(row) : line;
      ++(time < kept.rows.back()[t] ? backwards : repeated);
      continue;
    }
    kept.rows.push_back(table->rows[row]);
    kept.lines.push_back(table->lines[row]);
  }
  if (repeated + backwards == 0) {
    return {};
  }
  *table = std::move(kept);
  return {{Severity::error, "recording", "units.time",
           fmt::format("{}:{}: time must increase: {} row{} repeat{} a time and {} go{} back",
                       table->file, line, repeated, repeated == 1 ? "" : "s",
                       repeated == 1 ? "s" : "", backwards, backwards == 1 ? "es" : ""),
           "give each row its own time, with enough digits; sort the rows, or split the file where "
           "the clock starts again"}};
}

Checks check_times(const model::Robot* robot, recording::Recording* recording) {
  if (recording->size() < 10) {
    return {};
  }
  const Eigen::VectorXd steps =
      recording->time.tail(recording->size() - 1) - recording->time.head(recording->size() - 1);
  const double step = statistics::median({steps.begin(), steps.end()});
  Checks checks = check_unit(robot, step, recording);
  if (checks.empty()) {
    add(check_speed(robot, *recording), &checks);
  }
  if (checks.empty() && !recording::counts_rows(recording->time)) {
    add(check_gaps(step, *recording), &checks);
    add(check_sampling(*recording), &checks);
  }
  return checks;
}

}  // namespace flexcomp::check
