// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a yield law gives the radial return. A yielding law has
///   template <class Real> auto at(Real temperature) const
/// or, with `reads_pressure`,
///   template <class Real> auto at(Real temperature, Real pressure, Real compression) const
/// which does once per update what does not depend on plastic strain, and returns a curve with
///   Hardening hardening(Real eps) const      what depends on eps alone;
///                                            `.stress` is sigma_Y(eps, 0, T)
///   Flow<Real> flow(Hardening, Real eps, Real rate) const             for eps > 0
///   MaskOf<Real> smooth_between(Real rate0, Real rate1) const         no kink in between
///   MaskOf<Real> smooth_between_strains(Real eps0, Real eps1) const   the same in eps (optional)
/// A law may also have
///   Real least_yield(Real eps, Real temperature) const
/// never above sigma_Y(eps, 0, T) and without exp or log: where the trial stays below it in a whole
/// lane group, the law need not be evaluated. A NaN must pass through it.
/// A law whose shear modulus varies has `Real shear_modulus(Real T, Real p, Real x) const`. Both
/// see the state at the start of the step.
/// The curvature in the rate is taken as at most d_rate/rate, which holds for logarithms and for
/// powers below 1. sigma_Y must not decrease with eps or rate (the radial return brackets its root
/// by that).
#pragma once

#include "krater/core/simd.hpp"

namespace krater::inline KRATER_ISA {

template <class Real>
struct Flow {
  Real stress;  ///< sigma_Y [Pa]
  Real d_eps;   ///< its derivative by plastic strain [Pa]
  Real d_rate;  ///< its derivative by plastic strain rate [Pa s]
  Real bend;    ///< |second derivative| by plastic strain [Pa]
};

/// sigma_Y and its slopes at a plastic strain and rate.
template <class Curve, class Real>
KRATER_FORCE_INLINE Flow<Real> flow_at(const Curve& curve, Real eps, Real rate) {
  return curve.flow(curve.hardening(eps), eps, rate);
}

/// What a law may read of a point at the start of the step.
template <class Real>
struct StartState {
  Real temperature;        ///< [K]
  Real pressure = 0.0;     ///< [Pa]
  Real compression = 1.0;  ///< rho/rho0
};

/// A law that needs the pressure and the density.
template <class Law>
concept ReadsPressure = requires {
  requires Law::reads_pressure;
};
/// A law whose shear modulus is not the constant of the material.
template <class Law>
concept VariesShear = requires(const Law& law) {
  law.shear_modulus(1.0, 1.0, 1.0);
};
/// A law whose plastic flow opens voids (strength/drucker_prager.hpp).
template <class Law>
concept Dilatant = requires(const Law& law) {
  law.bulking(1.0, 1.0);
};
/// A law with a yield surface (the others are elastic for ever).
template <class Law>
concept Yielding = requires(const Law& law) {
  law.at(1.0);
}
|| ReadsPressure<Law>;

template <class Law, class Real>
KRATER_FORCE_INLINE auto curve_at(const Law& law, const StartState<Real>& start) {
  if constexpr (ReadsPressure<Law>) {
    return law.at(start.temperature, start.pressure, start.compression);
  } else {
    return law.at(start.temperature);
  }
}

/// The modulus of the step: `G` (a double), or what the law makes of the state.
template <class Law, class Real>
KRATER_FORCE_INLINE auto shear_at(const Law& law, const StartState<Real>& start, double G) {
  if constexpr (VariesShear<Law>) {
    return law.shear_modulus(start.temperature, start.pressure, start.compression);
  } else {
    return G;
  }
}

}  // namespace krater::inline KRATER_ISA
