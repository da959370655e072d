#include <CGAL/Exact_rational.h>
#include <CGAL/Min_annulus_d.h>
#include <CGAL/Min_sphere_annulus_d_traits_2.h>
#include <CGAL/Min_sphere_d.h>
#include <CGAL/Simple_cartesian.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <string>

#include "cases.hpp"
#include "error.hpp"
#include "geometry/circularity.hpp"
#include "recording/csv.hpp"
#include "unity_main.hpp"

using Eigen::Vector2d;
using flexcomp::InputError;
using flexcomp::geometry::Circularity;
using flexcomp::geometry::least_squares_circularity;
using flexcomp::geometry::maximum_inscribed_circularity;
using flexcomp::geometry::minimum_circumscribed_circularity;
using flexcomp::geometry::minimum_zone_circularity;
using flexcomp::geometry::Points;
using flexcomp::test::cases;

namespace {

constexpr double kPi = 3.14159265358979323846;
using Method = Circularity (*)(const Points&);
constexpr Method kMethods[] = {least_squares_circularity, minimum_zone_circularity,
                               maximum_inscribed_circularity, minimum_circumscribed_circularity};

/// Circularity in mm of deflected milling paths, each value found in two independent ways.
struct Reference {
  const char* name;
  double lsc, mzc, mic, mcc;
};
constexpr Reference kReferences[] = {
    {"KR270_S", 0.5835773711951049, 0.5457407128916003, 0.5903026098757636, 0.678971942716629},
    {"KR100_B", 1.186627680173416, 1.1198604719510996, 1.4370404074612253, 1.2325577044589977},
    {"KR500_C", 0.5434446398652995, 0.5296290999661721, 0.5837520743188378, 0.531980033967173},
    {"KR360_A_x10", 11.353186329402703, 10.969379826916224, 12.137066112157655, 11.638014673670497},
    {"KR100_S_far_x5", 8.786823410448932, 8.556307414518756, 9.731007929115876, 9.070780338418771},
};

Points read_points(const std::string& name) {
  const auto table =
      flexcomp::recording::read_csv(std::string(FLEXCOMP_TEST_DATA) + "/circle_" + name + ".csv");
  Points points;
  for (const auto& row : table.rows) {
    points.emplace_back(row[0], row[1]);
  }
  return points;
}

Points profile(std::size_t count, double radius, const std::function<double(double)>& deviation,
               double arc = 2 * kPi) {
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = arc * static_cast<double>(i) / static_cast<double>(count);
    const double r = radius + deviation(angle);
    points.emplace_back(r * std::cos(angle), r * std::sin(angle));
  }
  return points;
}

Points noisy_profile(std::size_t count, double radius, double noise, unsigned seed,
                     double arc = 2 * kPi) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-noise, noise);
  return profile(
      count, radius, [&](double) { return uniform(random); }, arc);
}

double range_about(const Points& points, const Vector2d& center) {
  double low = std::numeric_limits<double>::infinity();
  double high = 0;
  for (const Vector2d& point : points) {
    low = std::fmin(low, (point - center).norm());
    high = std::fmax(high, (point - center).norm());
  }
  return high - low;
}

bool meets(const Vector2d& p, const Vector2d& u, const Vector2d& q, const Vector2d& v,
           Vector2d* at) {
  const double determinant = u.x() * v.y() - u.y() * v.x();
  if (std::abs(determinant) < 1e-14 * u.norm() * v.norm()) {
    return false;
  }
  const Vector2d d = q - p;
  *at = p + (d.x() * v.y() - d.y() * v.x()) / determinant * u;
  return true;
}

/// Every place where two perpendicular bisectors of pairs of points meet: all centres that contacts
/// can fix are among them.
std::vector<Vector2d> all_bisector_crossings(const Points& points) {
  std::vector<std::pair<Vector2d, Vector2d>> bisectors;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      const Vector2d d = points[j] - points[i];
      bisectors.emplace_back((points[i] + points[j]) / 2, Vector2d(-d.y(), d.x()));
    }
  }
  std::vector<Vector2d> crossings;
  for (std::size_t i = 0; i < bisectors.size(); ++i) {
    for (std::size_t j = i + 1; j < bisectors.size(); ++j) {
      Vector2d at;
      if (meets(bisectors[i].first, bisectors[i].second, bisectors[j].first, bisectors[j].second,
                &at)) {
        crossings.push_back(at);
      }
    }
  }
  return crossings;
}

