// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Radial return: theory 4, `coupling: effective` (CCF (7), (14), (16), Decision 8). On *effective*
/// stresses, so damage needs no change here: the carried stress is (1 - phi) times the result.
///   q_tr <= sigma_Y(eps_n, 0, T_n): d = 0;  else  q_tr - 3G d - sigma_Y(eps_n + d, d/dt, T_n) = 0;
///   s_{n+1} = s_tr (1 - 3G d/q_tr).
///
/// The left side falls monotonically and is convex for the usual laws. From the left of the root a
/// Newton step in d does not overshoot. Far to its right a Newton step in log d does not, stays
/// positive although sigma_Y' may be infinite at eps = 0, and is exact where the rate term rules;
/// e^-t is replaced by 1/(1 + t + t^2/2 + t^3/6) >= e^-t. What leaves the bracket is bisected.
///
/// A point is done when the residual is below 1e-11 of yield, or when the error term of the Newton
/// step just made, |sigma_Y''| step^2/2, is (four times over) below 2e-11 of it; hence the law
/// gives its curvature and says whether it is smooth between two rates. Then sigma_Y = q_tr - 3G d
/// by the equation itself. In developed flow that takes one evaluation after the first guess.
#pragma once

#include "krater/core/tensor.hpp"
#include "krater/materials/returns/flow.hpp"

