// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The operations of simd.hpp for one `double`, with `bool` as its mask. Include simd.hpp, not this
/// file.
///
/// They exist so that a law written once as `template <class Real>` serves both a batch (Pack) and
/// a single point (double) with the same bits. Names such as `sqrt` and `abs` hide those of <cmath>
/// inside namespace krater.
#pragma once

#include <cstdint>

#include "krater/core/isa.hpp"
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

// Comparisons are marked const so that clang sees that `a(x) & b(y)` of two bools has no side
// effect to skip.
#define KRATER_SCALAR_TEST __attribute__((const)) KRATER_FORCE_INLINE

namespace krater::inline KRATER_ISA {

/// x = mantissa * 2^exponent with mantissa in [0.75, 1.5) and an integral exponent.
/// x = +-0 gives (1, -inf); +inf gives (1, +inf); NaN and x < 0 give a NaN mantissa. Denormals are
/// exact.
template <class Real>
struct SplitExponent {
  Real exponent;
  Real mantissa;
};

namespace simd_detail {
/// Adding this to |n| < 2^51 rounds n to the nearest integer (ties to even) in the low bits.
inline constexpr double round_magic = 0x1.8p52;
/// Adding this to an integral n leaves n + 1023, the biased exponent of 2^n, in the low 12 bits.
inline constexpr double exponent_magic = 0x1.8p52 + 1023.0;
inline constexpr double smallest_normal = 0x1p-1022;
inline constexpr double largest_finite = 0x1.fffffffffffffp1023;
inline constexpr double infinity = __builtin_huge_val();
inline constexpr double not_a_number = __builtin_nan("");
inline constexpr std::uint64_t mantissa_bits = 0x000fffffffffffffULL;
inline constexpr std::uint64_t one_bits = 0x3ff0000000000000ULL;
/// Bits of 2^52: or-ing an integer below 2^52 into it makes the double 2^52 + integer.
inline constexpr std::uint64_t two52_bits = 0x4330000000000000ULL;
}  // namespace simd_detail

KRATER_FORCE_INLINE double fma(double a, double b, double c) { return __builtin_fma(a, b, c); }
KRATER_FORCE_INLINE double fms(double a, double b, double c) { return __builtin_fma(a, b, -c); }
KRATER_FORCE_INLINE double fnma(double a, double b, double c) { return __builtin_fma(-a, b, c); }
KRATER_FORCE_INLINE double min(double a, double b) { return a < b ? a : b; }
KRATER_FORCE_INLINE double max(double a, double b) { return a > b ? a : b; }
KRATER_FORCE_INLINE double abs(double a) { return __builtin_fabs(a); }
KRATER_FORCE_INLINE double floor(double a) { return __builtin_floor(a); }

KRATER_FORCE_INLINE double sqrt(double a) {
#if defined(__SSE2__)
  // Not __builtin_sqrt: without -fno-math-errno that adds a branch to the library for a < 0.
  const __m128d v = _mm_set_sd(a);
  return _mm_cvtsd_f64(_mm_sqrt_sd(v, v));
#else
  return __builtin_sqrt(a);
#endif
}

KRATER_SCALAR_TEST bool is_finite(double a) {
  return __builtin_fabs(a) <= simd_detail::largest_finite;
}

KRATER_FORCE_INLINE double select(bool m, double a, double b) { return m ? a : b; }
KRATER_SCALAR_TEST bool any(bool m) { return m; }
KRATER_SCALAR_TEST bool all(bool m) { return m; }
KRATER_SCALAR_TEST bool none(bool m) { return !m; }
KRATER_SCALAR_TEST unsigned bits(bool m) { return m ? 1U : 0U; }

KRATER_FORCE_INLINE double sum(double a) { return a; }
KRATER_FORCE_INLINE double hmin(double a) { return a; }
KRATER_FORCE_INLINE double hmax(double a) { return a; }

/// 2^n for integral n in [-1022, 1023].
KRATER_FORCE_INLINE double exp2_int(double n) {
  const auto shifted = __builtin_bit_cast(std::uint64_t, n + simd_detail::exponent_magic);
  return __builtin_bit_cast(double, shifted << 52);
}

/// x * 2^n, rounded once, for integral n in [-2000, 2000] and |x| in [0.5, 2]: two factors because
/// 2^n alone may not be representable; the first product is exact.
KRATER_FORCE_INLINE double scale_pow2(double x, double n) {
  const double half = (n * 0.5 + simd_detail::round_magic) - simd_detail::round_magic;
  return x * exp2_int(half) * exp2_int(n - half);
}

/// See SplitExponent.
KRATER_FORCE_INLINE SplitExponent<double> split_exponent(double x) {
  using namespace simd_detail;
  const bool tiny = x < smallest_normal;
  const auto b = __builtin_bit_cast(std::uint64_t, tiny ? x * 0x1p54 : x);
  const double biased = __builtin_bit_cast(double, (b >> 52) | two52_bits);
  const double m = __builtin_bit_cast(double, (b & mantissa_bits) | one_bits);
  double e = biased - (tiny ? 0x1p52 + 1023.0 + 54.0 : 0x1p52 + 1023.0);
  const bool upper = m >= 1.5;
  e = upper ? e + 1.0 : e;
  e = x == 0.0 ? -infinity : e;
  e = x == infinity ? infinity : e;
  return {e, x >= 0.0 ? (upper ? m * 0.5 : m) : not_a_number};
}

}  // namespace krater::inline KRATER_ISA
