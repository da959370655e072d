// The largest safe gain against closed forms and against the roots of the loop's polynomial.
#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "control/loop_gain.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using namespace flexcomp::control;

namespace {

constexpr double kPi = 3.14159265358979323846;

/// Largest magnitude of the roots of z^d (z − (1−α)) + g μ α z = 0, the closed loop.
double spectral_radius(double gain, std::complex<double> factor, const CorrectionLoop& loop) {
  const auto ticks = static_cast<Eigen::Index>(std::lround(loop.delay / loop.period));
  const double share =
      loop.filter_cutoff > 0 ? -std::expm1(-2 * kPi * loop.filter_cutoff * loop.period) : 1.0;
  Eigen::MatrixXcd companion = Eigen::MatrixXcd::Zero(ticks + 1, ticks + 1);
  for (Eigen::Index i = 1; i <= ticks; ++i) {
    companion(i, i - 1) = 1;
  }
  // z^(d+1) = (1−α) z^d − g μ α z
  companion(0, 0) = 1 - share;
  companion(0, ticks - 1) -= gain * factor * share;
  return Eigen::ComplexEigenSolver<Eigen::MatrixXcd>(companion).eigenvalues().cwiseAbs().maxCoeff();
}

void with_delay_alone_the_limit_is_a_loop_of_one() {
  for (const double delay : {0.004, 0.008, 0.02}) {
    for (const double factor : {0.3, 2.0, -0.7, -3.0}) {
      TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1 / std::fabs(factor),
                                critical_gain(factor, {0.004, 0, delay}));
    }
  }
}

void at_the_critical_gain_the_closed_loop_has_a_root_on_the_unit_circle() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 300; ++i) {
    const CorrectionLoop loop = {0.004, uniform(random) < 0.3 ? 0 : 1 + 60 * uniform(random),
                                 0.004 * (1 + static_cast<int>(5 * uniform(random)))};
    const std::complex<double> factor = std::polar(
        0.1 + 5 * uniform(random), uniform(random) < 0.5 ? 0 : 2 * kPi * uniform(random));
    const double critical = critical_gain(factor, loop);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1, spectral_radius(critical, factor, loop));
    TEST_ASSERT_TRUE(spectral_radius(0.98 * critical, factor, loop) < 1);
    TEST_ASSERT_TRUE(spectral_radius(0.5 * critical, factor, loop) < 1);
  }
}

void a_robot_pushed_out_of_the_cut_may_be_corrected_in_full() {
  const Compliance<double> compliance = Compliance<double>::Identity() * 1e-6;
  Wrench<double> wrench;
  wrench << 1000, 0, 0, 0, 0, 0;
  // The force pushes away from the material, and weakens as the tool gives way.
  const Vector3<double> into_the_material(-1, 0, 0);
  const auto stiffness = milling_stiffness(wrench, into_the_material, 0.002);
  TEST_ASSERT_EQUAL_DOUBLE(1, largest_safe_gain(compliance, stiffness, {0.004, 0, 0.004}));
}

void a_robot_pulled_into_the_cut_is_limited_by_the_closed_form() {
  const Compliance<double> compliance = Compliance<double>::Identity() * 1e-6;
  Wrench<double> wrench;
  wrench << 1000, 0, 0, 0, 0, 0;
  for (const double depth : {0.002, 0.0015, 0.0012}) {
    const auto stiffness = milling_stiffness(wrench, {1, 0, 0}, depth);
    // λ = C w / a: 1 mm of deflection per nominal force, over the depth. No filter: (1−λ)/λ,
    // halved.
    const double lambda = 0.001 / depth;
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, std::min(1.0, (1 - lambda) / lambda / 2),
                              largest_safe_gain(compliance, stiffness, {0.004, 0, 0.004}));
  }
}

void a_process_that_digs_in_by_itself_allows_no_correction() {
  const Compliance<double> compliance = Compliance<double>::Identity() * 1e-6;
  Wrench<double> wrench;
  wrench << 1000, 0, 0, 0, 0, 0;
  const auto stiffness = milling_stiffness(wrench, {1, 0, 0}, 0.0009);
  TEST_ASSERT_EQUAL_DOUBLE(0, largest_safe_gain(compliance, stiffness, {0.004, 20, 0.004}));
}

void no_process_allows_every_gain() {
  const Compliance<double> compliance = Compliance<double>::Identity() * 1e-6;
  TEST_ASSERT_EQUAL_DOUBLE(
      1, largest_safe_gain(compliance, Compliance<double>::Zero(), {0.004, 20, 0.004}));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(with_delay_alone_the_limit_is_a_loop_of_one);
  RUN_TEST(at_the_critical_gain_the_closed_loop_has_a_root_on_the_unit_circle);
  RUN_TEST(a_robot_pushed_out_of_the_cut_may_be_corrected_in_full);
  RUN_TEST(a_robot_pulled_into_the_cut_is_limited_by_the_closed_form);
  RUN_TEST(a_process_that_digs_in_by_itself_allows_no_correction);
  RUN_TEST(no_process_allows_every_gain);
  return UNITY_END();
}
