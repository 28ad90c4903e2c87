// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Elastic trial deviators of the objective rates (theory 3, Decision 1),
/// H = (f - I)[(f + I)/2]^-1:
///   truesdell            G dev(f_bar b_e f_bar^T), f_bar = j^(-1/3) f: returns/trial_deviator.hpp
///   truesdell_projected  dev[(1/j) f s f^T] + 2G dev(sym H): CCF (7), the trace dropped
///   jaumann              Q s Q^T + 2G dev(sym H),  Q = (I - W/2)^-1 (I + W/2),  W = skew H
///   green_naghdi         dR s dR^T + 2G R_h dev(sym H) R_h^T,  dR = R_{n+1} R_n^T,  R_h half of dR
/// Projected and jaumann are first order in the step, green_naghdi second (for its R_h); they stand
/// here to measure what the paper calls the inconsistency of rates. s is traceless, so
/// push-forwards are written as s + dev(change): a body at rest keeps its stress bit for bit.
#pragma once

#include "krater/core/lane_math.hpp"
#include "krater/core/tensor.hpp"
#include "krater/materials/returns/trial_deviator.hpp"

namespace krater::inline KRATER_ISA {

/// Map and strain of the step; F at its end where the rate asks for it.
template <class Real>
struct StepMotion {
  Mat3<Real> dtL;
  Sym3<Real> dE;  ///< sym H
  Mat3<Real> F;
};

template <class Real>
KRATER_FORCE_INLINE Mat3<Real> plus_identity(Mat3<Real> a) {
  a.xx = a.xx + 1.0;
  a.yy = a.yy + 1.0;
  a.zz = a.zz + 1.0;
  return a;
}
template <class Real>
KRATER_FORCE_INLINE Mat3<Real> minus_identity(Mat3<Real> a) {
  a.xx = a.xx - 1.0;
  a.yy = a.yy - 1.0;
  a.zz = a.zz - 1.0;
  return a;
}

/// Rotation of the polar decomposition A = R U, det A > 0: X <- (X + X^-T)/2, quadratic once
/// near; the first steps halve the logarithm of the stretch. Reference: Higham 1986.
template <class Real>
KRATER_FORCE_INLINE Mat3<Real> polar_rotation(const Mat3<Real>& A) {
  constexpr int cap = 60;
  Mat3<Real> X = A;
  MaskOf<Real> active = Real(0.0) == Real(0.0);
  for (int i = 0; i < cap && any(active); ++i) {
    const Mat3<Real> Y = transpose(inverse(X));
    const auto change = [&](Real x, Real y) { return 0.5 * (y - x); };
    const Mat3<Real> d = {change(X.xx, Y.xx), change(X.xy, Y.xy), change(X.xz, Y.xz),
                          change(X.yx, Y.yx), change(X.yy, Y.yy), change(X.yz, Y.yz),
                          change(X.zx, Y.zx), change(X.zy, Y.zy), change(X.zz, Y.zz)};
    const auto step = [&](Real x, Real dx) { return select(active, x + dx, x); };
    X = {step(X.xx, d.xx), step(X.xy, d.xy), step(X.xz, d.xz), step(X.yx, d.yx), step(X.yy, d.yy),
         step(X.yz, d.yz), step(X.zx, d.zx), step(X.zy, d.zy), step(X.zz, d.zz)};
    const Real size =
        max(max(max(abs(d.xx), abs(d.xy)), max(abs(d.xz), abs(d.yx))),
            max(max(abs(d.yy), abs(d.yz)), max(abs(d.zx), max(abs(d.zy), abs(d.zz)))));
    active = active & (size > Real(1e-8));  // the next error is its square
  }
  return X;
}

struct TruesdellRate {
  static constexpr bool needs_F = false;
  template <class Real, class Modulus>
  KRATER_FORCE_INLINE static Sym3<Real> trial(const Sym3<Real>& s, const StepMotion<Real>& m,
                                              Modulus G) {
    return trial_deviator(s, m.dtL, G);
  }
};

struct TruesdellProjectedRate {
  static constexpr bool needs_F = false;
  template <class Real, class Modulus>
  KRATER_FORCE_INLINE static Sym3<Real> trial(const Sym3<Real>& s, const StepMotion<Real>& m,
                                              Modulus G) {
    const Real per_j = Real(1.0) / (det_minus_one(m.dtL) + 1.0);
    return fma(Real(2.0 * G), dev(m.dE), per_j * (s + dev(push_forward_change(m.dtL, s))));
  }
};

struct JaumannRate {
  static constexpr bool needs_F = false;
  template <class Real, class Modulus>
  KRATER_FORCE_INLINE static Sym3<Real> trial(const Sym3<Real>& s, const StepMotion<Real>& m,
                                              Modulus G) {
    const Mat3<Real> H = m.dtL * inverse(plus_identity(Real(0.5) * m.dtL));
    const Real x = 0.5 * (H.zy - H.yz), y = 0.5 * (H.xz - H.zx), z = 0.5 * (H.yx - H.xy);
    const Real o = Real(0.0);
    const Mat3<Real> W = {o, -z, y, z, o, -x, -y, x, o};
    const Mat3<Real> turn = inverse(plus_identity(Real(-0.5) * W)) * W;  // Q - I
    return fma(Real(2.0 * G), dev(m.dE), s + dev(push_forward_change(turn, s)));
  }
};

struct GreenNaghdiRate {
  static constexpr bool needs_F = true;
  template <class Real, class Modulus>
  KRATER_FORCE_INLINE static Sym3<Real> trial(const Sym3<Real>& s, const StepMotion<Real>& m,
                                              Modulus G) {
    const Mat3<Real> before = polar_rotation(inverse(plus_identity(m.dtL)) * m.F);
    const Mat3<Real> turn = polar_rotation(m.F) * transpose(before);
    // R + I = R_h (R_h + R_h^T), and the bracket is symmetric and positive below half a turn.
    const Mat3<Real> half = polar_rotation(plus_identity(turn));
    return fma(Real(2.0 * G), dev(push_forward(half, dev(m.dE))),
               s + dev(push_forward_change(minus_identity(turn), s)));
  }
};

}  // namespace krater::inline KRATER_ISA
