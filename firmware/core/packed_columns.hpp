#pragma once

#include "packed_six.hpp"

namespace flexcomp {

/// A matrix A of six columns of six numbers, a geometric Jacobian between those of two tables'
/// records, as a tick computes with it: in vector registers where the processor has them.
template <typename Scalar>
class PackedColumns {
  using Six = PackedSix<Scalar>;
  using Lane = typename Lanes<Scalar>::Lane;

 public:
  /// from + t (to - from), column after column.
  static PackedColumns blend(const float* from, const float* to, Scalar t) {
    return PackedColumns(from, to, t);
  }

  /// f(Aᵀ b), and A f(Aᵀ b). `f` maps a lane of the six, by its number, to one. One column after
  /// the other: none has to wait in memory for the second product.
  template <typename Function>
  Six product_of(const Six& b, const Function& f, Six* mapped) const {
    Six sum;
#pragma GCC unroll 6
    for (std::size_t i = 0; i < 6; ++i) {
      Six column = Six::blend(from_ + 6 * i, to_ + 6 * i, t_);
      const Lane factor = f(i, column.dot(b));
      mapped->lanes_[i] = factor;
      sum = i > 0 ? sum + factor * column : factor * column;
    }
    return sum;
  }

 private:
  PackedColumns(const float* from, const float* to, Scalar t) : from_(from), to_(to), t_(t) {}

  const float* from_;
  const float* to_;
  Scalar t_;
};

#ifdef FLEXCOMP_VECTOR_REGISTERS

/// The 36 numbers as they follow each other, in nine registers: of two columns the first has the
/// first four numbers of one, the second its last two and the first two of the other, the third the
/// other's last four. Six registers' worth of `PackedSix` would be twelve.
template <>
class PackedColumns<float> {
  using Six = PackedSix<float>;
  using L = Lanes<float>;
  using Four = L::Lane;

 public:
  static PackedColumns blend(const float* from, const float* to, float t) {
    PackedColumns columns;
#pragma GCC unroll 9
    for (std::size_t i = 0; i < 9; ++i) {
      const Four a = L::four(from + 4 * i);
      columns.fours_[i] = a + t * (L::four(to + 4 * i) - a);
    }
    return columns;
  }

  template <typename Function>
  Six product_of(const Six& b, const Function& f, Six* mapped) const {
    const Six product = transposed_times(b);
    mapped->lanes_[0] = f(0, product.lanes_[0]);
    mapped->lanes_[1] = f(1, product.lanes_[1]);
    return times(*mapped);
  }

 private:
  /// Aᵀ b.
  Six transposed_times(const Six& b) const {
    const Four b_first = b.lanes_[0], b_last = b.lanes_[1];
    const Four middle = __builtin_shufflevector(b_last, b_first, 0, 1, 4, 5);
    const Four last = __builtin_shufflevector(b_first, b_last, 2, 3, 4, 5);
    const auto pair = [&](std::size_t i) {
      const Four p = fours_[i] * b_first;
      const Four q = fours_[i + 2] * last;
      return fours_[i + 1] * middle + (__builtin_shufflevector(p, q, 0, 1, 4, 5) +
                                       __builtin_shufflevector(p, q, 2, 3, 6, 7));
    };
    const Four ab = pair(0), cd = pair(3), ef = pair(6), none = {};
    Six product;
    product.lanes_[0] =
        __builtin_shufflevector(ab, cd, 0, 2, 4, 6) + __builtin_shufflevector(ab, cd, 1, 3, 5, 7);
    product.lanes_[1] = __builtin_shufflevector(ef, none, 0, 2, 4, 6) +
                        __builtin_shufflevector(ef, none, 1, 3, 5, 7);
    return product;
  }
  /// A b.
  Six times(const Six& b) const {
    const Four f = b.lanes_[0], g = b.lanes_[1];
    const Four first = f[0] * fours_[0] + f[2] * fours_[3] + g[0] * fours_[6];
    const Four middle = __builtin_shufflevector(f, f, 0, 0, 1, 1) * fours_[1] +
                        __builtin_shufflevector(f, f, 2, 2, 3, 3) * fours_[4] +
                        __builtin_shufflevector(g, g, 0, 0, 1, 1) * fours_[7];
    const Four last = f[1] * fours_[2] + f[3] * fours_[5] + g[1] * fours_[8];
    const Four none = {};
    Six product;
    product.lanes_[0] = first + __builtin_shufflevector(middle, last, 2, 3, 4, 5);
    product.lanes_[1] = __builtin_shufflevector(middle, none, 0, 1, 4, 5) +
                        __builtin_shufflevector(last, none, 2, 3, 4, 5);
    return product;
  }

  std::array<Four, 9> fours_;
};

#endif

}  // namespace flexcomp
