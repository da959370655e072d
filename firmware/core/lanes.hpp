#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#if defined(__ARM_ARCH_7EM__) && defined(__ARM_FP) && (__ARM_FP & 8) != 0  // a Cortex-M7
#define FLEXCOMP_LARGER_IN_ONE_INSTRUCTION
#endif

namespace flexcomp {

/// Numbers one by one. An algorithm that is written for a `Lane`, with the operators of C++ and the
/// functions here, is that for one number and for four side by side (`FourFloats`): the same to the
/// bit.
template <typename Scalar>
struct OneByOne {
  using Lane = Scalar;
  using Truth = bool;
  static constexpr std::size_t kCount = 6;  ///< lanes that six numbers take

  template <typename Number>
  static Lane load(const Number* numbers, std::size_t lane) {
    return static_cast<Scalar>(numbers[lane]);
  }
  static void store(Lane value, std::size_t lane, Scalar* numbers) { numbers[lane] = value; }

  static Lane magnitude(Lane a) { return std::abs(a); }
  static Lane choose(Truth where, Lane a, Lane b) { return where ? a : b; }
#ifdef FLEXCOMP_LARGER_IN_ONE_INSTRUCTION
  /// The larger of two numbers in one instruction, of one and what is none the one.
  static float larger(float a, float b) { return __builtin_fmaxf(a, b); }
  static double larger(double a, double b) { return __builtin_fmax(a, b); }
#endif
  static Truth both(Truth a, Truth b) { return a && b; }
  static Truth either(Truth a, Truth b) { return a || b; }
  static bool all(Truth truth) { return truth; }
  /// `holds` of every lane of six numbers.
  template <typename Holds>
  [[gnu::always_inline]] static bool all_of(const Holds& holds) {
    return holds(0) && holds(1) && holds(2) && holds(3) && holds(4) && holds(5);
  }
  static bool any(Truth truth) { return truth; }
  static Scalar total(Lane a) { return a; }
  static Scalar largest(Lane a) { return a; }
  /// `function` of each number of two lanes.
  template <typename Function>
  static Lane apply(const Function& function, Lane a, Lane b) {
    return function(a, b);
  }
};

#if defined(__SSE2__) || defined(__ARM_NEON)
#define FLEXCOMP_VECTOR_REGISTERS

/// Four floats in a register. Of six floats Eigen takes four together and two one by one; here the
/// two are in a register too, beside two zeros.
struct FourFloats {
  using Lane [[gnu::vector_size(16)]] = float;
  using Truth = decltype(Lane() < Lane());  ///< all bits of a number, or none
  static constexpr std::size_t kCount = 2;

  static Lane load(const float* numbers, std::size_t lane) {
    return lane == 0 ? four(numbers) : two(numbers + 4);
  }
  static void store(Lane value, std::size_t lane, float* numbers) {
    if (lane == 0) {
      std::memcpy(numbers, &value, sizeof value);
    } else {
      const std::uint64_t pair = reinterpret_cast<TwoPairs>(value)[0];
      std::memcpy(numbers + 4, &pair, sizeof pair);
    }
  }

  static Lane magnitude(Lane a) {
    return reinterpret_cast<Lane>(reinterpret_cast<FourBits>(a) & 0x7fffffffU);
  }
  static Lane choose(Truth where, Lane a, Lane b) { return where ? a : b; }
  static Truth both(Truth a, Truth b) { return a & b; }
  static Truth either(Truth a, Truth b) { return a | b; }
  static bool all(Truth truth) {
    const TwoPairs pairs = reinterpret_cast<TwoPairs>(truth);
    return (pairs[0] & pairs[1]) == ~std::uint64_t{0};
  }
  template <typename Holds>
  [[gnu::always_inline]] static bool all_of(const Holds& holds) {
    return all(holds(0) & holds(1));
  }
  static bool any(Truth truth) {
    const TwoPairs pairs = reinterpret_cast<TwoPairs>(truth);
    return (pairs[0] | pairs[1]) != 0;
  }
  static float total(Lane a) {
    const Lane pairs = a + __builtin_shufflevector(a, a, 2, 3, 2, 3);
    return pairs[0] + pairs[1];
  }
  static float largest(Lane a) {
    const float even = a[0] > a[2] ? a[0] : a[2];
    const float odd = a[1] > a[3] ? a[1] : a[3];
    return even > odd ? even : odd;
  }
  template <typename Function>
  static Lane apply(const Function& function, Lane a, Lane b) {
    return Lane{function(a[0], b[0]), function(a[1], b[1]), function(a[2], b[2]),
                function(a[3], b[3])};
  }

  static Lane four(const float* floats) {
    Lane lane;
    std::memcpy(&lane, floats, sizeof lane);
    return lane;
  }

 private:
  using FourBits [[gnu::vector_size(16)]] = std::uint32_t;
  using TwoPairs [[gnu::vector_size(16)]] = std::uint64_t;

  static Lane two(const float* floats) {
    std::uint64_t pair = 0;
    std::memcpy(&pair, floats, sizeof pair);
    return reinterpret_cast<Lane>(TwoPairs{pair, 0});
  }
};

template <typename Scalar>
using Lanes = std::conditional_t<std::is_same_v<Scalar, float>, FourFloats, OneByOne<Scalar>>;

#else

/// The lanes that a tick computes with.
template <typename Scalar>
using Lanes = OneByOne<Scalar>;

#endif

}  // namespace flexcomp
