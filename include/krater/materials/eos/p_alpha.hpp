// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Porous material: a solid of distension alpha = v/v_s >= 1 (Herrmann; Carroll and Holt),
///   p(rho, e, alpha) = p_s(alpha rho, e)/alpha,          p_s: mie_gruneisen_shock of the solid
/// whose pores close irreversibly along the crush curve of returns/pore_closure.hpp,
///   alpha(p) = 1 + (alpha_0 - 1) ((p_c - p)/(p_c - p_e))^n,         p_e <= p <= p_c
/// from the elastic limit p_e to full compaction p_c; alpha_0 = solid_density/density. In tension
/// pores do not open again (spall does that).
/// Assumptions: pores carry no energy; the sound speed of unloading at constant alpha is that of
/// the solid, an upper bound while pores close; internal energy per mass is that of the solid.
/// References: Herrmann, J. Appl. Phys. 40 (1969) 2490; Carroll and Holt, J. Appl. Phys. 43 (1972)
/// 759 (the factor 1/alpha).
#pragma once

#include "krater/materials/eos/mie_gruneisen_shock.hpp"
#include "krater/materials/law_state.hpp"
#include "krater/materials/returns/pore_closure.hpp"

namespace krater::inline KRATER_ISA {

struct PAlpha {
  double solid_density, c0, S1, gamma0, elastic_pressure, compaction_pressure, exponent;
  double rho0, alpha0;
  CrushLaw pores;
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
    pores = {elastic_pressure, compaction_pressure, exponent, alpha0};
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

  /// The law at a distension.
  template <class Real>
  struct Porous {
    const PAlpha& law;
    Real alpha;
    double rho0, c0;

    /// alpha of the end of a step, of the density and energy there.
    KRATER_FORCE_INLINE Real closed(Real rho, Real v, Real e) const {
      return closed_pores(law.pores, law.solid, alpha, rho, v, e);
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