namespace krater::inline KRATER_ISA {

template <class Real>
struct PlasticStep {
  Real d;       ///< increment of plastic strain
  Real stress;  ///< sigma_Y at the end of the step: q_{n+1} where yielding
  MaskOf<Real> yielding;
  MaskOf<Real> unconverged;
};

/// The next iterate from x > 0 with residual `rest` and slope -`slope` there (see the top of the
/// file).
template <class Real>
KRATER_FORCE_INLINE Real newton_step(Real x, Real rest, Real slope) {
  const Real k = x * slope;  // positive
  const Real k_squared = k * k;
  // k^3 (1 + t + t^2/2 + t^3/6) with t = -rest/k.
  const Real series = fms(k_squared, k - rest, rest * rest * fma(rest, Real(1.0 / 6.0), -0.5 * k));
  const MaskOf<Real> far = rest < -0.5 * k;
  return x * (select(far, k_squared * k, k + rest) / select(far, series, k));
}

/// Start of the iteration. In developed flow d is nearly the strain of the step: one Newton step
/// from the known hardening at eps_n and the rate of the step costs a logarithm. Near first yield,
/// where d is much smaller and sigma_Y' unbounded, the strain or the bound of a rate-free material.
template <class Real>
KRATER_FORCE_INLINE Real first_guess(const Flow<Real>& flow, Real q_trial, Real eps, Real three_G,
                                     Real strain, Real per_dt, Real bound) {
  const Real rate_slope = flow.d_rate * per_dt;
  const Real tangent =
      fma(rate_slope, strain, q_trial - flow.stress) / (three_G + (flow.d_eps + rate_slope));
  const MaskOf<Real> developed = (eps > strain) & (tangent > Real(0.0)) & (tangent < bound);
  const Real crude = min(select(strain > Real(0.0), strain, bound), bound);
  return select(developed, tangent, crude);
}

/// No kink of the curve between two strains; most have none.
template <class Real, class Curve>
KRATER_FORCE_INLINE MaskOf<Real> smooth_in_strain(const Curve& curve, Real eps0, Real eps1) {
  if constexpr (requires { curve.smooth_between_strains(eps0, eps1); }) {
    return curve.smooth_between_strains(eps0, eps1);
  } else {
    return Real(0.0) == Real(0.0);
  }
}

/// `strain`: equivalent strain increment of the step, the first guess of d. `G`: a double or a
/// Real.
template <class Real, class Curve, class Modulus>
KRATER_FORCE_INLINE PlasticStep<Real> radial_return(const Curve& curve, Real q_trial, Real eps,
                                                    Modulus G, Real strain, double dt) {
  constexpr int cap = 100;
  // A tenth of what is promised (1e-10 of yield); q_trial's own round-off where strength is next to
  // nothing.
  constexpr double tolerance = 1e-11, round_off = 1e-15;
  const Real three_G = Real(3.0 * G);
  const Real per_dt = Real(1.0 / dt);
  const auto start = curve.hardening(eps);
  const Real static_yield = start.stress;
  // Written so that a NaN counts as yielding: it then ends as "no convergence", not as an elastic
  // point.
  const MaskOf<Real> yielding = !(q_trial <= static_yield);
  Real stress = static_yield;
  Real d = Real(0.0);
  MaskOf<Real> active = yielding;
  if (any(active)) {
    const Real bound = (q_trial - static_yield) / three_G;
    const Real guess = first_guess(curve.flow(start, eps, strain * per_dt), q_trial, eps, three_G,
                                   strain, per_dt, bound);
    Real low = Real(0.0);
    Real high = q_trial / three_G;
    Real x = select(active, guess, Real(1.0));
    for (int i = 0; i < cap && any(active); ++i) {
      const Flow<Real> flow = flow_at(curve, eps + x, x * per_dt);
      const Real rest = fnma(three_G, x, q_trial) - flow.stress;
      const MaskOf<Real> exact = abs(rest) <= max(tolerance * flow.stress, round_off * q_trial);
      const MaskOf<Real> left = rest > Real(0.0);
      low = select(left, x, low);
      high = select(left, high, x);
      const Real rate_slope = flow.d_rate * per_dt;
      const Real newton = newton_step(x, rest, three_G + (flow.d_eps + rate_slope));
      const MaskOf<Real> inside = (newton > low) & (newton < high);
      const Real next = select(inside, newton, 0.5 * (low + high));
      const Real step = next - x;
      const Real bend = 2.0 * (step * step) * fma(flow.bend, x, rate_slope);
      const MaskOf<Real> sure = inside & (bend <= 2.0 * tolerance * flow.stress * x) &
                                (abs(step) <= 0.01 * x) &
                                curve.smooth_between(x * per_dt, next * per_dt) &
                                smooth_in_strain(curve, eps + x, eps + next);
      d = select(active, select(exact, x, next), d);
      stress = select(active, select(exact, flow.stress, fnma(three_G, next, q_trial)), stress);
      x = select(active, next, x);
      active = active & !(exact | sure);
    }
  }
  return {d, stress, yielding, active};
}

/// The same from a law and the state at the start of the step. Where all trials stay below the
/// law's cheap bound (flow.hpp) nothing more is computed: such steps have no use for `stress`.
template <class Real, class Law, class Modulus>
KRATER_FORCE_INLINE PlasticStep<Real> plastic_step(const Law& law, const StartState<Real>& start,
                                                   Real q_trial, Real eps, Modulus G, Real strain,
                                                   double dt) {
  if constexpr (requires { law.least_yield(eps, start.temperature); }) {
    const MaskOf<Real> may_yield = !(q_trial <= law.least_yield(eps, start.temperature));
    if (!any(may_yield)) return {Real(0.0), q_trial, may_yield, may_yield};
  }
  return radial_return(curve_at(law, start), q_trial, eps, G, strain, dt);
}

/// q = sqrt(3/2 s:s).
template <class Real>
KRATER_FORCE_INLINE Real equivalent_stress(const Sym3<Real>& s) {
  return sqrt(1.5 * contract(s, s));
}
/// sqrt(2/3 dev e : dev e).
template <class Real>
KRATER_FORCE_INLINE Real equivalent_strain(const Sym3<Real>& e) {
  const Sym3<Real> deviator = dev(e);
  return sqrt((2.0 / 3.0) * contract(deviator, deviator));
}

}  // namespace krater::inline KRATER_ISA
