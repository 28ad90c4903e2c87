// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A polyline y(x) of N points without branches: y = y_0 + sum of slope_k times the part of x in
/// piece k. Below the first point it is constant; beyond the last it goes on with the last slope,
/// or is constant.
#pragma once

#include <array>

#include "krater/core/simd.hpp"

namespace krater::inline KRATER_ISA {

template <unsigned N>
struct Polyline {
  std::array<double, N> x;
  double start;
  std::array<double, N - 1> slope, width;

  static Polyline through(const std::array<double, N>& x, const std::array<double, N>& y,
                          bool goes_on) {
    constexpr double endless = 1e300;
    Polyline line{x, y[0], {}, {}};
    for (unsigned k = 0; k + 1 < N; ++k) {
      line.width[k] = x[k + 1] - x[k];
      line.slope[k] = (y[k + 1] - y[k]) / line.width[k];
    }
    if (goes_on) line.width[N - 2] = endless;
    return line;
  }
  /// A NaN stays one.
  template <class Real>
  KRATER_FORCE_INLINE Real operator()(Real at) const {
    Real y = Real(start);
    for (unsigned k = 0; k + 1 < N; ++k)
      y = fma(Real(slope[k]), min(Real(width[k]), max(Real(0.0), at - x[k])), y);
    return y;
  }
  /// Of the piece that begins at `at` or holds it, as if the first and the last had no ends.
  template <class Real>
  KRATER_FORCE_INLINE Real slope_at(Real at) const {
    Real found = Real(slope[0]);
    for (unsigned k = 1; k + 1 < N; ++k) found = select(at < Real(x[k]), found, Real(slope[k]));
    return found;
  }
};

}  // namespace krater::inline KRATER_ISA
