// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Metals and rock from the solid to vapour, x = rho/rho0, mu = x - 1, z = 1/x - 1,
/// w = max(e/(E0 x^2) + 1, 1/2):
///   condensed (x >= 1 or e <= E_iv)  p_c = (a + b/w) rho e + g (A mu + B mu^2)
///   expanded  (x < 1 and e >= E_cv)  p_x = a rho e + [b rho e/w + A mu e^(-beta z)] e^(-alpha z^2)
///   between                          p = [(e - E_iv) p_x + (E_cv - e) p_c] / (E_cv - E_iv)
/// Theory 9. References: Tillotson, General Atomic GA-3216, 1962; Melosh, Impact Cratering, 1989,
/// AII.2; alpha and beta placed as there (some codes swap them). e = 0 at rho0.
///
/// Nonlinear in e: the law gives its tangent, and the energy update is a Newton iteration over it
/// (eos_stage.hpp). Continuous across all borders; the slope by e jumps at E_iv and E_cv. Below
/// e = 0, which strong cold tension reaches, w stays 1/2 or more: as printed it has a pole there.
/// g = 1 for x >= 0.8 and 0 for x <= 0.5 (`cohesion`, split.hpp): as printed the condensed part of
/// a thin gas tends to B - A, a tension of 10 GPa in aluminium, wherever e < E_cv. Where it ends,
/// so does the negative heat of e < 0: p >= 0 for x <= 0.5, and where g < 1 the slope by e jumps at
/// e = 0 too (K_s is that of e >= 0 there). c^2 is floored where the tension falls, and counted.
/// The deviator ends with the tension (materials/stages/cohesion_stage.hpp).
#pragma once

#include "krater/core/lane_math.hpp"
#include "krater/materials/eos/split.hpp"
#include "krater/materials/law.hpp"

namespace krater::inline KRATER_ISA {

struct Tillotson {
  double a, b, A, B, E0, E_iv, E_cv, alpha, beta;
  double rho0, c0;
  double per_rho0, per_band;  ///< 1/rho0, 1/(E_cv - E_iv)

  static constexpr Family family = Family::eos;
  static constexpr const char* name = "tillotson";
  static constexpr bool parts = true;  ///< its deviator ends as its cold tension does (cohesion)
  static constexpr const char* equation =
      "condensed: p = (a + b/w) rho e + g (A mu + B mu^2), w = e/(E0 x^2) + 1, g from 1 to 0 "
      "between x = 0.8 and 0.5; expanded: p = a rho e + (b rho e/w + A mu exp(-beta (1/x - 1))) "
      "exp(-alpha (1/x - 1)^2); linear in e in between";
  static constexpr const char* reference =
      "Tillotson, General Atomic GA-3216, 1962; Melosh, Impact Cratering, 1989, AII.2";
  static constexpr Parameter<Tillotson> parameters[] = {
      {{"a", "1", Range::positive, kRequired, "Grueneisen parameter of the hot gas"},
       &Tillotson::a},
      {{"b", "1", Range::non_negative, kRequired, "a + b is the Grueneisen parameter at rest"},
       &Tillotson::b},
      {{"A", "Pa", Range::positive, kRequired, "bulk modulus at rest"}, &Tillotson::A},
      {{"B", "Pa", Range::any, kRequired, "factor of mu^2"}, &Tillotson::B},
      {{"E0", "J/kg", Range::positive, kRequired, "energy at which b has halved"}, &Tillotson::E0},
      {{"E_iv", "J/kg", Range::positive, kRequired, "energy of incipient vaporisation"},
       &Tillotson::E_iv},
      {{"E_cv", "J/kg", Range::positive, kRequired, "energy of complete vaporisation"},
       &Tillotson::E_cv},
      {{"alpha", "1", Range::non_negative, 5.0, "factor of z^2 in the expanded state"},
       &Tillotson::alpha},
      {{"beta", "1", Range::non_negative, 5.0, "factor of z in the expanded state"},
       &Tillotson::beta},
  };

