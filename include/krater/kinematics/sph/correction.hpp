// SPDX-License-Identifier: GPL-3.0-or-later
/// \file kinematics/sph/correction.hpp
/// What makes the gradient of particles exact for linear fields (Randles and Libersky 1996; the
/// adjoint pair: Bonet and Lok 1999):
///   M_i = sum_j V_j grad W_ij (x) (x_j - x_i),   K_i = M_i^-1,
///   L_i = [sum_j V_j (v_j - v_i) (x) grad W_ij] K_i,
///   f_i = sum_j V_i V_j (sigma_i K_i + sigma_j K_j) grad W_ij.
/// M is symmetric, so both momenta are exact with K; with K = 1 the angular one is not. Where
/// neighbours lie in a plane or a line M has no inverse: from a condition |M| |M^-1| of 100 to 1000
/// (Frobenius) the correction goes over, continuously, to
///   K = (M + w tr(M)/d 1)^-1,   w from 0 to 1.
#pragma once

#include "krater/core/simd.hpp"

namespace krater::inline KRATER_ISA {

inline constexpr double kSoundCondition = 100, kFlatCondition = 1000;

/// A symmetric matrix over grid axes: xx yy xy, or xx yy zz yz xz xy.
template <class Real, int Dim>
struct SymAxes {
  static constexpr int size = Dim == 3 ? 6 : 3;
  Real c[size];
  /// Which component (a, b) is.
  static constexpr int place(int a, int b) {
    if (a == b) return a;
    return Dim == 3 ? 6 - a - b : 2;
  }
  KRATER_FORCE_INLINE Real at(int a, int b) const { return c[place(a, b)]; }
};

/// det(m) and the adjugate.
template <class Real>
KRATER_FORCE_INLINE Real adjugate(const SymAxes<Real, 2>& m, SymAxes<Real, 2>& out) {
  out.c[0] = m.c[1];
  out.c[1] = m.c[0];
  out.c[2] = -m.c[2];
  return fms(m.c[0], m.c[1], m.c[2] * m.c[2]);
}
template <class Real>
KRATER_FORCE_INLINE Real adjugate(const SymAxes<Real, 3>& m, SymAxes<Real, 3>& out) {
  const Real xx = m.c[0], yy = m.c[1], zz = m.c[2], yz = m.c[3], xz = m.c[4], xy = m.c[5];
  out.c[0] = fms(yy, zz, yz * yz);
  out.c[1] = fms(xx, zz, xz * xz);
  out.c[2] = fms(xx, yy, xy * xy);
  out.c[3] = fms(xy, xz, xx * yz);
  out.c[4] = fms(xy, yz, yy * xz);
  out.c[5] = fms(xz, yz, zz * xy);
  return fma(xx, out.c[0], fma(xy, out.c[5], xz * out.c[4]));
}

template <class Real, int Dim>
KRATER_FORCE_INLINE Real squared_norm(const SymAxes<Real, Dim>& m) {
  Real sum = 0.0;
  for (int a = 0; a < Dim; ++a)
    for (int b = 0; b < Dim; ++b) sum = fma(m.at(a, b), m.at(a, b), sum);
  return sum;
}

/// K of M; `flat`: where w > 0. Where M is zero (no neighbour at all) K is zero too.
template <class Real, int Dim>
KRATER_FORCE_INLINE SymAxes<Real, Dim> corrected(const SymAxes<Real, Dim>& M, MaskOf<Real>& flat) {
  SymAxes<Real, Dim> inverse, out;
  Real trace = M.c[0] + M.c[1];
  if constexpr (Dim == 3) trace = trace + M.c[2];
  const Real det = adjugate(M, inverse);
  // |M| |adj M| > 100 det, without the division that a singular M does not stand.
  const Real norms = sqrt(squared_norm(M) * squared_norm(inverse)), least = Real(1e-200);
  const Real condition = norms / max(det, least);
  Real w = (condition - kSoundCondition) * (1 / (kFlatCondition - kSoundCondition));
  w = max(Real(0.0), min(Real(1.0), w));
  SymAxes<Real, Dim> regular = M;
  for (int a = 0; a < Dim; ++a) regular.c[a] = fma(w * (1.0 / Dim), trace, M.c[a]);
  const Real regular_det = adjugate(regular, inverse);
  const MaskOf<Real> alone = !(trace > Real(1e-12));
  flat = alone | (w > Real(0.0));
  const Real per_det = select(alone, Real(0.0), 1.0 / select(alone, Real(1.0), regular_det));
  for (int k = 0; k < SymAxes<Real, Dim>::size; ++k) out.c[k] = per_det * inverse.c[k];
  return out;
}

}  // namespace krater::inline KRATER_ISA
