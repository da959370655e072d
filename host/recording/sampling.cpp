#include "recording/sampling.hpp"

#include <algorithm>
#include <cmath>

#include "recording/noise.hpp"
#include "statistics/median.hpp"

namespace flexcomp::recording {
namespace {

constexpr Eigen::Index kAround = 5;       // steps on either side that tell how a joint moves
constexpr double kFewCounts = 3;          // of an encoder, by which it goes on where it creeps
constexpr double kSteady = 0.5;           // of the median step around, that the next ones have
constexpr Eigen::Index kFewestEven = 50;  // rows, to draw a line through
constexpr double kGap = 2.5;              // usual steps without a row, where a line ends
constexpr double kMostLag = 5;            // periods, between the earliest stamp and the latest
constexpr double kLeastLag = 0.01;        // periods, that a stamp is off: less is rounding
constexpr double kMuchSmoother = 0.5;  // of the mean square by which angles miss their neighbours'
constexpr double kLeastMiss = 1e-12;   // rad: angles computed and not measured

/// Rows that show the same angles to the bit, from the first to the last.
struct Run {
  Eigen::Index first, last;
};

std::vector<Run> runs_of(const Samples& angles) {
  std::vector<Run> runs;
  for (Eigen::Index row = 0; row < angles.rows(); ++row) {
    if (row > 0 && (angles.row(row).array() == angles.row(row - 1).array()).all()) {
      runs.back().last = row;
    } else {
      runs.push_back({row, row});
    }
  }
  return runs;
}

/// Do the steps to a run and to the next one go on as those around do? `steps`: to each run from
/// the one before.
bool goes_on(const Eigen::VectorXd& steps, Eigen::Index run) {
  const Eigen::Index first = std::max<Eigen::Index>(1, run - kAround + 1);
  const Eigen::Index count = std::min(steps.size(), run + kAround + 1) - first;
  const Eigen::VectorXd around = steps.segment(first, count);
  const double usual = statistics::median({around.data(), around.data() + count});
  const double least = kSteady * std::abs(usual);
  return std::abs(steps[run]) > least && std::abs(steps[run + 1]) > least &&
         (around.array() * usual > 0).all();
}

/// How a joint moves from each run's sample to the next.
struct Motion {
  Eigen::VectorXd steps;  ///< rad, to each run from the one before
  Eigen::VectorXd rates;  ///< rad/s, the same
  double count = 0;       ///< rad, of its encoder; zero where none is seen

  /// Does it move on steadily before a run and after it? A log may ask at even times, and see a
  /// sample once more, or be shown samples at uneven ones. By a few counts it may creep.
  bool moves_about(Eigen::Index run) const {
    if (run == 0 || run + 1 >= steps.size()) {
      return false;
    }
    const double least = kFewCounts * count;
    return std::abs(steps[run]) > least && std::abs(steps[run + 1]) > least &&
           (goes_on(steps, run) || goes_on(rates, run));
  }
};

Motion motion_of(const Eigen::VectorXd& time, const Eigen::VectorXd& angle) {
  const Eigen::Index n = angle.size();
  Motion motion{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), quantisation_step(angle)};
  motion.steps.tail(n - 1) = angle.tail(n - 1) - angle.head(n - 1);
  motion.rates.tail(n - 1) =
      motion.steps.tail(n - 1).cwiseQuotient(time.tail(n - 1) - time.head(n - 1));
  return motion;
}

void find_repeats(const Eigen::VectorXd& time, const Samples& angles, Sampling* sampling) {
  const std::vector<Run> runs = runs_of(angles);
  std::vector<Eigen::Index> first;
  for (const Run& run : runs) {
    first.push_back(run.first);
  }
  std::vector<Motion> motions;
  for (Eigen::Index joint = 0; joint < angles.cols() && !first.empty(); ++joint) {
    motions.push_back(motion_of(time(first), angles(first, joint)));
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const bool repeats = runs[i].last > runs[i].first &&
                         std::any_of(motions.begin(), motions.end(), [i](const Motion& motion) {
                           return motion.moves_about(static_cast<Eigen::Index>(i));
                         });
    sampling->rows.push_back(runs[i].first);
    for (Eigen::Index row = runs[i].first + 1; row <= runs[i].last; ++row) {
      (repeats ? sampling->repeats : sampling->rows).push_back(row);
    }
  }
}

/// Times on a straight line over the index of first … last; their spacing is the period. False
/// where the stamps are too far from any line.
bool even_out(Eigen::Index first, Eigen::Index last, Eigen::VectorXd* time) {
  const Eigen::Index count = last - first + 1;
  const Eigen::ArrayXd stamps = time->segment(first, count).array();
  const Eigen::ArrayXd index = Eigen::ArrayXd::LinSpaced(count, 0, static_cast<double>(count - 1)) -
                               static_cast<double>(count - 1) / 2;
  const double period = (index * stamps).sum() / index.square().sum();
  const Eigen::ArrayXd even = stamps.mean() + period * index;
  const Eigen::ArrayXd lag = stamps - even;
  time->segment(first, count) = even.matrix();
  return lag.maxCoeff() - lag.minCoeff() < kMostLag * period;
}

/// All times evened between gaps; empty where that cannot be.
Eigen::VectorXd evened(const Sampling& sampling, const Eigen::VectorXd& stamps) {
  const Eigen::Index n = sampling.time.size();
  std::vector<double> steps;
  for (Eigen::Index i = 1; i < n; ++i) {
    steps.push_back(sampling.time[i] - sampling.time[i - 1]);
  }
  const double usual = statistics::median(steps);
  Eigen::VectorXd time = sampling.time;
  Eigen::Index first = 0;
  for (Eigen::Index i = 1; i <= n; ++i) {
    // Rows that repeated a sample are no gap.
    const auto at = static_cast<std::size_t>(i);
    const bool is_gap =
        i == n || stamps[sampling.rows[at]] - stamps[sampling.rows[at] - 1] > kGap * usual;
    if (is_gap) {
      if (i - first >= kFewestEven && !even_out(first, i - 1, &time)) {
        return {};
      }
      first = i;
    }
  }
  for (Eigen::Index i = 1; i < n; ++i) {
    if (!(time[i] > time[i - 1])) {
      return {};
    }
  }
  return time;
}

/// Are most joints' angles much smoother over other times?
bool is_much_smoother(const Samples& angles, const Eigen::VectorXd& before,
                      const Eigen::VectorXd& after) {
  std::vector<double> ratios;
  for (Eigen::Index joint = 0; joint < angles.cols(); ++joint) {
    const double missed = neighbour_misses(before, angles.col(joint)).squaredNorm();
    const double left = neighbour_misses(after, angles.col(joint)).squaredNorm();
    if (missed > kLeastMiss * kLeastMiss * static_cast<double>(angles.rows())) {
      ratios.push_back(left / missed);
    }
  }
  return !ratios.empty() && statistics::median(ratios) < kMuchSmoother;
}

/// Some of these rows, by their places among them.
std::vector<Eigen::Index> at_places(const std::vector<Eigen::Index>& rows,
                                    const std::vector<Eigen::Index>& places) {
  std::vector<Eigen::Index> some;
  some.reserve(places.size());
  for (const Eigen::Index place : places) {
    some.push_back(rows[static_cast<std::size_t>(place)]);
  }
  return some;
}

template <typename Group>
void pick(const std::vector<Eigen::Index>& rows, std::optional<Group>* group) {
  if (*group) {
    *group = Group((**group)(rows, Eigen::all));
  }
}

}  // namespace

