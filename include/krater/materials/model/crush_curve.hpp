// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Pressure of a porous brittle solid, from mu = rho/rho0 - 1 and the largest mu so far alone,
/// never from the last p (pressure and mu positive in compression):
///   loading     K_el mu up to (mu_crush, p_crush);  a line to p_lock, where all pores are closed;
///               g(x) = K1 x + K2 x^2 + K3 x^3 beyond, x = (mu - mu_L)/(1 + mu_L), strain of grains
///   unloading   p = p_load(mu_max) - K_u (mu_max - mu), and up again on the same line;
///               K_u = K_el to mu_crush, then linear in mu_max to K_D = max(K1, g'(x))/(1 + mu_L)
/// `lock_strain: grain` (default) reads mu_lock = mu_L, the density of the grains over rho0, so the
/// crushing ends at mu_L + x_B (1 + mu_L) with g(x_B) = p_lock; `pressure` ends it at mu_lock.
///
/// The larger of K1 and g' is ours: the published K1/(1 + mu_L) alone is shallower than the loading
/// curve where g' > K1 (cards of 20 and 44 MPa), and a closed cycle then makes energy.
/// `unloading: published` is that, for comparisons.
///
/// Heat of crushing, per mass. On an unloading line p = K_u (mu - mu_p) the energy stored down to
/// p = 0 is psi = K_u [ln r - 1 + 1/r]/rho0, r = (1 + mu)/(1 + mu_p); of the work -p dv, what is
/// not d psi is lost:
///   d heat = p d mu_p/(rho0 (1 + mu)(1 + mu_p)) - (y^2/2 + y^3/3 + ...) dK_u/rho0,  y = 1 - 1/r
/// by the mean of both ends of a step: second order in it. The series is cut after y^4/4 (y < 0.1:
/// 1e-6 of psi).
///
/// Reference: Holmquist, Johnson, Cook, 14th Int. Symp. on Ballistics, Quebec 1993.
#pragma once

#include <cmath>

#include "krater/core/lane_math.hpp"
#include "krater/materials/law.hpp"

namespace krater::inline KRATER_ISA {

struct CrushCurve {
  double p_crush, mu_crush, p_lock, mu_lock, lock_reading, K1, K2, K3, unloading;
  double K_el, mu_L, per_grain;  ///< per_grain: 1/(1 + mu_L)
  double mu_pl;                  ///< where crushing ends
  double crush_slope, K_closed;  ///< of the crush line; K_u at its end
  double mu_p_most;              ///< mu_p at mu_pl
  double follows;                ///< 1: K_u of compact material follows g'; 0: published

  void prepare_curve() {
    K_el = p_crush / mu_crush;
    follows = unloading < 0.5 ? 1.0 : 0.0;
    const double x = locking_strain();
    const bool grain = lock_reading < 0.5;
    mu_L = grain ? mu_lock : (mu_lock - x) / (1.0 + x);
    mu_pl = grain ? mu_lock + x * (1.0 + mu_lock) : mu_lock;
    per_grain = 1.0 / (1.0 + mu_L);
    crush_slope = (p_lock - p_crush) / (mu_pl - mu_crush);
    K_closed = std::fmax(K1, follows * grain_slope(x)) * per_grain;
    mu_p_most = mu_pl - p_lock / K_closed;
  }
  const char* curve_problem() const {
    const double x = locking_strain();
    if (!(p_lock > p_crush)) return "lock_pressure must lie above crush_pressure";
    if (!std::isfinite(x) || std::fabs(grain(x) - p_lock) > 1e-9 * p_lock)
      return "K1, K2, K3 never reach lock_pressure";
    if (!(mu_pl > mu_crush)) return "lock_compression must lie above crush_compression";
    if (!(crush_slope <= std::fmin(K_el, K_closed)))
      return "the crush line may not be steeper than the elastic and the compact line: cycles "
             "would "
             "make energy";
    return nullptr;
  }

  template <class Real>
  KRATER_FORCE_INLINE Real grain(Real x) const {
    return x * fma(x, fma(x, Real(K3), Real(K2)), Real(K1));
  }
  template <class Real>
  KRATER_FORCE_INLINE Real grain_slope(Real x) const {
    return fma(x, fma(x, Real(3.0 * K3), Real(2.0 * K2)), Real(K1));
  }
  /// x_B of g(x_B) = p_lock, by Newton from the linear part; NaN where there is none.
  double locking_strain() const {
    double x = p_lock / K1;
    for (int i = 0; i < 50; ++i) x -= (grain(x) - p_lock) / grain_slope(x);
    return x > 0 ? x : NAN;
  }

  /// The loading curve and the unloading line that leaves it there.
  template <class Real>
  struct Line {
    Real mu_max, pressure, modulus;
    KRATER_FORCE_INLINE Real at(Real mu) const { return fnma(modulus, mu_max - mu, pressure); }
    /// Compression after unloading to p = 0.
    KRATER_FORCE_INLINE Real rest() const { return mu_max - pressure / modulus; }
  };
  template <class Real>
  KRATER_FORCE_INLINE Line<Real> line(Real mu_max) const {
    const Real x = (mu_max - mu_L) * per_grain;
    const Real share = (mu_max - mu_crush) * (1.0 / (mu_pl - mu_crush));
    const MaskOf<Real> elastic = mu_max <= Real(mu_crush), crushing = mu_max <= Real(mu_pl);
    const Real crush = fma(Real(crush_slope), mu_max - mu_crush, Real(p_crush));
    const Real partly = fma(share, Real(K_closed - K_el), Real(K_el));
    const Real compact = max(Real(K1), follows * grain_slope(x)) * per_grain;
    return {mu_max, select(elastic, K_el * mu_max, select(crushing, crush, grain(x))),
            select(elastic, Real(K_el), select(crushing, partly, compact))};
  }
  /// What stays of the compression after unloading, up to the end of crushing; `rest` is the
  /// line's.
  template <class Real>
  KRATER_FORCE_INLINE Real crushed(const Line<Real>& line, Real rest) const {
    return select(line.mu_max >= Real(mu_pl), Real(mu_p_most), rest);
  }
  template <class Real>
  KRATER_FORCE_INLINE Real lasting(Real mu_max) const {
    const Line<Real> at = line(mu_max);
    return crushed(at, at.rest());
  }
};

/// Heat of crushing from one unloading line to a later one [J/kg]; `a`, `b` are their compressions
/// at p = 0.
template <class Real>
KRATER_FORCE_INLINE Real crush_heat(const CrushCurve::Line<Real>& before, Real a,
                                    const CrushCurve::Line<Real>& after, Real b, double rho0) {
  const Real mu = fma(Real(0.5), before.mu_max + after.mu_max, Real(1.0));
  const Real rest = fma(Real(0.5), a + b, Real(1.0)), y = (mu - rest) / mu;
  const Real p = 0.5 * (before.pressure + after.pressure);
  const Real stored = y * y * fma(y, fma(y, Real(0.25), Real(1.0 / 3.0)), Real(0.5));
  const Real heat = fnma(stored, after.modulus - before.modulus, p * (b - a) / (mu * rest));
  return max(Real(0.0), heat) * (1.0 / rho0);  // this order keeps a NaN
}

}  // namespace krater::inline KRATER_ISA
