#include "flexcomp/loop_gain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexcomp {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Delay and low-pass at points of the unit circle.
class LoopFilter {
 public:
  explicit LoopFilter(const CorrectionLoop& loop)
      : share_(loop.filter_cutoff > 0 ? -std::expm1(-2 * kPi * loop.filter_cutoff * loop.period)
                                      : 1.0),
        ticks_(std::ceil(loop.delay / loop.period - 1e-9)) {}

  double real(double angle) const {
    const double back = 1 - share_;
    return share_ *
           (std::cos(ticks_ * angle) * (1 - back * std::cos(angle)) -
            std::sin(ticks_ * angle) * back * std::sin(angle)) /
           squared_pole(angle);
  }

  /// With the sign of the imaginary part.
  double imaginary(double angle) const {
    const double back = 1 - share_;
    return -std::cos(ticks_ * angle) * back * std::sin(angle) -
           std::sin(ticks_ * angle) * (1 - back * std::cos(angle));
  }

  /// Where, between two angles at which the imaginary part has opposite signs, it is zero.
  double real_crossing(double low, double high) const {
    const bool low_is_positive = imaginary(low) > 0;
    for (int step = 0; step < 60; ++step) {
      const double middle = (low + high) / 2;
      const bool middle_is_positive = imaginary(middle) > 0;
      (middle_is_positive == low_is_positive ? low : high) = middle;
    }
    return low;
  }

 private:
  /// |1 − (1 − share) e^(−jω)|²
  double squared_pole(double angle) const {
    const double back = 1 - share_;
    return 1 - 2 * back * std::cos(angle) + back * back;
  }

  double share_;
  double ticks_;
};

}  // namespace

double critical_gain(double factor, const CorrectionLoop& loop) {
  constexpr int kSteps = 4096;
  const LoopFilter filter(loop);
  double smallest = std::numeric_limits<double>::infinity();
  const auto consider = [&](double angle) {
    const double real = factor * filter.real(angle);
    if (real < 0) {
      smallest = std::min(smallest, -1 / real);
    }
  };
  consider(0);
  consider(kPi);
  double before = kPi / kSteps;
  double imaginary_before = filter.imaginary(before);
  for (int i = 2; i < kSteps; ++i) {
    const double angle = kPi * i / kSteps;
    const double imaginary = filter.imaginary(angle);
    if (imaginary_before * imaginary <= 0) {
      consider(filter.real_crossing(before, angle));
    }
    before = angle;
    imaginary_before = imaginary;
  }
  return smallest;
}

GainLimit gain_limit(const FeedbackRange& range, const CorrectionLoop& loop, double softer) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const auto deepened = [&](double gain) {
    const double left = 1 - range.most * (1 - gain / softer);
    return left > 0 ? 1 / left : kInfinite;
  };
  GainLimit limit;
  limit.engagement_without = deepened(0);
  if (range.most < 1) {
    // λ/(1−λ) grows with λ: only the ends of the range can be the worst.
    const auto critical = [&](double feedback) {
      return critical_gain(feedback / softer / (1 - feedback), loop);
    };
    limit.stable = std::min(critical(range.least), critical(range.most));
  }
  limit.safe = std::clamp(limit.stable / GainLimit::kMargin, GainLimit::kNone, 1.0);
  limit.engagement = range.most < 1 ? deepened(limit.safe) : kInfinite;
  if (limit.digs_in()) {
    limit.safe = GainLimit::kNone;
  }
  return limit;
}

GainLimit gain_limit(const GainBasis& basis) {
  const auto depth = static_cast<double>(basis.depth_of_cut);
  return gain_limit(
      {static_cast<double>(basis.least_push) / depth, static_cast<double>(basis.most_push) / depth},
      {static_cast<double>(basis.period), static_cast<double>(basis.filter_cutoff),
       static_cast<double>(basis.delay)});
}

bool is_empty(const GainBasis& basis) {
  return basis.least_push == 0.0F && basis.most_push == 0.0F && basis.depth_of_cut == 0.0F &&
         basis.period == 0.0F && basis.filter_cutoff == 0.0F && basis.delay == 0.0F;
}

bool follows_from(double largest_gain, const GainBasis& basis) {
  constexpr double kRounding = 1e-6;  // of a gain in `float`
  if (is_empty(basis)) {
    return true;
  }
  const bool is_possible = basis.least_push <= 0.0F && basis.most_push >= 0.0F &&
                           basis.depth_of_cut > 0.0F && basis.period > 0.0F &&
                           basis.filter_cutoff >= 0.0F && basis.delay >= 0.0F;
  if (!is_possible) {
    return false;
  }
  const double safe = gain_limit(basis).safe;
  return std::abs(largest_gain - safe) <= kRounding * safe;
}

}  // namespace flexcomp
