// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Eight doubles at a time: `Pack` and its `Mask`, and the same operations for one `double` with
/// `bool`.
///
/// A law is written once as `template <class Real>` and instantiated for Pack (kernels) and double
/// (slow paths, tests); masks are `MaskOf<Real>`, combined with & | ! and consumed by
/// select/any/all (never && || ?:, which a Mask has not). Bind a mask to a `MaskOf<Real>` variable,
/// not to `auto`: `bool & bool` is an int.
///
/// Contract: every operation gives the same bits in the AVX-512, AVX2 and portable back ends and
/// for a scalar double. Only the sign and payload of a NaN result are unspecified (x86 takes them
/// from an operand whose place the compiler chooses). It holds under -ffp-contract=off and without
/// -ffast-math: products and sums are fused exactly where `fma` is written.
///
/// - fma(a,b,c) = a*b + c; fms(a,b,c) = a*b - c; fnma(a,b,c) = c - a*b, each rounded once.
/// - min(a,b) = a < b ? a : b and max(a,b) = a > b ? a : b, as x86 minpd: if either is NaN, or both
///   are zeros, the result is b. Hence min(x, limit) drops a NaN in x, min(limit, x) keeps it.
/// - clamp(x, lo, hi) keeps a NaN in x.
/// - first_lanes(n) takes any n >= 0; from 8 on all lanes.
/// - comparisons with a NaN are false, except !=.
/// - sum adds in the order ((0+4)+(2+6)) + ((1+5)+(3+7)); hmin and hmax fold in that order too.
/// - load and store need 64-byte alignment, loadu and storeu none. store(to, x) writes as many
///   doubles as x has: `store(to, 0.0)` writes ONE, `store(to, Pack(0.0))` fills a batch.
///
/// Assumption: round to nearest. The tests of this contract run without flush to zero; the sweeps
/// of a run flush denormals (core/parallel.hpp). This file and its simd_*.hpp are the only ones
/// with intrinsics, but for the flag that core/parallel.cpp sets.
#pragma once

#include "krater/core/isa.hpp"
#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#include "krater/core/simd_avx512.hpp"
#define KRATER_SIMD_X86_HALVES 1
#elif defined(__AVX2__) && defined(__FMA__)
#include "krater/core/simd_avx2.hpp"
#define KRATER_SIMD_X86_HALVES 1
#else
#include "krater/core/simd_portable.hpp"
#endif

namespace krater::inline KRATER_ISA {

namespace simd_detail {
template <class Real>
struct Traits;
template <>
struct Traits<double> {
  using MaskType = bool;
  static constexpr int lanes = 1;
};
template <>
struct Traits<Pack> {
  using MaskType = Mask;
  static constexpr int lanes = Pack::lanes;
};
}  // namespace simd_detail

/// bool for double, Mask for Pack.
template <class Real>
using MaskOf = typename simd_detail::Traits<Real>::MaskType;

/// 1 for double, 8 for Pack.
template <class Real>
inline constexpr int lanes_of = simd_detail::Traits<Real>::lanes;

/// One double, or eight from a 64-byte boundary: what `Real` holds.
template <class Real>
KRATER_FORCE_INLINE Real load_as(const double* from);
template <>
KRATER_FORCE_INLINE double load_as<double>(const double* from) {
  return *from;
}
template <>
KRATER_FORCE_INLINE Pack load_as<Pack>(const double* from) {
  return load(from);
}
KRATER_FORCE_INLINE void store(double* to, double a) { *to = a; }
KRATER_FORCE_INLINE void storeu(double* to, double a) { *to = a; }

KRATER_FORCE_INLINE Pack& operator+=(Pack& a, Pack b) { return a = a + b; }
KRATER_FORCE_INLINE Pack& operator-=(Pack& a, Pack b) { return a = a - b; }
KRATER_FORCE_INLINE Pack& operator*=(Pack& a, Pack b) { return a = a * b; }
KRATER_FORCE_INLINE Pack& operator/=(Pack& a, Pack b) { return a = a / b; }

/// x limited to [lo, hi]; the operand order makes a NaN in x come through.
KRATER_FORCE_INLINE double clamp(double x, double lo, double hi) { return min(hi, max(lo, x)); }
KRATER_FORCE_INLINE Pack clamp(Pack x, Pack lo, Pack hi) { return min(hi, max(lo, x)); }

KRATER_FORCE_INLINE Mask is_finite(Pack a) { return abs(a) <= Pack(simd_detail::largest_finite); }
KRATER_FORCE_INLINE bool any(Mask m) { return bits(m) != 0U; }
KRATER_FORCE_INLINE bool all(Mask m) { return bits(m) == 0xffU; }
KRATER_FORCE_INLINE bool none(Mask m) { return bits(m) == 0U; }

#if defined(KRATER_SIMD_X86_HALVES)
#define KRATER_FOLD(name, op)                                                                \
  KRATER_FORCE_INLINE double name(Pack a) {                                                  \
    const __m256d h = _mm256_##op##_pd(simd_detail::low_half(a), simd_detail::high_half(a)); \
    const __m128d q = _mm_##op##_pd(_mm256_castpd256_pd128(h), _mm256_extractf128_pd(h, 1)); \
    return _mm_cvtsd_f64(_mm_##op##_sd(q, _mm_unpackhi_pd(q, q)));                           \
  }
KRATER_FOLD(sum, add)
KRATER_FOLD(hmin, min)
KRATER_FOLD(hmax, max)
#undef KRATER_FOLD
#undef KRATER_SIMD_X86_HALVES
#endif

}  // namespace krater::inline KRATER_ISA
