// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Return with damage inside the yield condition: theory 4, `coupling: rate`, CCF (26)-(32) and
/// (42)-(46) to the letter (Decision 8). Divided by 1 - phi_n, with
///   r(d) = (1 - phi(d))/(1 - phi_n):
///   q~_tr <= sigma_Y(eps_n, 0): d = 0;   else  q~_tr - 3G d - r(d) sigma_Y(eps_n + d, d/dt) = 0,
///   phi(d) = min(phi_c, phi_n + k <eps_n + d - max(eps_n, eps_D)>);
///   s_{n+1} = s_tr [1 - 3G (1 - phi_n) d/q_tr] = (1 - phi_{n+1}) s~_tr sigma_Y/q~_tr.
/// The left side is positive at d = 0 and not positive at q~_tr/3G. Its slope is
///   -3G + k sigma_Y/(1 - phi_n) - r sigma_Y';
/// where k sigma_Y > 3G (1 - phi_n) at the root, softening has snapped back and the point must
/// fail. Where it is not, sigma_Y being monotone, the root is the only one to its left: the
/// smallest. Damage that needs no plastic strain (Growth::source) is added after the return.
#pragma once

#include "krater/materials/returns/radial_return.hpp"

namespace krater::inline KRATER_ISA {

/// How damage grows in one step: with plastic strain, and by what needs none.
template <class Real>
struct Growth {
  Real k;             ///< d phi/d eps
  Real eps_D;         ///< no growth with plastic strain below
  Real phi_c;         ///< failure
  Real source = 0.0;  ///< growth of phi in the step that does not ask for plastic strain
};

/// phi after plastic strain d, eps the plastic strain then: the part that the return sees.
template <class Real>
KRATER_FORCE_INLINE Real damage_by_flow(const Growth<Real>& growth, Real phi, Real eps, Real d) {
  // <eps - max(eps - d, eps_D)> without the cancellation; the order of operands lets a NaN through.
  const Real strain = max(Real(0.0), min(d, eps - growth.eps_D));
  return min(growth.phi_c, fma(growth.k, strain, phi));
}

/// phi of the end of the step.
template <class Real>
KRATER_FORCE_INLINE Real damage_after(const Growth<Real>& growth, Real phi, Real eps, Real d) {
  return min(growth.phi_c, damage_by_flow(growth, phi, eps, d) + growth.source);
}

template <class Real>
struct RateStep {
  PlasticStep<Real> step;
  MaskOf<Real> snapped;
};

template <class Real, class Curve, class Modulus>
KRATER_FORCE_INLINE RateStep<Real> rate_return(const Curve& curve, Real q_trial, Real eps,
                                               Modulus G, Real phi, const Growth<Real>& growth,
                                               Real strain, double dt) {
  constexpr int cap = 200;
  constexpr double tolerance = 1e-11, round_off = 1e-15;
  const Real three_G = Real(3.0 * G), per_dt = Real(1.0 / dt);
  const Real per_intact = Real(1.0) / (Real(1.0) - phi);
  const Real static_yield = curve.hardening(eps).stress;
  const MaskOf<Real> yielding = !(q_trial <= static_yield);  // a NaN yields, and does not converge
  MaskOf<Real> active = yielding;
  Real d = Real(0.0), stress = static_yield, low = Real(0.0), high = q_trial / three_G;
  const MaskOf<Real> usable = (strain > Real(0.0)) & (strain < high);
  Real x = select(active, select(usable, strain, high), Real(1.0));
  for (int i = 0; i < cap && any(active); ++i) {
    const Flow<Real> flow = flow_at(curve, eps + x, x * per_dt);
    const Real phi_x = damage_by_flow(growth, phi, eps + x, x);
    const Real ratio = (Real(1.0) - phi_x) * per_intact;
    const Real carried = ratio * flow.stress;
    const Real rest = fnma(three_G, x, q_trial) - carried;
    const MaskOf<Real> exact = abs(rest) <= max(tolerance * carried, round_off * q_trial);
    const MaskOf<Real> left = rest > Real(0.0);
    low = select(left, x, low);
    high = select(left, high, x);
    const MaskOf<Real> grows = (eps + x > growth.eps_D) & (phi_x < growth.phi_c);
    const Real softening = select(grows, growth.k * per_intact * flow.stress, Real(0.0));
    const Real slope = fma(ratio, fma(flow.d_rate, per_dt, flow.d_eps), three_G) - softening;
    const Real newton = x + rest / slope;
    const MaskOf<Real> inside = (newton > low) & (newton < high) & (slope > Real(0.0));
    d = select(active & exact, x, d);
    stress = select(active & exact, flow.stress, stress);
    active = active & !exact;
    x = select(active, select(inside, newton, 0.5 * (low + high)), x);
  }
  const MaskOf<Real> snapped =
      yielding & (eps + d > growth.eps_D) & (growth.k * stress > three_G * (Real(1.0) - phi));
  return {{d, stress, yielding, active}, snapped};
}

}  // namespace krater::inline KRATER_ISA
