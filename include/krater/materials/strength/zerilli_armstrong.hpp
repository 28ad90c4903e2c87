// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Dislocation-mechanics flow stresses, T in K and epsdot in 1/s:
///   zerilli_armstrong_fcc:  sigma_Y = C0 + C2 sqrt(eps) exp(-C3 T + C4 T ln epsdot)
///   zerilli_armstrong_bcc:  sigma_Y = C0 + C1 exp(-C3 T + C4 T ln epsdot) + C5 eps^n
/// Theory 5. Reference: Zerilli and Armstrong, J. Appl. Phys. 61, 1816, 1987.
///
/// As printed the thermal term vanishes like epsdot^(C4 T) at no rate, so a point at rest would
/// creep for ever. Below `epsdot0` the curve is the one at epsdot0, as for Johnson-Cook.
#pragma once

#include "krater/materials/law.hpp"
#include "krater/materials/returns/flow.hpp"
#include "krater/materials/returns/softening.hpp"

namespace krater::inline KRATER_ISA {

/// exp(C4 T ln max(epsdot/epsdot0, 1)) and its slope by epsdot.
template <class Real>
struct ThermalActivation {
  Real factor, slope;
  KRATER_FORCE_INLINE ThermalActivation(Real rate, Real exponent, double epsdot0) {
    const Real relative = max(rate * (1.0 / epsdot0), Real(1.0));
    factor = exp(exponent * log(relative));
    slope = select(relative > Real(1.0), exponent, Real(0.0)) * factor / (epsdot0 * relative);
  }
};

struct ZerilliArmstrongFcc {
  double C0, C2, C3, C4, epsdot0;
  double log_rate0;

  static constexpr Family family = Family::strength;
  static constexpr const char* name = "zerilli_armstrong_fcc";
  static constexpr const char* equation =
      "sigma_Y = C0 + C2 sqrt(eps) exp(-C3 T + C4 T ln max(epsdot, epsdot0))";
  static constexpr const char* reference =
      "Zerilli and Armstrong, J. Appl. Phys. 61, 1816, 1987 (face-centred cubic)";
  static constexpr bool needs_shear_modulus = true;
  static constexpr bool reads_temperature = true;
  static constexpr Parameter<ZerilliArmstrongFcc> parameters[] = {
      {{"C0", "Pa", Range::positive, kRequired, "athermal stress (grain size, solutes)"},
       &ZerilliArmstrongFcc::C0},
      {{"C2", "Pa", Range::non_negative, kRequired, "factor of the thermal stress"},
       &ZerilliArmstrongFcc::C2},
      {{"C3", "1/K", Range::non_negative, kRequired, "softening by heat"},
       &ZerilliArmstrongFcc::C3},
      {{"C4", "1/K", Range::non_negative, kRequired, "rate sensitivity over temperature"},
       &ZerilliArmstrongFcc::C4},
      {{"epsdot0", "1/s", Range::positive, 1e-4, "rate below which the curve is static"},
       &ZerilliArmstrongFcc::epsdot0},
  };

  void prepare(const MaterialConstants&) { log_rate0 = log(epsdot0); }

  template <class Real>
  struct Curve {
    double C0, epsdot0;
    Real thermal;   ///< C2 exp(-C3 T + C4 T ln epsdot0)
    Real exponent;  ///< C4 T

    struct Hardening {
      Real stress;
      Real thermal_part;
    };
    KRATER_FORCE_INLINE Hardening hardening(Real eps) const {
      const Real part = thermal * sqrt(eps);
      return {C0 + part, part};
    }
    KRATER_FORCE_INLINE Flow<Real> flow(const Hardening& h, Real eps, Real rate) const {
      const ThermalActivation<Real> active{rate, exponent, epsdot0};
      const Real part = h.thermal_part * active.factor;
      const Real per_eps = 0.5 / eps;
      const Real d_eps = part * per_eps;
      return {C0 + part, d_eps, h.thermal_part * active.slope, d_eps * per_eps};
    }
    KRATER_FORCE_INLINE MaskOf<Real> smooth_between(Real rate0, Real rate1) const {
      const MaskOf<Real> crossed = (rate0 > Real(epsdot0)) ^ (rate1 > Real(epsdot0));
      return !crossed;
    }
  };

