// SPDX-License-Identifier: GPL-3.0-or-later
/// \file kinematics/mesh/hourglass.hpp
/// What holds the motions that a single point does not see: the modes h of the corners,
///   hexahedron      h_1 = eta zeta, h_2 = xi zeta, h_3 = xi eta, h_4 = xi eta zeta
///   quadrilateral   h = xi eta
/// made orthogonal to every linear field, for N corners
///   gamma_aI = (h_aI - (sum_K h_aK x_K) . B_I)/N,   q_a = sum_I gamma_aI v_I,
/// so that no affine motion and no turn of any size is resisted. Assumed strain (Belytschko and
/// Bindeman 1993, CMAME 105, 225), stored along the element's own directions, with k, l, m cyclic:
///   J_k = dx/dxi_k at the centre, a_k = |J_k|, e_k = J_k/a_k, dq_ka = e_k . q_a dt
///   Q_kk += mu V/3 [(1/a_l^2 + 1/a_m^2) dq_kk + dq_ll/(a_k a_l) + dq_mm/(a_k a_m)]
///   Q_kl += 2 mu V/3 [dq_kl/(a_k^2 (1 - nu)) + nu/(1 - nu) dq_lk/(a_k a_l)],  k != l
///   Q_k4 += 2 mu (1 + nu) V/9 dq_k4/a_k^2
///   quadrilateral   Q_k += 2 mu V/(3 (1 - nu) a_k^2) dq_k
///   f_I = - sum_a (sum_k e_k Q_ka) gamma_aI.
/// Bending of a brick is then exact, at every nu below 1/2. Stiffness as of Flanagan and Belytschko
/// (1981, IJNME 17, 679), with 2 mu and never lambda + 2 mu, in the same place:
///   Q_ka += n kappa mu (sum b:b)/V dq_ka,  n = 8; of a quadrilateral 6, as the cube of its edge.
/// In plastic flow Q <- s (Q + dQ) with
/// the s of the radial return: with elastic stiffness throughout it would create energy. The work
/// - sum f_I . v_I dt is kept beside the internal energy.
#pragma once

#include <initializer_list>

#include "krater/kinematics/mesh/element.hpp"

