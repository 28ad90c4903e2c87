// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// p = (1 - gamma mu/2) p_H + gamma rho e,  mu = rho/rho0 - 1 (theory 9, CCF (49)-(51)):
///   mu > 0:  p_H = a0 mu + b0 mu^2 + c0 mu^3,  gamma = gamma0 rho0/rho
///   else:    p_H = a0 mu,                      gamma = gamma0
/// Isentropic modulus by Decision 5: CCF (61)-(62) as printed miss gamma and d gamma/d mu.
/// e = 0 at rho0, T_ref.
#pragma once

#include "krater/materials/eos/split.hpp"
#include "krater/materials/law.hpp"

namespace krater::inline KRATER_ISA {

struct MieGruneisenPolynomial {
  double a0, b0, cubic, gamma0;
  double rho0, c0;
  double per_rho0;

  static constexpr Family family = Family::eos;
  static constexpr const char* name = "mie_gruneisen_polynomial";
  static constexpr const char* equation =
      "p = (1 - gamma mu/2) p_H + gamma rho e, p_H = a0 mu + b0 <mu>^2 + c0 <mu>^3, "
      "gamma = gamma0 rho0/rho (mu > 0) or gamma0";
  static constexpr const char* reference =
      "Zhou, Sha, Tamma, Miller, AIAA-2006-1758, eqs. (49)-(51)";
  static constexpr Parameter<MieGruneisenPolynomial> parameters[] = {
      {{"a0", "Pa", Range::positive, kRequired, "bulk modulus at rest"},
       &MieGruneisenPolynomial::a0},
      {{"b0", "Pa", Range::any, kRequired, "factor of mu^2 in the Hugoniot pressure"},
       &MieGruneisenPolynomial::b0},
      {{"c0", "Pa", Range::any, kRequired, "factor of mu^3 in the Hugoniot pressure"},
       &MieGruneisenPolynomial::cubic},
      {{"gamma0", "1", Range::non_negative, kRequired, "Grueneisen parameter at rest", "Gamma_0"},
       &MieGruneisenPolynomial::gamma0},
  };

  void prepare(const MaterialConstants& constants) {
    rho0 = constants.density;
    per_rho0 = 1.0 / rho0;
    c0 = sqrt(a0 / rho0);
  }

  template <class Real>
  KRATER_FORCE_INLINE PressureSplit<Real> split(Real rho, Real v) const {
    const Real mu = (rho - rho0) * per_rho0;
    const MaskOf<Real> compressed = mu > Real(0.0);
    const Real eta = mu * (rho0 * v);
    const Real p_h = select(compressed, hugoniot(mu), a0 * mu);
    // gamma mu is gamma0 eta in compression, gamma0 mu in expansion.
    const Real factor = fnma(Real(0.5 * gamma0), select(compressed, eta, mu), Real(1.0));
    return {factor * p_h, gamma0 * select(compressed, Real(rho0), rho)};
  }

  template <class Real>
  KRATER_FORCE_INLINE Real bulk_modulus(Real rho, Real v, Real p, Real e) const {
    const Real mu = (rho - rho0) * per_rho0;
    const Real x = mu + 1.0;
    const Real per_x = rho0 * v;
    const Real eta = mu * per_x;
    const Real slope = fma(mu, fma(mu, Real(3.0 * cubic), Real(2.0 * b0)), Real(a0));
    const Real compressed = fma(x * fnma(Real(0.5 * gamma0), eta, Real(1.0)), slope,
                                gamma0 * (fnma(Real(0.5), hugoniot(mu), p) * per_x));
    const Real expanded = fma(x * a0, fnma(Real(gamma0), mu, Real(1.0)), gamma0 * fma(rho, e, p));
    return select(mu > Real(0.0), compressed, expanded);
  }

 private:
  template <class Real>
  KRATER_FORCE_INLINE Real hugoniot(Real mu) const {
    return mu * fma(mu, fma(mu, Real(cubic), Real(b0)), Real(a0));
  }
};

}  // namespace krater::inline KRATER_ISA
