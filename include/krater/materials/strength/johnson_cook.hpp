// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// sigma_Y = (A + B eps^n) (1 + C ln max(epsdot/epsdot0, 1)) (1 - T*^m),
/// T* = clamp((T - T_ref)/(T_melt - T_ref), 0, 1): theory 5, CCF (33), Decision 2.
/// Reference: Johnson and Cook, 7th Int. Symp. Ballistics, 1983. Below the reference rate the rate
/// factor is 1 (the static curve); at T >= T_melt there is no strength at all.
#pragma once

#include "krater/materials/law.hpp"
#include "krater/materials/returns/flow.hpp"
#include "krater/materials/returns/softening.hpp"

namespace krater::inline KRATER_ISA {

struct JohnsonCook {
  double A, B, n, C, epsdot0, m, T_ref, T_melt;
  double per_rate;   ///< 1/epsdot0 [s]
  double per_range;  ///< 1/(T_melt - T_ref) [1/K]

  static constexpr Family family = Family::strength;
  static constexpr const char* name = "johnson_cook";
  static constexpr const char* equation =
      "sigma_Y = (A + B eps^n) (1 + C ln max(epsdot/epsdot0, 1)) (1 - T*^m), "
      "T* = clamp((T - T_ref)/(T_melt - T_ref), 0, 1)";
  static constexpr const char* reference =
      "Johnson and Cook 1983; Zhou, Sha, Tamma, Miller, AIAA-2006-1758, eq. (33)";
  static constexpr bool needs_shear_modulus = true;
  static constexpr bool reads_temperature = true;
  static constexpr Parameter<JohnsonCook> parameters[] = {
      {{"A", "Pa", Range::positive, kRequired, "yield stress at no plastic strain", "a"},
       &JohnsonCook::A},
      {{"B", "Pa", Range::non_negative, kRequired, "hardening factor", "b"}, &JohnsonCook::B},
      {{"n", "1", Range::positive, kRequired, "hardening exponent", "N"}, &JohnsonCook::n},
      {{"C", "1", Range::non_negative, kRequired, "rate sensitivity", "c"}, &JohnsonCook::C},
      {{"epsdot0", "1/s", Range::positive, 1.0, "reference rate", "epdot_0"},
       &JohnsonCook::epsdot0},
      {{"m", "1", Range::positive, kRequired, "thermal exponent", "M"}, &JohnsonCook::m},
      {{"T_ref", "K", Range::positive, kRequired, "temperature of full strength", "T_r"},
       &JohnsonCook::T_ref},
      {{"T_melt", "K", Range::positive, kRequired, "melting temperature: no strength", "T_m"},
       &JohnsonCook::T_melt},
  };

  void prepare(const MaterialConstants&) {
    per_rate = 1.0 / epsdot0;
    per_range = 1.0 / (T_melt - T_ref);
  }
  const char* problem() const { return T_melt > T_ref ? nullptr : "T_melt must lie above T_ref"; }

  template <class Real>
  struct Curve {
    const JohnsonCook& law;
    Real thermal;  ///< 1 - T*^m

    struct Hardening {
      Real stress;      ///< (A + B eps^n) thermal
      Real power_term;  ///< B eps^n thermal
    };
    KRATER_FORCE_INLINE Hardening hardening(Real eps) const {
      const Real power_term = law.B * positive_power(eps, law.n) * thermal;
      return {fma(Real(law.A), thermal, power_term), power_term};
    }
    KRATER_FORCE_INLINE Flow<Real> flow(const Hardening& h, Real eps, Real rate) const {
      const Real relative = max(rate * law.per_rate, Real(1.0));
      const Real factor = fma(Real(law.C), log(relative), Real(1.0));
      // One division for both slopes: n B eps^(n-1) and C / rate (zero below the reference rate).
      const Real quotient = Real(1.0) / (eps * relative);
      const Real per_eps = quotient * relative;
      const Real d_eps = law.n * h.power_term * factor * per_eps;
      const Real d_log = select(relative > Real(1.0), Real(law.C * law.per_rate), Real(0.0));
      return {h.stress * factor, d_eps, h.stress * d_log * (quotient * eps),
              abs(1.0 - law.n) * d_eps * per_eps};
    }
    KRATER_FORCE_INLINE MaskOf<Real> smooth_between(Real rate0, Real rate1) const {
      const MaskOf<Real> crossed = (rate0 > Real(law.epsdot0)) ^ (rate1 > Real(law.epsdot0));
      return !crossed;
    }
  };

  /// eps^n >= min(eps, 1) for n <= 1.
  template <class Real>
  KRATER_FORCE_INLINE Real least_yield(Real eps, Real temperature) const {
    const Real hardening = (n <= 1.0 ? (1.0 - 1e-13) * B : 0.0) * min(Real(1.0), eps);
    return (A + hardening) * least_thermal_factor(temperature, T_ref, per_range, m);
  }

  template <class Real>
  KRATER_FORCE_INLINE Curve<Real> at(Real temperature) const {
    return {*this, thermal_factor(temperature, T_ref, per_range, m)};
  }
};

}  // namespace krater::inline KRATER_ISA
