// SPDX-License-Identifier: GPL-3.0-or-later
/// \file kinematics/mesh/placed_element.hpp
/// The geometry that forces and strains of an element are taken with (mesh/element.hpp):
///   current   b, t, V of the corners where they are
///   initial   those of the start, b_0, t_0, V_0 at X, carried along by the mean gradient
///               F = sum_I x_I (x) b_0I/V_0,  F_tt = sum_I r_I t_0I/V_0,  J = det F,
///               b = J F^-T b_0,  t = J t_0/F_tt,  V = J V_0.
/// Then f_I = - sigma b_I = - V_0 P B_0I with P = J sigma F^-T, and L = sum v_I (x) b_I/V is
/// dF/dt F^-1: with one geometry in place of the other the sweeps are those of Theorem 1 on either
/// reference (theory 3), adjoint on both. On the initial one density is rho_0/J, hourglass does not
/// change it, and V is a measure, not the volume between the corners.
///
/// An adaptive reference begins as the initial one and is taken anew where the element is, when
/// the greatest component of |F^T F - 1|/2 passes a bound: X <- x, F <- 1, with the volume that it
/// has, V_0 <- J V_0, b_0, t_0 those of the corners times V_0 by their volume. Columns, nodes and
/// energies are not touched, and V_0 stays m/rho to round-off; its forces are those of another
/// method from then on. An element whose corners hold less than half of its volume keeps its own.
///
/// Hourglass on such a reference: gamma_0 is not orthogonal to x, so modes are pulled back,
///   q_a = sum_I gamma_0aI x_I,  q^_a = F^T q_a,  Q^ <- s (Q^ + K_0 dq^),
///   f_I = - sum_a F Q^_a gamma_0aI - (sum_a q_a (x) Q^_a) B_0I,
/// with K_0 the table of kinematics/mesh/hourglass.hpp at the start: objective, without moment, and
/// without plastic flow the gradient of an energy. A new reference keeps what is stored, Q^ K_0^-1
/// Q^/2. As K_ka of bending goes with V/a_k^2, that is Q^_ka a_k/sqrt V (of twist, nearly); the
/// force is another then, by up to the power 3/2 of the stretch. To keep the force instead, F Q^_a,
/// is to store more when stretched: cycles of 2 % made energy without end.
#pragma once

#include "krater/kinematics/mesh/hourglass.hpp"

