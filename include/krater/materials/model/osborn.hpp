// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Concrete of the type of Osborn's law in Hull and EPIC. Pressure p positive in compression:
///   sigma = min{ (c0 + c1 p^n) (1 + c3 ln e*), sigma_max }     p >= 0
///   sigma = c0 <1 + p/T> (1 + c3 ln e*)                        p < 0;  p >= -T
/// with the pressure of crush_curve.hpp. It is the law of Holmquist, Johnson and Cook without
/// damage and in units of stress, and is computed by it: A = c0/f, B = c1 f^(n - 1), S_max =
/// sigma_max/f.
///
/// Assumptions: no damage, so nothing softens. The equation is known from descriptions only: the
/// tension branch and the pressure are ours.
/// Reference: the description in Bush, SIMM 2010 (comparison of penetration codes); Osborn's report
/// was not read.
#pragma once

#include "krater/materials/model/holmquist_johnson_cook.hpp"

namespace krater::inline KRATER_ISA {

struct Osborn : CrushCurve {
  double c_0, c_1, n, c_3, epsdot0, sigma_max, T;
  double rho0, c0;
  HolmquistJohnsonCook kernel;

  static constexpr Family family = Family::model;
  static constexpr const char* name = "osborn";
  static constexpr const char* equation =
      "sigma = min[(c0 + c1 p^n) (1 + c3 ln e*), sigma_max]; p(mu, mu_max) elastic, crushing, "
      "compact; p >= -T";
  static constexpr const char* reference = "of the type of Osborn's law (Hull, EPIC); no damage";
  static constexpr bool needs_shear_modulus = true;
  using Law = Osborn;
  static constexpr Parameter<Law> parameters[] = {
      {{"c0", "Pa", Range::positive, kRequired, "cohesion"}, &Law::c_0},
      {{"c1", "Pa", Range::non_negative, kRequired,
        "friction: strength that p = 1 Pa adds; c1 p^n with p in Pa"},
       &Law::c_1},
      {{"n", "1", Range::positive, kRequired, "friction: power of p"}, &Law::n},
      {{"c3", "1", Range::non_negative, 0.0, "rate sensitivity"}, &Law::c_3},
      {{"epsdot0", "1/s", Range::positive, 1.0, "reference rate"}, &Law::epsdot0},
      {{"sigma_max", "Pa", Range::positive, kRequired, "largest strength"}, &Law::sigma_max},
      {{"tensile_strength", "Pa", Range::positive, kRequired, "T: largest mean tension", "T"},
       &Law::T},
      {{"crush_pressure", "Pa", Range::positive, kRequired, "where pores begin to close",
        "P_crush"},
       &Law::p_crush},
      {{"crush_compression", "1", Range::positive, kRequired, "mu there: K = p/mu", "mu_crush"},
       &Law::mu_crush},
      {{"lock_pressure", "Pa", Range::positive, kRequired, "where all pores are closed", "P_lock"},
       &Law::p_lock},
      {{"lock_compression", "1", Range::positive, kRequired, "mu of the unloaded grains",
        "mu_lock"},
       &Law::mu_lock},
      {{"K1", "Pa", Range::positive, kRequired, "compact: linear"}, &Law::K1},
      {{"K2", "Pa", Range::any, 0.0, "compact: quadratic"}, &Law::K2},
      {{"K3", "Pa", Range::any, 0.0, "compact: cubic"}, &Law::K3},
  };

  struct Compaction {
    static constexpr FieldInfo info{"compaction", "1", 1, "largest mu = rho/rho0 - 1 so far"};
  };
  using State = Columns<Compaction>;
  std::array<double, 1> initial_state() const { return {0.0}; }

  void prepare(const MaterialConstants& constants) {
    constexpr double never = 1e300;  // fracture strain: its reciprocal adds nothing to 1
    lock_reading = unloading = 0.0;
    static_cast<CrushCurve&>(kernel) = *this;
    kernel.f = c_0;
    kernel.A = 1.0;
    kernel.B = c_1 * std::pow(c_0, n - 1.0);
    kernel.N = n;
    kernel.C = c_3;
    kernel.epsdot0 = epsdot0;
    kernel.S_max = sigma_max / c_0;
    kernel.T = T;
    kernel.D1 = kernel.D2 = 0.0;
    kernel.eps_f_min = never;
    kernel.G_f = kernel.cohesion = kernel.tension = kernel.tension_cut = 0.0;
    kernel.prepare(constants);
    static_cast<CrushCurve&>(*this) = kernel;
    rho0 = constants.density;
    c0 = kernel.c0;
  }
  const char* problem() const {
    return sigma_max > c_0 ? kernel.problem() : "sigma_max must exceed c0";
  }

  template <class Real>
  struct Concrete {
    const Osborn& law;
    Real mu_max;
    KRATER_FORCE_INLINE CoupledUpdate<Real, 1> update(const CoupledStep<Real>& step) const {
      const auto u = law.kernel.at(std::array<Real, 2>{Real(0.0), mu_max}).update(step);
      return {u.q, u.plastic, u.pressure, u.least, u.modulus, u.crush, {u.state[1]}, u.failed};
    }
  };
  template <class Real>
  KRATER_FORCE_INLINE Concrete<Real> at(const std::array<Real, 1>& state) const {
    return {*this, state[0]};
  }
};

}  // namespace krater::inline KRATER_ISA
