#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "flexcomp/guard.hpp"
#include "unity_main.hpp"

using flexcomp::CorrectionLimits;
using flexcomp::Guard;
using flexcomp::JointGuards;
using flexcomp::JointVector;
using flexcomp::Result;

namespace {

constexpr double kPeriod = 1e-3;

template <typename Scalar>
Guard<Scalar> make_guard(const CorrectionLimits<Scalar>& limits) {
  Guard<Scalar> guard;
  TEST_ASSERT_EQUAL(Result::ok, guard.configure(limits, static_cast<Scalar>(kPeriod)));
  return guard;
}

/// Targets of every nasty kind, in stretches.
class HostileTargets {
 public:
  explicit HostileTargets(unsigned seed) : random_(seed) {}

  double next(double largest) {
    if (left_-- <= 0) {
      kind_ = static_cast<unsigned>(random_() % 7);
      left_ = static_cast<int>(random_() % 400);
      steady_ = 1.5 * largest * uniform_(random_);
    }
    switch (kind_) {
      case 0:
        return steady_;
      case 1:
        return 3.0 * largest * uniform_(random_);
      case 2:
        return std::numeric_limits<double>::quiet_NaN();
      case 3:
        return left_ % 2 == 0 ? 1e30 : -1e30;
      case 4:
        return largest * std::sin(0.01 * left_);
      case 5:
        return std::numeric_limits<double>::infinity();
      default:
        return std::numeric_limits<double>::denorm_min();
    }
  }

 private:
  std::mt19937 random_;
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
  unsigned kind_ = 0;
  int left_ = 0;
  double steady_ = 0;
};

template <typename Scalar>
void check_limits_hold(const CorrectionLimits<Scalar>& limits, unsigned seed, int ticks) {
  Guard<Scalar> guard = make_guard(limits);
  HostileTargets targets(seed);
  const double largest_step = static_cast<double>(limits.rate) * kPeriod;
  const double largest_change = static_cast<double>(limits.acceleration) * kPeriod * kPeriod;
  double before = 0;
  double before_that = 0;
  double worst_value = 0;
  double worst_step = 0;
  double worst_change = 0;
  for (int i = 0; i < ticks; ++i) {
    const double value =
        guard.advance(static_cast<Scalar>(targets.next(static_cast<double>(limits.value))));
    worst_value = std::fmax(worst_value, std::abs(value));
    worst_step = std::fmax(worst_step, std::abs(value - before));
    worst_change = std::fmax(worst_change, std::abs(value - 2 * before + before_that));
    before_that = before;
    before = value;
  }
  // Relative slack: the period itself is rounded to Scalar, and so are these sums.
  constexpr double kSlack = 1 + 4 * std::numeric_limits<Scalar>::epsilon();
  TEST_ASSERT_TRUE(worst_value <= static_cast<double>(limits.value));
  TEST_ASSERT_TRUE(worst_step <= kSlack * largest_step);
  TEST_ASSERT_TRUE(worst_change <= kSlack * largest_change);
  TEST_ASSERT_TRUE_MESSAGE(worst_value > 0, "the test moved nothing");
}

void no_target_breaks_a_limit_in_float() {
  check_limits_hold<float>({0.005F, 0.05F, 1.0F}, 1, 1000000);
  check_limits_hold<float>({0.02F, 0.5F, 20.0F}, 2, 1000000);
  check_limits_hold<float>({0.02F, 0.001F, 20.0F}, 3, 1000000);
  check_limits_hold<float>({0.002F, 10.0F, 0.1F}, 4, 1000000);
}

void no_target_breaks_a_limit_in_double() {
  check_limits_hold<double>({0.005, 0.05, 1.0}, 5, 1000000);
  check_limits_hold<double>({0.02, 5.0, 0.2}, 6, 1000000);
}

void a_steady_target_is_reached_without_overshoot() {
  Guard<double> guard = make_guard<double>({0.01, 0.05, 1.0});
  double highest = 0;
  for (int i = 0; i < 1000; ++i) {
    highest = std::fmax(highest, guard.advance(0.004));
  }
  TEST_ASSERT_EQUAL_DOUBLE(0.004, guard.value());
  TEST_ASSERT_TRUE(highest <= 0.004 * (1 + 1e-12));
  TEST_ASSERT_FALSE(guard.limited_by_rate());
}

/// Trapezoidal velocity profile: distance / rate + rate / acceleration, and a few periods for
/// sampling and for the reserve in braking.
void a_steady_target_is_reached_in_nearly_the_least_time() {
  Guard<double> guard = make_guard<double>({0.01, 0.05, 1.0});
  int ticks = 0;
  while (guard.value() < 0.004 - 1e-12 && ticks < 10000) {
    guard.advance(0.004);
    ++ticks;
  }
  const double least = 0.004 / 0.05 + 0.05 / 1.0;
  TEST_ASSERT_TRUE(ticks * kPeriod >= least - kPeriod);
  TEST_ASSERT_TRUE(ticks * kPeriod <= least + 5 * kPeriod);
}

void a_target_beyond_the_largest_value_stops_there_and_says_so() {
  Guard<double> guard = make_guard<double>({0.01, 0.05, 1.0});
  for (int i = 0; i < 1000; ++i) {
    guard.advance(1.0);
  }
  TEST_ASSERT_TRUE(guard.limited_by_value());
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.01, guard.value());
}

