#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace flexcomp {

template <typename Scalar>
class PackedColumns;

/// Six numbers, of a joint vector, a twist or a wrench, as a tick computes with them: in vector
/// registers where the processor has them.
///
/// Of six floats Eigen takes four together and two one by one; here the two are in a register too,
/// beside two zeros.
template <typename Scalar>
class PackedSix {
 public:
  using Numbers = Eigen::Matrix<Scalar, 6, 1>;

  PackedSix() = default;
  explicit PackedSix(const Numbers& numbers) {
    each([&](int i) { numbers_[i] = numbers.data()[i]; });
  }

  /// Of a table's record.
  static PackedSix read(const float* floats) {
    return of([&](int i) { return static_cast<Scalar>(floats[i]); });
  }

  Numbers numbers() const {
    Numbers numbers;
    each([&](int i) { numbers.data()[i] = numbers_[i]; });
    return numbers;
  }

  friend PackedSix operator+(const PackedSix& a, const PackedSix& b) {
    return of([&](int i) { return a.numbers_[i] + b.numbers_[i]; });
  }
  friend PackedSix operator-(const PackedSix& a, const PackedSix& b) {
    return of([&](int i) { return a.numbers_[i] - b.numbers_[i]; });
  }
  friend PackedSix operator*(Scalar factor, const PackedSix& a) {
    return of([&](int i) { return factor * a.numbers_[i]; });
  }
  friend PackedSix operator*(const PackedSix& a, const PackedSix& b) {
    return of([&](int i) { return a.numbers_[i] * b.numbers_[i]; });
  }
  PackedSix operator-() const {
    return of([&](int i) { return -numbers_[i]; });
  }
  Scalar dot(const PackedSix& other) const {
    Scalar sum = numbers_[0] * other.numbers_[0];
#pragma GCC unroll 6
    for (int i = 1; i < 6; ++i) {
      sum += numbers_[i] * other.numbers_[i];
    }
    return sum;
  }

  bool is_finite() const {
    Scalar sum = 0;  // of zeros, or not a number
    each([&](int i) { sum += numbers_[i] - numbers_[i]; });
    return sum == Scalar(0);
  }
  /// Is each number between those of the same place, which may be the bounds themselves? Not where
  /// one is not a number.
  bool is_within(const PackedSix& lower, const PackedSix& upper) const {
    bool within = true;
    each([&](int i) {
      within = within && numbers_[i] >= lower.numbers_[i] && numbers_[i] <= upper.numbers_[i];
    });
    return within;
  }

  /// Infinite if one of them is not a number.
  Scalar largest_magnitude() const {
    Scalar largest = 0;
    Scalar sum = 0;  // not a number if one of them is not
    each([&](int i) {
      const Scalar magnitude = std::abs(numbers_[i]);
      largest = magnitude > largest ? magnitude : largest;
      sum += magnitude;
    });
    return std::isnan(sum) ? std::numeric_limits<Scalar>::infinity() : largest;
  }

  /// Is no magnitude larger? Not where one is not a number.
  bool is_within(Scalar most) const {
    bool within = true;
    each([&](int i) { within = within && std::abs(numbers_[i]) <= most; });
    return within;
  }

 private:
  template <typename Do>
  [[gnu::always_inline]] static void each(const Do& visit) {
#pragma GCC unroll 6
    for (int i = 0; i < 6; ++i) {
      visit(i);
    }
  }
  template <typename Of>
  [[gnu::always_inline]] static PackedSix of(const Of& number) {
    PackedSix six;
    each([&](int i) { six.numbers_[i] = number(i); });
    return six;
  }

  Scalar numbers_[6] = {};
};

#if defined(__SSE2__) || defined(__ARM_NEON)
#define FLEXCOMP_VECTOR_REGISTERS

template <>
class PackedSix<float> {
  using Four [[gnu::vector_size(16)]] = float;
  using FourBits [[gnu::vector_size(16)]] = std::uint32_t;
  using TwoPairs [[gnu::vector_size(16)]] = std::uint64_t;
  using FourTruths = decltype(Four() < Four());  ///< all bits of a number, or none

 public:
  using Numbers = Eigen::Matrix<float, 6, 1>;

  PackedSix() = default;
  explicit PackedSix(const Numbers& numbers) : PackedSix(read(numbers.data())) {}

  static PackedSix read(const float* floats) {
    std::uint64_t pair = 0;
    std::memcpy(&pair, floats + 4, sizeof pair);
    return {four(floats), reinterpret_cast<Four>(TwoPairs{pair, 0})};
  }

  void write(float* floats) const {
    const std::uint64_t pair = reinterpret_cast<TwoPairs>(last_)[0];
    std::memcpy(floats, &first_, sizeof first_);
    std::memcpy(floats + 4, &pair, sizeof pair);
  }
  Numbers numbers() const {
    Numbers numbers;
    write(numbers.data());
    return numbers;
  }

