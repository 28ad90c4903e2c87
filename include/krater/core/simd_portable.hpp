// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Portable back end: eight doubles and plain loops over the scalar operations. Include simd.hpp,
/// not this file. Correct everywhere and slow: without an FMA instruction `fma` is a library call.
/// The operations are calls, not inlined: eight scalars an operation would blow the kernels up
/// until one file compiles for ten minutes (measured), for a level that exists to be correct.
#pragma once

#include "krater/core/simd_scalar.hpp"

#define KRATER_CALLED inline __attribute__((noinline))

namespace krater::inline KRATER_ISA {

struct Mask {
  bool lane[8];
};

struct Pack {
  static constexpr int lanes = 8;
  double lane[8];
  Pack() = default;
  KRATER_CALLED Pack(double a) : lane{a, a, a, a, a, a, a, a} {}
};

KRATER_CALLED Pack loadu(const double* from) {
  Pack r;
  for (int i = 0; i < 8; ++i) r.lane[i] = from[i];
  return r;
}
KRATER_CALLED void storeu(double* to, const Pack& a) {
  for (int i = 0; i < 8; ++i) to[i] = a.lane[i];
}
KRATER_FORCE_INLINE Pack load(const double* from) { return loadu(from); }
KRATER_FORCE_INLINE void store(double* to, const Pack& a) { storeu(to, a); }

#define KRATER_LANES(type, name, arguments, expression) \
  KRATER_CALLED type name arguments {                   \
    type r;                                             \
    for (int i = 0; i < 8; ++i) r.lane[i] = expression; \
    return r;                                           \
  }
#define KRATER_OPERATOR(type, op) \
  KRATER_LANES(type, operator op, (const Pack& a, const Pack& b), a.lane[i] op b.lane[i])
#define KRATER_UNARY(name) KRATER_LANES(Pack, name, (const Pack& a), name(a.lane[i]))
#define KRATER_BINARY(name) \
  KRATER_LANES(Pack, name, (const Pack& a, const Pack& b), name(a.lane[i], b.lane[i]))
#define KRATER_TERNARY(name)                                              \
  KRATER_LANES(Pack, name, (const Pack& a, const Pack& b, const Pack& c), \
               name(a.lane[i], b.lane[i], c.lane[i]))
#define KRATER_LOGIC(op) \
  KRATER_LANES(Mask, operator op, (const Mask& a, const Mask& b), (a.lane[i] op b.lane[i]) != 0)
KRATER_OPERATOR(Pack, +)
KRATER_OPERATOR(Pack, -)
KRATER_OPERATOR(Pack, *)
KRATER_OPERATOR(Pack, /)
KRATER_OPERATOR(Mask, <)
KRATER_OPERATOR(Mask, <=)
KRATER_OPERATOR(Mask, >)
KRATER_OPERATOR(Mask, >=)
KRATER_OPERATOR(Mask, ==)
KRATER_OPERATOR(Mask, !=)
KRATER_LOGIC(&)
KRATER_LOGIC(|)
KRATER_LOGIC(^)
KRATER_LANES(Mask, operator!, (const Mask& a), !a.lane[i])
KRATER_LANES(Pack, operator-, (const Pack& a), -a.lane[i])
KRATER_UNARY(sqrt)
KRATER_UNARY(abs)
KRATER_UNARY(floor)
KRATER_BINARY(min)
KRATER_BINARY(max)
KRATER_TERNARY(fma)
KRATER_TERNARY(fms)
KRATER_TERNARY(fnma)
KRATER_LANES(Pack, select, (const Mask& m, const Pack& a, const Pack& b),
             m.lane[i] ? a.lane[i] : b.lane[i])
KRATER_LANES(Mask, first_lanes, (int n), i < n)
/// 2^n for integral n in [-1022, 1023].
KRATER_UNARY(exp2_int)
/// x * 2^n, rounded once (see the scalar overload).
KRATER_BINARY(scale_pow2)
#undef KRATER_LANES
#undef KRATER_OPERATOR
#undef KRATER_UNARY
#undef KRATER_BINARY
#undef KRATER_TERNARY
#undef KRATER_LOGIC

KRATER_CALLED unsigned bits(const Mask& a) {
  unsigned r = 0;
  for (int i = 0; i < 8; ++i) r |= (a.lane[i] ? 1U : 0U) << i;
  return r;
}
template <int N>
KRATER_FORCE_INLINE Pack blend_low(const Pack& low, const Pack& high) {
  static_assert(0 <= N && N <= 8);
  return select(first_lanes(N), low, high);
}

KRATER_FORCE_INLINE double get(const Pack& a, int i) { return a.lane[i]; }
KRATER_FORCE_INLINE void set(Pack& a, int i, double value) { a.lane[i] = value; }

/// See SplitExponent.
KRATER_CALLED SplitExponent<Pack> split_exponent(const Pack& x) {
  SplitExponent<Pack> r;
  for (int i = 0; i < 8; ++i) {
    const SplitExponent<double> lane = split_exponent(x.lane[i]);
    r.exponent.lane[i] = lane.exponent;
    r.mantissa.lane[i] = lane.mantissa;
  }
  return r;
}

KRATER_CALLED void transpose8(const double* in, double* out) {
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j) out[8 * j + i] = in[8 * i + j];
}
KRATER_CALLED void transpose8(Pack (&r)[8]) {
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < i; ++j) {
      const double lower = r[i].lane[j];
      r[i].lane[j] = r[j].lane[i];
      r[j].lane[i] = lower;
    }
}

/// The fold of simd.hpp: x_i op x_{i+4}, then i op i+2, then 0 op 1.
#define KRATER_FOLD(name, combine)                                        \
  KRATER_CALLED double name(const Pack& a) {                              \
    double h[4];                                                          \
    for (int i = 0; i < 4; ++i) h[i] = combine(a.lane[i], a.lane[i + 4]); \
    return combine(combine(h[0], h[2]), combine(h[1], h[3]));             \
  }
#define KRATER_PLUS(a, b) ((a) + (b))
KRATER_FOLD(sum, KRATER_PLUS)
KRATER_FOLD(hmin, min)
KRATER_FOLD(hmax, max)
#undef KRATER_PLUS
#undef KRATER_FOLD

}  // namespace krater::inline KRATER_ISA
#undef KRATER_CALLED
