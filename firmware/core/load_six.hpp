#pragma once

namespace flexcomp {

/// Six floats that follow each other, by one instruction on a Cortex-M7, whose compiler takes six.
/// It fills registers in a row, so that they are named here: `Bank` is 0, 1 or 2, for sixes that
/// are wanted at the same time.
#if defined(__ARM_ARCH_7EM__) && defined(__ARM_FP)
#define FLEXCOMP_LOAD_SIX(A, B, C, D, E, F)                          \
  register float a asm(A);                                           \
  register float b asm(B);                                           \
  register float c asm(C);                                           \
  register float d asm(D);                                           \
  register float e asm(E);                                           \
  register float f asm(F);                                           \
  asm("vldmia %6, {" A "-" F "}"                                     \
      : "=t"(a), "=t"(b), "=t"(c), "=t"(d), "=t"(e), "=t"(f)         \
      : "r"(from), "m"(*reinterpret_cast<const float(*)[6]>(from))); \
  const float p = a, q = b, r = c, s = d, t = e, u = f;              \
  to[0] = p, to[1] = q, to[2] = r, to[3] = s, to[4] = t, to[5] = u

template <int Bank>
[[gnu::always_inline]] inline void load_six(const float* from, float (&to)[6]) {
  if constexpr (Bank == 0) {
    FLEXCOMP_LOAD_SIX("s16", "s17", "s18", "s19", "s20", "s21");
  } else if constexpr (Bank == 1) {
    FLEXCOMP_LOAD_SIX("s22", "s23", "s24", "s25", "s26", "s27");
  } else {
    FLEXCOMP_LOAD_SIX("s8", "s9", "s10", "s11", "s12", "s13");
  }
}
#undef FLEXCOMP_LOAD_SIX

/// The other way, from the registers of bank 2.
[[gnu::always_inline]] inline void store_six(const float (&from)[6], float* to) {
  register float a asm("s8") = from[0];
  register float b asm("s9") = from[1];
  register float c asm("s10") = from[2];
  register float d asm("s11") = from[3];
  register float e asm("s12") = from[4];
  register float f asm("s13") = from[5];
  asm("vstmia %1, {s8-s13}"
      : "=m"(*reinterpret_cast<float(*)[6]>(to))
      : "r"(to), "t"(a), "t"(b), "t"(c), "t"(d), "t"(e), "t"(f));
}
#else
template <int Bank>
[[gnu::always_inline]] inline void load_six(const float* from, float (&to)[6]) {
  for (int i = 0; i < 6; ++i) {
    to[i] = from[i];
  }
}

inline void store_six(const float (&from)[6], float* to) {
  for (int i = 0; i < 6; ++i) {
    to[i] = from[i];
  }
}
#endif

}  // namespace flexcomp
