// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Frictional strength: sigma_Y = max(Y + alpha p, 0), with the start-of-step pressure.
/// Plastic flow opens voids, d(bulking) = dilatancy d eps, up to `bulking_limit` (the critical
/// state), never less than non-associated: dilatancy <= alpha. Theory 5. References: Drucker and
/// Prager, Q. Appl. Math. 10, 1952; de Souza Neto, Peric, Owen, Computational Methods for
/// Plasticity, 2008, section 8.3.
///
/// The voids are a state of the point (specific volume `void_volume`): the equation of state sees
/// v - void_volume, so dilatancy under confinement raises the pressure by K dilatancy d, and the
/// plastic work per volume is (q - p dilatancy) d, not negative while p >= -Y/alpha.
///
/// Apex: the pressure never falls below -Y/alpha (`tension_limit`, read by the EOS stage), where
/// the yield stress is zero. Beyond it the material separates: its density falls on and pressure
/// returns on re-closure only, as after spall (theory 9). The classical return to the apex would
/// make that volume plastic for ever, and sand that was thrown up would come down too large.
#pragma once

#include "krater/materials/law.hpp"
#include "krater/materials/returns/flow.hpp"

namespace krater::inline KRATER_ISA {

struct DruckerPrager {
  double Y, alpha, dilatancy, bulking_limit;

  static constexpr Family family = Family::strength;
  static constexpr const char* name = "drucker_prager";
  static constexpr const char* equation =
      "sigma_Y = max(Y + alpha p, 0), d void fraction = dilatancy d eps, p >= -Y/alpha";
  static constexpr const char* reference =
      "Drucker and Prager, Q. Appl. Math. 10, 1952; de Souza Neto, Peric, Owen 2008, section 8.3";
  static constexpr bool needs_shear_modulus = true;
  static constexpr bool reads_temperature = false;
  static constexpr bool reads_pressure = true;
  static constexpr Parameter<DruckerPrager> parameters[] = {
      {{"Y", "Pa", Range::non_negative, kRequired, "yield stress at p = 0 (cohesion)", "cohesion"},
       &DruckerPrager::Y},
      {{"alpha", "1", Range::positive, kRequired, "friction: d sigma_Y / dp"},
       &DruckerPrager::alpha},
      {{"dilatancy", "1", Range::non_negative, 0.0, "void fraction per plastic strain"},
       &DruckerPrager::dilatancy},
      {{"bulking_limit", "1", Range::non_negative, 0.05, "void fraction of the critical state"},
       &DruckerPrager::bulking_limit},
  };

  void prepare(const MaterialConstants&) {}
  const char* problem() const {
    return dilatancy <= alpha ? nullptr : "dilatancy must not exceed alpha";
  }

  /// Lowest pressure the material carries [Pa].
  double tension_limit() const { return -Y / alpha; }

  /// Void volume opened per plastic strain, `voids` and `v` the void and whole specific volumes.
  template <class Real>
  KRATER_FORCE_INLINE Real bulking(Real voids, Real v) const {
    return select(voids < bulking_limit * v, dilatancy * v, Real(0.0));
  }

  template <class Real>
  struct Curve {
    Real yield;  ///< Y + alpha p, not below zero

    struct Hardening {
      Real stress;
    };
    KRATER_FORCE_INLINE Hardening hardening(Real) const { return {yield}; }
    KRATER_FORCE_INLINE Flow<Real> flow(const Hardening& h, Real, Real) const {
      return {h.stress, Real(0.0), Real(0.0), Real(0.0)};
    }
    KRATER_FORCE_INLINE MaskOf<Real> smooth_between(Real, Real) const {
      return Real(0.0) == Real(0.0);
    }
  };

  /// Temperature (not read), pressure and compression (not read) at the start of the step.
  template <class Real>
  KRATER_FORCE_INLINE Curve<Real> at(Real, Real p, Real) const {
    return {max(Real(0.0), fma(Real(alpha), p, Real(Y)))};  // this order keeps a NaN
  }
};

}  // namespace krater::inline KRATER_ISA
