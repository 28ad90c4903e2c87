// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// AVX2 + FMA back end: a Pack is two ymm registers, a Mask two registers of all-ones or all-zeros
/// lanes. Include simd.hpp, not this file. The two halves are spelt out because GCC's lowering of a
/// 64-byte vector type on a 32-byte machine goes through memory.
#pragma once

#include <immintrin.h>

#include "krater/core/simd_scalar.hpp"

namespace krater::inline KRATER_ISA {

struct Mask {
  __m256d lo, hi;
};

struct Pack {
  static constexpr int lanes = 8;
  __m256d lo, hi;
  Pack() = default;
  KRATER_FORCE_INLINE Pack(double a) : lo(_mm256_set1_pd(a)), hi(_mm256_set1_pd(a)) {}
  KRATER_FORCE_INLINE Pack(__m256d low, __m256d high) : lo(low), hi(high) {}
};

KRATER_FORCE_INLINE Pack load(const double* from) {
  return {_mm256_load_pd(from), _mm256_load_pd(from + 4)};
}
KRATER_FORCE_INLINE Pack loadu(const double* from) {
  return {_mm256_loadu_pd(from), _mm256_loadu_pd(from + 4)};
}
KRATER_FORCE_INLINE void store(double* to, Pack a) {
  _mm256_store_pd(to, a.lo);
  _mm256_store_pd(to + 4, a.hi);
}
KRATER_FORCE_INLINE void storeu(double* to, Pack a) {
  _mm256_storeu_pd(to, a.lo);
  _mm256_storeu_pd(to + 4, a.hi);
}

#define KRATER_BINARY(name, intrinsic)                     \
  KRATER_FORCE_INLINE Pack name(Pack a, Pack b) {          \
    return {intrinsic(a.lo, b.lo), intrinsic(a.hi, b.hi)}; \
  }
#define KRATER_TERNARY(name, intrinsic)                                \
  KRATER_FORCE_INLINE Pack name(Pack a, Pack b, Pack c) {              \
    return {intrinsic(a.lo, b.lo, c.lo), intrinsic(a.hi, b.hi, c.hi)}; \
  }
#define KRATER_COMPARE(op, code)                                               \
  KRATER_FORCE_INLINE Mask operator op(Pack a, Pack b) {                       \
    return {_mm256_cmp_pd(a.lo, b.lo, code), _mm256_cmp_pd(a.hi, b.hi, code)}; \
  }
#define KRATER_LOGIC(op, intrinsic)                        \
  KRATER_FORCE_INLINE Mask operator op(Mask a, Mask b) {   \
    return {intrinsic(a.lo, b.lo), intrinsic(a.hi, b.hi)}; \
  }
KRATER_BINARY(operator+, _mm256_add_pd)
KRATER_BINARY(operator-, _mm256_sub_pd)
KRATER_BINARY(operator*, _mm256_mul_pd)
KRATER_BINARY(operator/, _mm256_div_pd)
KRATER_BINARY(min, _mm256_min_pd)
KRATER_BINARY(max, _mm256_max_pd)
KRATER_TERNARY(fma, _mm256_fmadd_pd)
KRATER_TERNARY(fms, _mm256_fmsub_pd)
KRATER_TERNARY(fnma, _mm256_fnmadd_pd)
KRATER_COMPARE(<, _CMP_LT_OQ)
KRATER_COMPARE(<=, _CMP_LE_OQ)
KRATER_COMPARE(>, _CMP_GT_OQ)
KRATER_COMPARE(>=, _CMP_GE_OQ)
KRATER_COMPARE(==, _CMP_EQ_OQ)
KRATER_COMPARE(!=, _CMP_NEQ_UQ)
KRATER_LOGIC(&, _mm256_and_pd)
KRATER_LOGIC(|, _mm256_or_pd)
KRATER_LOGIC(^, _mm256_xor_pd)
#undef KRATER_BINARY
#undef KRATER_TERNARY
#undef KRATER_COMPARE
#undef KRATER_LOGIC

KRATER_FORCE_INLINE Pack operator-(Pack a) {
  const __m256d sign = _mm256_set1_pd(-0.0);
  return {_mm256_xor_pd(a.lo, sign), _mm256_xor_pd(a.hi, sign)};
}
KRATER_FORCE_INLINE Pack sqrt(Pack a) { return {_mm256_sqrt_pd(a.lo), _mm256_sqrt_pd(a.hi)}; }
KRATER_FORCE_INLINE Pack abs(Pack a) {
  const __m256d sign = _mm256_set1_pd(-0.0);
  return {_mm256_andnot_pd(sign, a.lo), _mm256_andnot_pd(sign, a.hi)};
}
KRATER_FORCE_INLINE Pack floor(Pack a) { return {_mm256_floor_pd(a.lo), _mm256_floor_pd(a.hi)}; }

KRATER_FORCE_INLINE Mask operator!(Mask a) {
  const __m256d ones = _mm256_castsi256_pd(_mm256_set1_epi64x(-1));
  return {_mm256_xor_pd(a.lo, ones), _mm256_xor_pd(a.hi, ones)};
}
KRATER_FORCE_INLINE unsigned bits(Mask a) {
  return static_cast<unsigned>(_mm256_movemask_pd(a.lo)) |
         (static_cast<unsigned>(_mm256_movemask_pd(a.hi)) << 4);
}
KRATER_FORCE_INLINE Mask first_lanes(int n) {
  const Pack index(_mm256_setr_pd(0, 1, 2, 3), _mm256_setr_pd(4, 5, 6, 7));
  return index < Pack(static_cast<double>(n));
}
KRATER_FORCE_INLINE Pack select(Mask m, Pack a, Pack b) {
  return {_mm256_blendv_pd(b.lo, a.lo, m.lo), _mm256_blendv_pd(b.hi, a.hi, m.hi)};
}
template <int N>
KRATER_FORCE_INLINE Pack blend_low(Pack low, Pack high) {
  static_assert(0 <= N && N <= 8);
  constexpr int lanes = (1 << N) - 1;
  return {_mm256_blend_pd(high.lo, low.lo, lanes & 15),
          _mm256_blend_pd(high.hi, low.hi, lanes >> 4)};
}

KRATER_FORCE_INLINE double get(Pack a, int i) { return i < 4 ? a.lo[i] : a.hi[i - 4]; }
KRATER_FORCE_INLINE void set(Pack& a, int i, double value) {
  if (i < 4)
    a.lo[i] = value;
  else
    a.hi[i - 4] = value;
}

namespace simd_detail {
KRATER_FORCE_INLINE __m256d low_half(Pack a) { return a.lo; }
KRATER_FORCE_INLINE __m256d high_half(Pack a) { return a.hi; }

KRATER_FORCE_INLINE __m256d exp2_int(__m256d n) {
  const __m256d shifted = _mm256_add_pd(n, _mm256_set1_pd(exponent_magic));
  return _mm256_castsi256_pd(_mm256_slli_epi64(_mm256_castpd_si256(shifted), 52));
}

/// Biased exponent field of x as a double.
KRATER_FORCE_INLINE __m256d biased_exponent(__m256d x) {
  const __m256i field = _mm256_srli_epi64(_mm256_castpd_si256(x), 52);
  const __m256i two52 = _mm256_set1_epi64x(static_cast<long long>(two52_bits));
  return _mm256_sub_pd(_mm256_castsi256_pd(_mm256_or_si256(field, two52)), _mm256_set1_pd(0x1p52));
}

/// Mantissa field of x as a double in [1, 2).
KRATER_FORCE_INLINE __m256d unit_mantissa(__m256d x) {
  const __m256i keep = _mm256_set1_epi64x(static_cast<long long>(mantissa_bits));
  return _mm256_or_pd(_mm256_and_pd(x, _mm256_castsi256_pd(keep)), _mm256_set1_pd(1.0));
}

/// Transpose of the 4x4 block at `in` (rows of 8 doubles) into the block at `out`.
KRATER_FORCE_INLINE void transpose4(const double* in, double* out) {
  __m256d a[2];
  __m256d b[2];
  for (int i = 0; i < 2; ++i) {
    // Rows i and i+2 of one column pair: the lane exchange is done by the load ports.
    a[i] = _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_load_pd(in + 8 * i)),
                                _mm_load_pd(in + 8 * (i + 2)), 1);
    b[i] = _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_load_pd(in + 8 * i + 2)),
                                _mm_load_pd(in + 8 * (i + 2) + 2), 1);
  }
  _mm256_store_pd(out, _mm256_unpacklo_pd(a[0], a[1]));
  _mm256_store_pd(out + 8, _mm256_unpackhi_pd(a[0], a[1]));
  _mm256_store_pd(out + 16, _mm256_unpacklo_pd(b[0], b[1]));
  _mm256_store_pd(out + 24, _mm256_unpackhi_pd(b[0], b[1]));
}

