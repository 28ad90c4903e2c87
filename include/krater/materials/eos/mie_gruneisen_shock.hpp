// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Mie-Grueneisen about the Hugoniot Us = c0 + S1 up; eta = 1 - rho0/rho, mu = rho/rho0 - 1:
///   eta >= 0: p = p_H (1 - Gamma0 eta/2) + Gamma0 rho0 e,  p_H = rho0 c0^2 eta/(1 - S1 eta)^2
///   eta <  0: p = rho0 c0^2 mu + Gamma0 rho e                                        Decision 9
/// Beyond eta_c = 0.8/S1 p_H is continued linearly with its slope there (the pole is at 1/S1) and
/// counted. Reference: SPEAR (S.36)-(S.41), theory 9; K_s by Decision 5. Gamma rho is constant in
/// compression; e = 0 at rho0.
#pragma once

#include "krater/materials/eos/split.hpp"
#include "krater/materials/law.hpp"

namespace krater::inline KRATER_ISA {

struct MieGruneisenShock {
  double c0, S1, gamma0;
  double rho0;
  double per_rho0;
  double modulus;                    ///< rho0 c0^2 [Pa]
  double eta_c, p_at_c, slope_at_c;  ///< where the linear continuation starts

  static constexpr Family family = Family::eos;
  static constexpr const char* name = "mie_gruneisen_shock";
  static constexpr const char* equation =
      "p = p_H (1 - gamma0 eta/2) + gamma0 rho0 e, p_H = rho0 c0^2 eta/(1 - S1 eta)^2, "
      "eta = 1 - rho0/rho; in expansion p = rho0 c0^2 (rho/rho0 - 1) + gamma0 rho e";
  static constexpr const char* reference =
      "Spear, Palazotto, Kemnitz 2021, eqs. (36)-(41); linear Us-up Hugoniot";
  static constexpr Parameter<MieGruneisenShock> parameters[] = {
      {{"c0", "m/s", Range::positive, kRequired, "bulk sound speed at rest", "C_0"},
       &MieGruneisenShock::c0},
      {{"S1", "1", Range::non_negative, kRequired, "slope of Us over up", "s"},
       &MieGruneisenShock::S1},
      {{"gamma0", "1", Range::non_negative, kRequired, "Grueneisen parameter at rest", "Gamma_0"},
       &MieGruneisenShock::gamma0},
  };

  void prepare(const MaterialConstants& constants) {
    rho0 = constants.density;
    per_rho0 = 1.0 / rho0;
    modulus = rho0 * c0 * c0;
    eta_c = S1 > 0.8 ? 0.8 / S1 : 1.0;  // eta < 1 always: a flatter Hugoniot has no pole to meet
    const double r = 1.0 / (1.0 - S1 * eta_c);
    p_at_c = modulus * eta_c * r * r;
    slope_at_c = modulus * (1.0 + S1 * eta_c) * r * r * r;
  }

  template <class Real>
  KRATER_FORCE_INLINE PressureSplit<Real> split(Real rho, Real v) const {
    const Real mu = (rho - rho0) * per_rho0;
    const Real eta = mu * (rho0 * v);
    const MaskOf<Real> compressed = mu >= Real(0.0);
    const Real hot = hugoniot(eta).pressure * fnma(Real(0.5 * gamma0), eta, Real(1.0));
    return {select(compressed, hot, modulus * mu), gamma0 * select(compressed, Real(rho0), rho)};
  }

  template <class Real>
  KRATER_FORCE_INLINE Real bulk_modulus(Real rho, Real v, Real p, Real e) const {
    const Real mu = (rho - rho0) * per_rho0;
    const Real eta = mu * (rho0 * v);
    const Hugoniot<Real> h = hugoniot(eta);
    const Real at_constant_e = h.slope * fnma(Real(0.5 * gamma0), eta, Real(1.0));
    const Real compressed =
        (rho0 * v) * fma(Real(gamma0), fnma(Real(0.5), h.pressure, p), at_constant_e);
    const Real expanded = fma(rho, Real(c0 * c0), gamma0 * fma(rho, e, p));
    return select(mu > Real(0.0), compressed, expanded);
  }

  template <class Real>
  KRATER_FORCE_INLINE MaskOf<Real> beyond_pole(Real rho) const {
    return rho * (1.0 - eta_c) > Real(rho0);
  }

 private:
  /// p_H and d p_H / d eta.
  template <class Real>
  struct Hugoniot {
    Real pressure;
    Real slope;
  };
  template <class Real>
  KRATER_FORCE_INLINE Hugoniot<Real> hugoniot(Real eta) const {
    // Operands in the order that lets a NaN through.
    const Real limited = min(Real(eta_c), eta);
    const Real r = Real(1.0) / fnma(Real(S1), limited, Real(1.0));
    const Real scale = modulus * r * r;
    const MaskOf<Real> beyond = eta > Real(eta_c);
    const Real slope =
        select(beyond, Real(slope_at_c), scale * r * fma(Real(S1), limited, Real(1.0)));
    return {select(beyond, fma(Real(slope_at_c), eta - eta_c, Real(p_at_c)), scale * limited),
            slope};
  }
};

}  // namespace krater::inline KRATER_ISA
