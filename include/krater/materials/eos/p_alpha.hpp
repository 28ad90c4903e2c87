// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Porous material: a solid of distension alpha = v/v_s >= 1 (Herrmann; Carroll and Holt),
///   p(rho, e, alpha) = p_s(alpha rho, e)/alpha,          p_s: mie_gruneisen_shock of the solid
/// whose pores close irreversibly along the crush curve
///   alpha(p) = 1 + (alpha_0 - 1) ((p_c - p)/(p_c - p_e))^n,         p_e <= p <= p_c
/// from the elastic limit p_e to full compaction p_c; alpha_0 = solid_density/density. Below the
/// curve of its alpha the material loads and unloads at constant alpha; in tension too, so pores do
/// not open again (spall does that).
/// On the curve p is the root of p_s(alpha(p) rho, e)/alpha(p) - p, which falls with p: Newton
/// inside a bracket.
/// Assumptions: pores carry no energy; the sound speed of unloading at constant alpha is that of
/// the solid, an upper bound while pores close; internal energy per mass is that of the solid.
/// References: Herrmann, J. Appl. Phys. 40 (1969) 2490; Carroll and Holt, J. Appl. Phys. 43 (1972)
/// 759 (the factor 1/alpha).
#pragma once

#include <algorithm>

#include "krater/core/lane_math.hpp"
#include "krater/materials/eos/mie_gruneisen_shock.hpp"
#include "krater/materials/law_state.hpp"

namespace krater::inline KRATER_ISA {

struct PAlpha {
  double solid_density, c0, S1, gamma0, elastic_pressure, compaction_pressure, exponent;
  double rho0, alpha0;
  double per_range;  ///< 1/(p_c - p_e)
  MieGruneisenShock solid;

  static constexpr Family family = Family::eos;
  static constexpr const char* name = "p_alpha";
  static constexpr const char* equation =
      "p = p_s(alpha rho, e)/alpha, p_s of mie_gruneisen_shock; alpha = 1 + (alpha_0 - 1) "
      "((p_c - p)/(p_c - p_e))^n on loading, constant below";
  static constexpr const char* reference =
      "Herrmann, J. Appl. Phys. 40 (1969) 2490; Carroll and Holt, J. Appl. Phys. 43 (1972) 759";
  static constexpr Parameter<PAlpha> parameters[] = {
      {{"solid_density", "kg/m^3", Range::positive, kRequired, "density without pores, at rest"},
       &PAlpha::solid_density},
      {{"c0", "m/s", Range::positive, kRequired, "bulk sound speed of the solid at rest", "C_0"},
       &PAlpha::c0},
      {{"S1", "1", Range::non_negative, kRequired, "slope of Us over up of the solid", "s"},
       &PAlpha::S1},
      {{"gamma0", "1", Range::non_negative, kRequired, "Grueneisen parameter of the solid at rest",
        "Gamma_0"},
       &PAlpha::gamma0},
      {{"elastic_pressure", "Pa", Range::non_negative, kRequired,
        "pressure at which pores begin to close", "p_e"},
       &PAlpha::elastic_pressure},
      {{"compaction_pressure", "Pa", Range::positive, kRequired,
        "pressure at which no pore is left", "p_c"},
       &PAlpha::compaction_pressure},
      {{"exponent", "1", Range::positive, 2.0, "n of the crush curve", "n"}, &PAlpha::exponent},
  };

  using State = Columns<field::Distension>;
  std::array<double, 1> initial_state() const { return {alpha0}; }

  void prepare(const MaterialConstants& constants) {
    rho0 = constants.density;
    alpha0 = solid_density / rho0;
    per_range = 1.0 / (compaction_pressure - elastic_pressure);
    solid.c0 = c0;
    solid.S1 = S1;
    solid.gamma0 = gamma0;
    solid.prepare({solid_density, constants.shear_modulus, constants.initial_temperature});
  }
  const char* problem() const {
    if (!(compaction_pressure > elastic_pressure))
      return "compaction_pressure must lie above elastic_pressure";
    if (!(alpha0 >= 1.0))
      return "the material is denser than its solid: density may not exceed solid_density";
    return exponent >= 1.0 ? nullptr : "exponent must be 1 at least";
  }

