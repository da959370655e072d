#include "control/loop_gain.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace flexcomp::control {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Delay and low-pass at the angle ω·period.
std::complex<double> filter_response(double angle, const CorrectionLoop& loop) {
  const double share =
      loop.filter_cutoff > 0 ? -std::expm1(-2 * kPi * loop.filter_cutoff * loop.period) : 1.0;
  const double ticks = std::ceil(loop.delay / loop.period - 1e-9);
  const std::complex<double> back = std::polar(1.0, -angle);
  return std::polar(1.0, -angle * ticks) * share / (1.0 - (1.0 - share) * back);
}

}  // namespace

Compliance<double> milling_stiffness(const Wrench<double>& wrench, const Vector3<double>& normal,
                                     double depth_of_cut) {
  Compliance<double> stiffness = Compliance<double>::Zero();
  stiffness.leftCols<3>() = wrench * normal.transpose() / depth_of_cut;
  return stiffness;
}

double critical_gain(std::complex<double> factor, const CorrectionLoop& loop) {
  // Both halves of the circle: a complex factor has no symmetry.
  constexpr int kSteps = 4096;
  const auto open_loop = [&](double angle) { return factor * filter_response(angle, loop); };
  double smallest = kInfinity;
  const auto consider = [&](std::complex<double> value) {
    if (value.real() < 0) {
      smallest = std::min(smallest, -1 / value.real());
    }
  };
  double before = -kPi;
  std::complex<double> at_before = open_loop(before);
  if (std::abs(at_before.imag()) <= 1e-12 * std::abs(at_before)) {
    consider(at_before);
  }
  for (int i = 1; i <= kSteps; ++i) {
    const double angle = -kPi + 2 * kPi * i / kSteps;
    const std::complex<double> at = open_loop(angle);
    if (std::abs(at.imag()) <= 1e-12 * std::abs(at)) {
      consider(at);
    } else if (at.imag() * at_before.imag() < 0) {
      double low = before;
      double high = angle;
      for (int step = 0; step < 60; ++step) {
        const double middle = (low + high) / 2;
        (open_loop(middle).imag() * at_before.imag() > 0 ? low : high) = middle;
      }
      consider(open_loop(low));
    }
    before = angle;
    at_before = at;
  }
  return smallest;
}

double largest_safe_gain(const Compliance<double>& compliance, const Compliance<double>& stiffness,
                         const CorrectionLoop& loop, double margin) {
  const Compliance<double> product = stiffness * compliance;
  const Eigen::EigenSolver<Compliance<double>> solver(product, false);
  double gain = 1;
  for (const std::complex<double>& eigenvalue : solver.eigenvalues()) {
    if (eigenvalue.real() >= 1) {
      return 0;
    }
    if (std::abs(eigenvalue) > 1e-12) {
      gain = std::min(gain, critical_gain(eigenvalue / (1.0 - eigenvalue), loop) / margin);
    }
  }
  return gain;
}

}  // namespace flexcomp::control
