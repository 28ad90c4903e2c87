// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How pores close: a crush curve alpha(p), and the distension at the end of a step on it,
///   alpha(p) = 1 + (alpha_0 - 1) ((p_c - p)/(p_c - p_e))^n,         p_e <= p <= p_c
///   p(rho, e, alpha) = p_s(alpha rho, e)/alpha,                     p_s of the solid
/// (Herrmann, J. Appl. Phys. 40 (1969) 2490; Carroll and Holt, J. Appl. Phys. 43 (1972) 759). Below
/// the curve of its alpha a material loads and unloads at constant alpha; pores do not open again.
/// On the curve p is the root of p_s(alpha(p) rho, e)/alpha(p) - p, which falls with p: Newton
/// inside a bracket. The solid has split and bulk_modulus as an equation of state (eos/split.hpp).
#pragma once

#include <algorithm>

#include "krater/core/lane_math.hpp"
#include "krater/materials/eos/split.hpp"

namespace krater::inline KRATER_ISA {

struct CrushLaw {
  double elastic_pressure, compaction_pressure, exponent, alpha0;

  /// alpha on the crush curve, and its slope.
  template <class Real>
  struct Crush {
    Real alpha, slope;
  };
  template <class Real>
  KRATER_FORCE_INLINE Crush<Real> crush(Real p) const {
    const double per_range = 1.0 / (compaction_pressure - elastic_pressure);
    const Real left = clamp((compaction_pressure - p) * per_range, Real(1e-30), Real(1.0));
    const Real power = (alpha0 - 1.0) * exp(exponent * log(left));
    return {power + 1.0, power / left * (-exponent * per_range)};
  }
  /// Where the curve has this alpha.
  template <class Real>
  KRATER_FORCE_INLINE Real crush_pressure(Real alpha) const {
    const Real share =
        clamp((alpha - 1.0) * (1.0 / std::max(alpha0 - 1.0, 1e-30)), Real(1e-30), Real(1.0));
    return fnma(Real(compaction_pressure - elastic_pressure), exp(1.0 / exponent * log(share)),
                Real(compaction_pressure));
  }
};

/// alpha of the end of a step that began with `alpha`, of the density and energy there.
template <class Solid, class Real>
KRATER_FORCE_INLINE Real closed_pores(const CrushLaw& law, const Solid& solid, Real alpha, Real rho,
                                      Real v, Real e) {
  const auto pressure = [&](Real at) {
    const PressureSplit<Real> s = solid.split(at * rho, v / at);
    return fma(s.thermal, e, s.cold) / at;
  };
  constexpr int cap = 60;
  Real low = law.crush_pressure(alpha), high = Real(law.compaction_pressure);
  const MaskOf<Real> crushing = pressure(alpha) > low;
  if (!any(crushing)) return alpha;
  const MaskOf<Real> compact = crushing & (pressure(Real(1.0)) >= high);
  MaskOf<Real> active = crushing & !compact;
  Real p = 0.5 * (low + high);
  const Real enough = Real(1e-13 * law.compaction_pressure);
  for (int i = 0; i < cap && any(active); ++i) {
    const CrushLaw::Crush<Real> at = law.crush(p);
    const Real rho_s = at.alpha * rho, v_s = v / at.alpha;
    const PressureSplit<Real> s = solid.split(rho_s, v_s);
    const Real p_s = fma(s.thermal, e, s.cold), per = Real(1.0) / at.alpha;
    const Real rest = fms(p_s, per, p);
    low = select(rest > Real(0.0), p, low);
    high = select(rest > Real(0.0), high, p);
    const Real by_rho = fnma(p_s * v_s, s.thermal, solid.bulk_modulus(rho_s, v_s, p_s, e));
    const Real slope = fma((by_rho - p_s) * (per * per), at.slope, Real(-1.0));
    const Real newton = p - rest / slope;
    const MaskOf<Real> inside = (newton > low) & (newton < high);
    const Real next = select(inside, newton, 0.5 * (low + high));
    const MaskOf<Real> near = abs(next - p) <= enough;
    p = select(active, next, p);  // each lane by itself: no bits of its neighbours
    active = active & !near & (high - low > enough);
  }
  const Real on_curve = min(alpha, law.crush(p).alpha);
  return select(compact, Real(1.0), select(crushing, on_curve, alpha));
}

}  // namespace krater::inline KRATER_ISA
