// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Return to a shear surface that a moving elliptic cap closes. J1 = 3p, compression positive,
/// J2 = q^2/3; R is the Lode factor of the trial (1 where the law has none), fixed in the return:
///   f = J2 - R^2 F_f(J1)^2 C(J1; kappa) = 0,   x = <J1 - kappa>/a
///   C = 1 - x^2,   X = kappa + a: reach of the cap,   a = r F_f(kappa)
///   compaction  eps_c = W [1 - exp(-D1 (X - X0) - D2 (X - X0)^2)]
/// Associated flow, but for the dilatant side (df/dJ1 < 0), which has the share `dilatancy` of it:
///   d eps_p = d gamma (s + df/dJ1 I)
/// eps_c counts compaction only and the cap never retreats. So, with J1 = J1_tr - 9K d gamma g,
/// q = q_tr/(1 + 2G d gamma) and g = df/dJ1 = 2 R^2 F_f m, m = F_f x/a - F_f' C, a root of
///   h = J1_tr - J1 - (9K/2G) (q_tr/q - 1) g
/// is left, whose sign changes once:
///   dilatant     kappa stays, the unknown is J1, above J1_tr and the apex of F_f; where h < 0 at
///                the apex already, the end lies there and the material parts by -h (as J1)
///   compacting   the unknown is kappa, above its start: J1 = J1_tr - 3K (eps_c(kappa) - eps_c);
///                the root of h sqrt(C) brought to one side and squared, which is smooth where the
///                cap ends (C = 0) and goes on beyond:
///                C (J1_tr - J1 + (9K/G) R^2 F_f m)^2 = (9K R q_tr m/(sqrt3 G))^2
/// By Newton with slopes of both, inside a bracket that is halved where Newton leaves it: three or
/// four evaluations in small steps. Fully implicit: first order along a path.
///
/// The surface is a struct with
///   CapSurface<Real> at(J1)           F_f, F_f', F_f''
///   double shape, apex                r; J1 where F_f = 0
/// References: Sandler, Rubin, Int. J. Numer. Anal. Methods Geomech. 3, 1979; the cap of Schwer,
/// Murray, Int. J. Numer. Anal. Methods Geomech. 18, 1994.
#pragma once

#include <cmath>

#include "krater/core/lane_math.hpp"

namespace krater::inline KRATER_ISA {

/// F_f and its derivatives by J1.
template <class Real>
struct CapSurface {
  Real strength, slope, curvature;
};

/// Compaction that moves the cap.
struct CapHardening {
  double W, D1, D2, X0;

  /// X of a compaction; eps_c stays a little below W.
  template <class Real>
  KRATER_FORCE_INLINE Real reach(Real eps_c) const {
    constexpr double most = 1.0 - 1e-9;
    const Real share = min(Real(most), eps_c * (1.0 / W)), y = -log(Real(1.0) - share);
    // D1 z + D2 z^2 = y, in the form that has no difference of like numbers.
    return X0 + 2.0 * y / (D1 + sqrt(fma(Real(4.0 * D2), y, Real(D1 * D1))));
  }
  template <class Real>
  struct Compaction {
    Real value, slope;  ///< eps_c, and by X
  };
  template <class Real>
  KRATER_FORCE_INLINE Compaction<Real> compaction(Real X) const {
    const Real z = X - X0, left = exp(-z * fma(Real(D2), z, Real(D1)));
    return {W * (Real(1.0) - left), W * left * fma(Real(2.0 * D2), z, Real(D1))};
  }
};

struct ElasticPair {
  double K, G;
};

template <class Real>
struct CapState {
  Real J1, q, kappa;
};
template <class Real>
struct CapEnd {
  Real J1, q, kappa;
  Real parted;  ///< what of J1_tr - J1 is no flow: 0 or below
};

namespace cap_detail {

template <class Surface, class Real>
struct Return {
  const Surface& surface;
  const CapHardening& hardening;
  ElasticPair elastic;
  double dilatancy;
  Real lode;
  CapState<Real> trial;
  Real eps_c;  ///< of the start

