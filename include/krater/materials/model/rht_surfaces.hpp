// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The three surfaces of rht.hpp and its solid. p, stresses and strengths in units of f there,
/// compression positive; F_c, F_t: strength increase with the rate, 1 without.
#pragma once

#include <cmath>

#include "krater/materials/eos/split.hpp"
#include "krater/materials/returns/lode.hpp"
#include "krater/materials/returns/softening.hpp"

namespace krater::inline KRATER_ISA {

/// Failure on the compressive meridian; F_r goes from F_t (3p <= -F_t f_t) to F_c (3p >= F_c):
///   3p >= F_r       A [p - F_r/3 + (A/F_r)^(-1/n)]^n
///   0 <= 3p < F_r   F_r f_s/Q1 + 3p (1 - f_s/Q1)
///   p < 0           F_r f_s/Q1 - 3p [1/Q2 - f_s/(Q1 f_t)], not below 0
/// so unconfined compression gives f, shear f_s, direct tension f_t. Q2 = Q0 + B p in [1/2, 1] is
/// the ratio of the meridians, Q1 the section of Willam and Warnke at 30 degrees.
///
/// Elastic limit: F_e times the failure at p/F_e, F_e from g_t (3p <= -F_t g_t f_t) to g_c
/// (3p >= F_c g_c), times the cap sqrt(1 - <(p - p_u)/(p_c - p_u)>^2).
/// Residual: A_f p^n_f, 0 for p <= 0, at most the failure.
struct RhtSurfaces {
  double A, n, f_s, f_t, Q0, B, g_c, g_t, A_f, n_f;

  template <class Real>
  struct Meridians {
    Real Q1, Q2;
  };
  template <class Real>
  KRATER_FORCE_INLINE Meridians<Real> meridians(Real p) const {
    constexpr double cos30 = 0.86602540378443865;
    const Real Q2 = clamp(fma(Real(B), p, Real(Q0)), Real(0.5), Real(1.0));
    return {willam_warnke(Real(cos30), Q2), Q2};
  }
  template <class Real>
  struct Rates {
    Real compression, tension;
  };
  /// From `low` where 3p <= -pulled to `high` where 3p >= pressed.
  template <class Real>
  KRATER_FORCE_INLINE Real between(Real p, Real low, Real high, Real pulled, Real pressed) const {
    const Real way = clamp(fma(Real(3.0), p, pulled) / (pressed + pulled), Real(0.0), Real(1.0));
    return fma(way, high - low, low);
  }
  template <class Real>
  KRATER_FORCE_INLINE Real failure(Real p, const Meridians<Real>& q, const Rates<Real>& F) const {
    const Real F_r = between(p, F.tension, F.compression, f_t * F.tension, F.compression);
    const Real start = exp((-1.0 / n) * log(A / F_r)), shear = f_s / q.Q1;
    const Real above = A * positive_power(max(Real(0.0), p - F_r * (1.0 / 3.0) + start), n);
    const Real low = fma(3.0 * p, Real(1.0) - shear, F_r * shear);
    const Real steep = Real(1.0) / q.Q2 - shear * (1.0 / f_t);
    const Real pulled = max(Real(0.0), fnma(3.0 * p, steep, F_r * shear));
    return select(3.0 * p >= F_r, above, select(p < Real(0.0), pulled, low));
  }
  /// Without the cap.
  template <class Real>
  KRATER_FORCE_INLINE Real elastic(Real p, const Meridians<Real>& q, const Rates<Real>& F) const {
    const Real F_e = between(p, Real(g_t), Real(g_c), g_t * f_t * F.tension, g_c * F.compression);
    return F_e * failure(p / F_e, q, F);
  }
  template <class Real>
  KRATER_FORCE_INLINE Real residual(Real p, Real failure) const {
    return min(failure, A_f * positive_power(max(Real(0.0), p), n_f));
  }
  /// p of failure = 0 without a rate, below 0; by fixed point, for Q hardly depends on p.
  double hugoniot_tension() const {
    double p = 0;
    for (int i = 0; i < 50; ++i) {
      const auto q = meridians(p);
      p = (f_s / q.Q1) / (3.0 * (1.0 / q.Q2 - f_s / (q.Q1 * f_t)));
    }
    return p;
  }
};

/// Solid of density rho_s, nu = rho_s/rho_s0 - 1:
///   nu >= 0  p = A1 nu + A2 nu^2 + A3 nu^3 + (B0 + B1 nu) rho_s e
///   nu < 0   p = T1 nu + T2 nu^2 + B0 rho_s e
struct RhtSolid {
  double A1, A2, A3, B0, B1, T1, T2, rho0, c0;  ///< rho0: of the solid, rho_s0

  template <class Real>
  KRATER_FORCE_INLINE PressureSplit<Real> split(Real rho, Real) const {
    const Real nu = (rho - rho0) * (1.0 / rho0);
    const MaskOf<Real> pressed = nu >= Real(0.0);
    const Real cold = nu * fma(nu, fma(nu, Real(A3), Real(A2)), Real(A1));
    return {select(pressed, cold, nu * fma(nu, Real(T2), Real(T1))),
            rho * fma(Real(B1), max(Real(0.0), nu), Real(B0))};
  }
  /// rho (dp/drho)_e + (p/rho) (dp/de)_rho.
  template <class Real>
  KRATER_FORCE_INLINE Real bulk_modulus(Real rho, Real v, Real p, Real e) const {
    const Real nu = (rho - rho0) * (1.0 / rho0);
    const MaskOf<Real> pressed = nu >= Real(0.0);
    const Real cold = fma(nu, fma(nu, Real(3.0 * A3), Real(2.0 * A2)), Real(A1));
    const Real slope = select(pressed, cold, fma(nu, Real(2.0 * T2), Real(T1)));
    const Real gamma = fma(Real(B1), max(Real(0.0), nu), Real(B0));
    const Real by_heat = e * fma(gamma, Real(rho0), select(pressed, B1 * rho, Real(0.0)));
    return fma(nu + 1.0, slope + by_heat, p * v * rho * gamma);
  }
};

}  // namespace krater::inline KRATER_ISA