namespace krater::inline KRATER_ISA {

/// An element on its reference.
template <class Frame>
struct ReferenceElement {
  static constexpr int dim = Frame::dim, nodes = corner_nodes(dim);
  Pack X[nodes][dim];
  ElementGeometry<Pack, Frame> start;  ///< at X
  Pack F[3][3];                        ///< over tensor axes
};

template <class Frame>
KRATER_FORCE_INLINE void scale_geometry(Pack share, ElementGeometry<Pack, Frame>& e) {
  e.volume = share * e.volume;
  for (int I = 0; I < corner_nodes(Frame::dim); ++I) {
    for (int i = 0; i < Frame::dim; ++i) e.b[I][i] = share * e.b[I][i];
    e.t[I] = share * e.t[I];
  }
}

/// F of the corners x, and the geometry carried along.
template <class Frame>
KRATER_FORCE_INLINE void carry(const Pack (&x)[corner_nodes(Frame::dim)][Frame::dim],
                               ReferenceElement<Frame>& r, ElementGeometry<Pack, Frame>& out) {
  constexpr int D = Frame::dim;
  const Mat3<Pack> m = mean_gradient(r.start, x, 1.0 / r.start.volume);
  const Pack F[3][3] = {{m.xx, m.xy, m.xz},
                        {m.yx, D == 2 && !Frame::hoop ? Pack(1.0) : m.yy, m.yz},
                        {m.zx, m.zy, m.zz}};
  Pack cofactor[3][3];
  for (int i = 0; i < 3; ++i)
    for (int a = 0; a < 3; ++a) {
      r.F[i][a] = F[i][a];
      const int j = (i + 1) % 3, k = (i + 2) % 3, b = (a + 1) % 3, c = (a + 2) % 3;
      cofactor[i][a] = fms(F[j][b], F[k][c], F[j][c] * F[k][b]);
    }
  Pack J = 0.0;
  for (int a = 0; a < 3; ++a) J = fma(F[0][a], cofactor[0][a], J);
  out.volume = J * r.start.volume;
  for (int I = 0; I < corner_nodes(D); ++I) {
    for (int i = 0; i < D; ++i) {
      out.b[I][i] = Pack(0.0);
      for (int a = 0; a < D; ++a)
        out.b[I][i] =
            fma(cofactor[tensor_axis<D>(i)][tensor_axis<D>(a)], r.start.b[I][a], out.b[I][i]);
    }
    out.t[I] = Frame::hoop ? cofactor[1][1] * r.start.t[I] : Pack(0.0);
  }
}

/// q_a along the grid's axes, and the components of q^_a along the element's directions at the
/// start.
template <class Frame>
KRATER_FORCE_INLINE void pulled_modes(const HourglassFrame<Pack, Frame::dim>& h,
                                      const ReferenceElement<Frame>& r,
                                      const Pack (&x)[corner_nodes(Frame::dim)][Frame::dim],
                                      Pack (&q)[hourglass_modes(Frame::dim)][Frame::dim],
                                      Pack (&out)[hourglass_size(Frame::dim)]) {
  constexpr int D = Frame::dim, modes = hourglass_modes(D);
  for (int a = 0; a < modes; ++a) {
    for (int i = 0; i < D; ++i) {
      q[a][i] = Pack(0.0);
      for (int I = 0; I < corner_nodes(D); ++I)
        q[a][i] = fma(h.gamma[a][I], x[I][i] - x[0][i], q[a][i]);
    }
    for (int k = 0; k < D; ++k) {
      Pack along = 0.0;
      for (int i = 0; i < D; ++i) {
        Pack Fe = 0.0;
        for (int b = 0; b < D; ++b)
          Fe = fma(r.F[tensor_axis<D>(i)][tensor_axis<D>(b)], h.e[k][b], Fe);
        along = fma(Fe, q[a][i], along);
      }
      out[modes * k + a] = along;
    }
  }
}

/// f -= sum_a F Q^_a gamma_a + (sum_a q_a (x) Q^_a) B_0.
template <class Frame>
KRATER_FORCE_INLINE void add_pulled_force(const HourglassFrame<Pack, Frame::dim>& h,
                                          const ReferenceElement<Frame>& r,
                                          const Pack (&x)[corner_nodes(Frame::dim)][Frame::dim],
                                          const Pack (&Q)[hourglass_size(Frame::dim)],
                                          Pack (&f)[corner_nodes(Frame::dim)][Frame::dim]) {
  constexpr int D = Frame::dim, modes = hourglass_modes(D);
  Pack q[modes][D], pulled[hourglass_size(D)];
  pulled_modes(h, r, x, q, pulled);
  const Pack per_volume = 1.0 / r.start.volume;
  for (int a = 0; a < modes; ++a) {
    Pack along[D], carried[D];  // Q^_a, F Q^_a
    for (int i = 0; i < D; ++i) {
      along[i] = Pack(0.0);
      for (int k = 0; k < D; ++k) along[i] = fma(h.e[k][i], Q[modes * k + a], along[i]);
    }
    for (int i = 0; i < D; ++i) {
      carried[i] = Pack(0.0);
      for (int b = 0; b < D; ++b)
        carried[i] = fma(r.F[tensor_axis<D>(i)][tensor_axis<D>(b)], along[b], carried[i]);
    }
    for (int I = 0; I < corner_nodes(D); ++I) {
      Pack on_B = 0.0;
      for (int b = 0; b < D; ++b) on_B = fma(along[b], r.start.b[I][b], on_B);
      for (int i = 0; i < D; ++i)
        f[I][i] = f[I][i] - fma(carried[i], h.gamma[a][I], q[a][i] * (per_volume * on_B));
    }
  }
}

/// Strained beyond `bound`, and whole enough where it is, `now`, to take that for a reference.
template <class Frame>
KRATER_FORCE_INLINE Mask renewable(const ReferenceElement<Frame>& r,
                                   const ElementGeometry<Pack, Frame>& carried,
                                   const ElementGeometry<Pack, Frame>& now, double bound) {
  Pack greatest = 0.0;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b <= a; ++b) {
      Pack C = a == b ? -1.0 : 0.0;
      for (int i = 0; i < 3; ++i) C = fma(r.F[i][a], r.F[i][b], C);
      greatest = max(greatest, abs(C));
    }
  return (greatest > Pack(2 * bound)) & (now.volume > 0.5 * carried.volume);
}

/// Q^ on the reference `now` at x, of volume V, from that on r.
template <class Frame>
KRATER_FORCE_INLINE void carry_stress(const ReferenceElement<Frame>& r,
                                      const ElementGeometry<Pack, Frame>& now, Pack V,
                                      const Pack (&x)[corner_nodes(Frame::dim)][Frame::dim],
                                      Pack (&Q)[hourglass_size(Frame::dim)]) {
  constexpr int D = Frame::dim, modes = hourglass_modes(D);
  HourglassFrame<Pack, D> before, after;
  find_hourglass(r.start, r.X, before);
  find_hourglass(now, x, after);
  const Pack grown = sqrt(V / r.start.volume);
  for (int k = 0; k < D; ++k)
    for (int a = 0; a < modes; ++a)
      Q[modes * k + a] = grown * (after.per_a[k] / before.per_a[k]) * Q[modes * k + a];
}

}  // namespace krater::inline KRATER_ISA