  /// alpha on the crush curve, and its slope.
  template <class Real>
  struct Crush {
    Real alpha, slope;
  };
  template <class Real>
  KRATER_FORCE_INLINE Crush<Real> crush(Real p) const {
    const Real left = clamp((compaction_pressure - p) * per_range, Real(1e-30), Real(1.0));
    const Real power = (alpha0 - 1.0) * exp(exponent * log(left));
    return {power + 1.0, power / left * (-exponent * per_range)};
  }
  /// Where the curve has this alpha.
  template <class Real>
  KRATER_FORCE_INLINE Real crush_pressure(Real alpha) const {
    const Real share =
        clamp((alpha - 1.0) * (1.0 / std::max(alpha0 - 1.0, 1e-30)), Real(1e-30), Real(1.0));
    return fnma(Real(compaction_pressure - elastic_pressure), exp(1.0 / exponent * log(share)),
                Real(compaction_pressure));
  }

  /// The law at a distension.
  template <class Real>
  struct Porous {
    const PAlpha& law;
    Real alpha;
    double rho0, c0;

    KRATER_FORCE_INLINE Real pressure(Real rho, Real v, Real e, Real at) const {
      const PressureSplit<Real> s = law.solid.split(at * rho, v / at);
      return fma(s.thermal, e, s.cold) / at;
    }

    /// alpha of the end of a step, of the density and energy there.
    KRATER_FORCE_INLINE Real closed(Real rho, Real v, Real e) const {
      constexpr int cap = 60;
      Real low = law.crush_pressure(alpha), high = Real(law.compaction_pressure);
      const MaskOf<Real> crushing = pressure(rho, v, e, alpha) > low;
      if (!any(crushing)) return alpha;
      const MaskOf<Real> solid = crushing & (pressure(rho, v, e, Real(1.0)) >= high);
      MaskOf<Real> active = crushing & !solid;
      Real p = 0.5 * (low + high);
      const Real enough = Real(1e-13 * law.compaction_pressure);
      for (int i = 0; i < cap && any(active); ++i) {
        const Crush<Real> at = law.crush(p);
        const Real rho_s = at.alpha * rho, v_s = v / at.alpha;
        const PressureSplit<Real> s = law.solid.split(rho_s, v_s);
        const Real p_s = fma(s.thermal, e, s.cold), per = Real(1.0) / at.alpha;
        const Real rest = fms(p_s, per, p);
        low = select(rest > Real(0.0), p, low);
        high = select(rest > Real(0.0), high, p);
        const Real by_rho = fnma(p_s * v_s, s.thermal, law.solid.bulk_modulus(rho_s, v_s, p_s, e));
        const Real slope = fma((by_rho - p_s) * (per * per), at.slope, Real(-1.0));
        const Real newton = p - rest / slope;
        const MaskOf<Real> inside = (newton > low) & (newton < high);
        const Real next = select(inside, newton, 0.5 * (low + high));
        const MaskOf<Real> near = abs(next - p) <= enough;
        p = select(active, next, p);  // each lane by itself: no bits of its neighbours
        active = active & !near & (high - low > enough);
      }
      const Real on_curve = min(alpha, law.crush(p).alpha);
      return select(solid, Real(1.0), select(crushing, on_curve, alpha));
    }
    KRATER_FORCE_INLINE std::array<Real, 1> after(Real rho, Real v, Real e) const {
      return {closed(rho, v, e)};
    }

    /// The line in e at the alpha that the step ends with if it ends at e.
    KRATER_FORCE_INLINE PressureSplit<Real> tangent(Real rho, Real v, Real e) const {
      const Real at = closed(rho, v, e), per = Real(1.0) / at;
      const PressureSplit<Real> s = law.solid.split(at * rho, v * per);
      return {s.cold * per, s.thermal * per};
    }
    /// K_s at constant alpha: K_s of the solid over alpha.
    KRATER_FORCE_INLINE Real bulk_modulus(Real rho, Real v, Real p, Real e) const {
      return law.solid.bulk_modulus(alpha * rho, v / alpha, p * alpha, e) / alpha;
    }
    KRATER_FORCE_INLINE MaskOf<Real> beyond_pole(Real rho) const {
      return law.solid.beyond_pole(alpha * rho);
    }
  };
  template <class Real>
  KRATER_FORCE_INLINE Porous<Real> at(const std::array<Real, 1>& state) const {
    return {*this, state[0], rho0, c0};
  }
};

}  // namespace krater::inline KRATER_ISA
