// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Tuler and Butcher: brittle failure needs a tension and the time for it,
///   phi = 1/tau int <sigma_1/sigma_0 - 1>^a dt,   failure at phi = 1,
/// sigma_1 the largest principal stress. The printed criterion int (sigma - sigma_0)^a dt = K has
/// K = tau sigma_0^a; tau is what a stress of 2 sigma_0 takes. Short pulses are borne that a long
/// one of the same height is not: incubation of spall and of brittle solids (glass, ceramics).
/// Under a constant stress it fails at t = tau (sigma_1/sigma_0 - 1)^-a, on a ramp
/// sigma_0 (1 + t/t_r), from where sigma_0 is passed, at t^(a+1) = (a + 1) tau t_r^a.
/// Assumptions: no healing; nothing is degraded before; no plastic strain is asked for.
/// Reference: Tuler and Butcher, Int. J. Fract. Mech. 4 (1968) 431.
#pragma once

#include "krater/materials/damage/strain_criteria.hpp"

namespace krater::inline KRATER_ISA {

struct TulerButcher {
  double stress, exponent, time;

  static constexpr Family family = Family::damage;
  static constexpr const char* name = "tuler_butcher";
  static constexpr const char* equation =
      "failure at int <sigma_1/stress - 1>^exponent dt = time, sigma_1 the largest principal "
      "stress";
  static constexpr const char* reference =
      "Tuler and Butcher, Int. J. Fract. Mech. 4 (1968) 431: K = time stress^exponent";
  static constexpr bool reads_temperature = false;
  static constexpr bool needs_flow = false;
  static constexpr Parameter<TulerButcher> parameters[] = {
      {{"stress", "Pa", Range::positive, kRequired, "tension borne for ever", "sigma_0"},
       &TulerButcher::stress},
      {{"exponent", "1", Range::positive, 2.0, "of the overstress", "a"}, &TulerButcher::exponent},
      {{"time", "s", Range::positive, kRequired, "to failure at twice that tension", "tau"},
       &TulerButcher::time},
  };
  void prepare(const MaterialConstants&) {}
  bool degrades() const { return false; }
  double limit() const { return 1.0; }

  template <class Real>
  KRATER_FORCE_INLINE Growth<Real> growth(const DamageDriver<Real>& x) const {
    // The order of operands lets a NaN through.
    const Real over =
        max(Real(0.0), fms(largest_principal(x.s) - x.pressure, Real(1.0 / stress), Real(1.0)));
    return {Real(0.0), Real(0.0), Real(1.0), damage_power(over, exponent) * (x.dt / time)};
  }
};

}  // namespace krater::inline KRATER_ISA
