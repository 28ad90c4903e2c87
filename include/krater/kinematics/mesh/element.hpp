// SPDX-License-Identifier: GPL-3.0-or-later
/// \file kinematics/mesh/element.hpp
/// Geometry of an element with one point: volume, its exact derivatives, mean gradient, forces.
/// Hexahedron (3d), corners 0-3 the bottom counter-clockwise seen from the top, 4-7 above them:
///   V = sum_I x_I b_xI,   b_xI = dV/dx_I exactly (Flanagan and Belytschko 1981, IJNME 17, 679).
/// Quadrilateral (plane strain, axisymmetric per full revolution), corners counter-clockwise,
/// w = 1 or 2 pi r, by 2x2 Gauss, which is exact:
///   V = int w dA,   b_aI = int w dN_I/dx_a dA,   t_I = int 2 pi N_I dA   (hoop).
/// With B = b/V, T = t/V:
///   L = sum_I v_I (x) B_I,  L_tt = sum_I v_rI T_I,
///   f_I = - sigma b_I,      f_rI -= sigma_tt t_I,
/// so that sum f_I . v_I = - V sigma : L for any v and sigma. As sum_I b_I = 0 and
/// sum_I x_I (x) b_I = V 1, linear fields are exact on any element, a uniform stress leaves inner
/// nodes at rest, and moments vanish. The gradient at the centre has none of the last two.
#pragma once

#include "krater/core/tensor.hpp"
#include "krater/kinematics/frames.hpp"

