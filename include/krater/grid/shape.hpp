// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file grid/shape.hpp
/// Shape functions: a hat of the grid convolved with a box of half-width lp of the point (theory
/// 15, lengths in h):
///   hat(z) = max(0, 1 - |z|),  its antiderivative A(z) = 1/2 + u - u|u|/2,  u = clamp(z, -1, 1)
///   S(r; lp) = [A(r + lp) - A(r - lp)]/(2 lp),  r = x_p - x_i
///   S'(r; lp) = [hat(r + lp) - hat(r - lp)]/(2 lp)
/// lp -> 0: linear; lp of the point's own domain: gimp; lp = 1/2: quadratic B-spline. For every lp
/// <= 1/2 the support lies in the three nodes floor(x - 1/2) + {0, 1, 2}, and constants and linear
/// fields are reproduced exactly.
#include "krater/core/simd.hpp"
#include "krater/grid/support.hpp"

namespace krater::inline KRATER_ISA {

/// Weights of the nodes along one axis for 8 points: S and dS/dx [in 1/h units: S' per cell].
struct Knots {
  Pack w[ThreeNodes::support], d[ThreeNodes::support];
};

/// `f`: distance to the first of the three nodes in cells, in [1/2, 3/2).
struct QuadraticBSpline : ThreeNodes {
  static constexpr bool has_width = false, quadratic_in_cell = true;
  static KRATER_FORCE_INLINE Knots at(Pack f, Pack /*lp*/) {
    const Pack a = 1.5 - f, b = f - 1.0, c = f - 0.5;
    return {{0.5 * (a * a), fnma(b, b, 0.75), 0.5 * (c * c)}, {-a, -2.0 * b, c}};
  }
};

struct Linear : ThreeNodes {
  static constexpr bool has_width = false, quadratic_in_cell = false;
  static KRATER_FORCE_INLINE Knots at(Pack f, Pack /*lp*/) {
    const Mask left = f < Pack(1.0);  // between the first and the second node
    const Pack zero = 0.0, one = 1.0;
    return {{select(left, one - f, zero), select(left, f, 2.0 - f), select(left, zero, f - 1.0)},
            {select(left, -one, zero), select(left, one, -one), select(left, zero, one)}};
  }
};

/// Half-width of the point in cells, in (0, 1/2].
struct Gimp : ThreeNodes {
  static constexpr bool has_width = true, quadratic_in_cell = false;
  static KRATER_FORCE_INLINE Pack hat(Pack z) { return max(1.0 - abs(z), Pack(0.0)); }
  static KRATER_FORCE_INLINE Pack antiderivative(Pack z) {
    const Pack u = clamp(z, Pack(-1.0), Pack(1.0));
    return 0.5 + u - 0.5 * (u * abs(u));
  }
  static KRATER_FORCE_INLINE Knots at(Pack f, Pack lp) {
    const Pack scale = 0.5 / lp;
    Knots k;
    for (int i = 0; i < support; ++i) {
      const Pack r = f - static_cast<double>(i);
      k.w[i] = scale * (antiderivative(r + lp) - antiderivative(r - lp));
      k.d[i] = scale * (hat(r + lp) - hat(r - lp));
    }
    return k;
  }
};

}  // namespace krater::inline KRATER_ISA
