// How large the numbers of a kind are: against numbers drawn from a known width.
#include <Eigen/Cholesky>
#include <cmath>
#include <random>

#include "diagnosis/families/widths.hpp"
#include "unity_main.hpp"

using Eigen::MatrixXd;
using Eigen::VectorXd;
using flexcomp::diagnosis::learn_widths;
using flexcomp::diagnosis::NormalEquations;

namespace {

constexpr Eigen::Index kSamples = 400;
constexpr Eigen::Index kNumbers = 24;
constexpr double kNoise = 0.1;

double draw() {
  static std::mt19937 engine(7);
  static std::normal_distribution<double> normal;
  return normal(engine);
}

MatrixXd drawn(Eigen::Index rows, Eigen::Index columns) {
  return MatrixXd::NullaryExpr(rows, columns, [] { return draw(); });
}

/// Normal equations of measurements of numbers, with noise.
NormalEquations measured(const MatrixXd& columns, const VectorXd& numbers) {
  const VectorXd seen = columns * numbers + kNoise * drawn(columns.rows(), 1);
  return {columns.transpose() * columns, columns.transpose() * seen, kNoise * kNoise};
}

const std::vector<std::size_t> kOneKind(static_cast<std::size_t>(kNumbers), 0);

void numbers_show_how_large_they_are() {
  const VectorXd numbers = 0.05 * drawn(kNumbers, 1);
  const VectorXd width = learn_widths(measured(drawn(kSamples, kNumbers), numbers),
                                      VectorXd::Ones(kNumbers), kOneKind);
  const double size = std::sqrt(numbers.squaredNorm() / kNumbers);
  TEST_ASSERT_DOUBLE_WITHIN(0.05 * size, size, width[0]);
  TEST_ASSERT_EQUAL_DOUBLE(width[0], width[kNumbers - 1]);
}

void kinds_have_widths_of_their_own() {
  VectorXd numbers = drawn(kNumbers, 1);
  numbers.head(kNumbers / 2) *= 0.02;
  std::vector<std::size_t> kind = kOneKind;
  std::fill(kind.begin() + kNumbers / 2, kind.end(), 1);
  const VectorXd width =
      learn_widths(measured(drawn(kSamples, kNumbers), numbers), VectorXd::Ones(kNumbers), kind);
  TEST_ASSERT_TRUE(width[0] < 0.05);
  TEST_ASSERT_TRUE(width[kNumbers - 1] > 0.5);
}

void the_ratios_within_a_kind_stay() {
  VectorXd usual = VectorXd::Ones(kNumbers);
  usual[3] = 7;
  const VectorXd numbers = 0.3 * usual.cwiseProduct(drawn(kNumbers, 1));
  const VectorXd width =
      learn_widths(measured(drawn(kSamples, kNumbers), numbers), usual, kOneKind);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 7 * width[0], width[3]);
}

void two_numbers_that_only_their_sum_shows_do_not_become_large_against_each_other() {
  const VectorXd numbers = 0.05 * drawn(kNumbers, 1);
  MatrixXd columns = drawn(kSamples, kNumbers);
  columns.col(1) = -columns.col(0) + 1e-3 * drawn(kSamples, 1);
  const NormalEquations equations = measured(columns, numbers);
  const VectorXd width = learn_widths(equations, VectorXd::Ones(kNumbers), kOneKind);
  MatrixXd inner = equations.gram / equations.variance;
  inner.diagonal() += width.cwiseAbs2().cwiseInverse();
  const VectorXd value = inner.ldlt().solve(equations.moment / equations.variance);
  TEST_ASSERT_TRUE(value.head(2).norm() < 0.2);
}

void nothing_is_held_closer_than_a_hundredth_of_what_is_usual() {
  const VectorXd width = learn_widths(measured(drawn(kSamples, kNumbers), VectorXd::Zero(kNumbers)),
                                      VectorXd::Constant(kNumbers, 1000), kOneKind);
  TEST_ASSERT_EQUAL_DOUBLE(10, width[0]);
}

void nothing_is_held_more_loosely_than_is_usual() {
  const VectorXd numbers = 50 * drawn(kNumbers, 1);
  const VectorXd width = learn_widths(measured(drawn(kSamples, kNumbers), numbers),
                                      VectorXd::Ones(kNumbers), kOneKind);
  TEST_ASSERT_EQUAL_DOUBLE(1, width[0]);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(numbers_show_how_large_they_are);
  RUN_TEST(kinds_have_widths_of_their_own);
  RUN_TEST(the_ratios_within_a_kind_stay);
  RUN_TEST(two_numbers_that_only_their_sum_shows_do_not_become_large_against_each_other);
  RUN_TEST(nothing_is_held_closer_than_a_hundredth_of_what_is_usual);
  RUN_TEST(nothing_is_held_more_loosely_than_is_usual);
  return UNITY_END();
}
