// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a yield law gives the radial return. A yielding law has
///   template <class Real> auto at(Real temperature) const
/// which does once per update what does not depend on plastic strain, and returns a curve with
///   Hardening hardening(Real eps) const      what depends on eps alone;
///                                            `.stress` is sigma_Y(eps, 0, T)
///   Flow<Real> flow(Hardening, Real eps, Real rate) const             for eps > 0
///   MaskOf<Real> smooth_between(Real rate0, Real rate1) const         no kink in between
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

/// A law with a yield surface (the others are elastic for ever).
template <class Law>
concept Yielding = requires(const Law& law) {
  law.at(1.0);
};

}  // namespace krater::inline KRATER_ISA