  /// Of a point (J1, kappa), and how it changes along the unknown.
  struct Point {
    Real J1, by_J1;           ///< by_: by the unknown
    CapSurface<Real> f;       ///< at J1
    Real x, by_x, closed, m;  ///< closed: C
    Real by_m;
    KRATER_FORCE_INLINE Real by_closed() const { return -2.0 * x * by_x; }
  };
  KRATER_FORCE_INLINE Point point(Real J1, Real by_J1, Real kappa, Real by_kappa,
                                  const CapSurface<Real>& corner) const {
    const CapSurface<Real> f = surface.at(J1);
    const Real per_a = Real(1.0) / (surface.shape * corner.strength);
    const Real by_a = surface.shape * corner.slope * by_kappa;
    const Real beyond = (J1 - kappa) * per_a, x = max(Real(0.0), beyond);
    const Real moved = (by_J1 - by_kappa - beyond * by_a) * per_a;
    const Real by_x = select(beyond > Real(0.0), moved, Real(0.0));
    const Real C = fnma(x, x, Real(1.0)), by_C = -2.0 * x * by_x, F = f.strength;
    const Real m = fms(F * x, per_a, f.slope * C);
    const Real by_m = (f.slope * by_J1 * x + F * (by_x - x * by_a * per_a)) * per_a -
                      fma(f.curvature * by_J1, C, f.slope * by_C);
    return {J1, by_J1, f, x, by_x, C, m, by_m};
  }
  KRATER_FORCE_INLINE Point dilatant(Real J1) const {
    return point(J1, Real(1.0), trial.kappa, Real(0.0), surface.at(trial.kappa));
  }
  KRATER_FORCE_INLINE Point compacting(Real kappa) const {
    const CapSurface<Real> corner = surface.at(kappa);
    const auto e = hardening.compaction(fma(Real(surface.shape), corner.strength, kappa));
    const Real by_X = fma(Real(surface.shape), corner.slope, Real(1.0));
    const Real J1 = fnma(Real(3.0 * elastic.K), max(Real(0.0), e.value - eps_c), trial.J1);
    return point(J1, -3.0 * elastic.K * e.slope * by_X, kappa, Real(1.0), corner);
  }
  KRATER_FORCE_INLINE Real q(const Point& at) const {
    return lode * 1.7320508075688772 * max(Real(0.0), at.f.strength) *
           sqrt(max(Real(0.0), at.closed));
  }