KRATER_FORCE_INLINE void transpose4(__m256d& a, __m256d& b, __m256d& c, __m256d& d) {
  const __m256d t0 = _mm256_unpacklo_pd(a, b);
  const __m256d t1 = _mm256_unpackhi_pd(a, b);
  const __m256d t2 = _mm256_unpacklo_pd(c, d);
  const __m256d t3 = _mm256_unpackhi_pd(c, d);
  a = _mm256_permute2f128_pd(t0, t2, 0x20);
  b = _mm256_permute2f128_pd(t1, t3, 0x20);
  c = _mm256_permute2f128_pd(t0, t2, 0x31);
  d = _mm256_permute2f128_pd(t1, t3, 0x31);
}
}  // namespace simd_detail

/// 2^n for integral n in [-1022, 1023].
KRATER_FORCE_INLINE Pack exp2_int(Pack n) {
  return {simd_detail::exp2_int(n.lo), simd_detail::exp2_int(n.hi)};
}

/// x * 2^n, rounded once (see the scalar overload).
KRATER_FORCE_INLINE Pack scale_pow2(Pack x, Pack n) {
  const Pack half = (n * 0.5 + simd_detail::round_magic) - simd_detail::round_magic;
  return x * exp2_int(half) * exp2_int(n - half);
}

