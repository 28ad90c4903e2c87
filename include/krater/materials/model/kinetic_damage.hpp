// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Concrete whose damage takes time. Our own law, after the description of the BFK model in Bush's
/// comparison (Silling's equations and constants were not found); not to be called by that name.
/// p compression positive; T1 the largest principal stress, tension positive:
///   intact       Y_i = f (1 - T1/T_f) for T1 >= 0 (0 beyond T_f),  f - m T1 below;
///                T_f = f_t/(1 - f_t/f): direct tension gives f_t, unconfined compression f
///   upper        Y_u = c_u Y_i(T1/c_u): Y_i blown up about the origin
///   damaged      Y_d = -m_d T1 for T1 < 0, else 0;   all three at most Y_max
///   strength     q <= (1 - phi) Y_u + phi Y_d
///   damage       d phi/dt = (1 - phi) (Omega_t^n/tau_t + Omega_s^n/tau_s),
///                Omega_t = <T1/f_t - 1>,  Omega_s = <q/Y_i - 1>, 0 where T1 > f_t: counted already
///   tension cut  p >= -c_u f_t (1 - phi);   pressure: crush_curve.hpp
/// A load above the intact surface is borne until damage has had its time, so strength grows with
/// the rate of loading, up to c_u times, without any rate in the law. Damage of a step follows from
/// the stress at its end and is exact at constant overload: 1 - phi falls by exp(-Omega^n dt/tau).
///
/// The surfaces are straight in T1 = -p + (2/3) q cos theta, so q on the surface is the least root
/// of a few linear equations.
///
/// Assumptions: no fracture energy; elastic deviator with constant G; no rate of compaction.
/// Reference: the description of a kinetic damage model (Silling 1997) in Bush, SIMM 2010.
#pragma once

#include <cmath>

#include "krater/materials/model/coupled.hpp"
#include "krater/materials/model/crush_curve.hpp"
#include "krater/materials/returns/lode.hpp"
#include "krater/materials/returns/softening.hpp"

namespace krater::inline KRATER_ISA {

struct KineticDamage : CrushCurve {
  double f, f_t, m, m_d, Y_max, c_u, n, tau_s, tau_t;
  double rho0, c0, per_rho0, G, T_f;