  /// What falls through zero at the end of the step, and its slope.
  struct Residual {
    Real value, slope;
  };
  KRATER_FORCE_INLINE Residual of_dilatant(const Point& at) const {
    const Real c = Real(dilatancy * 4.5 * elastic.K / elastic.G);
    const Real pull = trial.q * lode * (2.0 / 1.7320508075688772), back = 2.0 * lode * lode;
    const Real per = Real(1.0) / sqrt(max(Real(1e-30), at.closed)), F = at.f.strength;
    const Real by_root = at.by_m * per - 0.5 * at.m * per * per * per * at.by_closed();
    const Real by_return = fma(at.f.slope * at.by_J1, at.m, F * at.by_m);
    return {trial.J1 - at.J1 - c * (pull * at.m * per - back * F * at.m),
            -at.by_J1 - c * (pull * by_root - back * by_return)};
  }
  KRATER_FORCE_INLINE Residual of_compacting(const Point& at) const {
    const Real c = Real(9.0 * elastic.K / elastic.G), back = c * lode * lode, F = at.f.strength;
    const Real pull = c * lode * trial.q * (1.0 / 1.7320508075688772);
    const Real A = fma(back * F, at.m, trial.J1 - at.J1), B = pull * at.m;
    const Real by_A = back * fma(at.f.slope * at.by_J1, at.m, F * at.by_m) - at.by_J1;
    const Real by_C = at.by_closed(), value = fms(B, B, at.closed * A * A);
    const Real slope = 2.0 * (B * pull * at.by_m - at.closed * A * by_A) - by_C * A * A;
    // Below the crown of the surface the cap has come too far; no slope: halve.
    const MaskOf<Real> too_far = at.m <= Real(0.0);
    return {select(too_far, Real(-1.0), value), select(too_far, Real(0.0), slope)};
  }
};

/// Root of what falls through zero between `low` and `high`, from `low`: Newton, and half of the
/// bracket where it leaves that. A last step of `enough` squared is round-off. Each lane stops by
/// itself: its bits do not depend on its neighbours.
template <class Real>
KRATER_FORCE_INLINE Real falling_root(Real low, Real high, MaskOf<Real> active, Real enough,
                                      auto residual) {
  constexpr int cap = 100;  // halvings alone need 50
  Real at = low;
  for (int i = 0; i < cap && any(active); ++i) {
    const auto r = residual(at);
    const MaskOf<Real> below = r.value > Real(0.0), falls = r.slope < Real(0.0);
    low = select(active & below, at, low);
    high = select(active & (!below), at, high);
    const Real newton = at - r.value / r.slope;
    const MaskOf<Real> near = falls & (abs(newton - at) <= enough);
    const MaskOf<Real> inside = falls & (newton > low) & (newton < high);
    const Real next = select(inside | near, newton, 0.5 * (low + high));
    at = select(active, next, at);
    active = active & (!near) & (high - low > 1e-7 * enough);
  }
  return at;
}

}  // namespace cap_detail

/// The end of a step whose trial is `trial`; inside the surface it is the trial.
template <class Surface, class Real>
KRATER_FORCE_INLINE CapEnd<Real> cap_return(const Surface& surface, const CapHardening& hardening,
                                            ElasticPair elastic, double dilatancy, Real lode,
                                            const CapState<Real>& trial) {
  const CapSurface<Real> corner = surface.at(trial.kappa);
  const Real X = fma(Real(surface.shape), corner.strength, trial.kappa), apex = Real(surface.apex);
  const cap_detail::Return<Surface, Real> r{
      surface, hardening, elastic, dilatancy, lode, trial, hardening.compaction(X).value};
  const Real begin = max(apex, trial.J1);  // this order keeps a NaN
  const auto start = r.dilatant(begin);
  const Real most = r.q(start);
  const MaskOf<Real> inside = (trial.q <= most) & (trial.J1 <= X) & (trial.J1 >= apex);
  CapEnd<Real> end{trial.J1, trial.q, trial.kappa, Real(0.0)};
  const MaskOf<Real> outside = !inside, crushes = (start.m > Real(0.0)) | (trial.J1 > X);
  if (!any(outside)) return end;
  const MaskOf<Real> compacts = outside & crushes, dilates = outside & (!crushes);
  constexpr double half_the_digits = 1e-8;
  const Real enough = half_the_digits * (abs(trial.J1) + abs(apex));
  if (any(dilates)) {
    // F_f' does not grow with J1 (a concave surface), which bounds the way.
    const Real way = max(Real(0.0), start.f.slope) * lode * max(Real(0.0), trial.q - most) *
                     (9.0 / 1.7320508075688772 * dilatancy * elastic.K / elastic.G);
    const Real J1 = cap_detail::falling_root(begin, begin + way, dilates, enough, [&](Real at) {
      return r.of_dilatant(r.dilatant(at));
    });
    end.J1 = select(dilates, J1, end.J1);
    end.q = select(dilates, min(trial.q, r.q(r.dilatant(J1))), end.q);
    end.parted = select(dilates, min(Real(0.0), r.of_dilatant(start).value), Real(0.0));
  }
  if (any(compacts)) {
    const Real kappa =
        cap_detail::falling_root(trial.kappa, max(trial.kappa, trial.J1), compacts, enough,
                                 [&](Real at) { return r.of_compacting(r.compacting(at)); });
    const auto at_end = r.compacting(kappa);
    end.J1 = select(compacts, at_end.J1, end.J1);
    end.q = select(compacts, min(trial.q, r.q(at_end)), end.q);
    end.kappa = select(compacts, kappa, end.kappa);
  }
  return end;
}

}  // namespace krater::inline KRATER_ISA