namespace krater::inline KRATER_ISA {

constexpr int hourglass_modes(int dim) { return dim == 3 ? 4 : 1; }
/// Components of Q: along each axis, of each mode.
constexpr int hourglass_size(int dim) { return dim * hourglass_modes(dim); }

constexpr double hourglass_mode(int dim, int a, int I) {
  const double xi = corner_sign(dim, I, 0), eta = corner_sign(dim, I, 1);
  if (dim == 2) return xi * eta;
  const double zeta = corner_sign(dim, I, 2);
  return a == 0 ? eta * zeta : a == 1 ? xi * zeta : a == 2 ? xi * eta : xi * eta * zeta;
}

template <class Real, int Dim>
struct HourglassFrame {
  static constexpr int nodes = corner_nodes(Dim), modes = hourglass_modes(Dim);
  Real gamma[modes][nodes];
  Real e[Dim][Dim];  ///< e[k]: direction k
  Real per_a[Dim];   ///< 1/a_k [1/m]
};

template <class Frame, class Real>
KRATER_FORCE_INLINE void find_hourglass(const ElementGeometry<Real, Frame>& e,
                                        const Real (&x)[corner_nodes(Frame::dim)][Frame::dim],
                                        HourglassFrame<Real, Frame::dim>& out) {
  constexpr int D = Frame::dim, N = corner_nodes(D);
  const Real per_volume = 1.0 / e.volume;
  for (int a = 0; a < hourglass_modes(D); ++a) {
    Real hx[D];
    for (int i = 0; i < D; ++i) {
      hx[i] = Real(0.0);
      for (int K = 0; K < N; ++K)
        hx[i] = fma(Real(hourglass_mode(D, a, K)), x[K][i] - x[0][i], hx[i]);
      hx[i] = hx[i] * per_volume;
    }
    for (int I = 0; I < N; ++I) {
      Real rest = Real(hourglass_mode(D, a, I));
      for (int i = 0; i < D; ++i) rest = fnma(hx[i], e.b[I][i], rest);
      out.gamma[a][I] = (1.0 / N) * rest;
    }
  }
  for (int k = 0; k < D; ++k) {
    Real squares = Real(0.0);
    for (int i = 0; i < D; ++i) {
      Real J = Real(0.0);
      for (int I = 0; I < N; ++I) J = fma(Real(corner_sign(D, I, k) / N), x[I][i] - x[0][i], J);
      out.e[k][i] = J;
      squares = fma(J, J, squares);
    }
    out.per_a[k] = 1.0 / sqrt(squares);
    for (int i = 0; i < D; ++i) out.e[k][i] = out.e[k][i] * out.per_a[k];
  }
}

/// q_ka = e_k . sum_I gamma_aI v_I.
template <class Real, int Dim>
KRATER_FORCE_INLINE void hourglass_rates(const HourglassFrame<Real, Dim>& h,
                                         const Real (&v)[corner_nodes(Dim)][Dim],
                                         Real (&q)[hourglass_size(Dim)]) {
  constexpr int modes = hourglass_modes(Dim);
  for (int a = 0; a < modes; ++a) {
    Real sum[Dim];
    for (int i = 0; i < Dim; ++i) {
      sum[i] = Real(0.0);
      for (int I = 0; I < corner_nodes(Dim); ++I)
        sum[i] = fma(h.gamma[a][I], v[I][i] - v[0][i], sum[i]);
    }
    for (int k = 0; k < Dim; ++k) {
      Real along = Real(0.0);
      for (int i = 0; i < Dim; ++i) along = fma(h.e[k][i], sum[i], along);
      q[modes * k + a] = along;
    }
  }
}

/// f -= sum_a (sum_k e_k Q_ka) gamma_a.
template <class Real, int Dim>
KRATER_FORCE_INLINE void add_hourglass_force(const HourglassFrame<Real, Dim>& h,
                                             const Real (&Q)[hourglass_size(Dim)],
                                             Real (&f)[corner_nodes(Dim)][Dim]) {
  constexpr int modes = hourglass_modes(Dim);
  for (int a = 0; a < modes; ++a)
    for (int i = 0; i < Dim; ++i) {
      Real along = Real(0.0);
      for (int k = 0; k < Dim; ++k) along = fma(h.e[k][i], Q[modes * k + a], along);
      for (int I = 0; I < corner_nodes(Dim); ++I) f[I][i] = fnma(along, h.gamma[a][I], f[I][i]);
    }
}

/// The increment of Flanagan and Belytschko, `squares` = sum b:b.
template <class Real, int Dim>
KRATER_FORCE_INLINE void add_hourglass_stiffness(const Real (&dq)[hourglass_size(Dim)], Real mu,
                                                 double kappa, Real squares, Real volume,
                                                 Real (&Q)[hourglass_size(Dim)]) {
  constexpr int n = Dim == 3 ? 8 : 6;
  const Real modulus = n * kappa * mu * squares / volume;
  for (int k = 0; k < hourglass_size(Dim); ++k) Q[k] = fma(modulus, dq[k], Q[k]);
}

/// Sum b:b over the corners.
template <class Real, class Frame>
KRATER_FORCE_INLINE Real squares_of(const ElementGeometry<Real, Frame>& e) {
  Real sum = Real(0.0);
  for (int I = 0; I < corner_nodes(Frame::dim); ++I)
    for (int i = 0; i < Frame::dim; ++i) sum = fma(e.b[I][i], e.b[I][i], sum);
  return sum;
}

/// Elastic increment of Q for the increments dq.
template <class Real, int Dim>
KRATER_FORCE_INLINE void add_hourglass_stress(const HourglassFrame<Real, Dim>& h,
                                              const Real (&dq)[hourglass_size(Dim)], Real mu,
                                              Real nu, Real volume,
                                              Real (&Q)[hourglass_size(Dim)]) {
  const Real bending = 1.0 / (Real(1.0) - nu);
  if constexpr (Dim == 2) {
    for (int k = 0; k < 2; ++k)
      Q[k] = fma((2.0 / 3.0) * mu * volume * bending * (h.per_a[k] * h.per_a[k]), dq[k], Q[k]);
  } else {
    const auto at = [](int k, int a) { return 4 * k + a; };
    const auto dq_of = [&](int k, int a) { return dq[at(k, a)]; };
    const Real third = (1.0 / 3.0) * mu * volume;
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3, m = (k + 2) % 3;
      const Real *s = h.per_a, both = fma(s[l], s[l], s[m] * s[m]);
      const Real others = s[k] * fma(s[l], dq_of(l, l), s[m] * dq_of(m, m));
      Q[at(k, k)] = fma(third, fma(both, dq_of(k, k), others), Q[at(k, k)]);
      for (const int other : {l, m}) {
        const Real own = bending * (s[k] * s[k]), shared = nu * bending * (s[k] * s[other]);
        Q[at(k, other)] =
            fma(2.0 * third, fma(own, dq_of(k, other), shared * dq_of(other, k)), Q[at(k, other)]);
      }
      Q[at(k, 3)] =
          fma((2.0 / 3.0) * third * (Real(1.0) + nu) * (s[k] * s[k]), dq_of(k, 3), Q[at(k, 3)]);
    }
  }
}

}  // namespace krater::inline KRATER_ISA
