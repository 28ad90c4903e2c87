// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// sigma_Y = (A + sum Q_i (1 - e^(-C_i eps))) R (1 - T*^m), i = 1, 2, with the rate factor
///   voce:      R = (1 + epsdot/epsdot0)^C            Borvik's power form
///   voce_log:  R = 1 + C ln max(epsdot/epsdot0, 1)   Johnson and Cook's
/// Theory 5. References: Voce, J. Inst. Metals 74, 1948; Borvik, Hopperstad, Berstad, Langseth,
/// Eur. J. Mech. A/Solids 20, 2001 (power form, saturating terms). Hardening saturates at
/// A + Q1 + Q2, where a power law grows for ever.
#pragma once

#include "krater/materials/law.hpp"
#include "krater/materials/returns/flow.hpp"
#include "krater/materials/returns/softening.hpp"

namespace krater::inline KRATER_ISA {

/// R and dR/d epsdot of `Logarithmic` or power form.
template <bool logarithmic, class Real>
struct VoceRate {
  Real factor, slope;
  KRATER_FORCE_INLINE VoceRate(Real rate, double per_rate, double C) {
    if constexpr (logarithmic) {
      const Real relative = max(rate * per_rate, Real(1.0));
      factor = fma(Real(C), log(relative), Real(1.0));
      slope = select(relative > Real(1.0), Real(C * per_rate), Real(0.0)) / relative;
    } else {
      const Real base = fma(rate, Real(per_rate), Real(1.0));
      factor = exp(C * log(base));
      slope = (C * per_rate) * factor / base;
    }
  }
};

template <bool logarithmic>
struct VoceLaw {
  double A, Q1, C1, Q2, C2, C, epsdot0, m, T_ref, T_melt;
  double per_rate;   ///< 1/epsdot0 [s]
  double per_range;  ///< 1/(T_melt - T_ref) [1/K]

  static constexpr Family family = Family::strength;
  static constexpr const char* name = logarithmic ? "voce_log" : "voce";
  static constexpr const char* equation =
      logarithmic ? "sigma_Y = (A + Q1 (1 - exp(-C1 eps)) + Q2 (1 - exp(-C2 eps))) "
                    "(1 + C ln max(epsdot/epsdot0, 1)) (1 - T*^m)"
                  : "sigma_Y = (A + Q1 (1 - exp(-C1 eps)) + Q2 (1 - exp(-C2 eps))) "
                    "(1 + epsdot/epsdot0)^C (1 - T*^m)";
  static constexpr const char* reference =
      "Voce 1948; Borvik, Hopperstad, Berstad, Langseth, Eur. J. Mech. A/Solids 20, 2001";
  static constexpr bool needs_shear_modulus = true;
  static constexpr bool reads_temperature = true;
  static constexpr Parameter<VoceLaw> parameters[] = {
      {{"A", "Pa", Range::positive, kRequired, "yield stress at no plastic strain"}, &VoceLaw::A},
      {{"Q1", "Pa", Range::non_negative, kRequired, "hardening of the first term"}, &VoceLaw::Q1},
      {{"C1", "1", Range::non_negative, kRequired, "its rate of saturation"}, &VoceLaw::C1},
      {{"Q2", "Pa", Range::non_negative, 0.0, "hardening of the second term"}, &VoceLaw::Q2},
      {{"C2", "1", Range::non_negative, 0.0, "its rate of saturation"}, &VoceLaw::C2},
      {{"C", "1", Range::fraction, 0.0, "rate sensitivity"}, &VoceLaw::C},
      {{"epsdot0", "1/s", Range::positive, 1.0, "reference rate"}, &VoceLaw::epsdot0},
      {{"m", "1", Range::positive, kRequired, "thermal exponent"}, &VoceLaw::m},
      {{"T_ref", "K", Range::positive, kRequired, "temperature of full strength", "T_r"},
       &VoceLaw::T_ref},
      {{"T_melt", "K", Range::positive, kRequired, "melting temperature: no strength", "T_m"},
       &VoceLaw::T_melt},
  };

  void prepare(const MaterialConstants&) {
    per_rate = 1.0 / epsdot0;
    per_range = 1.0 / (T_melt - T_ref);
  }
  const char* problem() const { return T_melt > T_ref ? nullptr : "T_melt must lie above T_ref"; }

  template <class Real>
  struct Curve {
    const VoceLaw& law;
    Real thermal;  ///< 1 - T*^m

    struct Hardening {
      Real stress, slope, bend;
    };
    KRATER_FORCE_INLINE Hardening hardening(Real eps) const {
      const Real left1 = law.Q1 * exp(-law.C1 * eps);  // of the hardening still to come
      const Real left2 = law.Q2 * exp(-law.C2 * eps);
      const Real gained = (law.Q1 - left1) + (law.Q2 - left2);
      const Real slope1 = law.C1 * left1, slope2 = law.C2 * left2;
      return {(law.A + gained) * thermal, (slope1 + slope2) * thermal,
              fma(Real(law.C1), slope1, law.C2 * slope2) * thermal};
    }
    KRATER_FORCE_INLINE Flow<Real> flow(const Hardening& h, Real, Real rate) const {
      const VoceRate<logarithmic, Real> r{rate, law.per_rate, law.C};
      return {h.stress * r.factor, h.slope * r.factor, h.stress * r.slope, h.bend * r.factor};
    }
    KRATER_FORCE_INLINE MaskOf<Real> smooth_between(Real rate0, Real rate1) const {
      if constexpr (!logarithmic) return Real(0.0) == Real(0.0);
      const MaskOf<Real> crossed = (rate0 > Real(law.epsdot0)) ^ (rate1 > Real(law.epsdot0));
      return !crossed;
    }
  };

  template <class Real>
  KRATER_FORCE_INLINE Real least_yield(Real eps, Real temperature) const {
    return fma(Real(0.0), eps, Real(A)) * least_thermal_factor(temperature, T_ref, per_range, m);
  }

  template <class Real>
  KRATER_FORCE_INLINE Curve<Real> at(Real temperature) const {
    return {*this, thermal_factor(temperature, T_ref, per_range, m)};
  }
};

using Voce = VoceLaw<false>;
using VoceLog = VoceLaw<true>;

}  // namespace krater::inline KRATER_ISA
