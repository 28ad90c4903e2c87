// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Third invariant of a deviator s, tension positive:
///   cos 3 theta = (3 sqrt3/2) J3/J2^(3/2) = 27/2 det(s)/q^3,   q = sqrt(3 J2)
/// theta = 0: tensile meridian (direct tension, extension, biaxial compression), 60 degrees:
/// compressive meridian. A deviator with the signs turned turns the sign of J3: the first thing to
/// look for where a model is strong in the wrong test.
///
/// cos theta without an arccosine: sin(3a) = 3 sin a - 4 sin^3 a = w is solved for sin a with
/// a <= 15 degrees by Newton, from w/3 + 4 w^3/81, for theta = 2a nearer to the tensile meridian
/// and for 60 - theta = 2a nearer to the compressive one; so neither double root is met. Three
/// iterations leave round-off. Nearer than 1e-7 to a meridian a state lies on it: J3 knows it no
/// better, and a section with a corner there (psi = 1/2) would turn that into noise of the
/// strength.
///
/// Willam and Warnke's deviatoric section between meridians of the ratio psi (tensile over
/// compressive), 1/2 <= psi <= 1, c = cos theta:
///   r' = { 2(1 - psi^2) c + (2 psi - 1) sqrt[4(1 - psi^2) c^2 + 5 psi^2 - 4 psi] }
///        / { 4(1 - psi^2) c^2 + (1 - 2 psi)^2 },   r'(0) = psi, r'(60) = 1
/// Reference: Willam, Warnke, IABSE Proceedings 19, 1975.
#pragma once

#include "krater/core/tensor.hpp"

namespace krater::inline KRATER_ISA {

/// cos theta of a deviator with q = sqrt(3/2 s:s); 1/2 where q is next to nothing.
template <class Real>
KRATER_FORCE_INLINE Real lode_cosine(const Sym3<Real>& s, Real q) {
  constexpr double nothing = 1e-30, noise = 1e-14;  // noise: of J3 next to a meridian
  const Real scale = Real(1.0) / max(Real(nothing), q);
  const Real raw = 13.5 * det(scale * s), cos3 = clamp(raw, Real(-1.0), Real(1.0));
  const MaskOf<Real> tensile = cos3 > Real(0.0);
  const Real w = sqrt(max(Real(0.0), 0.5 * (Real(1.0) - select(tensile, cos3, -cos3)) - noise));
  Real a = w * fma(Real(4.0 / 81.0), w * w, Real(1.0 / 3.0));
  for (int i = 0; i < 3; ++i) {
    const Real a2 = a * a;
    a = a - (a * fnma(Real(4.0), a2, Real(3.0)) - w) / fnma(Real(12.0), a2, Real(3.0));
  }
  const Real a2 = a * a, cosine = fnma(Real(2.0), a2, Real(1.0)),
             sine = 2.0 * a * sqrt(Real(1.0) - a2);
  constexpr double sin60 = 0.86602540378443865;
  return select(q > Real(nothing), select(tensile, cosine, fma(Real(sin60), sine, 0.5 * cosine)),
                Real(0.5));
}

/// r' of the cosine and of psi.
template <class Real>
KRATER_FORCE_INLINE Real willam_warnke(Real cosine, Real psi) {
  const Real a = Real(1.0) - psi * psi, b = 2.0 * psi - 1.0;
  const Real root = fma(4.0 * a * cosine, cosine, psi * fms(Real(5.0), psi, Real(4.0)));
  const Real above = fma(2.0 * a, cosine, b * sqrt(max(Real(0.0), root)));
  // At psi = 1/2 on the compressive meridian both are 3/4.
  return above / fma(4.0 * a * cosine, cosine, b * b);
}

}  // namespace krater::inline KRATER_ISA