Sampling sampling_of(const Eigen::VectorXd& time, const Samples& angles) {
  Sampling sampling;
  find_repeats(time, angles, &sampling);
  sampling.time = time(sampling.rows);
  if (sampling.time.size() < kFewestEven) {
    return sampling;
  }
  const Eigen::VectorXd even = evened(sampling, time);
  if (even.size() == 0) {
    return sampling;
  }
  const double period = (even[even.size() - 1] - even[0]) / static_cast<double>(even.size() - 1);
  if ((even - sampling.time).cwiseAbs().maxCoeff() > kLeastLag * period &&
      is_much_smoother(angles(sampling.rows, Eigen::all), sampling.time, even)) {
    sampling.period = period;
    sampling.time = even;
  }
  return sampling;
}

Sampling sampling_of(const Recording& recording) {
  const Samples& angles = *recording.angles();
  std::vector<Eigen::Index> whole;
  for (Eigen::Index row = 0; row < recording.size(); ++row) {
    if (angles.row(row).allFinite()) {
      whole.push_back(row);
    }
  }
  Sampling sampling;
  if (!recording.q_meas || counts_rows(recording.time)) {
    sampling.time = recording.time(whole);
    sampling.rows = std::move(whole);
    return sampling;
  }
  sampling = sampling_of(recording.time(whole), angles(whole, Eigen::all));
  sampling.rows = at_places(whole, sampling.rows);
  sampling.repeats = at_places(whole, sampling.repeats);
  return sampling;
}

std::optional<Eigen::Index> regular_step(std::vector<Eigen::Index> steps) {
  if (steps.empty()) {
    return std::nullopt;
  }
  std::sort(steps.begin(), steps.end());
  const Eigen::Index usual = steps[steps.size() / 2];
  if (steps[steps.size() * 9 / 10] > usual + 1) {
    return std::nullopt;
  }
  return usual;
}

Recording picked(const Recording& recording, const std::vector<Eigen::Index>& rows) {
  Recording some = recording;
  some.time = recording.time(rows);
  if (!recording.lines.empty()) {
    some.lines.clear();
    for (const Eigen::Index row : rows) {
      some.lines.push_back(recording.lines[static_cast<std::size_t>(row)]);
    }
  }
  for (auto* group : {&some.q_cmd, &some.q_meas, &some.q_link, &some.tau, &some.wrench,
                      &some.position, &some.temperature, &some.program_line}) {
    pick(rows, group);
  }
  return some;
}

}  // namespace flexcomp::recording
