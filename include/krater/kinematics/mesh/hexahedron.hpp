// SPDX-License-Identifier: GPL-3.0-or-later
/// \file kinematics/mesh/hexahedron.hpp
/// The hexahedron of element.hpp and hourglass.hpp on its current reference, in the modes of its
/// corners. With phi_m = xi, eta, zeta, eta zeta, xi zeta, xi eta, xi eta zeta (at corners +-1),
/// m = 1 to 7,
///   a_m = 1/8 sum_I phi_m(I) x_I,    u_m the same of v.
/// Of det dx/dxi only even powers of xi, eta, zeta outlast the integral:
///   V = 8 det(a1 a2 a3) + 8/3 [det(a1 a6 a5) + det(a6 a2 a4) + det(a5 a4 a3)],   c_m = dV/da_m,
/// and as the phi are orthogonal
///   b_I = 1/8 sum_m phi_m(I) c_m,    V L = sum_m u_m (x) c_m,    sum b:b = 1/8 sum_m c_m . c_m,
///   gamma_aI = 1/8 (phi_m(I) - 8 a_m . b_I/V),    q_a = u_m - L a_m,    m = a + 3,
///   J_k = a_k,
///   f_I = 1/8 sum_m phi_m(I) (- S c_m - F_m),    S = sigma - 1/V sum_m F_m (x) a_m,
/// F_m = sum_k e_k Q_ka of the hourglass modes, c_7 = 0. The same numbers as by the corners, to
/// round-off: no sum over corners is left but sums and differences.
#pragma once

#include "krater/core/tensor.hpp"
#include "krater/kinematics/mesh/element.hpp"
#include "krater/kinematics/mesh/hourglass.hpp"

namespace krater::inline KRATER_ISA {

/// Vectors of the modes 1 to 7; 0 is not used.
template <class Real>
using CornerModes = Real[8][3];

/// Of corner values less that of corner 0.
template <class Real>
KRATER_FORCE_INLINE void find_modes(const Real (&x)[8][3], CornerModes<Real>& a) {
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    const Real y1 = x[1][i] - x[0][i], y2 = x[2][i] - x[0][i], y3 = x[3][i] - x[0][i],
               y4 = x[4][i] - x[0][i], y5 = x[5][i] - x[0][i], y6 = x[6][i] - x[0][i],
               y7 = x[7][i] - x[0][i];
    const Real behind = y2 + y3, above = y4 + y5, top = y6 + y7;  // sums along xi
    const Real d2 = y2 - y3, d4 = y5 - y4, d6 = y6 - y7;          // differences; at the bottom y1
    const Real low = y1 + behind, high = above + top, low_eta = behind - y1, high_eta = top - above,
               low_xi = y1 + d2, high_xi = d4 + d6, low_both = d2 - y1, high_both = d6 - d4;
    a[1][i] = 0.125 * (low_xi + high_xi);
    a[2][i] = 0.125 * (low_eta + high_eta);
    a[3][i] = 0.125 * (high - low);
    a[4][i] = 0.125 * (high_eta - low_eta);
    a[5][i] = 0.125 * (high_xi - low_xi);
    a[6][i] = 0.125 * (low_both + high_both);
    a[7][i] = 0.125 * (high_both - low_both);
  }
}

/// sum_m phi_m(I) g_m at all corners.
template <class Real>
KRATER_FORCE_INLINE void find_corners(const CornerModes<Real>& g, Real (&out)[8][3]) {
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i)
#pragma GCC unroll 2
    for (int level = 0; level < 2; ++level) {
      const bool up = level == 1;
      const Real xi = up ? g[1][i] + g[5][i] : g[1][i] - g[5][i],
                 eta = up ? g[2][i] + g[4][i] : g[2][i] - g[4][i],
                 both = up ? g[6][i] + g[7][i] : g[6][i] - g[7][i],
                 same = up ? g[3][i] + both : both - g[3][i],
                 other = up ? g[3][i] - both : Real(0.0) - (g[3][i] + both);
      out[4 * level][i] = same - (xi + eta);
      out[4 * level + 1][i] = other + (xi - eta);
      out[4 * level + 2][i] = same + (xi + eta);
      out[4 * level + 3][i] = other - (xi - eta);
    }
}

/// Component i of the vector product.
template <class Real>
KRATER_FORCE_INLINE Real cross_at(const Real (&a)[3], const Real (&b)[3], int i) {
  const int j = (i + 1) % 3, k = (i + 2) % 3;
  return fms(a[j], b[k], a[k] * b[j]);
}
template <class Real>
KRATER_FORCE_INLINE Real dot3(const Real (&a)[3], const Real (&b)[3]) {
  return fma(a[0], b[0], fma(a[1], b[1], a[2] * b[2]));
}

template <class Real>
struct Hexahedron {
  CornerModes<Real> a, c;  ///< c_7 = 0 is not stored
  Real volume;

