#include <cmath>
#include <random>

#include "geometry/nearly_round.hpp"
#include "unity_main.hpp"

using namespace flexcomp::geometry;

namespace {

struct Profile {
  Eigen::ArrayXd x;
  Eigen::ArrayXd y;

  /// A circle of radius 0.1 m, off by up to `deviation` (m) in each coordinate.
  Profile(Eigen::Index count, double deviation, std::mt19937_64* draw) : x(count), y(count) {
    std::uniform_real_distribution<double> off(-deviation, deviation);
    for (Eigen::Index i = 0; i < count; ++i) {
      const double angle = 2 * M_PI * static_cast<double>(i) / static_cast<double>(count);
      x[i] = 0.1 * std::cos(angle) + off(*draw);
      y[i] = 0.1 * std::sin(angle) + off(*draw);
    }
  }

  double general() const {
    Points points;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      points.emplace_back(x[i], y[i]);
    }
    return least_squares_circularity(points).value();
  }
};

void a_nearly_round_profile_has_the_circularity_of_the_general_method() {
  std::mt19937_64 draw(1);
  for (const double deviation : {1e-6, 1e-4, 3e-3, 0.02}) {
    for (const Eigen::Index count : {8, 9, 72, 360}) {
      const Profile profile(count, deviation, &draw);
      TEST_ASSERT_DOUBLE_WITHIN(1e-14, profile.general(),
                                nearly_round_circularity(profile.x, profile.y));
    }
  }
}

void a_circle_that_moved_as_a_whole_is_round() {
  std::mt19937_64 draw(2);
  const Profile circle(72, 0, &draw);
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0, nearly_round_circularity(circle.x + 0.004, circle.y - 0.03));
}

void a_profile_far_from_round_is_left_to_the_general_method() {
  std::mt19937_64 draw(3);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const Profile scatter(12, 0.5, &draw);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, scatter.general(),
                              nearly_round_circularity(scatter.x, scatter.y));
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_nearly_round_profile_has_the_circularity_of_the_general_method);
  RUN_TEST(a_circle_that_moved_as_a_whole_is_round);
  RUN_TEST(a_profile_far_from_round_is_left_to_the_general_method);
  return UNITY_END();
}
