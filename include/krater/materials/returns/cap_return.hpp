// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Return to a shear surface that a moving elliptic cap closes. J1 = 3p, compression positive,
/// J2 = q^2/3; R is the Lode factor of the trial (1 where the law has none), fixed in the return:
///   f = J2 - R^2 F_f(J1)^2 F_c(J1; kappa) = 0
///   F_c = 1 for J1 <= kappa,  1 - ((J1 - kappa)/(X - kappa))^2 beyond;  X = kappa + r F_f(kappa)
///   compaction  eps_c = W [1 - exp(-D1 (X - X0) - D2 (X - X0)^2)]
/// Associated flow, but for the dilatant side (df/dJ1 < 0), which has the share `dilatancy` of it:
///   d eps_p = d gamma (s + df/dJ1 I)
/// eps_c counts compaction only and the cap never retreats. So
///   J1 = J1_tr - 9K d gamma g,   q = q_tr/(1 + 2G d gamma),   g = df/dJ1 or its share,
/// and with q on the surface one unknown is left: J1, the root of
///   h(J1) = J1_tr - J1 - (9K/2G) <q_tr/q(J1) - 1> g(J1),
/// where eps_c of the end, and with it kappa and X, follow from the plastic volume
/// (J1_tr - J1)/(3K). h changes sign once: between the cap's corner and J1_tr on the compacting
/// side, between J1_tr and X on the dilatant side. Fully implicit: first order along a path.
///
/// The surface is a struct with
///   Real strength(J1), slope(J1)      F_f and F_f'
///   Real corner(X)                    kappa of X
///   double apex                       J1 where F_f = 0
/// References: Sandler, Rubin, Int. J. Numer. Anal. Methods Geomech. 3, 1979; the cap of Schwer,
/// Murray, Int. J. Numer. Anal. Methods Geomech. 18, 1994.
#pragma once

#include <cmath>

#include "krater/core/lane_math.hpp"

namespace krater::inline KRATER_ISA {

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
};

struct ElasticPair {
  double K, G;
};

template <class Real>
struct CapState {
  Real J1, q, eps_c;
};

namespace cap_detail {

template <class Surface, class Real>
struct Return {
  const Surface& surface;
  const CapHardening& hardening;
  ElasticPair elastic;
  double dilatancy;
  Real lode, J1_trial, q_trial, eps_c;

  struct Point {
    Real q, slope, X;  ///< of the surface at J1; g; reach of the cap
  };
  KRATER_FORCE_INLINE Real compaction(Real J1) const {
    return eps_c + max(Real(0.0), J1_trial - J1) * (1.0 / (3.0 * elastic.K));
  }
  KRATER_FORCE_INLINE Point at(Real J1) const {
    const Real X = hardening.reach(compaction(J1)), corner = surface.corner(X);
    const Real F = max(Real(0.0), surface.strength(J1)), width = Real(1.0) / (X - corner);
    const Real r = max(Real(0.0), (J1 - corner) * width), closed = max(Real(0.0), 1.0 - r * r);
    const Real g = 2.0 * F * lode * lode * fms(F * r, width, surface.slope(J1) * closed);
    return {lode * 1.7320508075688772 * F * sqrt(closed), select(g < Real(0.0), dilatancy * g, g),
            X};
  }
  KRATER_FORCE_INLINE Real residual(Real J1) const {
    const Point at_J1 = at(J1);
    constexpr double least = 1e-12;  // of q_trial: no division by zero on the axis
    const Real ratio = q_trial / max(at_J1.q, max(Real(1e-200), least * q_trial));
    const Real flow = max(Real(0.0), ratio - 1.0) * at_J1.slope;
    const Real h = fnma(Real(4.5 * elastic.K / elastic.G), flow, J1_trial - J1);
    // Beyond the cap's end the surface has no point.
    return select(J1 >= at_J1.X, min(h, J1_trial - J1) - elastic.K, h);
  }
};

KRATER_FORCE_INLINE bool any_outside(bool inside) { return !inside; }
KRATER_FORCE_INLINE bool any_outside(Mask inside) { return !all(inside); }

}  // namespace cap_detail

/// The end of a step whose trial is (J1_trial, q_trial); inside the surface it is the trial.
template <class Surface, class Real>
KRATER_FORCE_INLINE CapState<Real> cap_return(const Surface& surface, const CapHardening& hardening,
                                              ElasticPair elastic, double dilatancy, Real lode,
                                              const CapState<Real>& trial) {
  const cap_detail::Return<Surface, Real> r{surface, hardening, elastic, dilatancy,
                                            lode,    trial.J1,  trial.q, trial.eps_c};
  const auto start = r.at(trial.J1);
  const MaskOf<Real> inside =
      (trial.q <= start.q) & (trial.J1 <= start.X) & (trial.J1 >= Real(surface.apex));
  if (!cap_detail::any_outside(inside)) return trial;
  // The root lies between `low` (h >= 0) and `high` (h <= 0). On the dilatant side F_f' does not
  // grow with J1 (a concave surface), which bounds the way to it.
  const MaskOf<Real> compacts = (start.slope > Real(0.0)) | (trial.J1 > start.X);
  const Real begin = max(Real(surface.apex), trial.J1);  // this order keeps a NaN
  const Real excess = max(Real(0.0), trial.q - r.at(begin).q);
  const Real way = surface.slope(begin) * lode * excess *
                   (4.5 * 2.0 / 1.7320508075688772 * dilatancy * elastic.K / elastic.G);
  Real low = select(compacts, min(surface.corner(start.X), trial.J1), begin);
  Real high = select(compacts, trial.J1, begin + way);
  Real h_low = r.residual(low), h_high = r.residual(high);
  // Halvings, and false position after every second one: 2^-32 of the bracket at the least.
  constexpr int halvings = 32;
  for (int i = 0; i < halvings + halvings / 2; ++i) {
    const Real fall = max(Real(1e-200), h_low - h_high);
    const Real share = i % 3 < 2 ? Real(0.5) : clamp(h_low / fall, Real(1e-9), Real(1.0 - 1e-9));
    const Real J1 = fma(share, high - low, low), h = r.residual(J1);
    const MaskOf<Real> below = h > Real(0.0);
    low = select(below, J1, low);
    h_low = select(below, h, h_low);
    high = select(below, high, J1);
    h_high = select(below, h_high, h);
  }
  // A chord through what is left of the bracket: round-off where h is smooth.
  const Real chord = clamp(h_low / max(Real(1e-200), h_low - h_high), Real(0.0), Real(1.0));
  const Real J1 = select(inside, trial.J1, fma(chord, high - low, low));
  return {J1, select(inside, trial.q, min(trial.q, r.at(J1).q)),
          select(inside, trial.eps_c, r.compaction(J1))};
}

}  // namespace krater::inline KRATER_ISA
