#include <random>
#include <vector>

#include "packed_columns.hpp"
#include "unity_main.hpp"

using flexcomp::PackedColumns;
using flexcomp::PackedSix;

namespace {

template <typename Scalar>
using Numbers = Eigen::Matrix<Scalar, 6, 1>;
using Matrix = Eigen::Matrix<float, 6, 6>;  // column after column, as in a table

Matrix any_matrix(std::mt19937* random) {
  std::uniform_real_distribution<float> between(-10, 10);
  return Matrix::NullaryExpr([&] { return between(*random); });
}

/// Aᵀ b and A f(Aᵀ b), f of which doubles each number.
template <typename Scalar>
struct Products {
  Products(const PackedColumns<Scalar>& columns, const Numbers<Scalar>& b) {
    PackedSix<Scalar> mapped;
    product = columns.product_of(
        PackedSix<Scalar>(b), [](std::size_t /*lane*/, auto lane) { return lane + lane; }, &mapped);
    doubled = mapped;
  }

  PackedSix<Scalar> doubled;
  PackedSix<Scalar> product;
};

/// A blend of two matrices and its transpose, times a vector, beside what Eigen makes of them.
template <typename Scalar>
void try_products() {
  std::mt19937 random(2);
  for (int round = 0; round < 100; ++round) {
    const Matrix from = any_matrix(&random);
    const Matrix to = any_matrix(&random);
    const Numbers<Scalar> b = any_matrix(&random).col(0).template cast<Scalar>();
    const Scalar t = Scalar(0.01) * static_cast<Scalar>(round);
    const auto columns = PackedColumns<Scalar>::blend(from.data(), to.data(), t);
    const Eigen::Matrix<Scalar, 6, 6> matrix =
        (Scalar(1) - t) * from.template cast<Scalar>() + t * to.template cast<Scalar>();
    const Scalar units = 16 * std::numeric_limits<Scalar>::epsilon() * b.norm() *
                         static_cast<Scalar>(from.norm() + to.norm());
    const Products<Scalar> found(columns, b);
    const Numbers<Scalar> doubled = 2 * matrix.transpose() * b;
    TEST_ASSERT_TRUE((found.doubled.numbers() - doubled).norm() <= 2 * units);
    TEST_ASSERT_TRUE((found.product.numbers() - matrix * doubled).norm() <=
                     4 * units * matrix.norm());
  }
}

void columns_multiply_as_a_matrix_and_its_transpose() {
  try_products<float>();
  try_products<double>();
}

/// Each place of the matrix by itself, so that none can stand in for another.
template <typename Scalar>
void try_each_place() {
  for (Eigen::Index place = 0; place < 36; ++place) {
    Matrix matrix = Matrix::Zero();
    matrix.data()[place] = 3;
    const auto columns = PackedColumns<Scalar>::blend(matrix.data(), matrix.data(), Scalar(0.5));
    const Numbers<Scalar> b = {1, 2, 3, 4, 5, 6};
    const Products<Scalar> found(columns, b);
    const Eigen::Matrix<Scalar, 6, 6> exact = matrix.template cast<Scalar>();
    const Numbers<Scalar> doubled = 2 * exact.transpose() * b;
    TEST_ASSERT_TRUE(found.doubled.numbers() == doubled);
    TEST_ASSERT_TRUE(found.product.numbers() == exact * doubled);
  }
}

void each_place_counts() {
  try_each_place<float>();
  try_each_place<double>();
}

/// Numbers behind the six in a register must be zero: products and norms of the six would
/// otherwise count it.
template <typename Scalar>
void try_norms() {
  std::mt19937 random(4);
  const Matrix matrix = any_matrix(&random);
  const auto columns = PackedColumns<Scalar>::blend(matrix.data(), matrix.data(), Scalar(0));
  const Products<Scalar> found(columns, Numbers<Scalar>::Ones());
  for (const PackedSix<Scalar>& six : {found.doubled, found.product}) {
    const Scalar squares = six.numbers().squaredNorm();
    TEST_ASSERT_TRUE(std::abs(six.dot(six) - squares) <=
                     8 * std::numeric_limits<Scalar>::epsilon() * squares);
    TEST_ASSERT_TRUE(six.largest_magnitude() == six.numbers().cwiseAbs().maxCoeff());
  }
}

void nothing_is_left_beside_a_product() {
  try_norms<float>();
  try_norms<double>();
}

void nothing_but_36_floats_is_read() {
  const std::vector<float> floats(36, 1.0F);  // the address sanitizer watches its ends
  const auto columns = PackedColumns<float>::blend(floats.data(), floats.data(), 0.5F);
  const Products<float> found(columns, Numbers<float>::Ones());
  TEST_ASSERT_TRUE(found.product.numbers() == Numbers<float>::Constant(72));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(columns_multiply_as_a_matrix_and_its_transpose);
  RUN_TEST(each_place_counts);
  RUN_TEST(nothing_is_left_beside_a_product);
  RUN_TEST(nothing_but_36_floats_is_read);
  return UNITY_END();
}