void a_target_that_is_not_finite_brings_it_to_rest() {
  Guard<float> guard = make_guard<float>({0.01F, 0.05F, 1.0F});
  for (int i = 0; i < 100; ++i) {
    guard.advance(0.01F);
  }
  for (int i = 0; i < 200; ++i) {
    guard.advance(std::numeric_limits<float>::quiet_NaN());
  }
  const float rest = guard.value();
  TEST_ASSERT_TRUE(std::isfinite(rest) && rest > 0);
  TEST_ASSERT_EQUAL_FLOAT(rest, guard.advance(std::numeric_limits<float>::quiet_NaN()));
}

void it_returns_to_exactly_zero() {
  Guard<float> guard = make_guard<float>({0.01F, 0.05F, 1.0F});
  for (int i = 0; i < 150; ++i) {
    guard.advance(0.0071F);
  }
  for (int i = 0; i < 1000; ++i) {
    guard.advance(0.0F);
  }
  TEST_ASSERT_TRUE(guard.is_at_rest_at_zero());
}

void limits_that_are_not_positive_finite_or_representable_are_refused() {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const CorrectionLimits<float> bad[] = {{0, 1, 1},
                                         {1, 0, 1},
                                         {1, 1, 0},
                                         {-1, 1, 1},
                                         {1, -1, 1},
                                         {1, 1, -1},
                                         {nan, 1, 1},
                                         {1, nan, 1},
                                         {1, 1, nan},
                                         {inf, 1, 1},
                                         {1, inf, 1},
                                         {1, 1, inf},
                                         {1, 1, 1e-3F},
                                         {1, 1e-9F, 100},
                                         {1, 1, 3e38F},
                                         // The way from one end to the other has no number, and
                                         // the reserve for rounding none in full precision.
                                         {3e38F, 3e38F, 1e37F},
                                         {1e-32F, 1, 1},
                                         {1e-45F, 1, 1}};
  for (const CorrectionLimits<float>& limits : bad) {
    Guard<float> guard;
    TEST_ASSERT_EQUAL(Result::bad_config,
                      guard.configure(limits, limits.acceleration > 1e36F ? 10.0F : 1e-3F));
  }
  Guard<float> guard;
  TEST_ASSERT_EQUAL(Result::bad_config, guard.configure({0.01F, 1, 1}, 0.0F));
  TEST_ASSERT_EQUAL(Result::bad_config, guard.configure({0.01F, 1, 1}, nan));
  TEST_ASSERT_EQUAL(Result::bad_config, guard.configure({1, 3e38F, 1}, 10.0F));
}

/// Each joint with limits and targets of its own.
template <typename Scalar>
void joints_move_together_as_they_do_alone() {
  std::array<CorrectionLimits<Scalar>, 6> limits;
  std::array<Guard<Scalar>, 6> alone;
  std::vector<HostileTargets> targets;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto factor = static_cast<Scalar>(i + 1);
    limits[i] = {Scalar(0.01) * factor, Scalar(0.3) / factor, 20 * factor};
    alone[i] = make_guard<Scalar>(limits[i]);
    targets.emplace_back(static_cast<unsigned>(i));
  }
  JointGuards<Scalar, 6> together;
  TEST_ASSERT_EQUAL(Result::ok, together.configure(limits, static_cast<Scalar>(kPeriod)));
  TEST_ASSERT_TRUE(together.is_at_rest_at_zero());
  for (int tick = 0; tick < 20000; ++tick) {
    JointVector<Scalar, 6> wanted = JointVector<Scalar, 6>::Zero();
    for (std::size_t i = 0; i < 6 && tick % 1000 < 800; ++i) {
      wanted[static_cast<Eigen::Index>(i)] =
          static_cast<Scalar>(targets[i].next(static_cast<double>(limits[i].value)));
    }
    const JointVector<Scalar, 6> values = together.advance(wanted);
    bool by_value = false;
    bool by_rate = false;
    bool at_rest = true;
    for (std::size_t i = 0; i < 6; ++i) {
      const auto joint = static_cast<Eigen::Index>(i);
      TEST_ASSERT_TRUE(alone[i].advance(wanted[joint]) == values[joint]);
      by_value = by_value || alone[i].limited_by_value();
      by_rate = by_rate || alone[i].limited_by_rate();
      at_rest = at_rest && alone[i].is_at_rest_at_zero();
    }
    TEST_ASSERT_EQUAL(by_value, together.limited_by_value());
    TEST_ASSERT_EQUAL(by_rate, together.limited_by_rate());
    TEST_ASSERT_EQUAL(at_rest, together.is_at_rest_at_zero());
  }
}

void bad_limits_of_any_joint_are_refused() {
  for (std::size_t bad = 0; bad < 6; ++bad) {
    std::array<CorrectionLimits<float>, 6> limits;
    limits.fill({0.01F, 1, 10});
    limits[bad].rate = 0;
    JointGuards<float, 6> guards;
    TEST_ASSERT_EQUAL(Result::bad_config, guards.configure(limits, 1e-3F));
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(no_target_breaks_a_limit_in_float);
  RUN_TEST(no_target_breaks_a_limit_in_double);
  RUN_TEST(a_steady_target_is_reached_without_overshoot);
  RUN_TEST(a_steady_target_is_reached_in_nearly_the_least_time);
  RUN_TEST(a_target_beyond_the_largest_value_stops_there_and_says_so);
  RUN_TEST(a_target_that_is_not_finite_brings_it_to_rest);
  RUN_TEST(it_returns_to_exactly_zero);
  RUN_TEST(joints_move_together_as_they_do_alone<float>);
  RUN_TEST(joints_move_together_as_they_do_alone<double>);
  RUN_TEST(bad_limits_of_any_joint_are_refused);
  RUN_TEST(limits_that_are_not_positive_finite_or_representable_are_refused);
  return UNITY_END();
}
