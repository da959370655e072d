/// Four sources of the core are compiled for wider vector registers (AVX) than the library that
/// they are linked with, as where a customer builds one part with -march=native. Both must agree
/// where in their matrices a number lies. This file is compiled like those four.
#include <vector>

#include "core/test_robots.hpp"
#include "flexcomp/table_builder.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

constexpr double kTurn = 6.28318530717958647692;
constexpr int kPieces = 120;

template <typename Scalar>
std::vector<JointVector<Scalar, 6>> program() {
  std::vector<JointVector<Scalar, 6>> points;
  for (int i = 0; i <= kPieces; ++i) {
    points.push_back(test::loop_angles<Scalar>(kTurn * (i % kPieces) / kPieces));
  }
  return points;
}

/// Built by the library, read by what is compiled otherwise.
template <typename Scalar>
void build_and_look_up(const RobotModel<Scalar, 6>& model, Scalar tolerance) {
  const auto points = program<Scalar>();
  std::vector<std::uint32_t> words(1 << 16);
  std::size_t size = 0;
  TEST_ASSERT_EQUAL(
      Result::ok, (build_path_table<Scalar, 6>(model, points.data(), points.size(),
                                               {Scalar(1600), Scalar(20), tolerance, tolerance, 0},
                                               words.data(), 4 * words.size(), &size)));
  Table table;
  TEST_ASSERT_EQUAL(Result::ok, Table::open(words.data(), size, &table));
  const auto certified = static_cast<Scalar>(table.header().position_error);
  Wrench<Scalar> wrench;
  wrench << 440, 1370, 635, 0, 3, Scalar(10.5);
  TableCursor cursor;
  locate<Scalar, 6>(table, points[0], &cursor);
  for (const JointVector<Scalar, 6>& q : points) {
    const TableEntry<Scalar, 6> entry = look_up<Scalar, 6>(table, q, &cursor);
    TEST_ASSERT_TRUE(entry.outside == Scalar(0));
    TEST_ASSERT_EQUAL(0, cursor.searched);
    const Twist<Scalar> exact = deflection<Scalar, 6>(model, q, wrench).tcp;
    const Twist<Scalar> read = respond<Scalar, 6>(table, entry, wrench).deflection;
    TEST_ASSERT_TRUE((read - exact).template head<3>().norm() <= certified);
  }
}

void tables_are_read_as_they_were_built() {
  build_and_look_up<double>(test::kr270_with_everything<double>(), 5e-6);
  build_and_look_up<float>(test::kr270<float>(), 2e-6F);
}

}  // namespace

int main() {
  if (__builtin_cpu_supports("avx") == 0) {
    return 77;
  }
  UNITY_BEGIN();
  RUN_TEST(tables_are_read_as_they_were_built);
  return UNITY_END();
}
