// Fuzzy numbers, quartics, cost and bounds against worked numbers, closed forms and brute force.
#include <algorithm>
#include <cmath>
#include <random>

#include "control/gain_cost.hpp"
#include "control/lyapunov_bound.hpp"
#include "control/quartic.hpp"
#include "error.hpp"
#include "unity_main.hpp"

using namespace flexcomp::control;

namespace {

void within(double relative, double expected, double actual) {
  TEST_ASSERT_DOUBLE_WITHIN(relative * std::abs(expected), expected, actual);
}

void the_d_operation_has_its_closed_forms() {
  const FuzzyNumber triangle = FuzzyNumber::triangular(1, 2, 4);
  within(1e-14, 7.0 / 3, triangle.mean());
  within(1e-14, 35.0 / 6, triangle.mean_square());
  within(1e-14, 2.8, FuzzyNumber::trapezoidal(1, 2, 3, 5).mean());
  within(1e-14, 450, FuzzyNumber::triangular(10, 20, 30).squared().mean());
  within(1e-6, 2500.0 / 6, FuzzyNumber::triangular(10, 20, 30).mean_square());
  TEST_ASSERT_EQUAL_DOUBLE(7, FuzzyNumber::crisp(7).mean());
  TEST_ASSERT_EQUAL_DOUBLE(49, FuzzyNumber::crisp(7).mean_square());
}

/// Mean of a power by summing the membership itself over values, not its cuts.
void cuts_and_membership_say_the_same() {
  const std::vector<std::pair<double, double>> points = {{-1, 0}, {0.5, 0.2}, {1, 0.9}, {1.5, 1},
                                                         {2, 1},  {4, 0.3},   {4.5, 0}};
  const FuzzyNumber number = FuzzyNumber::tabulated(points);
  double area = 0;
  double first = 0;
  double second = 0;
  constexpr int kSteps = 1000000;
  for (int i = 0; i < kSteps; ++i) {
    const double value = -1 + 5.5 * (i + 0.5) / kSteps;
    const auto after = std::find_if(points.begin() + 1, points.end() - 1,
                                    [&](const auto& point) { return point.first > value; });
    const auto before = after - 1;
    const double degree = before->second + (value - before->first) /
                                               (after->first - before->first) *
                                               (after->second - before->second);
    area += degree;
    first += degree * value;
    second += degree * value * value;
  }
  // The rule over α is exact between corners of the membership, not across one.
  within(1e-5, first / area, number.mean());
  within(1e-5, second / area, number.mean_square());
  TEST_ASSERT_EQUAL_DOUBLE(-1, number.support().lower);
  TEST_ASSERT_EQUAL_DOUBLE(4.5, number.support().upper);
}

void a_table_of_a_triangle_is_the_triangle() {
  const FuzzyNumber table = FuzzyNumber::tabulated({{0, 0}, {1, 0}, {2, 1}, {4, 0}, {9, 0}});
  within(1e-12, 7.0 / 3, table.mean());
  TEST_ASSERT_EQUAL_DOUBLE(1, table.support().lower);
  TEST_ASSERT_EQUAL_DOUBLE(4, table.support().upper);
}

void arithmetic_is_that_of_intervals() {
  const FuzzyNumber a = FuzzyNumber::triangular(-1, 1, 2);
  const FuzzyNumber b = FuzzyNumber::triangular(-3, 1, 4);
  const Interval product = (a * b).support();
  TEST_ASSERT_EQUAL_DOUBLE(-6, product.lower);
  TEST_ASSERT_EQUAL_DOUBLE(8, product.upper);
  TEST_ASSERT_EQUAL_DOUBLE(0, a.squared().support().lower);
  TEST_ASSERT_EQUAL_DOUBLE(4, a.squared().support().upper);
  TEST_ASSERT_EQUAL_DOUBLE(-5, (a - b).support().lower);
  TEST_ASSERT_EQUAL_DOUBLE(5, (a - b).support().upper);
  TEST_ASSERT_EQUAL_DOUBLE(2, a.magnitude().support().upper);
}

void sets_that_are_none_are_refused() {
  int refused = 0;
  const auto attempt = [&](auto make) {
    try {
      make();
    } catch (const flexcomp::InputError&) {
      ++refused;
    }
  };
  attempt([] { FuzzyNumber::triangular(2, 1, 3); });
  attempt([] { FuzzyNumber::triangular(0, std::nan(""), 3); });
  attempt([] { FuzzyNumber::trapezoidal(0, 1, 2, INFINITY); });
  attempt([] { FuzzyNumber::tabulated({{0, 0}, {1, 0.9}, {2, 0}}); });
  attempt([] { FuzzyNumber::tabulated({{0, 0}, {1, 1}, {1, 0}}); });
  attempt([] { FuzzyNumber::tabulated({{0, 1}, {1, 0.5}, {2, 0.7}}); });
  attempt([] { FuzzyNumber::tabulated({{0, 1}}); });
  TEST_ASSERT_EQUAL(7, refused);
}

void the_quartic_has_its_known_roots() {
  within(1e-14, 2, positive_root(0, 16));
  within(1e-13, 1.59310543049843, positive_root(6, 16));
  within(1e-14, 2, positive_root(-6, 4));
  within(1e-14, 0.000999999999999, positive_root(1e3, 1));
  within(1e-13, 10.0003333111136, positive_root(-1e3, 1));
  within(1e-13, 0.999999749999969, positive_root(1e-6, 1));
}

/// Drift c = b ω_l/2 · α²/Γ of one parameter.
FuzzyNumber drift(double share, double leak, const FuzzyNumber& alpha, double rate) {
  return alpha.squared() * (share * leak / (2 * rate));
}

GainProblem problem(double share, const FuzzyNumber& start, const FuzzyNumber& alpha) {
  return {2, 2, 0.01, share, start, drift(share, 2, alpha, 2000)};
}

GainProblem worked_first() {
  return problem(0.8, FuzzyNumber::triangular(0.2, 0.5, 1.1), FuzzyNumber::triangular(10, 20, 30));
}

GainProblem worked_second() {
  return problem(1, FuzzyNumber::triangular(0.1, 0.3, 0.5), FuzzyNumber::triangular(4, 8, 16));
}

void the_worked_example_comes_out() {
  const GainProblem first = worked_first();
  within(1e-9, 0.6, first.start.mean());
  within(1e-9, 0.395, first.start.mean_square());
  within(1e-9, 0.18, first.drift.mean());
  within(1e-9, 0.0368, first.drift.mean_square());
  const GainCost cost = gain_cost(first);
  within(1e-9, 0.09245, cost.constant);
  within(1e-9, -0.0105, cost.linear);
  within(1e-9, 0.0225, cost.square);
  within(1e-9, -0.525, cost.p());
  within(1e-9, 2.25, cost.r());
  within(1e-9, 1.30914297182, cost.best());
  within(1e-9, 0.130737363592, cost(cost.best()));

  const GainProblem second = worked_second();
  within(1e-9, 0.3, second.start.mean());
  within(1e-9, 0.0966666666667, second.start.mean_square());
  within(1e-12, 93.0 / 1750, second.drift.mean());
  const GainCost other = gain_cost(second);
  within(1e-9, 3.515625, other.r());
  within(1e-9, 1.34371461309, other.best());
  within(1e-9, 0.0568364405177, other(other.best()));
}

void both_parts_are_where_a_sweep_over_both_gains_is_lowest() {
  const GainCost first = gain_cost(worked_first());
  const GainCost second = gain_cost(worked_second());
  const double least = first(first.best()) + second(second.best());
  double best = INFINITY;
  for (int i = 0; i <= 1600; ++i) {
    for (int j = 0; j <= 1600; ++j) {
      const double one = std::pow(10, -2 + 4 * i / 1600.0);
      const double two = std::pow(10, -2 + 4 * j / 1600.0);
      best = std::min(best, first(one) + second(two));
    }
  }
  TEST_ASSERT_TRUE(best >= least);
  within(1e-5, least, best);
}

double drawn(std::mt19937* random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(*random);
}

FuzzyNumber drawn_number(std::mt19937* random) {
  double corner[3] = {drawn(random, 0, 5), drawn(random, 0, 5), drawn(random, 0, 5)};
  std::sort(corner, corner + 3);
  return FuzzyNumber::triangular(corner[0], corner[1], corner[2]);
}

void a_thousand_random_problems_have_one_stationary_gain_and_it_is_the_minimum() {
  std::mt19937 random(7);
  for (int trial = 0; trial < 1000; ++trial) {
    GainProblem at;
    at.decay = std::pow(10, drawn(&random, -1, 2));
    at.residual_time = std::pow(10, drawn(&random, -2, 1));
    at.effort = std::pow(10, drawn(&random, -4, 4));
    at.share = drawn(&random, 0.3, 1);
    at.start = drawn_number(&random);
    at.drift = drawn_number(&random) * std::pow(10, drawn(&random, -2, 2));
    const GainCost cost = gain_cost(at);
    const std::vector<double> roots = positive_roots_by_companion(cost.p(), cost.r());
    const double best = cost.best();
    TEST_ASSERT_EQUAL(1, roots.size());
    within(1e-9, roots[0], best);
    // Brute force: falling before it, rising behind it, nowhere lower.
    constexpr int kSteps = 4000;
    const double least = cost(best);
    int lowest = 0;
    double lowest_cost = INFINITY;
    for (int i = 0; i <= kSteps; ++i) {
      const double gain = best * std::pow(10, -3 + 6.0 * i / kSteps);
      const double value = cost(gain);
      TEST_ASSERT_TRUE(value >= least - 1e-12 * (std::abs(cost.constant) + std::abs(least)));
      if (value < lowest_cost) {
        lowest_cost = value;
        lowest = i;
      }
    }
    // The constant may drown the curve near its minimum: compare without it where the grid ends.
    const double step = std::pow(10, 6.0 / kSteps);
    const double found = best * std::pow(10, -3 + 6.0 * lowest / kSteps);
    GainCost curve = cost;
    curve.constant = 0;
    TEST_ASSERT_TRUE(curve(best) <= curve(best * step) && curve(best) <= curve(best / step));
    TEST_ASSERT_TRUE(cost(found) - least <= 1e-4 * (std::abs(curve(best * 10)) + std::abs(least)));
  }
}

void the_drift_of_the_worked_example_comes_out_term_by_term() {
  const double share = 0.8;
  const double coupling = 1.25;
  const double link = layer_drift(share, 1 / 0.02);
  const double motor = layer_drift(coupling, 1 / 0.03);
  within(1e-12, 10, link);
  within(1e-12, 125.0 / 12, motor);
  const double link_leak =
      leak_drift(share, 5, Eigen::Vector3d(9, 0.5, 1.3), Eigen::Vector3d(1000, 0.9, 40));
  const double motor_leak = leak_drift(coupling, 5, Eigen::Vector4d(4.2, 1.6, 0.24, 0.04),
                                       Eigen::Vector4d(360, 160, 0.9, 0.225));
  within(1e-11, 0.802055555556, link_leak);
  within(1e-11, 0.425347222222, motor_leak);
  // A lag of 2 N·m on springs a fifth too stiff: 1.2² · 2² / (40 · 4.8).
  const double filter = filter_drift(1.2, 4, 40, 4.8);
  within(1e-12, 0.03, filter);
  within(1e-11, 21.6740694444, link + motor + link_leak + motor_leak + filter);
}

void the_bound_of_the_worked_example_comes_out() {
  const LyapunovBound bound{5, 21.6740694444};
  within(1e-9, 4.33481388889, bound.residual());
  within(1e-9, 5.62069066926, bound.at(20, 0.5));
  within(1e-9, 0.856098880296, bound.time_to(1.05 * bound.residual(), 20));
  TEST_ASSERT_EQUAL_DOUBLE(0, bound.time_to(21, 20));
  TEST_ASSERT_EQUAL_DOUBLE(20, bound.most(20));
  TEST_ASSERT_EQUAL_DOUBLE(bound.residual(), bound.most(1));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(the_d_operation_has_its_closed_forms);
  RUN_TEST(cuts_and_membership_say_the_same);
  RUN_TEST(a_table_of_a_triangle_is_the_triangle);
  RUN_TEST(arithmetic_is_that_of_intervals);
  RUN_TEST(sets_that_are_none_are_refused);
  RUN_TEST(the_quartic_has_its_known_roots);
  RUN_TEST(the_worked_example_comes_out);
  RUN_TEST(both_parts_are_where_a_sweep_over_both_gains_is_lowest);
  RUN_TEST(a_thousand_random_problems_have_one_stationary_gain_and_it_is_the_minimum);
  RUN_TEST(the_drift_of_the_worked_example_comes_out_term_by_term);
  RUN_TEST(the_bound_of_the_worked_example_comes_out);
  return UNITY_END();
}
