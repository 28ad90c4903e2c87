// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// AVX-512 (F, DQ, VL) back end: a Pack is one zmm register, a Mask one k register. Include
/// simd.hpp, not this file.
#pragma once

#include <immintrin.h>

#include "krater/core/simd_scalar.hpp"

namespace krater::inline KRATER_ISA {

namespace simd_detail {
/// GCC 12 warns of an uninitialised variable inside its own unmasked intrinsics (bug 105593). The
/// zero-masked ones with every lane kept compile to the same unmasked instruction, without the
/// warning.
inline constexpr __mmask8 every_lane = 0xff;
}  // namespace simd_detail

struct Mask {
  __mmask8 m;
};

struct Pack {
  static constexpr int lanes = 8;
  __m512d v;
  Pack() = default;
  KRATER_FORCE_INLINE Pack(double a) : v(_mm512_set1_pd(a)) {}
  KRATER_FORCE_INLINE explicit Pack(__m512d a) : v(a) {}
};

KRATER_FORCE_INLINE Pack load(const double* from) { return Pack(_mm512_load_pd(from)); }
KRATER_FORCE_INLINE Pack loadu(const double* from) { return Pack(_mm512_loadu_pd(from)); }
KRATER_FORCE_INLINE void store(double* to, Pack a) { _mm512_store_pd(to, a.v); }
KRATER_FORCE_INLINE void storeu(double* to, Pack a) { _mm512_storeu_pd(to, a.v); }

KRATER_FORCE_INLINE Pack operator+(Pack a, Pack b) { return Pack(_mm512_add_pd(a.v, b.v)); }
KRATER_FORCE_INLINE Pack operator-(Pack a, Pack b) { return Pack(_mm512_sub_pd(a.v, b.v)); }
KRATER_FORCE_INLINE Pack operator*(Pack a, Pack b) { return Pack(_mm512_mul_pd(a.v, b.v)); }
KRATER_FORCE_INLINE Pack operator/(Pack a, Pack b) { return Pack(_mm512_div_pd(a.v, b.v)); }
KRATER_FORCE_INLINE Pack operator-(Pack a) {
  return Pack(_mm512_xor_pd(a.v, _mm512_set1_pd(-0.0)));
}
KRATER_FORCE_INLINE Pack fma(Pack a, Pack b, Pack c) {
  return Pack(_mm512_fmadd_pd(a.v, b.v, c.v));
}
KRATER_FORCE_INLINE Pack fms(Pack a, Pack b, Pack c) {
  return Pack(_mm512_fmsub_pd(a.v, b.v, c.v));
}
KRATER_FORCE_INLINE Pack fnma(Pack a, Pack b, Pack c) {
  return Pack(_mm512_fnmadd_pd(a.v, b.v, c.v));
}
KRATER_FORCE_INLINE Pack sqrt(Pack a) {
  return Pack(_mm512_maskz_sqrt_pd(simd_detail::every_lane, a.v));
}
KRATER_FORCE_INLINE Pack min(Pack a, Pack b) {
  return Pack(_mm512_maskz_min_pd(simd_detail::every_lane, a.v, b.v));
}
KRATER_FORCE_INLINE Pack max(Pack a, Pack b) {
  return Pack(_mm512_maskz_max_pd(simd_detail::every_lane, a.v, b.v));
}
KRATER_FORCE_INLINE Pack abs(Pack a) { return Pack(_mm512_andnot_pd(_mm512_set1_pd(-0.0), a.v)); }
KRATER_FORCE_INLINE Pack floor(Pack a) {
  return Pack(_mm512_maskz_roundscale_pd(simd_detail::every_lane, a.v,
                                         _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC));
}

#define KRATER_COMPARE(op, code)                         \
  KRATER_FORCE_INLINE Mask operator op(Pack a, Pack b) { \
    return {_mm512_cmp_pd_mask(a.v, b.v, code)};         \
  }
KRATER_COMPARE(<, _CMP_LT_OQ)
KRATER_COMPARE(<=, _CMP_LE_OQ)
KRATER_COMPARE(>, _CMP_GT_OQ)
KRATER_COMPARE(>=, _CMP_GE_OQ)
KRATER_COMPARE(==, _CMP_EQ_OQ)
KRATER_COMPARE(!=, _CMP_NEQ_UQ)
#undef KRATER_COMPARE

KRATER_FORCE_INLINE Mask operator&(Mask a, Mask b) { return {static_cast<__mmask8>(a.m & b.m)}; }
KRATER_FORCE_INLINE Mask operator|(Mask a, Mask b) { return {static_cast<__mmask8>(a.m | b.m)}; }
KRATER_FORCE_INLINE Mask operator^(Mask a, Mask b) { return {static_cast<__mmask8>(a.m ^ b.m)}; }
KRATER_FORCE_INLINE Mask operator!(Mask a) { return {static_cast<__mmask8>(~a.m)}; }
KRATER_FORCE_INLINE unsigned bits(Mask a) { return a.m; }
KRATER_FORCE_INLINE Mask first_lanes(int n) {
  return {static_cast<__mmask8>(n >= 8 ? 0xffU : (1U << static_cast<unsigned>(n)) - 1U)};
}
KRATER_FORCE_INLINE Pack select(Mask m, Pack a, Pack b) {
  return Pack(_mm512_mask_blend_pd(m.m, b.v, a.v));
}
template <int N>
KRATER_FORCE_INLINE Pack blend_low(Pack low, Pack high) {
  static_assert(0 <= N && N <= 8);
  return Pack(_mm512_mask_blend_pd(static_cast<__mmask8>((1U << N) - 1U), high.v, low.v));
}

KRATER_FORCE_INLINE double get(Pack a, int i) { return a.v[i]; }
KRATER_FORCE_INLINE void set(Pack& a, int i, double value) { a.v[i] = value; }

namespace simd_detail {
KRATER_FORCE_INLINE __m256d low_half(Pack a) {
  return _mm512_maskz_extractf64x4_pd(simd_detail::every_lane, a.v, 0);
}
KRATER_FORCE_INLINE __m256d high_half(Pack a) {
  return _mm512_maskz_extractf64x4_pd(simd_detail::every_lane, a.v, 1);
}
}  // namespace simd_detail

/// 2^n for integral n in [-1022, 1023].
KRATER_FORCE_INLINE Pack exp2_int(Pack n) {
  const __m512i shifted = _mm512_castpd_si512((n + simd_detail::exponent_magic).v);
  return Pack(_mm512_castsi512_pd(_mm512_maskz_slli_epi64(simd_detail::every_lane, shifted, 52)));
}

/// x * 2^n, rounded once (see the scalar overload).
KRATER_FORCE_INLINE Pack scale_pow2(Pack x, Pack n) {
  return Pack(_mm512_maskz_scalef_pd(simd_detail::every_lane, x.v, n.v));
}

/// See SplitExponent.
KRATER_FORCE_INLINE SplitExponent<Pack> split_exponent(Pack x) {
  // Adding zero turns -0, whose mantissa would be NaN, into +0.
  const __m512d positive = _mm512_add_pd(x.v, _mm512_setzero_pd());
  const __m512d m = _mm512_maskz_getmant_pd(simd_detail::every_lane, positive,
                                            _MM_MANT_NORM_p75_1p5, _MM_MANT_SIGN_nan);
  const __m512d e = _mm512_maskz_getexp_pd(simd_detail::every_lane, x.v);
  // getexp counts from mantissas in [1, 2): those of [1.5, 2) were halved by getmant.
  const __mmask8 upper = _mm512_cmp_pd_mask(m, _mm512_set1_pd(1.0), _CMP_LT_OQ);
  return {Pack(_mm512_mask_add_pd(e, upper, e, _mm512_set1_pd(1.0))), Pack(m)};
}

namespace simd_detail {
/// Rows (row, row+4) of one 256-bit half of the columns: the exchange of halves is done by the load
/// ports.
KRATER_FORCE_INLINE __m512d two_rows(const double* in, int row, int column) {
  const __m512d top = _mm512_castpd256_pd512(_mm256_load_pd(in + 8 * row + column));
  return _mm512_maskz_insertf64x4(simd_detail::every_lane, top,
                                  _mm256_load_pd(in + 8 * (row + 4) + column), 1);
}

/// Columns column..column+3 of the transpose: a 4x4 transposition in each half of four registers.
KRATER_FORCE_INLINE void four_columns(const double* in, double* out, int column) {
  const __m512d a0 = two_rows(in, 0, column);
  const __m512d a1 = two_rows(in, 1, column);
  const __m512d a2 = two_rows(in, 2, column);
  const __m512d a3 = two_rows(in, 3, column);
  const __m512d t0 = _mm512_maskz_unpacklo_pd(simd_detail::every_lane, a0, a1);
  const __m512d t1 = _mm512_maskz_unpackhi_pd(simd_detail::every_lane, a0, a1);
  const __m512d t2 = _mm512_maskz_unpacklo_pd(simd_detail::every_lane, a2, a3);
  const __m512d t3 = _mm512_maskz_unpackhi_pd(simd_detail::every_lane, a2, a3);
  const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
  const __m512i high = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
  _mm512_store_pd(out + 8 * column, _mm512_permutex2var_pd(t0, low, t2));
  _mm512_store_pd(out + 8 * column + 8, _mm512_permutex2var_pd(t1, low, t3));
  _mm512_store_pd(out + 8 * column + 16, _mm512_permutex2var_pd(t0, high, t2));
  _mm512_store_pd(out + 8 * column + 24, _mm512_permutex2var_pd(t1, high, t3));
}
}  // namespace simd_detail

KRATER_FORCE_INLINE void transpose8(const double* in, double* out) {
  simd_detail::four_columns(in, out, 0);
  simd_detail::four_columns(in, out, 4);
}

/// 24 shuffles in three stages: pairs of lanes, of 128-bit parts, of 256-bit halves.
KRATER_FORCE_INLINE void transpose8(Pack (&r)[8]) {
  __m512d t[8];
  for (int i = 0; i < 8; i += 2) {
    t[i] = _mm512_maskz_unpacklo_pd(simd_detail::every_lane, r[i].v, r[i + 1].v);
    t[i + 1] = _mm512_maskz_unpackhi_pd(simd_detail::every_lane, r[i].v, r[i + 1].v);
  }
  for (int i = 0; i < 2; ++i) {
    const __m512d a = _mm512_maskz_shuffle_f64x2(simd_detail::every_lane, t[i], t[i + 2], 0x88);
    const __m512d b = _mm512_maskz_shuffle_f64x2(simd_detail::every_lane, t[i + 4], t[i + 6], 0x88);
    const __m512d c = _mm512_maskz_shuffle_f64x2(simd_detail::every_lane, t[i], t[i + 2], 0xdd);
    const __m512d d = _mm512_maskz_shuffle_f64x2(simd_detail::every_lane, t[i + 4], t[i + 6], 0xdd);
    r[i] = Pack(_mm512_maskz_shuffle_f64x2(simd_detail::every_lane, a, b, 0x88));
    r[i + 4] = Pack(_mm512_maskz_shuffle_f64x2(simd_detail::every_lane, a, b, 0xdd));
    r[i + 2] = Pack(_mm512_maskz_shuffle_f64x2(simd_detail::every_lane, c, d, 0x88));
    r[i + 6] = Pack(_mm512_maskz_shuffle_f64x2(simd_detail::every_lane, c, d, 0xdd));
  }
}

}  // namespace krater::inline KRATER_ISA