/// See SplitExponent.
KRATER_FORCE_INLINE SplitExponent<Pack> split_exponent(Pack x) {
  using namespace simd_detail;
  const Mask tiny = x < Pack(smallest_normal);
  const Pack scaled = select(tiny, x * 0x1p54, x);
  const Pack biased(biased_exponent(scaled.lo), biased_exponent(scaled.hi));
  const Pack m(unit_mantissa(scaled.lo), unit_mantissa(scaled.hi));
  Pack e = biased - select(tiny, 1023.0 + 54.0, 1023.0);
  const Mask upper = m >= Pack(1.5);
  e = select(upper, e + 1.0, e);
  e = select(x == Pack(0.0), -infinity, e);
  e = select(x == Pack(infinity), infinity, e);
  return {e, select(x >= Pack(0.0), select(upper, m * 0.5, m), not_a_number)};
}

KRATER_FORCE_INLINE void transpose8(const double* in, double* out) {
  simd_detail::transpose4(in, out);
  simd_detail::transpose4(in + 4, out + 32);
  simd_detail::transpose4(in + 32, out + 4);
  simd_detail::transpose4(in + 36, out + 36);
}

KRATER_FORCE_INLINE void transpose8(Pack (&r)[8]) {
  simd_detail::transpose4(r[0].lo, r[1].lo, r[2].lo, r[3].lo);
  simd_detail::transpose4(r[0].hi, r[1].hi, r[2].hi, r[3].hi);
  simd_detail::transpose4(r[4].lo, r[5].lo, r[6].lo, r[7].lo);
  simd_detail::transpose4(r[4].hi, r[5].hi, r[6].hi, r[7].hi);
  for (int i = 0; i < 4; ++i) {
    const __m256d upper_right = r[i].hi;
    r[i].hi = r[i + 4].lo;
    r[i + 4].lo = upper_right;
  }
}

}  // namespace krater::inline KRATER_ISA
