#include "recording/clock_alignment.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "error.hpp"

namespace flexcomp::recording {
namespace {

constexpr double kNanoseconds = 1e9;

/// Joint angles over time.
struct Motion {
  std::int64_t origin = 0;
  std::vector<double> time;  ///< s since the origin
  std::vector<JointAngles> q;

  double step() const { return time.back() / static_cast<double>(time.size() - 1); }
};

Motion motion_in(const std::vector<LoggedMessage>& messages) {
  Motion motion;
  const auto add = [&](std::int64_t time, const JointAngles& q) {
    if (motion.q.empty()) {
      motion.origin = time;
    }
    const double seconds = static_cast<double>(time - motion.origin) / kNanoseconds;
    if (std::isfinite(q[0]) && (motion.time.empty() || seconds > motion.time.back())) {
      motion.time.push_back(seconds);
      motion.q.push_back(q);
    }
  };
  const bool has_setpoints = std::any_of(messages.begin(), messages.end(), [](const auto& logged) {
    return std::holds_alternative<SetpointMessage>(logged.message);
  });
  for (const LoggedMessage& logged : messages) {
    if (const auto* setpoint = std::get_if<SetpointMessage>(&logged.message)) {
      add(logged.time, setpoint->q);
    } else if (const auto* corrected = std::get_if<CorrectedMessage>(&logged.message)) {
      if (!has_setpoints) {
        add(logged.time, corrected->uncorrected);
      }
    }
  }
  return motion;
}

/// Angles and speeds at a time (s since the origin), straight between the samples; false outside.
bool interpolate(const Motion& motion, double time, JointAngles* q, JointAngles* speed) {
  const auto after = std::upper_bound(motion.time.begin(), motion.time.end(), time);
  if (after == motion.time.begin() || after == motion.time.end()) {
    return false;
  }
  const auto i = static_cast<std::size_t>(after - motion.time.begin());
  const double span = motion.time[i] - motion.time[i - 1];
  const double share = (time - motion.time[i - 1]) / span;
  for (std::size_t k = 0; k < q->size(); ++k) {
    (*speed)[k] = (motion.q[i][k] - motion.q[i - 1][k]) / span;
    (*q)[k] = motion.q[i - 1][k] + share * (motion.q[i][k] - motion.q[i - 1][k]);
  }
  return true;
}

/// Mean square distance of the two motions where they overlap by at least a third of the shorter;
/// infinite elsewhere.
double mismatch(const Motion& first, const Motion& second, double offset, std::size_t stride) {
  double sum = 0;
  std::size_t count = 0;
  std::size_t asked = 0;
  JointAngles q{};
  JointAngles speed{};
  for (std::size_t i = 0; i < second.time.size(); i += stride) {
    ++asked;
    if (interpolate(first, second.time[i] + offset, &q, &speed)) {
      for (std::size_t k = 0; k < q.size(); ++k) {
        sum += (q[k] - second.q[i][k]) * (q[k] - second.q[i][k]);
      }
      ++count;
    }
  }
  const double shorter = std::min(1.0, first.time.back() / std::max(second.time.back(), 1e-9)) *
                         static_cast<double>(asked);
  return static_cast<double>(3 * count) < shorter || count == 0
             ? std::numeric_limits<double>::infinity()
             : sum / static_cast<double>(count);
}

double search_offset(const Motion& first, const Motion& second) {
  constexpr std::size_t kSamples = 400;
  const std::size_t stride = std::max<std::size_t>(1, second.time.size() / kSamples);
  const double step = std::max(first.step(), second.step());
  double best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (double offset = -second.time.back(); offset <= first.time.back(); offset += step) {
    const double distance = mismatch(first, second, offset, stride);
    if (distance < least) {
      least = distance;
      best = offset;
    }
  }
  return best;
}

/// Offset and rate by Gauss-Newton from a start within a sample of the truth.
ClockAlignment refine(const Motion& first, const Motion& second, double offset) {
  constexpr int kIterations = 8;
  ClockAlignment alignment;
  alignment.origin = second.origin;
  const double middle = second.time.back() / 2;
  Eigen::Vector2d x(offset, 0);  // at the middle of the second log, s and s/s
  Eigen::Matrix2d normal;
  double rest = 0;
  std::size_t equations = 0;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    normal.setZero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    rest = 0;
    equations = 0;
    JointAngles q{};
    JointAngles speed{};
    for (std::size_t i = 0; i < second.time.size(); ++i) {
      const double from_middle = second.time[i] - middle;
      if (!interpolate(first, second.time[i] + x[0] + x[1] * from_middle, &q, &speed)) {
        continue;
      }
      for (std::size_t k = 0; k < q.size(); ++k) {
        const Eigen::Vector2d slope = speed[k] * Eigen::Vector2d(1, from_middle);
        const double miss = second.q[i][k] - q[k];
        normal += slope * slope.transpose();
        right += slope * miss;
        rest += miss * miss;
        ++equations;
      }
    }
    x += normal.ldlt().solve(right);
  }
  const double variance = rest / std::max<double>(1, static_cast<double>(equations) - 2);
  alignment.rate = x[1];
  alignment.uncertainty = std::sqrt(variance * normal.inverse()(0, 0));
  alignment.offset =
      x[0] - x[1] * middle + static_cast<double>(first.origin - second.origin) / kNanoseconds;
  return alignment;
}

}  // namespace

ClockAlignment align_clocks(const std::vector<LoggedMessage>& first,
                            const std::vector<LoggedMessage>& second) {
  const Motion a = motion_in(first);
  const Motion b = motion_in(second);
  if (a.q.size() < 3 || b.q.size() < 3) {
    throw InputError("the logs have no setpoints in common to align their clocks by");
  }
  constexpr double kSmallestMotion = 1e-4;  // rad
  JointAngles low = b.q[0];
  JointAngles high = b.q[0];
  double largest = 0;
  for (const JointAngles& q : b.q) {
    for (std::size_t k = 0; k < q.size(); ++k) {
      low[k] = std::min(low[k], q[k]);
      high[k] = std::max(high[k], q[k]);
      largest = std::max(largest, high[k] - low[k]);
    }
  }
  if (largest < kSmallestMotion) {
    throw InputError("the robot does not move in the logs: their clocks cannot be aligned");
  }
  return refine(a, b, search_offset(a, b));
}

std::vector<LoggedMessage> merge(const std::vector<LoggedMessage>& first,
                                 std::vector<LoggedMessage> second,
                                 const ClockAlignment& alignment) {
  for (LoggedMessage& logged : second) {
    const auto since = static_cast<double>(logged.time - alignment.origin);
    logged.time += std::llround(kNanoseconds * alignment.offset + alignment.rate * since);
  }
  std::vector<LoggedMessage> all = first;
  all.insert(all.end(), second.begin(), second.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.time < b.time; });
  return all;
}

}  // namespace flexcomp::recording
