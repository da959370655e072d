#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "study/selection.hpp"
#include "unity_main.hpp"

using namespace flexcomp::study;

namespace {

/// |F_C| of the study.
const double kStudyForce = std::sqrt(440.0 * 440 + 1370.0 * 1370 + 635.0 * 635);

/// Klimchik et al. (2017): minima of table 3, payloads of table 2.
std::vector<Candidate> published_robots() {
  constexpr double kGravity = 9.81;
  return {{"KR100", 1.03e-3, kStudyForce, 100 * kGravity},
          {"KR270", 0.84e-3, kStudyForce, 270 * kGravity},
          {"KR360", 1.02e-3, kStudyForce, 360 * kGravity},
          {"KR500", 0.41e-3, kStudyForce, 500 * kGravity}};
}

using Names = std::set<std::string>;

struct Row {
  double circularity;
  std::array<Names, 4> robots;  ///< at 500, 1000, 2000 and 3000 N
};

const Names kAll = {"KR100", "KR270", "KR360", "KR500"};

/// Table 4 of the paper.
const std::vector<Row>& published_table() {
  static const std::vector<Row> rows = {
      {0.2e-3, {Names{"KR500"}, {}, {}, {}}},
      {0.5e-3, {kAll, {"KR270", "KR500"}, {"KR500"}, {}}},
      {1.0e-3, {kAll, kAll, {"KR270", "KR360", "KR500"}, {"KR500"}}},
      {1.5e-3, {kAll, kAll, {"KR270", "KR360", "KR500"}, {"KR500"}}},
      {2.0e-3, {kAll, kAll, {"KR270", "KR360", "KR500"}, {"KR360", "KR500"}}},
  };
  return rows;
}

/// The one that differs: by the paper's own minimum the KR 360 has 1.30 mm at 2000 N, yet it is
/// listed at 1.0 mm.
void the_published_minima_give_79_of_the_80_cells_of_the_published_table() {
  const std::array<double, 4> forces = {500, 1000, 2000, 3000};
  const Tolerance tolerance = {0.07, 0.02};  // 981 N count as 1000 N
  int agreeing = 0;
  std::string missed;
  for (const Row& row : published_table()) {
    for (std::size_t f = 0; f < forces.size(); ++f) {
      for (const Candidate& robot : published_robots()) {
        const bool ours = suits(robot, forces[f], row.circularity, tolerance);
        const bool theirs = row.robots[f].count(robot.name) > 0;
        agreeing += ours == theirs ? 1 : 0;
        if (ours != theirs) {
          missed = robot.name + " at " + std::to_string(static_cast<int>(forces[f])) + " N, " +
                   std::to_string(static_cast<int>(1e6 * row.circularity)) + " µm";
        }
      }
    }
  }
  TEST_ASSERT_EQUAL_MESSAGE(79, agreeing, missed.c_str());
  TEST_ASSERT_EQUAL_STRING("KR360 at 2000 N, 1000 µm", missed.c_str());
}

void circularity_grows_with_the_force() {
  const Candidate robot = published_robots()[3];
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.41e-3, circularity_at(robot, kStudyForce));
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.82e-3, circularity_at(robot, 2 * kStudyForce));
}

void a_robot_that_cannot_bear_the_force_does_not_suit() {
  Candidate robot{"stiff", 1e-6, 1000, 900};
  TEST_ASSERT_FALSE(suits(robot, 1000, 1e-3));
  robot.largest_load = std::numeric_limits<double>::infinity();
  TEST_ASSERT_TRUE(suits(robot, 1000, 1e-3));
}

void without_tolerance_a_limit_is_a_limit() {
  const Candidate robot{"any", 1.01e-3, 1000, 5000};
  TEST_ASSERT_FALSE(suits(robot, 1000, 1e-3));
  TEST_ASSERT_TRUE(suits(robot, 1000, 1e-3, {0.02, 0}));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(the_published_minima_give_79_of_the_80_cells_of_the_published_table);
  RUN_TEST(circularity_grows_with_the_force);
  RUN_TEST(a_robot_that_cannot_bear_the_force_does_not_suit);
  RUN_TEST(without_tolerance_a_limit_is_a_limit);
  return UNITY_END();
}