bool in_hull(const Points& points, const Vector2d& at) {
  std::vector<double> angles;
  for (const Vector2d& point : points) {
    angles.push_back(std::atan2(point.y() - at.y(), point.x() - at.x()));
  }
  std::sort(angles.begin(), angles.end());
  double gap = angles.front() + 2 * kPi - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) {
    gap = std::fmax(gap, angles[i] - angles[i - 1]);
  }
  return gap <= kPi + 1e-9;
}

void the_reference_circles_come_out_in_all_four_methods() {
  for (const Reference& reference : kReferences) {
    const Points points = read_points(reference.name);
    const double expected[] = {reference.lsc, reference.mzc, reference.mic, reference.mcc};
    for (std::size_t i = 0; i < 4; ++i) {
      TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-9, expected[i], 1e3 * kMethods[i](points).value(),
                                        reference.name);
    }
  }
}

void points_on_a_circle_have_no_form_error() {
  const Points points = profile(48, 0.1, [](double) { return 0.0; });
  for (const Method method : kMethods) {
    const Circularity result = method(points);
    TEST_ASSERT_TRUE(result.value() < 1e-16);
    TEST_ASSERT_TRUE(result.center.norm() < 1e-15);
  }
}

/// r(φ) = R + a cos 3φ sampled at its extremes: the zone touches at six points and is 2a wide; the
/// other circles are concentric with it by symmetry.
void three_lobes_are_twice_their_amplitude() {
  const Points points = profile(360, 0.1, [](double angle) { return 2e-5 * std::cos(3 * angle); });
  for (const Method method : kMethods) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 4e-5, method(points).value());
  }
}

void an_ellipse_is_as_wide_as_its_half_axes_differ() {
  Points points;
  for (int i = 0; i < 360; ++i) {
    const double angle = kPi * i / 180;
    points.emplace_back(0.1003 * std::cos(angle), 0.0998 * std::sin(angle));
  }
  for (const Method method :
       {least_squares_circularity, minimum_zone_circularity, minimum_circumscribed_circularity}) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-14, 5e-4, method(points).value());
  }
  // The largest inscribed circle can shift a little between the samples.
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0998, maximum_inscribed_circularity(points).r_min);
}

void the_contacts_of_the_minimum_zone_alternate() {
  const Points points = noisy_profile(200, 1.0, 1e-3, 3);
  const Circularity zone = minimum_zone_circularity(points);
  TEST_ASSERT_EQUAL(4, zone.inner_support.size() + zone.outer_support.size());
  TEST_ASSERT_EQUAL(2, zone.inner_support.size());
  std::vector<std::pair<double, bool>> contacts;
  const auto add = [&](const std::vector<std::size_t>& support, bool outer) {
    for (const std::size_t i : support) {
      const Vector2d arm = points[i] - zone.center;
      TEST_ASSERT_DOUBLE_WITHIN(1e-12, outer ? zone.r_max : zone.r_min, arm.norm());
      contacts.emplace_back(std::atan2(arm.y(), arm.x()), outer);
    }
  };
  add(zone.inner_support, false);
  add(zone.outer_support, true);
  std::sort(contacts.begin(), contacts.end());
  for (std::size_t i = 0; i < 4; ++i) {
    TEST_ASSERT_TRUE(contacts[i].second != contacts[(i + 1) % 4].second);
  }
}