  template <class Real>
  KRATER_FORCE_INLINE Curve<Real> at(Real T) const {
    return {C0, epsdot0, C2 * exp(T * (C4 * log_rate0 - C3)), C4 * T};
  }
};

struct ZerilliArmstrongBcc {
  double C0, C1, C3, C4, C5, n, epsdot0;
  double log_rate0;

  static constexpr Family family = Family::strength;
  static constexpr const char* name = "zerilli_armstrong_bcc";
  static constexpr const char* equation =
      "sigma_Y = C0 + C1 exp(-C3 T + C4 T ln max(epsdot, epsdot0)) + C5 eps^n";
  static constexpr const char* reference =
      "Zerilli and Armstrong, J. Appl. Phys. 61, 1816, 1987 (body-centred cubic)";
  static constexpr bool needs_shear_modulus = true;
  static constexpr bool reads_temperature = true;
  static constexpr Parameter<ZerilliArmstrongBcc> parameters[] = {
      {{"C0", "Pa", Range::non_negative, kRequired, "athermal stress (grain size, solutes)"},
       &ZerilliArmstrongBcc::C0},
      {{"C1", "Pa", Range::non_negative, kRequired, "factor of the thermal stress"},
       &ZerilliArmstrongBcc::C1},
      {{"C3", "1/K", Range::non_negative, kRequired, "softening by heat"},
       &ZerilliArmstrongBcc::C3},
      {{"C4", "1/K", Range::non_negative, kRequired, "rate sensitivity over temperature"},
       &ZerilliArmstrongBcc::C4},
      {{"C5", "Pa", Range::non_negative, kRequired, "hardening factor"}, &ZerilliArmstrongBcc::C5},
      {{"n", "1", Range::positive, kRequired, "hardening exponent"}, &ZerilliArmstrongBcc::n},
      {{"epsdot0", "1/s", Range::positive, 1e-4, "rate below which the curve is static"},
       &ZerilliArmstrongBcc::epsdot0},
  };

  void prepare(const MaterialConstants&) { log_rate0 = log(epsdot0); }
  const char* problem() const { return C0 + C1 > 0.0 ? nullptr : "C0 + C1 must be positive"; }

  template <class Real>
  struct Curve {
    const ZerilliArmstrongBcc& law;
    Real thermal;   ///< C1 exp(-C3 T + C4 T ln epsdot0)
    Real exponent;  ///< C4 T

    struct Hardening {
      Real stress;
      Real athermal;    ///< C0 + C5 eps^n
      Real power_term;  ///< C5 eps^n
    };
    KRATER_FORCE_INLINE Hardening hardening(Real eps) const {
      const Real power_term = law.C5 * positive_power(eps, law.n);
      const Real athermal = law.C0 + power_term;
      return {athermal + thermal, athermal, power_term};
    }
    KRATER_FORCE_INLINE Flow<Real> flow(const Hardening& h, Real eps, Real rate) const {
      const ThermalActivation<Real> active{rate, exponent, law.epsdot0};
      const Real per_eps = Real(1.0) / eps;
      const Real d_eps = law.n * h.power_term * per_eps;
      return {fma(thermal, active.factor, h.athermal), d_eps, thermal * active.slope,
              abs(1.0 - law.n) * d_eps * per_eps};
    }
    KRATER_FORCE_INLINE MaskOf<Real> smooth_between(Real rate0, Real rate1) const {
      const MaskOf<Real> crossed = (rate0 > Real(law.epsdot0)) ^ (rate1 > Real(law.epsdot0));
      return !crossed;
    }
  };

  template <class Real>
  KRATER_FORCE_INLINE Curve<Real> at(Real T) const {
    return {*this, C1 * exp(T * (C4 * log_rate0 - C3)), C4 * T};
  }
};

}  // namespace krater::inline KRATER_ISA
