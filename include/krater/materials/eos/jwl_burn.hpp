// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// An explosive that burns behind a programmed front: of its mass the fraction F are products,
///   p = F p_jwl(v, e) + (1 - F) K mu,     e = e_0 = E0/rho0 from the start, whatever F is,
///   F = max(F before, F_t, F_v),          F <= 1
///   F_t = (t - t_l) D/(k h),              t_l: when the front comes by (geometry/lighting.hpp)
///   F_v = (1 - v/v0)/(1 - v_CJ/v0),       1 - v_CJ/v0 = p_CJ/(rho0 D^2)
/// F_t spreads the front over k cells, so a shock that a grid can carry follows it; F_v burns what
/// a shock compresses before its time (overdriven waves, oblique incidence). As e_0 is carried by
/// the unburnt material too, burning brings no energy from outside: only its pressure begins to do
/// work, and the balance closes. A steady front then lies on the Rayleigh line of D and on the
/// Hugoniot of e_0, which touch in the Chapman-Jouguet state where D, p_CJ and the constants agree.
/// Assumptions: equilibrium products at once (no reaction zone); the unburnt material has no heat
/// of its own, p = K mu; F fixed for the sound speed.
/// References: Wilkins, UCRL-7322, 1964 (burn fractions); Giroux, UCRL-51079, 1973 (HEMP, max of
/// the two); Hallquist, LS-DYNA Theory Manual, "high explosive burn" (beta = 0, 1, 2).
#pragma once

#include "krater/materials/eos/jwl.hpp"
#include "krater/materials/law_state.hpp"

namespace krater::inline KRATER_ISA {

struct JwlBurn {
  double A, B, R1, R2, omega, E0, D, p_CJ, bulk_modulus, front_width, burn;
  double rho0, c0, initial_energy;
  double per_width;     ///< D/k [m/s]
  double per_collapse;  ///< 1/(1 - v_CJ/v0)
  Jwl products;

  static constexpr Family family = Family::eos;
  static constexpr const char* name = "jwl_burn";
  static constexpr const char* equation =
      "p = F p_jwl + (1 - F) K mu; F = max((t - t_lit) D/(k h), (1 - v/v0)/(1 - v_CJ/v0)), never "
      "falling; e = E0/rho0 at the start";
  static constexpr const char* reference =
      "Wilkins, UCRL-7322, 1964; Giroux, UCRL-51079, 1973; LS-DYNA Theory Manual";
  static constexpr Parameter<JwlBurn> parameters[] = {
      {{"A", "Pa", Range::positive, kRequired, "first factor"}, &JwlBurn::A},
      {{"B", "Pa", Range::any, kRequired, "second factor"}, &JwlBurn::B},
      {{"R1", "1", Range::positive, kRequired, "first exponent"}, &JwlBurn::R1},
      {{"R2", "1", Range::positive, kRequired, "second exponent"}, &JwlBurn::R2},
      {{"omega", "1", Range::positive, kRequired, "Grueneisen parameter"}, &JwlBurn::omega},
      {{"E0", "Pa", Range::positive, kRequired, "energy of detonation per reference volume"},
       &JwlBurn::E0},
      {{"D", "m/s", Range::positive, kRequired, "detonation velocity"}, &JwlBurn::D},
      {{"p_CJ", "Pa", Range::positive, kRequired, "Chapman-Jouguet pressure"}, &JwlBurn::p_CJ},
      {{"bulk_modulus", "Pa", Range::positive, kRequired, "K of the unburnt explosive", "K"},
       &JwlBurn::bulk_modulus},
      {{"front_width", "1", Range::positive, 3.0, "cells over which the front is spread", "k"},
       &JwlBurn::front_width},
      {{"burn", "1", Range::any, 0.0, "what burns it: the front, compression, or the first of both",
        nullptr, "both|front|compression"},
       &JwlBurn::burn},
  };

  using State = Columns<field::BurnFraction>;
  std::array<double, 1> initial_state() const { return {0.0}; }

  void prepare(const MaterialConstants& constants) {
    rho0 = constants.density;
    products.A = A;
    products.B = B;
    products.R1 = R1;
    products.R2 = R2;
    products.omega = omega;
    products.E0 = E0;
    products.prepare(constants);
    initial_energy = products.initial_energy;
    c0 = sqrt(bulk_modulus / rho0);
    per_width = lit() ? D / front_width : 0.0;
    per_collapse = burn == 1.0 ? 0.0 : rho0 * D * D / p_CJ;
  }
  bool lit() const { return burn != 2.0; }  ///< the front burns it

  /// D of the constants: the least over the Hugoniot of the products about (v0, p = 0, e_0).
  double jouguet_speed() const {
    double least = 1e300;
    for (int i = 1; i < 2000; ++i) {
      const double x = 1.0 + 5e-4 * i, v = 1.0 / (rho0 * x), collapse = 1.0 / rho0 - v;
      const PressureSplit<double> s = products.split(rho0 * x, v);
      const double below = 1.0 - 0.5 * s.thermal * collapse;
      const double p = (s.cold + s.thermal * initial_energy) / below;
      if (below <= 0.0 || p <= 0.0) break;
      const double speed = sqrt(p / collapse) / rho0;
      least = speed < least ? speed : least;
    }
    return least;
  }
  const char* problem() const {
    if (products.problem() != nullptr) return products.problem();
    if (p_CJ >= rho0 * D * D) return "p_CJ must lie below rho0 D^2";
    const double ratio = jouguet_speed() / D;
    return ratio > 0.95 && ratio < 1.05
               ? nullptr
               : "D is more than 5 % off the Chapman-Jouguet velocity that density, A, B, R1, R2, "
                 "omega and E0 give";
  }

  /// F of the end of a step.
  template <class Real>
  KRATER_FORCE_INLINE Real burnt(Real before, Real since_lighting, Real rho, Real length) const {
    const Real by_front = since_lighting * per_width / length;
    const Real by_collapse = (rho - rho0) / rho * per_collapse;  // exactly 0 at rho0
    return max(before, min(Real(1.0), max(by_front, by_collapse)));
  }

  /// The law at a burn fraction.
  template <class Real>
  struct Burning {
    const JwlBurn& law;
    Real F;
    double rho0, c0;

    KRATER_FORCE_INLINE PressureSplit<Real> split(Real rho, Real v) const {
      const PressureSplit<Real> s = law.products.split(rho, v);
      const Real unburnt = (Real(1.0) - F) * law.bulk_modulus;
      return {fma(F, s.cold, unburnt * ((rho - rho0) * (1.0 / rho0))), F * s.thermal};
    }
    KRATER_FORCE_INLINE Real bulk_modulus(Real rho, Real v, Real p, Real e) const {
      const Real unburnt = (Real(1.0) - F) * (law.bulk_modulus / rho0) * rho;
      return fma(F, law.products.bulk_modulus(rho, v, p, e), unburnt);
    }
    KRATER_FORCE_INLINE std::array<Real, 1> after(Real, Real, Real) const { return {F}; }
  };
  template <class Real>
  KRATER_FORCE_INLINE Burning<Real> at(const std::array<Real, 1>& state) const {
    return {*this, state[0], rho0, c0};
  }
};

}  // namespace krater::inline KRATER_ISA