void no_small_step_of_the_centre_improves_least_squares() {
  const Points points = noisy_profile(50, 0.1, 0.02, 5);
  const Vector2d center = least_squares_circularity(points).center;
  const auto sum_of_squares = [&](const Vector2d& c) {
    double mean = 0;
    for (const Vector2d& point : points) {
      mean += (point - c).norm() / static_cast<double>(points.size());
    }
    double sum = 0;
    for (const Vector2d& point : points) {
      sum += std::pow((point - c).norm() - mean, 2);
    }
    return sum;
  };
  for (int direction = 0; direction < 8; ++direction) {
    const Vector2d step = 1e-6 * Vector2d(std::cos(direction), std::sin(direction));
    TEST_ASSERT_TRUE(sum_of_squares(center + step) > sum_of_squares(center));
  }
}

void minimum_zone_is_the_best_of_all_candidates() {
  std::mt19937 random(11);
  for (unsigned set = 0; set < cases(100U); ++set) {
    const double noise = set % 4 == 0 ? 0.3 : 0.01;
    const double arc = set % 3 == 0 ? 0.3 : 2 * kPi;
    const Points points = noisy_profile(8 + random() % 4, 1.0, noise, set, arc);
    double best = std::numeric_limits<double>::infinity();
    for (const Vector2d& center : all_bisector_crossings(points)) {
      best = std::fmin(best, range_about(points, center));
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-11, best, minimum_zone_circularity(points).value());
  }
}

void inscribed_circle_is_the_largest_of_all_candidates() {
  std::mt19937 random(12);
  for (unsigned set = 0; set < cases(100U); ++set) {
    const double arc = set % 3 == 0 ? 1.2 * kPi : 2 * kPi;
    const Points points = noisy_profile(8 + random() % 4, 1.0, 0.2, set, arc);
    double best = 0;
    const auto consider = [&](const Vector2d& center) {
      if (in_hull(points, center)) {
        double radius = std::numeric_limits<double>::infinity();
        for (const Vector2d& point : points) {
          radius = std::fmin(radius, (point - center).norm());
        }
        best = std::fmax(best, radius);
      }
    };
    for (const Vector2d& center : all_bisector_crossings(points)) {
      consider(center);
    }
    // On the hull's border: a bisector against the line through any two points.
    for (const Vector2d& a : points) {
      for (const Vector2d& b : points) {
        for (const Vector2d& p : points) {
          for (const Vector2d& q : points) {
            const Vector2d d = q - p;
            Vector2d at;
            if (a != b && p != q && meets(a, b - a, (p + q) / 2, Vector2d(-d.y(), d.x()), &at)) {
              consider(at);
            }
          }
        }
      }
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, best, maximum_inscribed_circularity(points).r_min);
  }
}

void circumscribed_circle_agrees_with_cgal() {
  using Sphere = CGAL::Min_sphere_d<
      CGAL::Min_sphere_annulus_d_traits_2<CGAL::Simple_cartesian<CGAL::Exact_rational>>>;
  for (unsigned set = 0; set < 30; ++set) {
    const Points points = noisy_profile(40, 0.1, set % 2 == 0 ? 1e-4 : 0.05, set);
    std::vector<CGAL::Simple_cartesian<CGAL::Exact_rational>::Point_2> exact;
    for (const Vector2d& point : points) {
      exact.emplace_back(point.x(), point.y());
    }
    const Sphere sphere(exact.begin(), exact.end());
    TEST_ASSERT_DOUBLE_WITHIN(1e-14, std::sqrt(CGAL::to_double(sphere.squared_radius())),
                              minimum_circumscribed_circularity(points).r_max);
  }
}

/// CGAL's annulus has the least difference of squared radii: the minimum zone where the form error
/// is small against the radius.
void minimum_zone_agrees_with_cgal_at_small_form_error() {
  using Exact = CGAL::Simple_cartesian<CGAL::Exact_rational>;
  using Annulus = CGAL::Min_annulus_d<CGAL::Min_sphere_annulus_d_traits_2<Exact>>;
  for (unsigned set = 0; set < 10; ++set) {
    const Points points = noisy_profile(36, 0.1, 1e-6, set);
    std::vector<Exact::Point_2> exact;
    for (const Vector2d& point : points) {
      exact.emplace_back(point.x(), point.y());
    }
    const Annulus annulus(exact.begin(), exact.end());
    const double width = std::sqrt(CGAL::to_double(annulus.squared_outer_radius())) -
                         std::sqrt(CGAL::to_double(annulus.squared_inner_radius()));
    TEST_ASSERT_DOUBLE_WITHIN(1e-4 * width, width, minimum_zone_circularity(points).value());
  }
}

