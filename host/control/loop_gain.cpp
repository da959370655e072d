#include "control/loop_gain.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

namespace flexcomp::control {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Delay and low-pass at the angle ω·period.
std::complex<double> filter_response(double angle, const CorrectionLoop& loop) {
  const double share =
      loop.filter_cutoff > 0 ? -std::expm1(-2 * kPi * loop.filter_cutoff * loop.period) : 1.0;
  const double ticks = std::ceil(loop.delay / loop.period - 1e-9);
  const std::complex<double> back = std::polar(1.0, -angle);
  return std::polar(1.0, -angle * ticks) * share / (1.0 - (1.0 - share) * back);
}

/// Where, between two angles at which the imaginary part of the response has opposite signs, it is
/// zero.
double real_crossing(double low, double high, const CorrectionLoop& loop) {
  const bool low_is_positive = filter_response(low, loop).imag() > 0;
  for (int step = 0; step < 60; ++step) {
    const double middle = (low + high) / 2;
    const bool middle_is_positive = filter_response(middle, loop).imag() > 0;
    (middle_is_positive == low_is_positive ? low : high) = middle;
  }
  return low;
}

}  // namespace

double cut_feedback(const Compliance<double>& compliance, const Wrench<double>& wrench,
                    const Vector3<double>& normal, double depth_of_cut) {
  const Twist<double> bent = compliance * wrench;
  return normal.dot(bent.head<3>()) / depth_of_cut;
}

double critical_gain(double factor, const CorrectionLoop& loop) {
  constexpr int kSteps = 4096;
  double smallest = std::numeric_limits<double>::infinity();
  const auto consider = [&](double angle) {
    const double real = factor * filter_response(angle, loop).real();
    if (real < 0) {
      smallest = std::min(smallest, -1 / real);
    }
  };
  consider(0);
  consider(kPi);
  double before = kPi / kSteps;
  for (int i = 2; i < kSteps; ++i) {
    const double angle = kPi * i / kSteps;
    const double sign = filter_response(before, loop).imag() * filter_response(angle, loop).imag();
    if (sign <= 0) {
      consider(real_crossing(before, angle, loop));
    }
    before = angle;
  }
  return smallest;
}

double largest_safe_gain(double feedback, const CorrectionLoop& loop, double margin) {
  if (feedback >= 1) {
    return 0;
  }
  return std::min(1.0, critical_gain(feedback / (1 - feedback), loop) / margin);
}

}  // namespace flexcomp::control
