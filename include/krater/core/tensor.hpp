// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Tensors of three dimensions over `Real` (double, or a Pack of 8 points). A law knows no grid
/// dimension: plane strain and axisymmetry are 3x3 tensors with zeros (points/fields.hpp says which
/// axis is which).
///
/// Order of a symmetric tensor, here and in every file: xx yy zz yz xz xy, true components
/// (engineering shear is never stored). Stress is positive in tension, pressure in compression.
/// Matrices are row-major. Sums are fused exactly where fma is written, so that double and Pack
/// give the same bits.
#pragma once

#include "krater/core/simd.hpp"

namespace krater::inline KRATER_ISA {

template <class Real>
struct Sym3 {
  Real xx, yy, zz, yz, xz, xy;
};

template <class Real>
struct Mat3 {
  Real xx, xy, xz, yx, yy, yz, zx, zy, zz;
};

template <class Real>
KRATER_FORCE_INLINE Sym3<Real> zero_sym3() {
  return {Real(0.0), Real(0.0), Real(0.0), Real(0.0), Real(0.0), Real(0.0)};
}
template <class Real>
KRATER_FORCE_INLINE Mat3<Real> identity3() {
  return {Real(1.0), Real(0.0), Real(0.0), Real(0.0), Real(1.0),
          Real(0.0), Real(0.0), Real(0.0), Real(1.0)};
}

template <class Real>
KRATER_FORCE_INLINE Sym3<Real> operator+(const Sym3<Real>& a, const Sym3<Real>& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.yz + b.yz, a.xz + b.xz, a.xy + b.xy};
}
template <class Real>
KRATER_FORCE_INLINE Sym3<Real> operator*(Real k, const Sym3<Real>& a) {
  return {k * a.xx, k * a.yy, k * a.zz, k * a.yz, k * a.xz, k * a.xy};
}
template <class Real>
KRATER_FORCE_INLINE Mat3<Real> operator*(Real k, const Mat3<Real>& a) {
  return {k * a.xx, k * a.xy, k * a.xz, k * a.yx, k * a.yy, k * a.yz, k * a.zx, k * a.zy, k * a.zz};
}

/// a x + y.
template <class Real>
KRATER_FORCE_INLINE Sym3<Real> fma(Real a, const Sym3<Real>& x, const Sym3<Real>& y) {
  return {fma(a, x.xx, y.xx), fma(a, x.yy, y.yy), fma(a, x.zz, y.zz),
          fma(a, x.yz, y.yz), fma(a, x.xz, y.xz), fma(a, x.xy, y.xy)};
}

template <class Real>
KRATER_FORCE_INLINE Real trace(const Sym3<Real>& a) {
  return a.xx + a.yy + a.zz;
}
template <class Real>
KRATER_FORCE_INLINE Real trace(const Mat3<Real>& a) {
  return a.xx + a.yy + a.zz;
}

/// Deviator. Written in differences: a multiple of the identity gives exactly zero, so a body that
/// is only compressed, or at rest, stays exactly free of shear stress.
template <class Real>
KRATER_FORCE_INLINE Sym3<Real> dev(const Sym3<Real>& a) {
  constexpr double third = 1.0 / 3.0;
  const Real xy = a.xx - a.yy;
  const Real yz = a.yy - a.zz;
  const Real zx = a.zz - a.xx;
  return {(xy - zx) * third, (yz - xy) * third, (zx - yz) * third, a.yz, a.xz, a.xy};
}

template <class Real>
KRATER_FORCE_INLINE Sym3<Real> sym(const Mat3<Real>& a) {
  return {a.xx, a.yy, a.zz, (a.yz + a.zy) * 0.5, (a.xz + a.zx) * 0.5, (a.xy + a.yx) * 0.5};
}

/// a + a^T.
template <class Real>
KRATER_FORCE_INLINE Sym3<Real> twice_sym(const Mat3<Real>& a) {
  return {a.xx + a.xx, a.yy + a.yy, a.zz + a.zz, a.yz + a.zy, a.xz + a.zx, a.xy + a.yx};
}

template <class Real>
KRATER_FORCE_INLINE Mat3<Real> transpose(const Mat3<Real>& a) {
  return {a.xx, a.yx, a.zx, a.xy, a.yy, a.zy, a.xz, a.yz, a.zz};
}

/// a : b, off-diagonal terms counted twice.
template <class Real>
KRATER_FORCE_INLINE Real contract(const Sym3<Real>& a, const Sym3<Real>& b) {
  const Real shear = fma(a.xy, b.xy, fma(a.xz, b.xz, a.yz * b.yz));
  return fma(Real(2.0), shear, fma(a.zz, b.zz, fma(a.yy, b.yy, a.xx * b.xx)));
}

template <class Real>
KRATER_FORCE_INLINE Real det(const Mat3<Real>& a) {
  const Real c0 = fms(a.yy, a.zz, a.yz * a.zy);
  const Real c1 = fms(a.yz, a.zx, a.yx * a.zz);
  const Real c2 = fms(a.yx, a.zy, a.yy * a.zx);
  return fma(a.xx, c0, fma(a.xy, c1, a.xz * c2));
}
template <class Real>
KRATER_FORCE_INLINE Real det(const Sym3<Real>& a) {
  const Real c0 = fms(a.yy, a.zz, a.yz * a.yz);
  const Real c1 = fms(a.yz, a.xz, a.xy * a.zz);
  const Real c2 = fms(a.xy, a.yz, a.yy * a.xz);
  return fma(a.xx, c0, fma(a.xy, c1, a.xz * c2));
}

