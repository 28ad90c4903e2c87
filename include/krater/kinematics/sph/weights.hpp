// SPDX-License-Identifier: GPL-3.0-or-later
/// \file kinematics/sph/weights.hpp
/// Weights W(r) of particles, q = r/h, of support 2h:
///   cubic spline   W = s (1 - 3 q^2/2 + 3 q^3/4), q < 1;   s (2 - q)^3/4, q < 2
///                  s = 10/(7 pi h^2), 1/(pi h^3)                         (Monaghan 2005, eq. 2.6)
///   Wendland C2    W = s (1 - q/2)^4 (1 + 2 q);  s = 7/(4 pi h^2), 21/(16 pi h^3)
///                                                           (Dehnen and Aly 2012, table 1)
///   quadratic      W = s (1 - q/2)^2;  s = 3/(2 pi h^2), 15/(16 pi h^3)
///                                                           (Johnson and Beissel 1996)
/// whose slope grows all the way inwards, so that no pair that is pressed together yields.
/// and their slopes by the distance, W'(r)/r: finite at r = 0, so that a particle may stand in its
/// own list, or a lane that is empty for it, and adds nothing there. No gradient of a weight is
/// longer than its h times W'/r at the inflexion. A pair is worth one division and one root: 1/r
/// (inverse_distance()), from which q and 1/q follow.
#pragma once

#include <numbers>

#include "krater/core/lane_math.hpp"
#include "krater/kinematics/sph/options.hpp"

namespace krater::inline KRATER_ISA {

/// Numbers that a sweep needs of h.
struct WeightScale {
  double h = 0, per_h = 0, size = 0, slope = 0;  ///< h; 1/h; s; s/h^2
};

template <SphKernel Kind>
KRATER_FORCE_INLINE WeightScale weight_scale(int dimension, double h) {
  constexpr double per_pi = std::numbers::inv_pi;
  const double plane = Kind == SphKernel::cubic_spline  ? 10.0 / 7.0
                       : Kind == SphKernel::wendland_c2 ? 7.0 / 4.0
                                                        : 3.0 / 2.0,
               space = Kind == SphKernel::cubic_spline  ? 1.0
                       : Kind == SphKernel::wendland_c2 ? 21.0 / 16.0
                                                        : 15.0 / 16.0;
  const double s = dimension == 2 ? plane * per_pi / (h * h) : space * per_pi / (h * h * h);
  return {h, 1 / h, s, s / (h * h)};
}

/// 1/r from r^2, finite at 0.
template <class Real>
KRATER_FORCE_INLINE Real inverse_distance(Real r_squared) {
  return sqrt(1.0 / max(r_squared, Real(1e-280)));
}

/// W'(r)/r from r^2 and 1/r; zero or less.
template <SphKernel Kind, class Real>
KRATER_FORCE_INLINE Real weight_slope(const WeightScale& scale, Real r_squared, Real per_r) {
  if constexpr (Kind == SphKernel::quadratic) {
    return scale.slope * min(Real(0.0), fnma(Real(scale.h), per_r, Real(0.5)));
  } else {
    const Real q = Real(scale.per_h) * (r_squared * per_r), rest = max(Real(0.0), 2.0 - q);
    if constexpr (Kind == SphKernel::wendland_c2)
      return Real(-0.625 * scale.slope) * (rest * rest * rest);
    const Real inner = fma(Real(2.25), q, Real(-3.0)),
               outer = (-0.75 * scale.h) * rest * rest * per_r;
    return Real(scale.slope) * select(q < Real(1.0), inner, outer);
  }
}

/// W(r) from r^2.
template <SphKernel Kind, class Real>
KRATER_FORCE_INLINE Real weight(const WeightScale& scale, Real r_squared) {
  const Real q = Real(scale.per_h) * sqrt(max(r_squared, Real(1e-280)));
  const Real rest = max(Real(0.0), 2.0 - q);
  if constexpr (Kind == SphKernel::cubic_spline) {
    const Real inner = fma(q * q, fma(Real(0.75), q, Real(-1.5)), Real(1.0)),
               outer = 0.25 * rest * rest * rest;
    return Real(scale.size) * select(q < Real(1.0), inner, outer);
  } else if constexpr (Kind == SphKernel::quadratic) {
    return Real(0.25 * scale.size) * (rest * rest);
  } else {
    const Real squared = rest * rest;
    return Real(scale.size / 16) * (squared * squared) * fma(Real(2.0), q, Real(1.0));
  }
}

}  // namespace krater::inline KRATER_ISA