  friend PackedSix operator+(const PackedSix& a, const PackedSix& b) {
    return {a.first_ + b.first_, a.last_ + b.last_};
  }
  friend PackedSix operator-(const PackedSix& a, const PackedSix& b) {
    return {a.first_ - b.first_, a.last_ - b.last_};
  }
  friend PackedSix operator*(float factor, const PackedSix& a) {
    return {factor * a.first_, factor * a.last_};
  }
  friend PackedSix operator*(const PackedSix& a, const PackedSix& b) {
    return {a.first_ * b.first_, a.last_ * b.last_};
  }
  PackedSix operator-() const { return {-first_, -last_}; }
  float dot(const PackedSix& other) const { return total(products(other)); }

  /// Four scalar products, of `a` with two and of `b` with two.
  static std::array<float, 4> dots(const PackedSix& a, const std::array<PackedSix, 2>& with_a,
                                   const PackedSix& b, const std::array<PackedSix, 2>& with_b) {
    const Four of_a = halves(a.products(with_a[0]), a.products(with_a[1]));
    const Four of_b = halves(b.products(with_b[0]), b.products(with_b[1]));
    const Four sums = of_both(of_a, of_b);
    return {sums[0], sums[1], sums[2], sums[3]};
  }

  /// Number by number: a if a < b, else b; a if a > b, else b.
  static PackedSix smaller(const PackedSix& a, const PackedSix& b) {
    return {a.first_ < b.first_ ? a.first_ : b.first_, a.last_ < b.last_ ? a.last_ : b.last_};
  }
  static PackedSix larger(const PackedSix& a, const PackedSix& b) {
    return {a.first_ > b.first_ ? a.first_ : b.first_, a.last_ > b.last_ ? a.last_ : b.last_};
  }
  PackedSix magnitudes() const { return {magnitude(first_), magnitude(last_)}; }

  /// What holds number by number.
  class Truth {
   public:
    bool any() const { return (bits()[0] | bits()[1]) != 0; }

   private:
    friend class PackedSix;
    Truth(FourTruths first, FourTruths last) : first_(first), last_(last) {}
    TwoPairs bits() const { return reinterpret_cast<TwoPairs>(first_ | last_); }
    FourTruths first_;
    FourTruths last_;
  };
  Truth operator<(const PackedSix& other) const {
    return {first_ < other.first_, last_ < other.last_};
  }
  Truth operator>(const PackedSix& other) const {
    return {first_ > other.first_, last_ > other.last_};
  }
  Truth operator!=(const PackedSix& other) const {
    return {first_ != other.first_, last_ != other.last_};
  }
  Truth are_finite() const {
    constexpr float kLargest = std::numeric_limits<float>::max();
    return {magnitude(first_) <= kLargest, magnitude(last_) <= kLargest};
  }
  static PackedSix choose(const Truth& where, const PackedSix& a, const PackedSix& b) {
    return {where.first_ ? a.first_ : b.first_, where.last_ ? a.last_ : b.last_};
  }

  bool is_finite() const {
    const Truth truth = are_finite();
    return all(truth.first_ & truth.last_);
  }
  bool is_within(const PackedSix& lower, const PackedSix& upper) const {
    return all((first_ >= lower.first_) & (first_ <= upper.first_) & (last_ >= lower.last_) &
               (last_ <= upper.last_));
  }
  bool is_within(float most) const {
    return all((magnitude(first_) <= most) & (magnitude(last_) <= most));
  }

  float largest_magnitude() const {
    const Four a = magnitude(first_);
    const Four b = magnitude(last_);
    const Four larger = a > b ? a : b;
    const float even = larger[0] > larger[2] ? larger[0] : larger[2];
    const float odd = larger[1] > larger[3] ? larger[1] : larger[3];
    return std::isnan(total(a + b)) ? std::numeric_limits<float>::infinity()
                                    : (even > odd ? even : odd);
  }

 private:
  PackedSix(Four first, Four last) : first_(first), last_(last) {}

  static Four four(const float* floats) {
    Four four;
    std::memcpy(&four, floats, sizeof four);
    return four;
  }
  static bool all(FourTruths truth) {
    const TwoPairs pairs = reinterpret_cast<TwoPairs>(truth);
    return (pairs[0] & pairs[1]) == ~std::uint64_t{0};
  }
  Four products(const PackedSix& other) const {
    return first_ * other.first_ + last_ * other.last_;
  }
  /// Each of two in turn: its first and third number, its second and fourth.
  static Four halves(Four a, Four b) {
    return __builtin_shufflevector(a, b, 0, 4, 1, 5) + __builtin_shufflevector(a, b, 2, 6, 3, 7);
  }
  /// The rest of four scalar products, of `halves` of the first two and of the last two.
  static Four of_both(Four ab, Four cd) {
    return __builtin_shufflevector(ab, cd, 0, 1, 4, 5) +
           __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
  }
  static float total(Four four) {
    const Four pairs = four + __builtin_shufflevector(four, four, 2, 3, 2, 3);
    return pairs[0] + pairs[1];
  }
  static Four magnitude(Four four) {
    return reinterpret_cast<Four>(reinterpret_cast<FourBits>(four) & 0x7fffffffU);
  }

  friend class PackedColumns<float>;

  Four first_ = {};
  Four last_ = {};  ///< the fifth, the sixth, two zeros
};

#endif

}  // namespace flexcomp
