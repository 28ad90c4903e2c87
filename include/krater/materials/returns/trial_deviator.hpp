// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Objective trial deviator, `rate: truesdell`: theory 3, Decision 1, CCF (7).
///
/// For isochoric motion the Truesdell rate with C = 2G I integrates exactly to s = G dev(b_e). Only
/// s is stored; the trace of b_e is recovered from det b_e = 1: with X = s_n/G, b = X + a I,
///   a^3 - (X:X/2) a + det X - 1 = 0 (largest root),   s_tr = G dev(j^(-2/3) f b f^T).
/// Objective for any f = R U, independent of the number of steps in elastic loading, no elastic
/// hysteresis at constant G. Evaluated as s_tr = j^(-2/3) (s_n + G dev(f b f^T - b)), so a body at
/// rest keeps its stress bit for bit.
#pragma once

#include "krater/core/lane_math.hpp"
#include "krater/core/tensor.hpp"

namespace krater::inline KRATER_ISA {

/// a of b = X + a I with det b = 1, X traceless.
///
/// Newton in delta = a - 1 (no cancellation at small strain) with c = X:X/2 and d = det X, from
/// delta = (c - d)/3, whose residual is of the order of c^(5/2): one step in metals. It lies to the
/// right of the local minimum of the cubic, -1 + sqrt(c/3), up to c = 1: |d| <= 2 (c/3)^(3/2), and
/// 1 - u + u^2 - 2 u^3/3 > 0 with u = sqrt(c/3) < 1.2. Beyond, c/3 does, for every X, because
/// (1 + c/3)^2 > c/3. So the first step lands on or above the largest root and the rest descend to
/// it: convergence is certain. An error in `a` enters the stress only through dev(f f^T), i.e.
/// times the strain of the step; 1e-7 before the last quadratic step is round-off after it.
template <class Real>
KRATER_FORCE_INLINE Real isotropic_part(const Sym3<Real>& X) {
  constexpr int cap = 60;  // 1 or 2 in metals; large X costs log(X)/log(3/2) more
  const Real c = contract(X, X) * 0.5;
  const Real d = det(X);
  Real delta = select(c < Real(1.0), c - d, c) * (1.0 / 3.0);
  MaskOf<Real> active = c > Real(0.0);
  for (int i = 0; i < cap && any(active); ++i) {
    const Real value = fma(fma(delta + 3.0, delta, 3.0 - c), delta, d - c);
    const Real slope = fma(fma(Real(3.0), delta, Real(6.0)), delta, 3.0 - c);
    const Real step = value / slope;
    delta = select(active, delta - step, delta);
    active = active & (abs(step) > 1e-7 * (1.0 + delta));
  }
  return delta + 1.0;
}

/// `G`: a double or a Real, the same for s_n and s_tr (strength/steinberg_guinan.hpp says why).
template <class Real, class Modulus>
KRATER_FORCE_INLINE Sym3<Real> trial_deviator(const Sym3<Real>& s, const Mat3<Real>& dtL,
                                              Modulus G) {
  const Sym3<Real> X = Real(1.0 / G) * s;
  const Real a = isotropic_part(X);
  const Sym3<Real> b = {X.xx + a, X.yy + a, X.zz + a, X.yz, X.xz, X.xy};
  const Real r = rcbrt(det_minus_one(dtL) + 1.0);
  return (r * r) * fma(Real(G), dev(push_forward_change(dtL, b)), s);
}

}  // namespace krater::inline KRATER_ISA