  /// From a.
  KRATER_FORCE_INLINE void find_slopes() {
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      c[1][i] = fma(Real(8.0), cross_at(a[2], a[3], i), (8.0 / 3.0) * cross_at(a[6], a[5], i));
      c[2][i] = fma(Real(8.0), cross_at(a[3], a[1], i), (8.0 / 3.0) * cross_at(a[4], a[6], i));
      c[3][i] = fma(Real(8.0), cross_at(a[1], a[2], i), (8.0 / 3.0) * cross_at(a[5], a[4], i));
      c[4][i] = (8.0 / 3.0) * (cross_at(a[6], a[2], i) + cross_at(a[3], a[5], i));
      c[5][i] = (8.0 / 3.0) * (cross_at(a[1], a[6], i) + cross_at(a[4], a[3], i));
      c[6][i] = (8.0 / 3.0) * (cross_at(a[5], a[1], i) + cross_at(a[2], a[4], i));
    }
    volume = dot3(a[1], c[1]) + dot3(a[4], c[4]);
  }

  /// scale V L of the motion u.
  KRATER_FORCE_INLINE Mat3<Real> gradient(const CornerModes<Real>& u, Real scale) const {
    Real L[3][3];
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i)
#pragma GCC unroll 3
      for (int k = 0; k < 3; ++k) {
        L[i][k] = u[1][i] * c[1][k];
#pragma GCC unroll 5
        for (int m = 2; m < 7; ++m) L[i][k] = fma(u[m][i], c[m][k], L[i][k]);
      }
    return scale * Mat3<Real>{L[0][0], L[0][1], L[0][2], L[1][0], L[1][1],
                              L[1][2], L[2][0], L[2][1], L[2][2]};
  }

  /// s q of the hourglass modes, along the grid's axes, from s L.
  KRATER_FORCE_INLINE void hourglass_of(const CornerModes<Real>& u, const Mat3<Real>& L, Real s,
                                        Real (&q)[4][3]) const {
    const Real l[3][3] = {{L.xx, L.xy, L.xz}, {L.yx, L.yy, L.yz}, {L.zx, L.zy, L.zz}};
#pragma GCC unroll 4
    for (int m = 0; m < 4; ++m)
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) q[m][i] = fms(s, u[m + 4][i], dot3(l[i], a[m + 4]));
  }

  /// e_k and 1/a_k of hourglass.hpp.
  KRATER_FORCE_INLINE void directions(Real (&e)[3][3], Real (&per_a)[3]) const {
#pragma GCC unroll 3
    for (int k = 0; k < 3; ++k) {
      per_a[k] = 1.0 / sqrt(dot3(a[k + 1], a[k + 1]));
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) e[k][i] = a[k + 1][i] * per_a[k];
    }
  }

  KRATER_FORCE_INLINE Real squares() const {
    Real sum = dot3(c[1], c[1]);
#pragma GCC unroll 5
    for (int m = 2; m < 7; ++m) sum = sum + dot3(c[m], c[m]);
    return 0.125 * sum;
  }

  /// Forces of stress and hourglass at the corners.
  KRATER_FORCE_INLINE void forces(const Sym3<Real>& s, const Real (&F)[4][3],
                                  Real (&out)[8][3]) const {
    const Real per_volume = 1.0 / volume;
    Real S[3][3] = {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}};
    CornerModes<Real> g;
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      Real carried[3] = {Real(0.0), Real(0.0), Real(0.0)};
#pragma GCC unroll 4
      for (int m = 0; m < 4; ++m)
#pragma GCC unroll 3
        for (int k = 0; k < 3; ++k) carried[k] = fma(F[m][i], a[m + 4][k], carried[k]);
#pragma GCC unroll 3
      for (int k = 0; k < 3; ++k) S[i][k] = fnma(per_volume, carried[k], S[i][k]);
#pragma GCC unroll 6
      for (int m = 1; m < 7; ++m) g[m][i] = -0.125 * dot3(S[i], c[m]);
#pragma GCC unroll 3
      for (int m = 0; m < 3; ++m) g[m + 4][i] = fma(Real(-0.125), F[m][i], g[m + 4][i]);
      g[7][i] = -0.125 * F[3][i];
    }
    find_corners(g, out);
  }

  /// stable_length() of element.hpp.
  KRATER_FORCE_INLINE Real stable_length(const Real (&share)[8], Real rho) const {
    CornerModes<Real> g;
    Real b[8][3], squares[8], mass[8];
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 6
      for (int m = 1; m < 7; ++m) g[m][i] = 0.125 * c[m][i];
      g[7][i] = Real(0.0);
    }
    find_corners(g, b);
#pragma GCC unroll 8
    for (int I = 0; I < 8; ++I) {
      squares[I] = dot3(b[I], b[I]);
      mass[I] = share[I];
    }
    return 2.0 * sqrt(volume / (rho * sum_of_quotients(squares, mass)));
  }
};

}  // namespace krater::inline KRATER_ISA
