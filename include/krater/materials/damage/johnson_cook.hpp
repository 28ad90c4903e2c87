// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Johnson-Cook damage (theory 7, CCF (34), (35), (41), SPEAR (S.42)-(S.44)):
///   eps_F = (D1 + D2 exp(D3 chi)) (1 + D4 ln max(epsdot/epsdot0, 1)) (1 + D5 T*) >= eps_f_min,
/// chi clamped to [-5, 1.5], positive in tension (SPEAR (S.43) omits the logarithm: it is used).
///   coupled    k = 1/((1 - gamma_D) eps_F) from eps_D = gamma_D eps_F on; fails at phi_c, as
///              printed (Decision 3); `normalise: critical` multiplies k by phi_c (Borvik's law)
///   uncoupled  phi = omega, d omega = d eps/eps_F: fails at 1; `softening: linear` lets it degrade
///              the stress, to .999
/// Reference: Johnson and Cook 1985.
#pragma once

#include "krater/materials/damage/driver.hpp"

namespace krater::inline KRATER_ISA {

/// Parameters and formula of eps_F.
struct FractureStrain {
  double D1, D2, D3, D4, D5, epsdot0, T_ref, T_melt, eps_f_min;
  double per_rate, per_range;  ///< 1/epsdot0; 1/(T_melt - T_ref), zero without D5

  void prepare_fracture() {
    per_rate = 1.0 / epsdot0;
    per_range = D5 == 0 ? 0.0 : 1.0 / (T_melt - T_ref);
  }
  const char* temperature_problem() const {
    return D5 == 0 || T_melt > T_ref ? nullptr : "D5 needs T_melt above T_ref";
  }

  template <class Real>
  KRATER_FORCE_INLINE Real fracture_strain(const DamageDriver<Real>& x) const {
    const Real chi = clamp(x.triaxiality, Real(-5.0), Real(1.5));
    const Real relative = max(Real(1.0), x.rate * per_rate);
    const Real t = clamp((x.temperature - T_ref) * per_range, Real(0.0), Real(1.0));
    const Real strain = fma(Real(D2), exp(D3 * chi), Real(D1)) *
                        fma(Real(D4), log(relative), Real(1.0)) * fma(Real(D5), t, Real(1.0));
    return max(Real(eps_f_min), strain);
  }
};

#define KRATER_FRACTURE_STRAIN(Law)                                                              \
  {{"D1", "1", Range::any, kRequired, "fracture strain: constant part"}, &Law::D1},              \
      {{"D2", "1", Range::any, kRequired, "fracture strain: triaxial part"}, &Law::D2},          \
      {{"D3", "1", Range::any, kRequired, "exponent of triaxiality, negative as a rule"},        \
       &Law::D3},                                                                                \
      {{"D4", "1", Range::any, 0.0, "rate sensitivity of the fracture strain"}, &Law::D4},       \
      {{"D5", "1", Range::any, 0.0, "thermal increase of the fracture strain"}, &Law::D5},       \
      {{"epsdot0", "1/s", Range::positive, 1.0, "reference rate", "epdot_0"}, &Law::epsdot0},    \
      {{"T_ref", "K", Range::non_negative, 293.0, "reference temperature", "T_r"}, &Law::T_ref}, \
      {{"T_melt", "K", Range::non_negative, 0.0, "melting temperature, needed with D5", "T_m"},  \
       &Law::T_melt},                                                                            \
  {                                                                                              \
    {"eps_f_min", "1", Range::positive, 1e-3, "least fracture strain", "EFMIN"}, &Law::eps_f_min \
  }

struct JohnsonCookDamage : FractureStrain {
  double gamma_D, phi_c, normalise;
  double scale;  ///< k eps_F

  static constexpr Family family = Family::damage;
  static constexpr const char* name = "johnson_cook";
  static constexpr const char* equation =
      "d phi/d eps = 1/((1 - gamma_D) eps_F) for eps > gamma_D eps_F, "
      "eps_F = (D1 + D2 exp(D3 chi)) (1 + D4 ln max(epsdot/epsdot0, 1)) (1 + D5 T*)";
  static constexpr const char* reference =
      "Johnson and Cook 1985; Zhou, Sha, Tamma, Miller, AIAA-2006-1758, eqs. (34)-(41)";
  static constexpr bool reads_temperature = true;
  static constexpr Parameter<JohnsonCookDamage> parameters[] = {
      KRATER_FRACTURE_STRAIN(JohnsonCookDamage),
      {{"gamma_D", "1", Range::fraction, 0.0, "part of eps_F where damage starts"},
       &JohnsonCookDamage::gamma_D},
      {{"phi_c", "1", Range::fraction, kMostDamage, "damage at which the material fails", "D_c"},
       &JohnsonCookDamage::phi_c},
      {{"normalise", "1", Range::any, 0.0, "failure at eps_F itself (critical) or as (41)", nullptr,
        "printed|critical"},
       &JohnsonCookDamage::normalise},
  };
  void prepare(const MaterialConstants&) {
    prepare_fracture();
    scale = (normalise > 0.5 ? phi_c : 1.0) / (1.0 - gamma_D);
  }
  const char* problem() const {
    if (!(gamma_D < 1)) return "gamma_D must be below 1";
    const char* temperature = temperature_problem();
    return temperature ? temperature : most_damage_problem(phi_c);
  }
  bool degrades() const { return true; }
  double limit() const { return phi_c; }

  template <class Real>
  KRATER_FORCE_INLINE Growth<Real> growth(const DamageDriver<Real>& x) const {
    const Real eps_F = fracture_strain(x);
    return {scale / eps_F, gamma_D * eps_F, Real(phi_c)};
  }
};

struct JohnsonCookUncoupled : FractureStrain {
  double softening;

  static constexpr Family family = Family::damage;
  static constexpr const char* name = "johnson_cook_uncoupled";
  static constexpr const char* equation =
      "d omega = d eps/eps_F, failure at omega = 1, "
      "eps_F = (D1 + D2 exp(D3 chi)) (1 + D4 ln max(epsdot/epsdot0, 1)) (1 + D5 T*)";
  static constexpr const char* reference =
      "Johnson and Cook 1985; Spear, Palazotto, Kemnitz 2021, eqs. (42)-(44)";
  static constexpr bool reads_temperature = true;
  static constexpr Parameter<JohnsonCookUncoupled> parameters[] = {
      KRATER_FRACTURE_STRAIN(JohnsonCookUncoupled),
      {{"softening", "1", Range::any, 0.0, "does omega degrade the stress", nullptr, "none|linear"},
       &JohnsonCookUncoupled::softening},
  };
  void prepare(const MaterialConstants&) { prepare_fracture(); }
  const char* problem() const { return temperature_problem(); }
  bool degrades() const { return softening > 0.5; }
  double limit() const { return degrades() ? kMostDamage : 1.0; }

  template <class Real>
  KRATER_FORCE_INLINE Growth<Real> growth(const DamageDriver<Real>& x) const {
    return {Real(1.0) / fracture_strain(x), Real(0.0), Real(limit())};
  }
};

#undef KRATER_FRACTURE_STRAIN

}  // namespace krater::inline KRATER_ISA