  static constexpr Family family = Family::model;
  static constexpr const char* name = "kinetic_damage";
  static constexpr const char* equation =
      "q <= (1 - phi) c_u Y_i(T1/c_u) + phi Y_d(T1); d phi/dt = (1 - phi) [<T1/f_t - 1>^n/tau_t + "
      "<q/Y_i - 1>^n/tau_s]; p(mu, mu_max) elastic, crushing, compact";
  static constexpr const char* reference =
      "our own, after the description of a kinetic damage model (Silling 1997) in Bush, SIMM 2010";
  static constexpr bool needs_shear_modulus = true;
  static constexpr bool fails = true;
  using Law = KineticDamage;
  static constexpr Parameter<Law> parameters[] = {
      {{"compressive_strength", "Pa", Range::positive, kRequired, "f: unconfined, slow", "f_c"},
       &Law::f},
      {{"tensile_strength", "Pa", Range::positive, kRequired, "f_t: direct tension, slow", "f_t"},
       &Law::f_t},
      {{"intact_slope", "1", Range::non_negative, 3.0, "m: dY/d(-T1) intact"}, &Law::m},
      {{"damaged_slope", "1", Range::non_negative, 2.5, "m_d: the same damaged"}, &Law::m_d},
      {{"strength_max", "1", Range::positive, 7.0, "Y_max over f"}, &Law::Y_max},
      {{"overload_max", "1", Range::positive, 3.0, "c_u: upper surface over the intact one"},
       &Law::c_u},
      {{"exponent", "1", Range::positive, 2.0, "n: of the overload"}, &Law::n},
      {{"shear_time", "s", Range::positive, 1e-5, "tau_s: delay in compression and shear"},
       &Law::tau_s},
      {{"tension_time", "s", Range::positive, 3e-6, "tau_t: delay in tension"}, &Law::tau_t},
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
  using State = Columns<field::Damage, Compaction>;
  std::array<double, 2> initial_state() const { return {0.0, 0.0}; }

  void prepare(const MaterialConstants& constants) {
    rho0 = constants.density;
    per_rho0 = 1.0 / rho0;
    G = constants.shear_modulus;
    T_f = f_t / (1.0 - f_t / f);
    lock_reading = unloading = 0.0;
    prepare_curve();
    c0 = std::sqrt(K_el / rho0);
  }
  const char* problem() const {
    if (!(f_t < f)) return "tensile_strength must lie below compressive_strength";
    if (!(c_u >= 1.0)) return "overload_max must be 1 at the least: the upper surface encloses";
    if (!(m >= m_d)) return "damaged_slope must not exceed intact_slope";
    if (!(m <= f / T_f)) return "the surface never closes in tension: intact_slope exceeds f/T_f";
    return curve_problem();
  }

  /// Largest q at pressure p for a deviator whose largest principal value is `share` of q.
  template <class Real>
  KRATER_FORCE_INLINE Real strength(Real phi, Real p, Real share) const {
    const Real intact = Real(1.0) - phi, limit = Real(Y_max * f), floor = Real(c_u * f);
    // q = a - b T1 with T1 = share q - p.
    const auto root = [&](Real a, Real b) { return fma(b, p, a) / fma(b, share, Real(1.0)); };
    const Real dry = phi * m_d, steep = intact * (f / T_f);
    const Real pressed =
        min(min(root(intact * floor, fma(intact, Real(m), dry)), root(intact * limit, dry)), limit);
    const Real pulled = min(root(intact * floor, steep), intact * limit);
    const Real q = select(share * pressed <= p, pressed, pulled);
    return max(Real(0.0), q);  // this order keeps a NaN
  }
  template <class Real>
  KRATER_FORCE_INLINE Real intact_strength(Real T1) const {
    const Real line = fnma(select(T1 > Real(0.0), Real(f / T_f), Real(m)), T1, Real(f));
    return min(Real(Y_max * f), max(Real(0.0), line));
  }
  /// Of both overloads, per time.
  template <class Real>
  KRATER_FORCE_INLINE Real growth(Real q, Real T1) const {
    const Real Y = intact_strength(T1), least = Real(1e-6 * f);
    const Real pulled = max(Real(0.0), T1 * (1.0 / f_t) - 1.0);
    const Real above = max(Real(0.0), q / max(least, Y) - 1.0);
    const Real sheared = select(T1 > Real(f_t), Real(0.0), above);
    return positive_power(pulled, n) * (1.0 / tau_t) + positive_power(sheared, n) * (1.0 / tau_s);
  }

  template <class Real>
  struct Concrete {
    const KineticDamage& law;
    Real phi, mu_max;

    KRATER_FORCE_INLINE CoupledUpdate<Real, 2> update(const CoupledStep<Real>& step) const {
      const Real mu = (step.rho - law.rho0) * law.per_rho0;
      const Real reached = max(mu, mu_max);  // this order keeps a NaN of the state
      const CrushCurve::Line<Real> line = law.line(reached), before = law.line(mu_max);
      const Real own = line.at(mu), cut = (-law.c_u * law.f_t) * (Real(1.0) - phi);
      const Real p = max(cut, own);
      const Real share = lode_cosine(step.trial, step.q) * (2.0 / 3.0);
      const Real q = min(step.q, law.strength(phi, p, share));  // this order keeps a NaN
      const Real gone = exp(-step.dt * law.growth(q, fms(share, q, p)));
      const Real after = fnma(Real(1.0) - phi, gone, Real(1.0));
      constexpr double nearly = 0.999;  // phi tends to 1 and never is
      return {q,
              (step.q - q) * (1.0 / (3.0 * law.G)),
              {own, Real(0.0)},
              cut,
              (mu + 1.0) * line.modulus,
              crush_heat(before, before.rest(), line, line.rest(), law.rho0),
              {max(phi, after), reached},
              after >= Real(nearly)};
    }
  };
  template <class Real>
  KRATER_FORCE_INLINE Concrete<Real> at(const std::array<Real, 2>& state) const {
    return {*this, state[0], state[1]};
  }
};

}  // namespace krater::inline KRATER_ISA
