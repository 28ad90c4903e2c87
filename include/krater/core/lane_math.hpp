// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// exp, log, pow and x^(-1/3) for `double` and `Pack`, the same bits for both, in every back end
/// and at every place in a batch. Own algorithms, written once in fma: the C library's differ
/// between versions and machines.
///
/// exp:   x = n ln2 + r, |r| <= ln2/2;  e^x = 2^n (1 + r + r^2 Q(r)),  Q of degree 9.
///
/// log:   x = 2^e m, m in [3/4, 3/2), f = m - 1;  log x = e ln2 + f - f^2/2 + f^3 P(f),
///        P of degree 18.
///
/// pow:   e^(y (hi + lo)) with log x = hi + lo to about 2^-58, from s = f/(2+f) corrected by the
///        remainder of the division and log m = 2 atanh(s) = 2s + s^3 A(s^2), A of degree 7.
///
/// rcbrt: t from a polynomial of degree 5 (2^-17), then t (1 + h/3 + 2h^2/9 + 14h^3/81), the
///        series of t (1-h)^(-1/3) with h = 1 - x t^3.
///
/// Splitting as in J.-M. Muller, Elementary Functions (3rd ed., 2016). Coefficients: minimax in
/// relative error by a Remez exchange in 200-bit arithmetic, rounded to double (2^-56 for exp and
/// log, 2^-60 for A).
///
/// Largest errors measured on 2e6 arguments each against long double, in units in the last place:
///   exp 1.05 (denormal results too), log 0.93, rcbrt 0.99,
///   pow 1.21 for |y log x| < 10, 2.4 for < 50, 7.9 for < 200, 31 for < 700: its logarithm errs by
///   2^-58 of itself.
///
/// Edges: NaN in, NaN out. exp underflows gradually to 0 below -708.4 and to inf above 709.78.
/// log(+-0) = -inf, log(x<0) = NaN. pow(x,0) = pow(1,y) = 1 always (as in C); pow(0,y) = 0 or inf;
/// pow(x<0, y != 0) = NaN even for integral y. rcbrt(+-0) = inf, rcbrt(inf) = 0, rcbrt(x<0) = NaN.
/// Denormal arguments are exact; a thread that flushes them (core/parallel.hpp) sees zeros.
#pragma once

#include "krater/core/simd.hpp"

