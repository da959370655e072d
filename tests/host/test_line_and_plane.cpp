#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "error.hpp"
#include "geometry/flatness.hpp"
#include "geometry/straightness.hpp"
#include "unity_main.hpp"

using Eigen::Vector2d;
using Eigen::Vector3d;
using flexcomp::InputError;
using namespace flexcomp::geometry;

namespace {

constexpr int kSets = 1000;
constexpr double kExact = 1e-9;  // relative

template <typename Points, typename Vector>
double width_along(const Points& points, const Vector& normal) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const auto& point : points) {
    low = std::min(low, normal.dot(point));
    high = std::max(high, normal.dot(point));
  }
  return high - low;
}

Points random_profile(std::mt19937* random, int count) {
  std::normal_distribution<double> error(0, 0.02);
  std::uniform_real_distribution<double> along(0, 1);
  const double slope = error(*random) * 20;
  Points points;
  for (int i = 0; i < count; ++i) {
    const double x = along(*random);
    points.emplace_back(x, slope * x + error(*random));
  }
  return points;
}

SpacePoints random_surface(std::mt19937* random, int count) {
  std::normal_distribution<double> error(0, 0.02);
  std::uniform_real_distribution<double> along(0, 1);
  const Eigen::AngleAxisd turn(along(*random) * 3, Vector3d(1, 2, along(*random)).normalized());
  SpacePoints points;
  for (int i = 0; i < count; ++i) {
    points.push_back(turn * Vector3d(along(*random), along(*random), error(*random)));
  }
  return points;
}

/// The thinnest strip over the directions of all pairs: the optimum goes through two points.
double narrowest_strip(const Points& points) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vector2d along = (points[i] - points[j]).normalized();
      least = std::min(least, width_along(points, Vector2d(-along.y(), along.x())));
    }
  }
  return least;
}

/// The thinnest slab over the normals of all pairs of lines through two points.
double narrowest_slab(const SpacePoints& points) {
  SpacePoints lines;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      lines.push_back((points[i] - points[j]).normalized());
    }
  }
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vector3d normal = lines[i].cross(lines[j]);
      if (normal.norm() > 1e-9) {
        least = std::min(least, width_along(points, Vector3d(normal.normalized())));
      }
    }
  }
  return least;
}

void the_straightness_zone_is_the_narrowest_strip_of_all() {
  std::mt19937 random(1);
  for (int set = 0; set < kSets; ++set) {
    const Points points = random_profile(&random, 3 + set % 40);
    const double expected = narrowest_strip(points);
    const Straightness got = minimum_zone_straightness(points);
    TEST_ASSERT_DOUBLE_WITHIN(kExact * expected + 1e-15, expected, got.value());
    TEST_ASSERT_EQUAL(3, got.support.size());
  }
}

void the_flatness_zone_is_the_thinnest_slab_of_all() {
  std::mt19937 random(2);
  for (int set = 0; set < kSets; ++set) {
    const SpacePoints points = random_surface(&random, 4 + set % 9);
    const double expected = narrowest_slab(points);
    TEST_ASSERT_DOUBLE_WITHIN(kExact * expected + 1e-15, expected,
                              minimum_zone_flatness(points).value());
  }
}

/// A plane tilted by little either way is worse, for many points too.
void no_slab_near_the_flatness_zone_is_thinner() {
  std::mt19937 random(3);
  std::normal_distribution<double> tilt(0, 1e-3);
  const SpacePoints points = random_surface(&random, 5000);
  const Flatness zone = minimum_zone_flatness(points);
  TEST_ASSERT_TRUE(zone.support.size() >= 4);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d normal =
        (zone.normal + Vector3d(tilt(random), tilt(random), tilt(random))).normalized();
    TEST_ASSERT_TRUE(width_along(points, normal) >= zone.value() * (1 - 1e-12));
  }
}

void least_squares_leave_no_slope() {
  std::mt19937 random(4);
  const Points points = random_profile(&random, 200);
  const Straightness line = least_squares_straightness(points);
  double slope = 0;
  for (const Vector2d& point : points) {
    const Vector2d arm = point - line.point;
    slope +=
        line.direction.dot(arm) * (line.direction.x() * arm.y() - line.direction.y() * arm.x());
  }
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, slope);

  const SpacePoints surface = random_surface(&random, 200);
  const Flatness plane = least_squares_flatness(surface);
  Vector3d slopes = Vector3d::Zero();
  for (const Vector3d& point : surface) {
    const Vector3d arm = point - plane.point;
    slopes += plane.normal.dot(arm) * (arm - plane.normal * plane.normal.dot(arm));
  }
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, slopes.norm());
}

void zones_are_never_wider_than_least_squares() {
  std::mt19937 random(5);
  for (int set = 0; set < 100; ++set) {
    const Points points = random_profile(&random, 50);
    TEST_ASSERT_TRUE(minimum_zone_straightness(points).value() <=
                     least_squares_straightness(points).value());
    const SpacePoints surface = random_surface(&random, 50);
    TEST_ASSERT_TRUE(minimum_zone_flatness(surface).value() <=
                     least_squares_flatness(surface).value());
  }
}

