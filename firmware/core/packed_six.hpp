#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "lanes.hpp"
#include "load_six.hpp"

namespace flexcomp {

template <typename Scalar>
class PackedColumns;

/// Six numbers, of a joint vector, a twist or a wrench, as a tick computes with them: in vector
/// registers where the processor has them.
///
/// Those on the way of a tick are not `const`: what is constant and filled in place GCC 12 keeps in
/// memory.
template <typename Scalar>
class PackedSix {
  using L = Lanes<Scalar>;
  using Lane = typename L::Lane;

 public:
  using Numbers = Eigen::Matrix<Scalar, 6, 1>;

  PackedSix() = default;
  [[gnu::always_inline]] explicit PackedSix(const Numbers& numbers) : PackedSix(read<2>(numbers)) {}

  /// The same, from another bank of registers (load_six.hpp).
  template <int Bank>
  [[gnu::always_inline]] static PackedSix read(const Numbers& numbers) {
    PackedSix six;
    if constexpr (std::is_same_v<Lane, float>) {
      load_six<Bank>(numbers.data(), six.lanes_);
    } else {
      each([&](std::size_t i) { six.lanes_[i] = L::load(numbers.data(), i); });
    }
    return six;
  }

  /// The numbers of a table's record.
  template <int Bank = 0>
  [[gnu::always_inline]] static PackedSix read(const float* floats) {
    if constexpr (std::is_same_v<Lane, float>) {
      PackedSix six;
      load_six<Bank>(floats, six.lanes_);
      return six;
    } else {
      return of([&](std::size_t i) { return L::load(floats, i); });
    }
  }
  /// from + t (to - from), of two records.
  static PackedSix blend(const float* from, const float* to, Scalar t) {
    PackedSix a = read(from);
    return a + t * (read<1>(to) - a);
  }

  Numbers numbers() const {
    Numbers numbers;
    each([&](std::size_t i) { L::store(lanes_[i], i, numbers.data()); });
    return numbers;
  }

  /// The same, into what is there.
  [[gnu::always_inline]] void store(Numbers* numbers) const {
    if constexpr (std::is_same_v<Lane, float>) {
      store_six(lanes_, numbers->data());
    } else {
      each([&](std::size_t i) { L::store(lanes_[i], i, numbers->data()); });
    }
  }

  friend PackedSix operator+(const PackedSix& a, const PackedSix& b) {
    return of([&](std::size_t i) { return a.lanes_[i] + b.lanes_[i]; });
  }
  friend PackedSix operator-(const PackedSix& a, const PackedSix& b) {
    return of([&](std::size_t i) { return a.lanes_[i] - b.lanes_[i]; });
  }
  friend PackedSix operator*(Scalar factor, const PackedSix& a) {
    return of([&](std::size_t i) { return factor * a.lanes_[i]; });
  }
  friend PackedSix operator*(const PackedSix& a, const PackedSix& b) {
    return of([&](std::size_t i) { return a.lanes_[i] * b.lanes_[i]; });
  }
  PackedSix operator-() const {
    return of([&](std::size_t i) { return -lanes_[i]; });
  }
  Scalar dot(const PackedSix& other) const { return L::total(products(other)); }

  bool is_finite() const {
    Lane sum = lanes_[0] - lanes_[0];  // of zeros, or not a number
    each([&](std::size_t i) { sum = i > 0 ? sum + (lanes_[i] - lanes_[i]) : sum; });
    return L::total(sum) == Scalar(0);
  }
  /// Is each number between those of the same place, which may be the bounds themselves? Not where
  /// one is not a number.
  bool is_within(const PackedSix& lower, const PackedSix& upper) const {
    return L::all_of([&](std::size_t i) {
      return L::both(lanes_[i] >= lower.lanes_[i], lanes_[i] <= upper.lanes_[i]);
    });
  }
  /// Is no magnitude larger? Not where one is not a number.
  bool is_within(Scalar most) const {
    return L::all_of([&](std::size_t i) { return L::magnitude(lanes_[i]) <= most; });
  }

  /// Infinite if one of them is not a number.
  Scalar largest_magnitude() const {
    Lane largest = L::magnitude(lanes_[0]);
    Lane sum = largest;  // not a number if one of them is not
    each([&](std::size_t i) {
      if (i > 0) {
        const Lane magnitude = L::magnitude(lanes_[i]);
        largest = larger(magnitude, largest);
        sum += magnitude;
      }
    });
    return std::isnan(L::total(sum)) ? std::numeric_limits<Scalar>::infinity()
                                     : L::largest(largest);
  }

#ifdef FLEXCOMP_VECTOR_REGISTERS
  /// Four scalar products, of `a` with two and of `b` with two: in a third of the instructions of
  /// one after the other.
  static std::array<Scalar, 4> dots(const PackedSix& a, const std::array<PackedSix, 2>& with_a,
                                    const PackedSix& b, const std::array<PackedSix, 2>& with_b) {
    const Lane of_a = halves(a.products(with_a[0]), a.products(with_a[1]));
    const Lane of_b = halves(b.products(with_b[0]), b.products(with_b[1]));
    const Lane sums = __builtin_shufflevector(of_a, of_b, 0, 1, 4, 5) +
                      __builtin_shufflevector(of_a, of_b, 2, 3, 6, 7);
    return {sums[0], sums[1], sums[2], sums[3]};
  }
#endif

 private:
  /// The larger of two magnitudes; where one is not a number, either.
  [[gnu::always_inline]] static Lane larger(Lane a, Lane b) {
#ifdef FLEXCOMP_LARGER_IN_ONE_INSTRUCTION
    return L::larger(a, b);
#else
    return L::choose(a > b, a, b);
#endif
  }
  template <typename Visit, std::size_t... I>
  [[gnu::always_inline]] static void each(const Visit& visit, std::index_sequence<I...> /*all*/) {
    (visit(I), ...);
  }
  template <typename Visit>
  [[gnu::always_inline]] static void each(const Visit& visit) {
    each(visit, std::make_index_sequence<L::kCount>());
  }
  template <typename Of>
  [[gnu::always_inline]] static PackedSix of(const Of& lane) {
    PackedSix six;
    each([&](std::size_t i) { six.lanes_[i] = lane(i); });
    return six;
  }
  [[gnu::always_inline]] Lane products(const PackedSix& other) const {
    Lane sum = lanes_[0] * other.lanes_[0];
    each([&](std::size_t i) { sum = i > 0 ? sum + lanes_[i] * other.lanes_[i] : sum; });
    return sum;
  }
#ifdef FLEXCOMP_VECTOR_REGISTERS
  /// Each of two in turn: its first and third number, its second and fourth.
  static Lane halves(Lane a, Lane b) {
    return __builtin_shufflevector(a, b, 0, 4, 1, 5) + __builtin_shufflevector(a, b, 2, 6, 3, 7);
  }
#endif

  friend class PackedColumns<Scalar>;

  Lane lanes_[L::kCount] = {};
};

}  // namespace flexcomp
