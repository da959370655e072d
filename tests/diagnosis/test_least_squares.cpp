// Least squares within a box: against closed forms, and against every choice of bounds tried.
#include <Eigen/QR>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "diagnosis/least_squares.hpp"
#include "unity_main.hpp"

using Eigen::MatrixXd;
using Eigen::VectorXd;
using flexcomp::diagnosis::Box;
using flexcomp::diagnosis::least_squares;
using flexcomp::diagnosis::Quadratic;
using flexcomp::diagnosis::Steps;
using flexcomp::diagnosis::SumOfSquares;

namespace {

constexpr Steps kEnough{200, 1e-14};
const double kFree = std::numeric_limits<double>::infinity();

/// A remainder and its slope as functions of the numbers; no value where the remainder is none.
class Problem : public SumOfSquares {
 public:
  using Remainder = std::function<VectorXd(const VectorXd&)>;
  using Slope = std::function<MatrixXd(const VectorXd&)>;

  Problem(Remainder remainder, Slope slope)
      : remainder_(std::move(remainder)), slope_(std::move(slope)) {}

  std::optional<double> half(const VectorXd& numbers) override {
    const VectorXd left = remainder_(numbers);
    return left.size() > 0 ? std::make_optional(0.5 * left.squaredNorm()) : std::nullopt;
  }

  std::optional<Quadratic> quadratic(const VectorXd& numbers) override {
    ++slopes;
    const VectorXd left = remainder_(numbers);
    if (left.size() == 0) {
      return std::nullopt;
    }
    const MatrixXd slope = slope_(numbers);
    return Quadratic{0.5 * left.squaredNorm(), slope.transpose() * left, slope.transpose() * slope};
  }

  int slopes = 0;  ///< that were asked for

 private:
  Remainder remainder_;
  Slope slope_;
};

Problem straight(const MatrixXd& matrix, const VectorXd& target) {
  return {[=](const VectorXd& x) { return VectorXd(matrix * x - target); },
          [=](const VectorXd& /*x*/) { return matrix; }};
}

/// Rosenbrock's valley, whose bottom is at one and one.
Problem valley() {
  return {[](const VectorXd& x) {
            return VectorXd(Eigen::Vector2d(10 * (x[1] - x[0] * x[0]), 1 - x[0]));
          },
          [](const VectorXd& x) {
            return MatrixXd((Eigen::Matrix2d() << -20 * x[0], 10, -1, 0).finished());
          }};
}

Box box(Eigen::Index count, double lower, double upper) {
  return {VectorXd::Constant(count, lower), VectorXd::Constant(count, upper)};
}

MatrixXd drawn(Eigen::Index rows, Eigen::Index columns, std::mt19937* engine) {
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(*engine); });
}

/// The least sum of squares in a cube about zero, of all choices which numbers are at which bound.
double least_by_trial(const MatrixXd& matrix, const VectorXd& target, double bound) {
  const auto count = static_cast<int>(matrix.cols());
  const auto choices = static_cast<int>(std::lround(std::pow(3, count)));
  double least = std::numeric_limits<double>::infinity();
  for (int choice = 0; choice < choices; ++choice) {
    VectorXd x = VectorXd::Zero(count);
    std::vector<int> free;
    for (int i = 0, rest = choice; i < count; ++i, rest /= 3) {
      if (rest % 3 == 0) {
        free.push_back(i);
      } else {
        x[i] = rest % 3 == 1 ? -bound : bound;
      }
    }
    if (!free.empty()) {
      const VectorXd left = target - matrix * x;
      x(free) = matrix(Eigen::all, free).colPivHouseholderQr().solve(left);
    }
    if (x.cwiseAbs().maxCoeff() <= bound) {
      least = std::min(least, 0.5 * (matrix * x - target).squaredNorm());
    }
  }
  return least;
}

void a_straight_problem_takes_two_slopes() {
  std::mt19937 engine(3);
  const MatrixXd matrix = drawn(30, 6, &engine);
  const VectorXd target = drawn(30, 1, &engine);
  Problem problem = straight(matrix, target);
  const VectorXd found =
      least_squares(&problem, box(6, -kFree, kFree), VectorXd::Zero(6), {50, 1e-9});
  const VectorXd expected = matrix.colPivHouseholderQr().solve(target);
  TEST_ASSERT_TRUE((found - expected).norm() < 1e-5 * expected.norm());
  TEST_ASSERT_LESS_OR_EQUAL_INT(2, problem.slopes);
}

