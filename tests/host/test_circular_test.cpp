#include <cmath>
#include <functional>

#include "error.hpp"
#include "geometry/circular_test.hpp"
#include "geometry/polar_profile.hpp"
#include "unity_main.hpp"

using namespace flexcomp::geometry;
using flexcomp::InputError;

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRadius = 0.1;

Points circle(int count, const std::function<double(double)>& deviation) {
  Points points;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * kPi * i / count;
    const double radius = kRadius + deviation(angle);
    points.emplace_back(3 + radius * std::cos(angle), -2 + radius * std::sin(angle));
  }
  return points;
}

std::function<double(double)> wave(double amplitude, int count, double phase = 0) {
  return [=](double angle) { return amplitude * std::sin(count * angle + phase); };
}

double range_of(const Points& points) { return least_squares_circularity(points).value(); }

/// Two ovals that lean against each other, as by a mismatch of servos.
void opposite_ovals_add_up_both_ways() {
  const Points clockwise = circle(720, wave(10e-6, 2));
  const Points counterclockwise = circle(720, wave(10e-6, 2, kPi));
  const CircularTest test = circular_test(clockwise, counterclockwise, kRadius);
  TEST_ASSERT_DOUBLE_WITHIN(1e-8, 20e-6, test.clockwise);
  TEST_ASSERT_DOUBLE_WITHIN(1e-8, 20e-6, test.counterclockwise);
  TEST_ASSERT_DOUBLE_WITHIN(1e-8, 20e-6, test.bidirectional);
  TEST_ASSERT_DOUBLE_WITHIN(1e-8, 20e-6, test.hysteresis);
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0, test.mean_radial);
}

void circles_of_two_sizes_differ_both_ways_only() {
  const CircularTest test = circular_test(circle(360, [](double) { return 5e-6; }),
                                          circle(500, [](double) { return -1e-6; }), kRadius);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, test.clockwise);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 6e-6, test.bidirectional);
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, 6e-6, test.hysteresis);
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2e-6, test.mean_radial);
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, 5e-6, test.clockwise_least);
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, 5e-6, test.clockwise_most);
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, -1e-6, test.counterclockwise_least);
}

void the_filter_lets_half_of_a_wave_at_its_cutoff_through() {
  for (const int count : {15, 50}) {
    const Points smooth = filtered(circle(20000, wave(10e-6, count)), count);
    TEST_ASSERT_DOUBLE_WITHIN(0.02e-6, 10e-6, range_of(smooth));
  }
}

/// exp(−π (α n / cut-off)²): ISO 16610-21.
void the_filter_follows_the_gaussian_characteristic() {
  for (const int count : {2, 5, 10, 25}) {
    const double share = std::exp(-std::log(2) * std::pow(count / 15.0, 2));
    const Points smooth = filtered(circle(20000, wave(10e-6, count)), 15);
    TEST_ASSERT_DOUBLE_WITHIN(0.05e-6, 20e-6 * share, range_of(smooth));
  }
}

void what_makes_no_circular_test_is_refused() {
  const Points good = circle(36, wave(1e-6, 3));
  int refused = 0;
  for (const auto& attempt : {std::function<void()>([&] { circular_test(good, good, 0); }),
                              std::function<void()>([&] { circular_test(good, {}, kRadius); }),
                              std::function<void()>([&] { filtered(good, 0.5); }),
                              std::function<void()>([&] { filtered(good, std::nan("")); }),
                              std::function<void()>([&] { filtered({}, 15); })}) {
    try {
      attempt();
    } catch (const InputError&) {
      ++refused;
    }
  }
  TEST_ASSERT_EQUAL(5, refused);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(opposite_ovals_add_up_both_ways);
  RUN_TEST(circles_of_two_sizes_differ_both_ways_only);
  RUN_TEST(the_filter_lets_half_of_a_wave_at_its_cutoff_through);
  RUN_TEST(the_filter_follows_the_gaussian_characteristic);
  RUN_TEST(what_makes_no_circular_test_is_refused);
  return UNITY_END();
}