  void prepare(const MaterialConstants& constants) {
    rho0 = constants.density;
    per_rho0 = 1.0 / rho0;
    per_band = 1.0 / (E_cv - E_iv);
    c0 = sqrt(A / rho0);
  }
  const char* problem() const { return E_cv > E_iv ? nullptr : "E_cv must lie above E_iv"; }

  /// Pressure, dp/de at constant rho, and rho dp/drho at constant e.
  template <class Real>
  struct State {
    Real p, by_e, by_rho;
  };

  template <class Real>
  KRATER_FORCE_INLINE State<Real> state(Real rho, Real v, Real e) const {
    const Real x = rho * per_rho0, per_x = rho0 * v, mu = (rho - rho0) * per_rho0;
    const Cohesion<Real> held = cohesion(x);
    const MaskOf<Real> below = e < Real(0.0);  // colder than cold: a tension, and ends with it
    const Real heat = select(below, held.share, Real(1.0));
    const Real E = rho * e;
    const Real free = e * (1.0 / E0) * (per_x * per_x);
    const MaskOf<Real> floored = free < Real(-0.5);
    const Real over = max(Real(-0.5), free);  // w - 1; this order keeps a NaN
    const Real per_w = Real(1.0) / (over + 1.0);
    const Real all_warm = b * E * per_w, warm = heat * all_warm, hot = heat * (a * E);
    const Real warm_by_e = heat * (b * rho * per_w * select(floored, Real(1.0), per_w));
    const Real hot_by_e = heat * (a * rho);
    const Real ends = select(below, x * held.by_x, Real(0.0));
    const Real warm_by_rho =
        fma(ends, all_warm, warm * select(floored, Real(1.0), fma(2.0 * over, per_w, Real(1.0))));
    const Real hot_by_rho = fma(ends, a * E, hot);
    const Real bare = mu * fma(Real(B), mu, Real(A));
    const State<Real> condensed{
        hot + warm + held.share * bare, hot_by_e + warm_by_e,
        hot_by_rho + warm_by_rho +
            x * fma(held.by_x, bare, held.share * fma(Real(2.0 * B), mu, Real(A)))};
    const MaskOf<Real> vapour = (mu < Real(0.0)) & (e > Real(E_iv));
    if (!any(vapour)) return condensed;

    const Real z = per_x - 1.0;
    const Real fade = exp(-alpha * (z * z));
    const Real cold = A * exp(-beta * z);
    const Real cold_by_rho = cold * fma(beta * mu, per_x, x);
    const Real inner = fma(cold, mu, warm);
    const Real expanded_p = fma(inner, fade, hot);
    const Real expanded_by_e = fma(warm_by_e, fade, hot_by_e);
    const Real fade_by_rho = fade * (2.0 * alpha) * z * per_x;
    const Real expanded_by_rho =
        fma(inner, fade_by_rho, fma(warm_by_rho + cold_by_rho, fade, hot_by_rho));
    const Real share = clamp((e - E_iv) * per_band, Real(0.0), Real(1.0));
    const MaskOf<Real> mixed = e < Real(E_cv);
    const Real jump = expanded_p - condensed.p;
    const Real by_e = fma(share, expanded_by_e - condensed.by_e, condensed.by_e) +
                      select(mixed, jump * per_band, Real(0.0));
    return {select(vapour, fma(share, jump, condensed.p), condensed.p),
            select(vapour, by_e, condensed.by_e),
            select(vapour, fma(share, expanded_by_rho - condensed.by_rho, condensed.by_rho),
                   condensed.by_rho)};
  }

  /// The line p = cold + thermal e that touches p(rho, .) at e.
  template <class Real>
  KRATER_FORCE_INLINE PressureSplit<Real> tangent(Real rho, Real v, Real e) const {
    const State<Real> s = state(rho, v, e);
    return {fnma(s.by_e, e, s.p), s.by_e};
  }
  template <class Real>
  KRATER_FORCE_INLINE Real bulk_modulus(Real rho, Real v, Real p, Real e) const {
    const State<Real> s = state(rho, v, e);
    return fma(p * v, s.by_e, s.by_rho);
  }
};

}  // namespace krater::inline KRATER_ISA