void moving_turning_scaling_and_repeating_points_changes_nothing_else() {
  const Points points = noisy_profile(60, 0.1, 5e-6, 7);
  const Eigen::Rotation2D<double> turn(0.7);
  Points moved;
  for (const Vector2d& point : points) {
    moved.push_back(turn * point + Vector2d(1000, -2000));
    moved.push_back(moved.back());
  }
  std::shuffle(moved.begin(), moved.end(), std::mt19937(2));
  Points scaled;
  for (const Vector2d& point : points) {
    scaled.push_back(1024 * point);
  }
  for (const Method method : kMethods) {
    const double value = method(points).value();
    // Coordinates near 2 km resolve 2e-13 m.
    TEST_ASSERT_DOUBLE_WITHIN(2e-12, value, method(moved).value());
    TEST_ASSERT_DOUBLE_WITHIN(1e-10 * value, 1024 * value, method(scaled).value());
  }
}

void the_order_of_the_zones_holds() {
  for (unsigned set = 0; set < 50; ++set) {
    const Points points = noisy_profile(100, 1.0, 0.05, set);
    const double zone = minimum_zone_circularity(points).value();
    for (const Method method : kMethods) {
      TEST_ASSERT_TRUE(zone <= method(points).value() * (1 + 1e-12));
    }
    TEST_ASSERT_TRUE(minimum_circumscribed_circularity(points).r_max <=
                     minimum_zone_circularity(points).r_max * (1 + 1e-12));
    TEST_ASSERT_TRUE(maximum_inscribed_circularity(points).r_min >=
                     minimum_zone_circularity(points).r_min * (1 - 1e-12));
  }
}

void arcs_are_measured_as_well() {
  const Points points = profile(
      90, 0.1, [](double angle) { return 1e-5 * std::cos(12 * angle); }, kPi / 2);
  TEST_ASSERT_TRUE(minimum_zone_circularity(points).value() <= 2e-5);
  TEST_ASSERT_TRUE(minimum_zone_circularity(points).value() > 1e-5);
  TEST_ASSERT_DOUBLE_WITHIN(1e-5, 0.1, least_squares_circularity(points).r_min + 1e-5);
}

void points_of_a_short_arc_lie_in_a_zone_of_no_width() {
  for (const double arc : {0.02, 0.2, 0.5, 0.8, 1.5}) {
    for (const std::size_t count : {3U, 4U, 5U, 30U}) {
      const Points points = profile(
          count, 1.0, [](double) { return 0; }, arc);
      TEST_ASSERT_DOUBLE_WITHIN(1e-11, 0, minimum_zone_circularity(points).value());
    }
  }
}

void a_million_points_are_no_trouble() {
  const Points points = noisy_profile(1000000, 0.1, 1e-5, 9);
  for (const Method method : kMethods) {
    const double value = method(points).value();
    TEST_ASSERT_TRUE(value > 1.9e-5 && value < 2.1e-5);
  }
}

bool refuses(Method method, const Points& points) {
  try {
    method(points);
    return false;
  } catch (const InputError&) {
    return true;
  }
}

bool is_refused(const Points& points) {
  return std::all_of(std::begin(kMethods), std::end(kMethods),
                     [&](Method method) { return refuses(method, points); });
}

/// Its corners are numbers that a double holds exactly, eight units in the last place apart.
void a_triangle_far_from_the_origin_is_no_line() {
  for (const double offset : {0.0, 1.0, 1e6, 1e12, 1e15, -1e15}) {
    const Points triangle = {
        {offset, offset}, {offset + 1, offset}, {offset, offset + 1}, {offset, offset}};
    for (const Method method : kMethods) {
      const Circularity circle = method(triangle);
      TEST_ASSERT_DOUBLE_WITHIN(1e-9, std::sqrt(0.5), circle.r_max);
      TEST_ASSERT_DOUBLE_WITHIN(0.13, offset + 0.5, circle.center.x());
    }
  }
}

