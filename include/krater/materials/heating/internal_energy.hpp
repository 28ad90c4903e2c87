// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// T = T_s + (e - s:s/(4G (1 - phi) rho) - e_s)/c_v: temperature from the internal energy, over the
/// isentrope of the equation of state through the reference state (theory 8;
/// heating/isentrope.hpp). Sees every heat: shocks, viscosity, plastic work. Reference: Meyers,
/// Dynamic Behavior of Materials, 1994, section 5.4.
///
/// The reference temperature is the material's initial_temperature: the state at the start is the
/// one where e has its start value. Assumes constant c_v, and a Grueneisen parameter that depends
/// on the density alone; for tillotson, where it falls with e, T is exact on the isentrope only.
/// Ideal gas and jwl have a caloric relation of their own, e = e_cold(v) + c_v T, which this is, if
/// c_v and initial_temperature agree with their energy at the start: a scene where they do not is
/// refused (`thermal_energy` of those laws).
///
/// **Where the carried pressure is not that of the equation of state** (spall, failure, damage),
/// the density holds voids. The solid part is then at the density where p~(rho_s, e) = p^, and T is
/// taken there; a fragment that flies apart keeps its temperature instead of cooling for ever.
#pragma once

#include "krater/materials/eos/split.hpp"
#include "krater/materials/law.hpp"

namespace krater::inline KRATER_ISA {

struct EnergyHeating {
  double c_v;

  static constexpr Family family = Family::heating;
  static constexpr const char* name = "energy";
  static constexpr const char* equation = "T = T_s + (e - s:s/(4G (1 - phi) rho) - e_s)/c_v";
  static constexpr const char* reference =
      "Meyers, Dynamic Behavior of Materials, 1994, section 5.4; src/THEORY.md 8";
  static constexpr bool needs_eos = true;
  static constexpr Parameter<EnergyHeating> parameters[] = {
      {{"c_v", "J/(kg.K)", Range::positive, kRequired, "specific heat at constant volume", "cv"},
       &EnergyHeating::c_v},
  };

  void prepare(const MaterialConstants&) {}
};

/// Density of the solid part: p~(rho_s, e) = p by Newton in rho, where p~(rho, e) is not p already.
/// dp~/drho at constant e is (K_s - p~ v dp/de)/rho. Steps that leave the range between rho and
/// several rho0 are bisected; what has not converged after `cap` is off by less than T can show.
template <class Law, class Real>
KRATER_FORCE_INLINE Real solid_density(const Law& law, Real rho, Real p, Real e) {
  constexpr int cap = 20;
  const Real enough = Real(1e-10 * law.rho0 * law.c0 * law.c0);
  Real x = rho, low = Real(0.0), high = Real(1e3 * law.rho0);
  MaskOf<Real> active = Real(0.0) == Real(0.0);
  for (int i = 0; i < cap; ++i) {
    const Real v = Real(1.0) / x;
    const PressureSplit<Real> split = split_at(law, x, v, e);
    const Real pressure = fma(split.thermal, e, split.cold);
    const Real over = pressure - p;
    active = active & (abs(over) > enough);
    if (!any(active)) break;
    low = select(over < Real(0.0), x, low);
    high = select(over > Real(0.0), x, high);
    const Real slope = fnma(pressure * v, split.thermal, law.bulk_modulus(x, v, pressure, e)) * v;
    const Real newton = x - over / slope;
    // From far below, where a curved law points anywhere, by way of rho0.
    const Real inside = select((low < Real(law.rho0)) & (high > Real(2.0 * law.rho0)),
                               Real(law.rho0), 0.5 * (low + high));
    const MaskOf<Real> good = (slope > Real(0.0)) & (newton > low) & (newton < high);
    x = select(active, select(good, newton, inside), x);
  }
  return x;
}

}  // namespace krater::inline KRATER_ISA
