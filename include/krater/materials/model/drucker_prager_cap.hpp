// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Concrete of Drucker and Prager, without a cap (the form that Bush 2010 ran in an MPM code) and
/// with one. J1 = 3p, p compression positive:
///   sqrt(J2) <= k + alpha J1,  alpha = (f - f_t)/[sqrt3 (f + f_t)],  k = 2 f f_t/[sqrt3 (f + f_t)]
/// so that unconfined compression gives f and direct tension f_t. Flow has the share `dilatancy` of
/// the associated dilation. Pressure p = K ln(rho/rho0), less what flow and compaction leave.
///
/// Without a cap (`cap: none`) the strength in triaxial compression rises with a slope of 13.5
/// where f_t = f/10 (concrete: 3 to 4), there is no biaxial strength where f_t > f/3 does not
/// hold, and no pore ever closes. The cap is ours: returns/cap_return.hpp with kappa0 = f, so that
/// the unconfined strength stays f, X0 = f (1 + r/sqrt3) and D1 = -ln(0.05)/(3 p_lock - X0): at
/// p_lock 95 % of the air voids W are closed.
///
/// Tension: what lies below the apex J1 = -k/alpha after flow parts: the pressure stays there and
/// returns on closing only.
///
/// Assumptions: perfectly plastic, so nothing softens and there is no fracture energy; no rate; no
/// third invariant; no energy in the pressure.
/// Reference: Drucker, Prager, Q. Appl. Math. 10, 1952, 157-165.
#pragma once

#include <cmath>

#include "krater/materials/model/coupled.hpp"
#include "krater/materials/returns/cap_return.hpp"

namespace krater::inline KRATER_ISA {

struct DruckerPragerCap {
  double f, f_t, K, dilatancy, no_cap, shape, W, p_lock;
  double rho0, c0, G, alpha, k;
  CapHardening hardening;

  static constexpr Family family = Family::model;
  static constexpr const char* name = "drucker_prager";
  static constexpr const char* equation =
      "sqrt(J2) <= k + alpha 3p from the unconfined and the direct tensile strength, closed by an "
      "elliptic cap that compaction moves, or by none; p = K ln(rho/rho0) elastically";
  static constexpr const char* reference =
      "Drucker, Prager, Q. Appl. Math. 10, 1952; Sandler, Rubin, Int. J. Numer. Anal. Methods "
      "Geomech. 3, 1979; cap: none is the form of Bush 2010";
  static constexpr bool needs_shear_modulus = true;
  using Law = DruckerPragerCap;
  static constexpr Parameter<Law> parameters[] = {
      {{"compressive_strength", "Pa", Range::positive, kRequired, "f: unconfined", "f_c"}, &Law::f},
      {{"tensile_strength", "Pa", Range::positive, kRequired, "f_t: direct tension", "f_t"},
       &Law::f_t},
      {{"bulk_modulus", "Pa", Range::positive, kRequired, "elastic, K"}, &Law::K},
      {{"dilatancy", "1", Range::fraction, 0.0, "share of the associated dilation"},
       &Law::dilatancy},
      {{"cap", "1", Range::any, 0.0, "what closes the surface under pressure", nullptr,
        "elliptic|none"},
       &Law::no_cap},
      {{"cap_shape", "1", Range::positive, 2.0, "r: (X - kappa)/F_f(kappa)", "R"}, &Law::shape},
      {{"air_voids", "1", Range::positive, 0.1, "W: volume that compaction can close", "W"},
       &Law::W},
      {{"lock_pressure", "Pa", Range::positive, 0.8e9, "where 95 % of it is closed", "P_lock"},
       &Law::p_lock},
  };

  struct Compaction {
    static constexpr FieldInfo info{"compaction", "1", 1, "volume that compaction closed"};
  };
  struct PlasticVolume {
    static constexpr FieldInfo info{"plastic_volume", "1", 1,
                                    "volume strain of flow, compression positive"};
  };
  using State = Columns<Compaction, PlasticVolume>;
  std::array<double, 2> initial_state() const { return {0.0, 0.0}; }

  void prepare(const MaterialConstants& constants) {
    rho0 = constants.density;
    G = constants.shear_modulus;
    c0 = std::sqrt(K / rho0);
    const double sum = std::sqrt(3.0) * (f + f_t);
    alpha = (f - f_t) / sum;
    k = 2.0 * f * f_t / sum;
    // Without a cap it lies where no state comes.
    constexpr double far = 1e15;
    const double X0 = no_cap > 0.5 ? far : f * (1.0 + shape / std::sqrt(3.0));
    const double D1 = no_cap > 0.5 ? 1.0 / far : -std::log(0.05) / (3.0 * p_lock - X0);
    hardening = {W, D1, 0.0, X0};
  }
  const char* problem() const {
    if (!(f_t < f)) return "tensile_strength must lie below compressive_strength";
    if (!(hardening.D1 > 0)) return "lock_pressure lies within the first cap: 3 p_lock <= X0";
    return nullptr;
  }

  struct Surface {
    double alpha, k, shape, apex;
    template <class Real>
    KRATER_FORCE_INLINE CapSurface<Real> at(Real J1) const {
      return {fma(Real(alpha), J1, Real(k)), Real(alpha), Real(0.0)};
    }
    template <class Real>
    KRATER_FORCE_INLINE Real corner(Real X) const {
      return (X - shape * k) * (1.0 / (1.0 + shape * alpha));
    }
  };

  template <class Real>
  struct Concrete {
    const DruckerPragerCap& law;
    Real eps_c, volume;

    KRATER_FORCE_INLINE CoupledUpdate<Real, 2> update(const CoupledStep<Real>& step) const {
      const Surface surface{law.alpha, law.k, law.shape, -law.k / law.alpha};
      const Real strain = log(step.rho * (1.0 / law.rho0));
      const Real trial = 3.0 * law.K * (strain - volume);
      const Real kappa = surface.corner(law.hardening.reach(eps_c));
      const CapEnd<Real> end =
          cap_return(surface, law.hardening, ElasticPair{law.K, law.G}, law.dilatancy, Real(1.0),
                     CapState<Real>{trial, step.q, kappa});
      const Real flowed = (trial - end.parted - end.J1) * (1.0 / (3.0 * law.K));
      const Real plastic = (step.q - end.q) * (1.0 / (3.0 * law.G));
      // Dilation works against the pressure: then this is negative, but never the whole.
      const Real crush =
          max(-end.q * plastic, end.J1 * (1.0 / 3.0) * flowed) * step.v;  // this order keeps a NaN
      return {min(step.q, end.q),
              plastic,
              {(end.J1 + end.parted) * (1.0 / 3.0), Real(0.0)},
              Real(surface.apex / 3.0),
              Real(law.K),
              crush,
              {eps_c + max(Real(0.0), flowed), volume + flowed},
              Real(1.0) < Real(0.0)};
    }
  };
  template <class Real>
  KRATER_FORCE_INLINE Concrete<Real> at(const std::array<Real, 2>& state) const {
    return {*this, state[0], state[1]};
  }
};

}  // namespace krater::inline KRATER_ISA