namespace krater::inline KRATER_ISA {

namespace lane_math_detail {

/// ln 2 in two parts; n * ln2_hi is exact for |n| < 2^12.
inline constexpr double ln2_hi = 0x1.62e42fefa2000p-1;
inline constexpr double ln2_lo = 0x1.9ef35793c7673p-41;
inline constexpr double log2_e = 0x1.71547652b82fep+0;

/// c0 + x (c1 + x (c2 + ...)). Longer polynomials interleave two to four of these: the chain of
/// dependent fma, not their number, is what a kernel waits for.
template <class Real>
KRATER_FORCE_INLINE Real horner(Real, double c0) {
  return Real(c0);
}
template <class Real, class... Rest>
KRATER_FORCE_INLINE Real horner(Real x, double c0, Rest... rest) {
  return fma(x, horner(x, rest...), Real(c0));
}

/// Nearest integer, ties to even, for |x| < 2^51.
template <class Real>
KRATER_FORCE_INLINE Real nearest(Real x) {
  return (x + simd_detail::round_magic) - simd_detail::round_magic;
}

/// Nearest integer to x / ln 2.
template <class Real>
KRATER_FORCE_INLINE Real nearest_quotient(Real x) {
  return fma(x, Real(log2_e), Real(simd_detail::round_magic)) - simd_detail::round_magic;
}

/// 2^n e^r for |r| <= 0.35.
template <class Real>
KRATER_FORCE_INLINE Real exp_reduced(Real n, Real r) {
  const Real z = r * r;
  const Real w = z * z;
  const Real q0 = fma(z, horner(r, 0x1.555555555087dp-5, 0x1.1111111127c34p-7),
                      horner(r, 0x1.000000000000ap-1, 0x1.55555555554fap-3));
  const Real q4 = fma(z, horner(r, 0x1.a0199a064bfe5p-16, 0x1.71df2561544fep-19),
                      horner(r, 0x1.6c16c1842b40fp-10, 0x1.a01a012a45e70p-13));
  const Real q8 = horner(r, 0x1.28ad7a89a5a9ap-22, 0x1.ad7f7fdcdf70ep-26);
  const Real q = fma(w, fma(w, q8, q4), q0);
  return scale_pow2(fma(z, q, r) + 1.0, n);
}

template <class Real>
KRATER_FORCE_INLINE Real exp(Real x) {
  // The limits lie beyond underflow and overflow; they keep n and r finite.
  const Real limited = clamp(x, Real(-750.0), Real(720.0));
  const Real n = nearest_quotient(limited);
  const Real r = fnma(n, Real(ln2_lo), fnma(n, Real(ln2_hi), limited));
  return exp_reduced(n, r);
}

template <class Real>
KRATER_FORCE_INLINE Real log(Real x) {
  const SplitExponent<Real> split = split_exponent(x);
  const Real f = split.mantissa - 1.0;
  const Real z = f * f;
  const Real w = z * z;
  const Real p0 = horner(w, 0x1.55555555555a0p-2, 0x1.2492492974ff4p-3, 0x1.745cec2054b73p-4,
                         0x1.101cb026dda57p-4, 0x1.9f4c048a6f009p-5);
  const Real p1 = horner(w, -0x1.0000000000772p-2, -0x1.00000063df024p-3, -0x1.5559396147c54p-4,
                         -0x1.fffce31871bcdp-5, -0x1.e180efee0aa58p-6);
  const Real p2 = horner(w, 0x1.999999998c6cep-3, 0x1.c71c70de9b334p-4, 0x1.3b1f032b59952p-4,
                         0x1.f252b03d86176p-5, 0x1.091ee285f70f3p-7);
  const Real p3 = horner(w, -0x1.5555555459248p-3, -0x1.999972ca67c1bp-4, -0x1.2465759d517d4p-4,
                         -0x1.e8e7e2dbf3632p-5);
  const Real p = fma(z, fma(f, p3, p2), fma(f, p1, p0));
  const Real tail = fma(split.exponent, Real(ln2_lo), z * f * p);
  // f - z/2 + tail with the largest term last; e ln2_hi is exact.
  const Real log_mantissa = f + fnma(Real(0.5), z, tail);
  return fma(split.exponent, Real(ln2_hi), log_mantissa);
}

/// An unevaluated sum, |lo| <= ulp(hi)/2.
template <class Real>
struct TwoPart {
  Real hi;
  Real lo;
};

/// log x to about 2^-58. For x = 0 and x = inf, hi is right and lo is NaN.
template <class Real>
KRATER_FORCE_INLINE TwoPart<Real> log_two_part(Real x) {
  const SplitExponent<Real> split = split_exponent(x);
  const Real m = split.mantissa;
  const Real f = m - 1.0;
  // m + 1 = u + u_low exactly; s + s_low = f / (m + 1).
  const Real u = m + 1.0;
  const Real u_low = m - (u - 1.0);
  const Real reciprocal = Real(1.0) / u;
  const Real s = f * reciprocal;
  const Real two_s_low = fnma(s, u_low, fnma(s, u, f)) * (reciprocal + reciprocal);
  const Real z = s * s;
  const Real w = z * z;
  const Real a0 = fma(w, horner(z, 0x1.2492492260834p-2, 0x1.c71c744771572p-3),
                      horner(z, 0x1.5555555555552p-1, 0x1.999999999b543p-2));
  const Real a4 = fma(w, horner(z, 0x1.0dd0b2a400307p-3, 0x1.1b85bcffc038bp-3),
                      horner(z, 0x1.745c556fc4439p-3, 0x1.3b350035240cbp-3));
  // d(2 atanh s) = 2 ds / (1 - s^2), here 2 ds (1 + s^2).
  const Real correction = fma(two_s_low, z, two_s_low);
  const Real tail = fma(s * z, fma(w * w, a4, a0), correction);
  const Real two_s = s + s;
  const Real large = fma(split.exponent, Real(ln2_hi), two_s);
  const Real rounding = two_s - fnma(split.exponent, Real(ln2_hi), large);
  // For x = 0 and x = inf the difference is inf - inf.
  const Real lost = select(is_finite(split.exponent), rounding, Real(0.0));
  const Real small = fma(split.exponent, Real(ln2_lo), tail) + lost;
  const Real hi = large + small;
  return {hi, small - (hi - large)};
}

template <class Real>
KRATER_FORCE_INLINE Real pow(Real x, Real y) {
  const TwoPart<Real> logarithm = log_two_part(x);
  const Real product = y * logarithm.hi;
  const Real low = fma(y, logarithm.lo, fms(y, logarithm.hi, product));
  const Real n = nearest_quotient(product);
  const Real r = fnma(n, Real(ln2_lo), fnma(n, Real(ln2_hi), product)) + low;
  // Far outside the range of exp, r is noise: the result is replaced afterwards, which costs no
  // latency.
  const Real raw = exp_reduced(n, r);
  const Real above = select(product > Real(720.0), Real(simd_detail::infinity), raw);
  const Real below = select(product < Real(-750.0), Real(0.0), above);
  const MaskOf<Real> is_one = (y == Real(0.0)) | (x == Real(1.0));
  return select(is_one, Real(1.0), below);
}

template <class Real>
KRATER_FORCE_INLINE Real rcbrt(Real x) {
  // x = 2^(3q) k, k = m 2^j with j = -1, 0 or 1; x^(-1/3) = 2^-q k^(-1/3).
  const SplitExponent<Real> split = split_exponent(x);
  const Real m = split.mantissa;
  const Real q = nearest(split.exponent * 0x1.5555555555555p-2);
  const Real j = fnma(q, Real(3.0), split.exponent);
  const MaskOf<Real> below = j < Real(0.0);
  const MaskOf<Real> above = j > Real(0.0);
  const Real k = m * select(below, Real(0.5), select(above, Real(2.0), Real(1.0)));
  const Real factor = select(below, Real(0x1.428a2f98d728bp+0),
                             select(above, Real(0x1.965fea53d6e3dp-1), Real(1.0)));
  const Real z = m * m;
  const Real even = horner(z, 0x1.f5d75b17dd782p+0, 0x1.3785393165d84p+1, 0x1.15f7b71da3fb4p-1);
  const Real odd = horner(z, -0x1.262bfcd613faep+1, -0x1.8f50bfc1a2e1fp+0, -0x1.43509c44eb235p-4);
  const Real t = fma(m, odd, even) * factor;
  const Real h = fnma(k * t, t * t, Real(1.0));
  const Real series =
      h * horner(h, 0x1.5555555555555p-2, 0x1.c71c71c71c71cp-3, 0x1.61f9add3c0ca4p-3);
  const Real root = fma(t, series, t) * exp2_int(-q);
  const Real finite = select(x == Real(simd_detail::infinity), Real(0.0), root);
  return select(x == Real(0.0), Real(simd_detail::infinity), finite);
}

}  // namespace lane_math_detail

/// e^x.
KRATER_FORCE_INLINE double exp(double x) { return lane_math_detail::exp(x); }
KRATER_FORCE_INLINE Pack exp(Pack x) { return lane_math_detail::exp(x); }

/// Natural logarithm.
KRATER_FORCE_INLINE double log(double x) { return lane_math_detail::log(x); }
KRATER_FORCE_INLINE Pack log(Pack x) { return lane_math_detail::log(x); }

/// x^y for x >= 0.
KRATER_FORCE_INLINE double pow(double x, double y) { return lane_math_detail::pow(x, y); }
KRATER_FORCE_INLINE Pack pow(Pack x, Pack y) { return lane_math_detail::pow(x, y); }

/// x^(-1/3) for x >= 0; the cube root is x * rcbrt(x)^2.
KRATER_FORCE_INLINE double rcbrt(double x) { return lane_math_detail::rcbrt(x); }
KRATER_FORCE_INLINE Pack rcbrt(Pack x) { return lane_math_detail::rcbrt(x); }

}  // namespace krater::inline KRATER_ISA