/// det(I + a) - 1, accurate for small a: the sum of the three invariants.
template <class Real>
KRATER_FORCE_INLINE Real det_minus_one(const Mat3<Real>& a) {
  const Real m0 = fms(a.yy, a.zz, a.yz * a.zy);
  const Real m1 = fms(a.xx, a.zz, a.xz * a.zx);
  const Real m2 = fms(a.xx, a.yy, a.xy * a.yx);
  return trace(a) + ((m0 + m1) + m2) + det(a);
}

template <class Real>
KRATER_FORCE_INLINE Mat3<Real> inverse(const Mat3<Real>& a) {
  const Real c0 = fms(a.yy, a.zz, a.yz * a.zy);
  const Real c1 = fms(a.yz, a.zx, a.yx * a.zz);
  const Real c2 = fms(a.yx, a.zy, a.yy * a.zx);
  const Real r = Real(1.0) / fma(a.xx, c0, fma(a.xy, c1, a.xz * c2));
  return {c0 * r, fms(a.xz, a.zy, a.xy * a.zz) * r, fms(a.xy, a.yz, a.xz * a.yy) * r,
          c1 * r, fms(a.xx, a.zz, a.xz * a.zx) * r, fms(a.xz, a.yx, a.xx * a.yz) * r,
          c2 * r, fms(a.xy, a.zx, a.xx * a.zy) * r, fms(a.xx, a.yy, a.xy * a.yx) * r};
}

namespace tensor_detail {
template <class Real>
KRATER_FORCE_INLINE Real dot3(Real a0, Real b0, Real a1, Real b1, Real a2, Real b2) {
  return fma(a2, b2, fma(a1, b1, a0 * b0));
}
}  // namespace tensor_detail

template <class Real>
KRATER_FORCE_INLINE Mat3<Real> operator*(const Mat3<Real>& a, const Mat3<Real>& b) {
  using tensor_detail::dot3;
  return {dot3(a.xx, b.xx, a.xy, b.yx, a.xz, b.zx), dot3(a.xx, b.xy, a.xy, b.yy, a.xz, b.zy),
          dot3(a.xx, b.xz, a.xy, b.yz, a.xz, b.zz), dot3(a.yx, b.xx, a.yy, b.yx, a.yz, b.zx),
          dot3(a.yx, b.xy, a.yy, b.yy, a.yz, b.zy), dot3(a.yx, b.xz, a.yy, b.yz, a.yz, b.zz),
          dot3(a.zx, b.xx, a.zy, b.yx, a.zz, b.zx), dot3(a.zx, b.xy, a.zy, b.yy, a.zz, b.zy),
          dot3(a.zx, b.xz, a.zy, b.yz, a.zz, b.zz)};
}
template <class Real>
KRATER_FORCE_INLINE Mat3<Real> operator*(const Mat3<Real>& a, const Sym3<Real>& b) {
  using tensor_detail::dot3;
  return {dot3(a.xx, b.xx, a.xy, b.xy, a.xz, b.xz), dot3(a.xx, b.xy, a.xy, b.yy, a.xz, b.yz),
          dot3(a.xx, b.xz, a.xy, b.yz, a.xz, b.zz), dot3(a.yx, b.xx, a.yy, b.xy, a.yz, b.xz),
          dot3(a.yx, b.xy, a.yy, b.yy, a.yz, b.yz), dot3(a.yx, b.xz, a.yy, b.yz, a.yz, b.zz),
          dot3(a.zx, b.xx, a.zy, b.xy, a.zz, b.xz), dot3(a.zx, b.xy, a.zy, b.yy, a.zz, b.yz),
          dot3(a.zx, b.xz, a.zy, b.yz, a.zz, b.zz)};
}

/// sym(a b^T), exact when a b^T is symmetric: only the upper triangle is formed.
template <class Real>
KRATER_FORCE_INLINE Sym3<Real> product_transposed(const Mat3<Real>& a, const Mat3<Real>& b) {
  using tensor_detail::dot3;
  return {dot3(a.xx, b.xx, a.xy, b.xy, a.xz, b.xz), dot3(a.yx, b.yx, a.yy, b.yy, a.yz, b.yz),
          dot3(a.zx, b.zx, a.zy, b.zy, a.zz, b.zz), dot3(a.yx, b.zx, a.yy, b.zy, a.yz, b.zz),
          dot3(a.xx, b.zx, a.xy, b.zy, a.xz, b.zz), dot3(a.xx, b.yx, a.xy, b.yy, a.xz, b.yz)};
}

/// f b f^T.
template <class Real>
KRATER_FORCE_INLINE Sym3<Real> push_forward(const Mat3<Real>& f, const Sym3<Real>& b) {
  return product_transposed(f * b, f);
}

/// f b f^T - b for f = I + a, without the cancellation: a b + (a b)^T + a b a^T.
template <class Real>
KRATER_FORCE_INLINE Sym3<Real> push_forward_change(const Mat3<Real>& a, const Sym3<Real>& b) {
  const Mat3<Real> ab = a * b;
  return twice_sym(ab) + product_transposed(ab, a);
}

}  // namespace krater::inline KRATER_ISA