/// A wave of height h: known without any computation.
void known_forms_far_from_the_origin() {
  const Vector2d far(1000, -2000);
  const Vector2d along(0.6, 0.8);
  const Vector2d across(-0.8, 0.6);
  Points points;
  for (int i = 0; i < 101; ++i) {
    points.push_back(far + 0.01 * i * along + (i % 2 == 0 ? 1e-4 : 0) * across);
  }
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1e-4, minimum_zone_straightness(points).value());

  SpacePoints surface;
  for (int i = 0; i < 21; ++i) {
    for (int j = 0; j < 21; ++j) {
      surface.emplace_back(1000 + 0.01 * i, -2000 + 0.01 * j, 3000 + ((i + j) % 2 == 0 ? 1e-4 : 0));
    }
  }
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1e-4, minimum_zone_flatness(surface).value());
}

void a_triangle_far_from_the_origin_is_no_line() {
  for (const double offset : {0.0, 1e6, 1e15, -1e15}) {
    const SpacePoints corners = {{offset, offset, offset},
                                 {offset + 1, offset, offset},
                                 {offset, offset + 1, offset},
                                 {offset, offset, offset + 1}};
    const SpacePoints triangle(corners.begin(), corners.begin() + 3);
    TEST_ASSERT_DOUBLE_WITHIN(0.5, 0, minimum_zone_flatness(triangle).value());
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, std::sqrt(1.0 / 3), minimum_zone_flatness(corners).value());
    TEST_ASSERT_TRUE(least_squares_flatness(corners).value() < 1);
    const Points flat = {{offset, offset}, {offset + 1, offset}, {offset, offset + 1}};
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, std::sqrt(0.5), minimum_zone_straightness(flat).value());
  }
}

void points_on_a_line_are_straight() {
  const Points points = {{0, 0}, {3, 3}, {1, 1}, {1, 1}, {2, 2}};
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0, minimum_zone_straightness(points).value());
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0, least_squares_straightness(points).value());
}

void points_in_a_plane_are_flat() {
  const SpacePoints points = {{0, 0, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 2}, {0.3, 0.2, 0.5}};
  TEST_ASSERT_DOUBLE_WITHIN(1e-14, 0, minimum_zone_flatness(points).value());
  TEST_ASSERT_DOUBLE_WITHIN(1e-14, 0, least_squares_flatness(points).value());
}

template <typename Measure, typename Points>
bool is_refused(Measure measure, const Points& points) {
  try {
    measure(points);
    return false;
  } catch (const InputError&) {
    return true;
  }
}

void what_has_no_reference_is_refused() {
  const double nan = std::nan("");
  for (const auto measure : {least_squares_straightness, minimum_zone_straightness}) {
    TEST_ASSERT_TRUE(is_refused(measure, Points{}));
    TEST_ASSERT_TRUE(is_refused(measure, Points{{1, 1}, {1, 1}}));
    TEST_ASSERT_TRUE(is_refused(measure, Points{{1, 1}, {nan, 1}}));
    TEST_ASSERT_TRUE(is_refused(measure, Points{{1e200, 1}, {-1e200, 1}, {0, 1e200}}));
    TEST_ASSERT_TRUE(is_refused(measure, Points{{1e308, 1}, {-1e308, 1}, {-1e308, 1e200}}));
  }
  for (const auto measure : {least_squares_flatness, minimum_zone_flatness}) {
    TEST_ASSERT_TRUE(is_refused(measure, SpacePoints{}));
    TEST_ASSERT_TRUE(is_refused(measure, SpacePoints{{0, 0, 0}, {1, 1, 1}}));
    TEST_ASSERT_TRUE(is_refused(measure, SpacePoints{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}));
    TEST_ASSERT_TRUE(is_refused(measure, SpacePoints{{0, 0, 0}, {1, 1, 1}, {nan, 2, 2}}));
    TEST_ASSERT_TRUE(is_refused(measure, SpacePoints{{0, 0, 0}, {1e200, 1, 1}, {0, 2e200, 2}}));
    TEST_ASSERT_TRUE(
        is_refused(measure, SpacePoints{{0.1, 0.3, 0.7}, {0.2, 0.6, 1.4}, {0.3, 0.9, 2.1}}));
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(the_straightness_zone_is_the_narrowest_strip_of_all);
  RUN_TEST(the_flatness_zone_is_the_thinnest_slab_of_all);
  RUN_TEST(no_slab_near_the_flatness_zone_is_thinner);
  RUN_TEST(least_squares_leave_no_slope);
  RUN_TEST(zones_are_never_wider_than_least_squares);
  RUN_TEST(known_forms_far_from_the_origin);
  RUN_TEST(a_triangle_far_from_the_origin_is_no_line);
  RUN_TEST(points_on_a_line_are_straight);
  RUN_TEST(points_in_a_plane_are_flat);
  RUN_TEST(what_has_no_reference_is_refused);
  return UNITY_END();
}