namespace krater::inline KRATER_ISA {

constexpr int corner_nodes(int dim) { return dim == 3 ? 8 : 4; }

/// Corner I of the unit cube along axis k: -1 or 1.
constexpr double corner_sign(int dim, int I, int k) {
  if (k == 2) return I < 4 ? -1 : 1;
  const int i = dim == 3 ? I % 4 : I;
  return k == 0 ? ((i == 1 || i == 2) ? 1 : -1) : (i >= 2 ? 1 : -1);
}

template <class Real, class Frame>
struct ElementGeometry {
  static constexpr int dim = Frame::dim, nodes = corner_nodes(dim);
  Real b[nodes][dim];  ///< dV/dx without the hoop's part [m^2]
  Real t[nodes];       ///< [m^2], axisymmetric only
  Real volume;         ///< [m^3], [m^2] in plane strain
};

/// Other corners of the formula for corner 0, by renumbering.
inline constexpr int kHexahedronOrder[8][8] = {{0, 1, 2, 3, 4, 5, 6, 7}, {1, 2, 3, 0, 5, 6, 7, 4},
                                               {2, 3, 0, 1, 6, 7, 4, 5}, {3, 0, 1, 2, 7, 4, 5, 6},
                                               {4, 7, 6, 5, 0, 3, 2, 1}, {5, 4, 7, 6, 1, 0, 3, 2},
                                               {6, 5, 4, 7, 2, 1, 0, 3}, {7, 6, 5, 4, 3, 2, 1, 0}};

/// dV/dx_I along one axis from the other two, in cyclic order.
template <class Real>
KRATER_FORCE_INLINE Real hexahedron_b(const Real (&x)[8][3], int I, int axis) {
  const int p = (axis + 1) % 3, q = (axis + 2) % 3;
  const auto y = [&](int k) { return x[kHexahedronOrder[I][k]][p]; };
  const auto z = [&](int k) { return x[kHexahedronOrder[I][k]][q]; };
  const Real front = y(1) * ((z(5) - z(2)) - (z(3) - z(4))) + y(2) * (z(1) - z(3)) +
                     y(3) * ((z(2) - z(7)) - (z(4) - z(1)));
  const Real back =
      y(4) * ((z(7) - z(5)) - (z(1) - z(3))) + y(5) * (z(4) - z(1)) + y(7) * (z(3) - z(4));
  return (1.0 / 12.0) * (front + back);
}

template <class Real>
KRATER_FORCE_INLINE void find_geometry(const Real (&x)[8][3],
                                       ElementGeometry<Real, Cartesian<3>>& out) {
  out.volume = Real(0.0);
  for (int I = 0; I < 8; ++I) {
    for (int a = 0; a < 3; ++a) out.b[I][a] = hexahedron_b(x, I, a);
    out.t[I] = Real(0.0);
    out.volume = fma(x[I][0] - x[0][0], out.b[I][0], out.volume);
  }
}

/// Sums of one Gauss point of the quadrilateral.
template <class Frame, class Real>
KRATER_FORCE_INLINE void add_gauss_point(const Real (&x)[4][2], int point,
                                         ElementGeometry<Real, Frame>& out) {
  constexpr double g = 0.57735026918962576451, pi = 3.14159265358979323846;
  const double xi = g * corner_sign(2, point, 0), eta = g * corner_sign(2, point, 1);
  Real J[2][2] = {{Real(0.0), Real(0.0)}, {Real(0.0), Real(0.0)}}, r = Real(0.0);
  double by_xi[4], by_eta[4], N[4];
  for (int I = 0; I < 4; ++I) {
    const double s = corner_sign(2, I, 0), u = corner_sign(2, I, 1);
    N[I] = 0.25 * (1 + s * xi) * (1 + u * eta);
    by_xi[I] = 0.25 * s * (1 + u * eta);
    by_eta[I] = 0.25 * u * (1 + s * xi);
    r = fma(Real(N[I]), x[I][0], r);
    for (int a = 0; a < 2; ++a) {
      J[0][a] = fma(Real(by_xi[I]), x[I][a] - x[0][a], J[0][a]);
      J[1][a] = fma(Real(by_eta[I]), x[I][a] - x[0][a], J[1][a]);
    }
  }
  const Real weight = Frame::hoop ? 2.0 * pi * r : Real(1.0);
  const Real area = fms(J[0][0], J[1][1], J[0][1] * J[1][0]);
  out.volume = fma(weight, area, out.volume);
  for (int I = 0; I < 4; ++I) {
    // dN/dx of the point times its area.
    const Real along = fms(J[1][1], Real(by_xi[I]), J[0][1] * by_eta[I]);
    const Real across = fms(J[0][0], Real(by_eta[I]), J[1][0] * by_xi[I]);
    out.b[I][0] = fma(weight, along, out.b[I][0]);
    out.b[I][1] = fma(weight, across, out.b[I][1]);
    if constexpr (Frame::hoop) out.t[I] = fma(2.0 * pi * N[I] * Real(1.0), area, out.t[I]);
  }
}

template <class Real, class Frame>
KRATER_FORCE_INLINE void find_geometry(const Real (&x)[4][2], ElementGeometry<Real, Frame>& out) {
  out.volume = Real(0.0);
  for (int I = 0; I < 4; ++I) out.b[I][0] = out.b[I][1] = out.t[I] = Real(0.0);
  for (int point = 0; point < 4; ++point) add_gauss_point<Frame>(x, point, out);
}

/// Area of a quadrilateral, of a hexahedron its volume: a length of it is for viscosity only, and a
/// thin element by the axis may fold while its volume is whole.
template <class Real>
KRATER_FORCE_INLINE Real plane_measure(const Real (&x)[4][2], Real) {
  return 0.5 *
         abs(fms(x[2][0] - x[0][0], x[3][1] - x[1][1], (x[3][0] - x[1][0]) * (x[2][1] - x[0][1])));
}
template <class Real>
KRATER_FORCE_INLINE Real plane_measure(const Real (&)[8][3], Real volume) {
  return volume;
}

/// k L of nodal velocities, over tensor axes; `per_volume` = k/V.
template <class Frame, class Real>
KRATER_FORCE_INLINE Mat3<Real> mean_gradient(const ElementGeometry<Real, Frame>& e,
                                             const Real (&v)[corner_nodes(Frame::dim)][Frame::dim],
                                             Real per_volume) {
  constexpr int D = Frame::dim;
  Real L[3][3] = {{Real(0.0), Real(0.0), Real(0.0)},
                  {Real(0.0), Real(0.0), Real(0.0)},
                  {Real(0.0), Real(0.0), Real(0.0)}};
  for (int I = 0; I < corner_nodes(D); ++I) {
    for (int i = 0; i < D; ++i)
      for (int a = 0; a < D; ++a) {
        Real& entry = L[tensor_axis<D>(i)][tensor_axis<D>(a)];
        entry = fma(v[I][i] - v[0][i], e.b[I][a], entry);
      }
    if constexpr (Frame::hoop) L[1][1] = fma(v[I][0], e.t[I], L[1][1]);
  }
  return per_volume * Mat3<Real>{L[0][0], L[0][1], L[0][2], L[1][0], L[1][1],
                                 L[1][2], L[2][0], L[2][1], L[2][2]};
}

/// f -= sigma b.
template <class Frame, class Real>
KRATER_FORCE_INLINE void add_stress_force(const ElementGeometry<Real, Frame>& e,
                                          const Sym3<Real>& sigma,
                                          Real (&f)[corner_nodes(Frame::dim)][Frame::dim]) {
  constexpr int D = Frame::dim;
  const Real s[6] = {sigma.xx, sigma.yy, sigma.zz, sigma.yz, sigma.xz, sigma.xy};
  for (int I = 0; I < corner_nodes(D); ++I)
    for (int i = 0; i < D; ++i) {
      for (int a = 0; a < D; ++a)
        f[I][i] = fnma(s[voigt(tensor_axis<D>(i), tensor_axis<D>(a))], e.b[I][a], f[I][i]);
      if (Frame::hoop && i == 0) f[I][i] = fnma(sigma.yy, e.t[I], f[I][i]);
    }
}

/// sum_I p_I/q_I of positive q with one division.
template <class Real, int N>
KRATER_FORCE_INLINE Real sum_of_quotients(Real (&p)[N], Real (&q)[N]) {
#pragma GCC unroll 3
  for (int half = N / 2; half > 0; half /= 2)
#pragma GCC unroll 4
    for (int I = 0; I < half; ++I) {
      p[I] = fma(p[I], q[I + half], p[I + half] * q[I]);
      q[I] = q[I] * q[I + half];
    }
  return p[0] / q[0];
}

/// Length whose quotient by the wave speed is the greatest stable step of the element alone,
/// 2/omega with omega^2 <= c^2/V sum_I (|b_I|^2 + t_I^2 + 2 max(0, b_rI t_I))/w_I, w_I = m_I/rho:
/// exact for a fluid, and a bound for the mesh, as the eigenvalues of its elements bound its own.
template <class Frame, class Real>
KRATER_FORCE_INLINE Real stable_length(const ElementGeometry<Real, Frame>& e,
                                       const Real (&share)[corner_nodes(Frame::dim)], Real rho) {
  constexpr int D = Frame::dim;
  Real squares[corner_nodes(D)], mass[corner_nodes(D)];
  for (int I = 0; I < corner_nodes(D); ++I) {
    mass[I] = share[I];
    squares[I] = Real(0.0);
    for (int a = 0; a < D; ++a) squares[I] = fma(e.b[I][a], e.b[I][a], squares[I]);
    if constexpr (Frame::hoop)
      squares[I] = fma(e.t[I], e.t[I] + 2.0 * max(Real(0.0), e.b[I][0]), squares[I]);
  }
  return 2.0 * sqrt(e.volume / (rho * sum_of_quotients(squares, mass)));
}

}  // namespace krater::inline KRATER_ISA
