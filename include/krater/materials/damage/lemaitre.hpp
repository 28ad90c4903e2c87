// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Lemaitre damage (theory 6, CCF (8)-(25)), R_v = 3K/(3K+G) + 9G/(3K+G) chi^2:
///   energy form     dphi/deps = (Y/S)^s for eps > eps_d, Y = q~^2 R_v/(2E), E = 9KG/(3K+G):
///                   CCF (17)
///   threshold form  dphi/deps = phi_c R_v^s/(e_F - e_D) for eps > e_D/R_v^s: CCF (21), (25)
/// Growth only while chi > triaxiality_min (-1/3 by default: Decision 10, not in CCF). Fails at
/// phi >= phi_c. Reference: Lemaitre 1985.
#pragma once

#include "krater/materials/damage/driver.hpp"

namespace krater::inline KRATER_ISA {

struct LemaitreEnergy {
  double S, s, eps_d, phi_c, triaxiality_min;

  static constexpr Family family = Family::damage;
  static constexpr const char* name = "lemaitre_energy";
  static constexpr const char* equation =
      "d phi/d eps = (Y/S)^s for eps > eps_d, Y = q^2 R_v/(2E), "
      "R_v = 3K/(3K+G) + 9G/(3K+G) (p/q)^2";
  static constexpr const char* reference =
      "Lemaitre 1985; Zhou, Sha, Tamma, Miller, AIAA-2006-1758, eqs. (8)-(17)";
  static constexpr bool reads_temperature = false;
  static constexpr Parameter<LemaitreEnergy> parameters[] = {
      {{"S", "Pa", Range::positive, kRequired, "damage strength", "S_D"}, &LemaitreEnergy::S},
      {{"s", "1", Range::positive, 1.0, "exponent"}, &LemaitreEnergy::s},
      {{"eps_d", "1", Range::non_negative, 0.0, "plastic strain where damage starts", "EPS_D"},
       &LemaitreEnergy::eps_d},
      {{"phi_c", "1", Range::fraction, kMostDamage, "damage at which the material fails", "D_c"},
       &LemaitreEnergy::phi_c},
      {{"triaxiality_min", "1", Range::any, -1.0 / 3.0, "no growth at or below this triaxiality"},
       &LemaitreEnergy::triaxiality_min},
  };
  void prepare(const MaterialConstants&) {}
  const char* problem() const { return most_damage_problem(phi_c); }
  bool degrades() const { return true; }
  double limit() const { return phi_c; }

  template <class Real>
  KRATER_FORCE_INLINE Growth<Real> growth(const DamageDriver<Real>& x) const {
    const Real per_E = (3.0 * x.K + x.G) / (9.0 * x.K * x.G);
    const Real Y = 0.5 * (x.q * x.q) * triaxiality_function(x) * per_E;
    const Real k = damage_power(Y * (1.0 / S), s);
    return {select(x.triaxiality <= Real(triaxiality_min), Real(0.0), k), Real(eps_d), Real(phi_c)};
  }
};

struct LemaitreThreshold {
  double e_F, e_D, s, phi_c, triaxiality_min;

  static constexpr Family family = Family::damage;
  static constexpr const char* name = "lemaitre_threshold";
  static constexpr const char* equation =
      "d phi/d eps = phi_c R_v^s/(e_F - e_D) for eps > e_D/R_v^s, "
      "R_v = 3K/(3K+G) + 9G/(3K+G) (p/q)^2";
  static constexpr const char* reference =
      "Lemaitre 1985; Zhou, Sha, Tamma, Miller, AIAA-2006-1758, eqs. (18)-(25)";
  static constexpr bool reads_temperature = false;
  static constexpr Parameter<LemaitreThreshold> parameters[] = {
      {{"e_F", "1", Range::positive, kRequired, "fracture strain in uniaxial tension"},
       &LemaitreThreshold::e_F},
      {{"e_D", "1", Range::non_negative, 0.0, "threshold strain in uniaxial tension"},
       &LemaitreThreshold::e_D},
      {{"s", "1", Range::positive, 1.0, "exponent"}, &LemaitreThreshold::s},
      {{"phi_c", "1", Range::fraction, kMostDamage, "damage at which the material fails", "D_c"},
       &LemaitreThreshold::phi_c},
      {{"triaxiality_min", "1", Range::any, -1.0 / 3.0, "no growth at or below this triaxiality"},
       &LemaitreThreshold::triaxiality_min},
  };
  void prepare(const MaterialConstants&) {}
  const char* problem() const {
    return e_F > e_D ? most_damage_problem(phi_c) : "e_F must lie above e_D";
  }
  bool degrades() const { return true; }
  double limit() const { return phi_c; }

  template <class Real>
  KRATER_FORCE_INLINE Growth<Real> growth(const DamageDriver<Real>& x) const {
    const Real R = damage_power(triaxiality_function(x), s);
    const Real k = (phi_c / (e_F - e_D)) * R;
    return {select(x.triaxiality <= Real(triaxiality_min), Real(0.0), k), e_D / R, Real(phi_c)};
  }
};

}  // namespace krater::inline KRATER_ISA