std::string refusal(const Points& points) {
  try {
    minimum_zone_circularity(points);
    return "accepted";
  } catch (const InputError& error) {
    return error.what();
  }
}

void a_line_of_rounded_coordinates_is_one() {
  const char* const line = "points on a line have no reference circle";
  for (const double slope : {0.1, 0.3, -0.7, 3.3}) {
    for (const double offset : {0.0, 0.1, 1000.1, 1e6 + 0.3}) {
      Points points;
      for (int i = 0; i < 20; ++i) {
        points.emplace_back(offset + 0.1 * i, offset * slope + slope * 0.1 * i);
      }
      TEST_ASSERT_EQUAL_STRING(line, refusal(points).c_str());
    }
  }
}

void points_whose_digits_do_not_tell_are_refused_as_such() {
  const double unit = 0.125;  // the last place at 1e15
  const Points points = {{1e15, 1e15}, {1e15 + unit, 1e15}, {1e15, 1e15 + unit}};
  const std::string message = refusal(points);
  TEST_ASSERT_TRUE_MESSAGE(
      message.find("do not tell whether the points lie on a line") != std::string::npos,
      message.c_str());
}

void points_without_a_reference_circle_are_refused() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  TEST_ASSERT_TRUE(is_refused({}));
  TEST_ASSERT_TRUE(is_refused({{0, 0}, {1, 1}}));
  TEST_ASSERT_TRUE(is_refused({{0, 0}, {1, 1}, {0, 0}, {1, 1}}));
  TEST_ASSERT_TRUE(is_refused({{1, 2}, {1, 2}, {1, 2}}));
  TEST_ASSERT_TRUE(is_refused({{0, 0}, {1, 1}, {2, 2}, {5, 5}}));
  TEST_ASSERT_TRUE(is_refused({{1000, 1000}, {1000.1, 1000.1}, {1000.3, 1000.3}}));
  TEST_ASSERT_TRUE(is_refused({{0, 0}, {1, 0}, {nan, 1}}));
  TEST_ASSERT_TRUE(is_refused({{-1e308, 0}, {1e308, 0}, {0, 1e308}}));
  TEST_ASSERT_TRUE(is_refused({{-1e200, 0}, {1e200, 0}, {0, 1e200}}));
  TEST_ASSERT_TRUE(is_refused({{-1e-200, 0}, {1e-200, 0}, {0, 1e-200}}));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(the_reference_circles_come_out_in_all_four_methods);
  RUN_TEST(points_on_a_circle_have_no_form_error);
  RUN_TEST(three_lobes_are_twice_their_amplitude);
  RUN_TEST(an_ellipse_is_as_wide_as_its_half_axes_differ);
  RUN_TEST(the_contacts_of_the_minimum_zone_alternate);
  RUN_TEST(no_small_step_of_the_centre_improves_least_squares);
  RUN_TEST(minimum_zone_is_the_best_of_all_candidates);
  RUN_TEST(inscribed_circle_is_the_largest_of_all_candidates);
  RUN_TEST(circumscribed_circle_agrees_with_cgal);
  RUN_TEST(minimum_zone_agrees_with_cgal_at_small_form_error);
  RUN_TEST(moving_turning_scaling_and_repeating_points_changes_nothing_else);
  RUN_TEST(the_order_of_the_zones_holds);
  RUN_TEST(arcs_are_measured_as_well);
  RUN_TEST(points_of_a_short_arc_lie_in_a_zone_of_no_width);
  RUN_TEST(a_million_points_are_no_trouble);
  RUN_TEST(a_triangle_far_from_the_origin_is_no_line);
  RUN_TEST(a_line_of_rounded_coordinates_is_one);
  RUN_TEST(points_whose_digits_do_not_tell_are_refused_as_such);
  RUN_TEST(points_without_a_reference_circle_are_refused);
  return UNITY_END();
}
