// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Pieces that flow stresses share: a safe power, and the softening by heat 1 - T*^m with the
/// homologous temperature T* = clamp((T - T_ref)/(T_melt - T_ref), 0, 1) (theory 5, Decision 2).
#pragma once

#include "krater/core/lane_math.hpp"

namespace krater::inline KRATER_ISA {

/// x^y for x >= 0, y > 0, good to a few |y log x| ulp; `pow` carries the logarithm in two parts,
/// at half the speed. Zero, the value of most points, is kept out of the exponential: its
/// underflow costs a hundred cycles. The order of the operands lets a NaN through.
template <class Real>
KRATER_FORCE_INLINE Real positive_power(Real x, double y) {
  constexpr double nothing = 1e-100;
  return select(x <= Real(nothing), Real(0.0), exp(y * log(max(Real(nothing), x))));
}

/// 1 - T*^m; `per_range` = 1/(T_melt - T_ref).
template <class Real>
KRATER_FORCE_INLINE Real thermal_factor(Real temperature, double T_ref, double per_range,
                                        double m) {
  const Real t = clamp((temperature - T_ref) * per_range, Real(0.0), Real(1.0));
  return Real(1.0) - positive_power(t, m);
}

/// Never above thermal_factor: T*^m lies below its chord (m >= 1) or its tangent at T* = 1 (m < 1).
/// The subtrahend is more than the rounding of the power.
template <class Real>
KRATER_FORCE_INLINE Real least_thermal_factor(Real temperature, double T_ref, double per_range,
                                              double m) {
  const Real t = clamp((temperature - T_ref) * per_range, Real(0.0), Real(1.0));
  return max(Real(0.0), fms(Real(m < 1.0 ? m : 1.0), 1.0 - t, Real(1e-13)));
}

}  // namespace krater::inline KRATER_ISA