void within_a_box_no_choice_of_bounds_does_better() {
  std::mt19937 engine(5);
  for (int trial = 0; trial < 40; ++trial) {
    constexpr double kBound = 0.3;
    const MatrixXd matrix = drawn(8, 5, &engine);
    const VectorXd target = drawn(8, 1, &engine);
    Problem problem = straight(matrix, target);
    const VectorXd found =
        least_squares(&problem, box(5, -kBound, kBound), VectorXd::Zero(5), kEnough);
    TEST_ASSERT_TRUE(found.cwiseAbs().maxCoeff() <= kBound);
    const double least = least_by_trial(matrix, target, kBound);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6 * least, least, *problem.half(found));
  }
}

void numbers_at_their_bounds_do_not_slow_the_others() {
  std::mt19937 engine(9);
  MatrixXd matrix = drawn(40, 8, &engine);
  matrix.col(7) = matrix.col(6) + 1e-3 * matrix.col(7);  // two that are hard to tell apart
  VectorXd wanted = VectorXd::Ones(8);
  wanted.head(4).setConstant(-1);  // beyond the bounds
  Problem problem = straight(matrix, matrix * wanted);
  least_squares(&problem, box(8, 0, kFree), VectorXd::Zero(8), {50, 1e-9});
  TEST_ASSERT_LESS_OR_EQUAL_INT(8, problem.slopes);
}

void a_curved_valley_is_followed_to_its_end() {
  Problem problem = valley();
  const VectorXd found =
      least_squares(&problem, box(2, -kFree, kFree), Eigen::Vector2d(-1.2, 1), kEnough);
  TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1, found[0]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1, found[1]);
}

void a_curved_valley_is_followed_to_a_bound() {
  Problem problem = valley();
  const VectorXd found =
      least_squares(&problem, box(2, -2, 0.5), Eigen::Vector2d(-1.2, 0.5), kEnough);
  TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.5, found[0]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.25, found[1]);
}

void a_number_that_changes_nothing_stays() {
  MatrixXd matrix = MatrixXd::Identity(3, 3);
  matrix.col(1).setZero();
  Problem problem = straight(matrix, VectorXd::Ones(3));
  const VectorXd found =
      least_squares(&problem, box(3, -kFree, kFree), VectorXd::Constant(3, 0.7), kEnough);
  TEST_ASSERT_EQUAL_DOUBLE(0.7, found[1]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1, found[0]);
}

void it_goes_on_to_the_edge_of_where_there_is_a_value() {
  Problem problem([](const VectorXd& x) { return x[0] > 1 ? VectorXd() : VectorXd(x.array() - 2); },
                  [](const VectorXd& /*x*/) { return MatrixXd::Ones(1, 1); });
  const VectorXd found = least_squares(&problem, box(1, -kFree, kFree), VectorXd::Zero(1), kEnough);
  TEST_ASSERT_TRUE(found[0] <= 1);
  TEST_ASSERT_TRUE(found[0] > 0.9);
}

void without_a_value_it_stays_where_it_is() {
  Problem problem([](const VectorXd& /*x*/) { return VectorXd(); },
                  [](const VectorXd& /*x*/) { return MatrixXd(); });
  const VectorXd found =
      least_squares(&problem, box(1, -kFree, kFree), VectorXd::Constant(1, 0.3), kEnough);
  TEST_ASSERT_EQUAL_DOUBLE(0.3, found[0]);
}

void no_more_steps_are_taken_than_asked_for() {
  Problem problem = valley();
  least_squares(&problem, box(2, -kFree, kFree), Eigen::Vector2d(-1.2, 1), {3, 0});
  TEST_ASSERT_EQUAL_INT(3, problem.slopes);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_straight_problem_takes_two_slopes);
  RUN_TEST(within_a_box_no_choice_of_bounds_does_better);
  RUN_TEST(numbers_at_their_bounds_do_not_slow_the_others);
  RUN_TEST(a_curved_valley_is_followed_to_its_end);
  RUN_TEST(a_curved_valley_is_followed_to_a_bound);
  RUN_TEST(a_number_that_changes_nothing_stays);
  RUN_TEST(it_goes_on_to_the_edge_of_where_there_is_a_value);
  RUN_TEST(without_a_value_it_stays_where_it_is);
  RUN_TEST(no_more_steps_are_taken_than_asked_for);
  return UNITY_END();
}
