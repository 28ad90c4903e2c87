// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The three surfaces, the tables and the rate factors of karagozian_case.hpp, of concrete of
/// strength f (all coefficients are pure numbers, pressure and stresses in units of f there).
#pragma once

#include <cmath>

#include "krater/core/lane_math.hpp"
#include "krater/materials/returns/polyline.hpp"

namespace krater::inline KRATER_ISA {

/// Stress differences on the compressive meridian at p (in units of f, compression positive):
///   maximum   a0 + p/(a1 + a2 p) for p >= 1/3;  3/2 (p + f_t)/psi(p) below, 0 below -f_t
///   yield     a0y + p/(a1y + a2y p) for p >= 0.15;  a line to 1.35 f_t at p = 0;  1.35 (p + f_t)
///   residual  p/(a1f + a2f p), never above the maximum, 0 for p <= 0
/// psi is the ratio of the meridians: 1/2 for p <= 0, the value that makes the maximum continuous
/// at 1/3, 1.15 over the maximum at 2.3/3 (biaxial strength 1.15 f), 0.753 at 3, 1 from 8.45 on.
struct KaragozianSurfaces {
  double f_t;  ///< over f
  double a0, a1, a2, a0y, a1y, a2y, a1f, a2f;
  Polyline<5> psi;
  double yield_corner;  ///< yield at 0.15

  static constexpr double kLow = 1.0 / 3.0, kYieldLow = 0.15, kBiaxial = 2.3 / 3.0;

  void prepare() {
    const auto hyperbola = [&](double p) { return a0 + p / (a1 + a2 * p); };
    psi = Polyline<5>::through(
        {0.0, kLow, kBiaxial, 3.0, 8.45},
        {0.5, 1.5 * (kLow + f_t) / hyperbola(kLow), 1.15 / hyperbola(kBiaxial), 0.753, 1.0}, false);
    yield_corner = a0y + kYieldLow / (a1y + a2y * kYieldLow);
  }
  template <class Real>
  KRATER_FORCE_INLINE Real maximum(Real p, Real ratio) const {
    const Real pressed = max(Real(kLow), p), above = max(Real(0.0), p + f_t);
    return select(p < Real(kLow), 1.5 * above / ratio,
                  pressed / fma(Real(a2), pressed, Real(a1)) + a0);
  }
  template <class Real>
  KRATER_FORCE_INLINE Real yield(Real p) const {
    const Real pressed = max(Real(kYieldLow), p), above = max(Real(0.0), p + f_t);
    const Real line = fma(Real((yield_corner - 1.35 * f_t) / kYieldLow), p, Real(1.35 * f_t));
    return select(
        p < Real(0.0), 1.35 * above,
        select(p < Real(kYieldLow), line, pressed / fma(Real(a2y), pressed, Real(a1y)) + a0y));
  }
  template <class Real>
  KRATER_FORCE_INLINE Real residual(Real p, Real maximum) const {
    const Real pressed = max(Real(0.0), p);
    return min(maximum, pressed / fma(Real(a2f), pressed, Real(a1f)));
  }

  /// By the pressure, p > 0, the meridians' ratio held; of the hyperbola p/(first + second p).
  template <class Real>
  static KRATER_FORCE_INLINE Real rise(Real p, double first, double second) {
    const Real below = fma(Real(second), max(Real(0.0), p), Real(first));
    return first / (below * below);
  }
  template <class Real>
  KRATER_FORCE_INLINE Real maximum_slope(Real p, Real ratio) const {
    return select(p < Real(kLow), 1.5 / ratio, rise(p, a1, a2));
  }
  template <class Real>
  KRATER_FORCE_INLINE Real yield_slope(Real p) const {
    return select(p < Real(kYieldLow), Real((yield_corner - 1.35 * f_t) / kYieldLow),
                  rise(p, a1y, a2y));
  }
  template <class Real>
  KRATER_FORCE_INLINE Real residual_slope(Real p) const {
    return rise(p, a1f, a2f);
  }
};

/// Strength increase with the rate e [1/s], f in MPa (CEB's curves with the corrected branches):
///   compression  (e/3e-5)^(1.026 alpha) to 30 /s, then gamma (e/3e-5)^(1/3);
///                alpha = 1/(5 + 0.9 f), log10 gamma = 6.156 alpha - 2
///   tension      (e/1e-6)^delta to 1 /s, then beta (e/1e-6)^(1/3);
///                delta = 1/(1 + 0.8 f), log10 beta = 6 delta - 2
/// never below 1 nor above the limits given.
struct KaragozianRates {
  double compression_power, gamma, tension_power, beta;  ///< gamma, beta: logarithms
  double compression_most, tension_most, on;             ///< on: 1 or 0

  static constexpr double kQuiet = 3e-5, kQuietTension = 1e-6, kKnee = 30.0, kKneeTension = 1.0;

  static KaragozianRates of(double f_MPa, double compression_most, double tension_most, bool on) {
    const double alpha = 1.0 / (5.0 + 0.9 * f_MPa), delta = 1.0 / (1.0 + 0.8 * f_MPa);
    const double ln10 = std::log(10.0);
    return {1.026 * alpha,
            ln10 * (6.156 * alpha - 2.0),
            delta,
            ln10 * (6.0 * delta - 2.0),
            compression_most,
            tension_most,
            on ? 1.0 : 0.0};
  }
  template <class Real>
  KRATER_FORCE_INLINE Real factor(Real log_rate, double quiet, double knee, double power,
                                  double shift) const {
    const Real above = log_rate - std::log(quiet);
    const Real slow = power * above, fast = fma(Real(1.0 / 3.0), above, Real(shift));
    return exp(on * max(Real(0.0), select(log_rate > Real(std::log(knee)), fast, slow)));
  }
  template <class Real>
  KRATER_FORCE_INLINE Real compression(Real log_rate) const {
    return min(Real(compression_most), factor(log_rate, kQuiet, kKnee, compression_power, gamma));
  }
  template <class Real>
  KRATER_FORCE_INLINE Real tension(Real log_rate) const {
    return min(Real(tension_most),
               factor(log_rate, kQuietTension, kKneeTension, tension_power, beta));
  }
};

}  // namespace krater::inline KRATER_ISA
