// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// sigma_Y = Y + H eps, theory 5. Reference: von Mises 1913 with linear isotropic hardening.
/// Independent of rate and temperature.
#pragma once

#include "krater/materials/law.hpp"
#include "krater/materials/returns/flow.hpp"

namespace krater::inline KRATER_ISA {

struct VonMises {
  double Y;
  double H;

  static constexpr Family family = Family::strength;
  static constexpr const char* name = "von_mises";
  static constexpr const char* equation = "sigma_Y = Y + H eps";
  static constexpr const char* reference = "von Mises 1913; linear isotropic hardening";
  static constexpr bool needs_shear_modulus = true;
  static constexpr bool reads_temperature = false;
  static constexpr Parameter<VonMises> parameters[] = {
      {{"Y", "Pa", Range::positive, kRequired, "yield stress at no plastic strain", "yield_stress"},
       &VonMises::Y},
      {{"H", "Pa", Range::non_negative, 0.0, "hardening modulus d sigma_Y / d eps", "hardening"},
       &VonMises::H},
  };

  void prepare(const MaterialConstants&) {}

  template <class Real>
  struct Curve {
    double Y;
    double H;
    struct Hardening {
      Real stress;
    };
    KRATER_FORCE_INLINE Hardening hardening(Real eps) const { return {fma(Real(H), eps, Real(Y))}; }
    KRATER_FORCE_INLINE Flow<Real> flow(const Hardening& h, Real, Real) const {
      return {h.stress, Real(H), Real(0.0), Real(0.0)};
    }
    KRATER_FORCE_INLINE MaskOf<Real> smooth_between(Real, Real) const {
      return Real(0.0) == Real(0.0);
    }
  };

  template <class Real>
  KRATER_FORCE_INLINE Curve<Real> at(Real) const {
    return {Y, H};
  }
};

}  // namespace krater::inline KRATER_ISA
