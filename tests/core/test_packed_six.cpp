#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "packed_six.hpp"
#include "unity_main.hpp"

using flexcomp::PackedSix;

namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

template <typename Scalar>
using Numbers = Eigen::Matrix<Scalar, 6, 1>;

template <typename Scalar>
Numbers<Scalar> any(std::mt19937* random) {
  std::uniform_real_distribution<Scalar> between(-10, 10);
  return Numbers<Scalar>::NullaryExpr([&] { return between(*random); });
}

template <typename Scalar>
void expect_near(const Numbers<Scalar>& expected, const Numbers<Scalar>& found) {
  constexpr Scalar kUnits = 4 * std::numeric_limits<Scalar>::epsilon();
  TEST_ASSERT_TRUE((found - expected).norm() <= kUnits * expected.norm());
}

template <typename Scalar>
void try_arithmetic() {
  std::mt19937 random(1);
  for (int round = 0; round < 100; ++round) {
    const Numbers<Scalar> a = any<Scalar>(&random);
    const Numbers<Scalar> b = any<Scalar>(&random);
    const PackedSix<Scalar> p(a);
    const PackedSix<Scalar> q(b);
    expect_near<Scalar>(a + b, (p + q).numbers());
    expect_near<Scalar>(a - b, (p - q).numbers());
    expect_near<Scalar>(Scalar(0.3) * a, (Scalar(0.3) * p).numbers());
    expect_near<Scalar>(a.cwiseProduct(b), (p * q).numbers());
    expect_near<Scalar>(-a, (-p).numbers());
    const auto scale = static_cast<double>((a.cwiseAbs()).dot(b.cwiseAbs()));
    constexpr auto kUnits = 4 * static_cast<double>(std::numeric_limits<Scalar>::epsilon());
    TEST_ASSERT_DOUBLE_WITHIN(kUnits * scale, static_cast<double>(a.dot(b)),
                              static_cast<double>(p.dot(q)));
    TEST_ASSERT_TRUE(p.largest_magnitude() == a.cwiseAbs().maxCoeff());
  }
}

void arithmetic_is_that_of_vectors() {
  try_arithmetic<float>();
  try_arithmetic<double>();
}

void four_products_are_those_of_their_pairs() {
#ifdef FLEXCOMP_VECTOR_REGISTERS
  std::mt19937 random(3);
  for (int round = 0; round < 100; ++round) {
    const Numbers<float> a = any<float>(&random), b = any<float>(&random);
    const Numbers<float> c = any<float>(&random), d = any<float>(&random);
    using Six = PackedSix<float>;
    const std::array<float, 4> dots = Six::dots(Six(a), {Six(b), Six(c)}, Six(d), {Six(b), Six(a)});
    const std::array<float, 4> expected = {a.dot(b), a.dot(c), d.dot(b), d.dot(a)};
    const float norm = std::max(a.norm(), d.norm()) * std::max({a.norm(), b.norm(), c.norm()});
    for (std::size_t i = 0; i < 4; ++i) {
      TEST_ASSERT_TRUE(std::abs(dots[i] - expected[i]) <= 1e-6F * norm);
    }
  }
#else
  TEST_IGNORE_MESSAGE("there are no vector registers: they are computed one by one");
#endif
}

void nothing_but_six_floats_is_read() {
  const std::vector<float> floats = {1, 2, 3, 4, 5, 6};  // the address sanitizer watches its ends
  expect_near<float>({1, 2, 3, 4, 5, 6}, PackedSix<float>::read(floats.data()).numbers());
  expect_near<double>({1, 2, 3, 4, 5, 6}, PackedSix<double>::read(floats.data()).numbers());
}

template <typename Scalar>
void try_each_place() {
  const Numbers<Scalar> low = Numbers<Scalar>::Constant(-1);
  const Numbers<Scalar> high = Numbers<Scalar>::Constant(2);
  const auto is_within = [&](const Numbers<Scalar>& numbers) {
    return PackedSix<Scalar>(numbers).is_within(PackedSix<Scalar>(low), PackedSix<Scalar>(high));
  };
  TEST_ASSERT_TRUE(is_within(low));
  TEST_ASSERT_TRUE(is_within(high));
  for (Eigen::Index place = 0; place < 6; ++place) {
    for (const float odd : {kNaN, kInfinity, -kInfinity, -1.0001F, 2.0001F}) {
      Numbers<Scalar> numbers = Numbers<Scalar>::Ones();
      numbers[place] = static_cast<Scalar>(odd);
      const PackedSix<Scalar> six(numbers);
      TEST_ASSERT_EQUAL(std::isfinite(odd), six.is_finite());
      TEST_ASSERT_FALSE(is_within(numbers));
      const float most = std::isnan(odd) ? kInfinity : std::max(1.0F, std::abs(odd));
      TEST_ASSERT_TRUE(six.largest_magnitude() == static_cast<Scalar>(most));
      TEST_ASSERT_FALSE(six.is_within(Scalar(1)));
      TEST_ASSERT_EQUAL(!std::isnan(odd), six.is_within(static_cast<Scalar>(most)));
    }
  }
}

void each_number_counts() {
  try_each_place<float>();
  try_each_place<double>();
}

void without_numbers_all_are_zero() {
  TEST_ASSERT_TRUE(PackedSix<float>().numbers().isZero(0));
  TEST_ASSERT_TRUE(PackedSix<double>().numbers().isZero(0));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(arithmetic_is_that_of_vectors);
  RUN_TEST(four_products_are_those_of_their_pairs);
  RUN_TEST(nothing_but_six_floats_is_read);
  RUN_TEST(each_number_counts);
  RUN_TEST(without_numbers_all_are_zero);
  return UNITY_END();
}
