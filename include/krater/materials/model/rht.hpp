// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Concrete of Riedel, Hiermaier and Thoma. p* = p/f and all strengths in units of f, compression
/// positive; surfaces in rht_surfaces.hpp:
///   elastic limit -> failure   sigma_e + 3 xi G eps_p/f, up to sigma_f, while D = 0
///   failure -> residual        (1 - D) sigma_f + D sigma_r,  d D = d eps_p/eps_f
///   eps_f = max[D1 (p* + (1 - D) |p_t*|)^D2, eps_f_min],     p_t*: where failure ends in tension
/// All three times Willam and Warnke's section at the Lode angle: with a round residual surface, as
/// published, rubble in extension would be stronger than sound concrete. The cap of the elastic
/// limit closes at the pressure at which pores crush, and opens at p_u* = F_c g_c/3 + xi G eps_p/f.
/// The walk along both lines is exact at the pressure of the end of the step. p* >= (1 - D) p_t*
/// F_t; rubble (D = 1) keeps the residual friction.
///
/// Rate: F_c = (e/3e-5)^(1/(5 + 0.75 f)), F_t = (e/3e-6)^(1/(10 + 0.5 f)), f in MPa, at least 1,
/// of the mean rate over about ten steps. The second branch above 30 /s of other codes is not here.
///
/// Pressure: pores close by returns/pore_closure.hpp about the solid of rht_surfaces.hpp, with the
/// whole internal energy (one open code takes its deviatoric part only).
///
/// `fracture_energy` G_f, ours and off by default: where p < 0
///   eps_f = G_f/(L f_t I),  f_t I = integral of the stress of direct tension by D from 0 to 1
/// (0.58 f_t of C30/37; 2 G_f/(f_t L) of other codes is for a straight line), and of new largest
/// volume strains beyond that of the cut d D = d<-eps_v>/eps_v,f with eps_v,f = 2 G_f/(L |p_t|)
/// less the elastic strain there: direct and triaxial tension dissipate G_f per area of a crack
/// whatever the width L over which it localises.
///
/// Assumptions: no shear dilation; distension follows the energy of the start of a step.
/// References: Riedel, Thoma, Hiermaier, Schmolinske, 9th Int. Symp. on Interaction of the Effects
/// of Munitions with Structures, Berlin 1999; equations as in the material point application of
/// Kratos Multiphysics (pull request 7184).
#pragma once

#include <cmath>

#include "krater/materials/model/coupled.hpp"
#include "krater/materials/model/rht_surfaces.hpp"
#include "krater/materials/returns/pore_closure.hpp"

namespace krater::inline KRATER_ISA {

struct Rht {
  double f, A, n, f_s, f_t, Q0, B, g_c, g_t, xi, D1, D2, eps_f_min, A_f, n_f, rate, G_f;
  double A1, A2, A3, B0, B1, T1, T2, alpha0, elastic_pressure, compaction_pressure, exponent;
  double rho0, c0, K, G, p_t;  ///< p_t: below 0 [1]
  double power_c, power_t;     ///< 0 without a rate
  double own, per_length;      ///< 1/eps_f in tension: own times the law's + this times L
  double parting;              ///< dD per volume strain and length [1/m]
  double elastic_share;        ///< of G_f, per length [1/m]
  RhtSurfaces surfaces;
  RhtSolid solid;
  CrushLaw pores;

  static constexpr Family family = Family::model;
  static constexpr const char* name = "rht";
  static constexpr const char* equation =
      "sigma* = elastic limit, then failure, then (1 - D) failure + D A_f p*^n_f; d D = d "
      "eps_p/max(D1 (p* + (1 - D) |p_t*|)^D2, eps_f_min); p = p_s(alpha rho, e)/alpha";
  static constexpr const char* reference =
      "Riedel, Thoma, Hiermaier, Schmolinske, 9th Int. Symp. on Interaction of the Effects of "
      "Munitions with Structures, Berlin 1999";
  static constexpr bool needs_shear_modulus = true;
  static constexpr bool fails = true;
  using Law = Rht;
  static constexpr Parameter<Law> parameters[] = {
      {{"compressive_strength", "Pa", Range::positive, kRequired, "f, unit of all strengths",
        "f_c"},
       &Law::f},
      {{"A", "1", Range::positive, kRequired, "failure: factor"}, &Law::A},
      {{"n", "1", Range::positive, kRequired, "failure: power"}, &Law::n},
      {{"shear_strength", "1", Range::positive, kRequired, "f_s over f", "f_s"}, &Law::f_s},
      {{"tensile_strength", "1", Range::positive, kRequired, "f_t over f", "f_t"}, &Law::f_t},
      {{"Q0", "1", Range::positive, kRequired, "tensile over compressive meridian at p = 0"},
       &Law::Q0},
      {{"B", "1", Range::non_negative, 0.0, "growth of that with p*"}, &Law::B},
      {{"g_c", "1", Range::positive, kRequired, "elastic limit over failure, compression"},
       &Law::g_c},
      {{"g_t", "1", Range::positive, kRequired, "the same in tension"}, &Law::g_t},
      {{"hardening", "1", Range::positive, 0.5, "xi: slope of hardening over 3 G", "xi"}, &Law::xi},
      {{"D1", "1", Range::positive, kRequired, "fracture strain: factor"}, &Law::D1},
      {{"D2", "1", Range::non_negative, 1.0, "fracture strain: power"}, &Law::D2},
      {{"eps_f_min", "1", Range::positive, 0.01, "least fracture strain"}, &Law::eps_f_min},
      {{"A_f", "1", Range::non_negative, kRequired, "residual: factor"}, &Law::A_f},
      {{"n_f", "1", Range::positive, kRequired, "residual: power"}, &Law::n_f},
      {{"rate_factor", "1", Range::any, 0.0, "strength increase with the rate", nullptr,
        "power|none"},
       &Law::rate},
      {{"fracture_energy", "J/m^2", Range::non_negative, 0.0, "G_f in tension; 0: none", "G_f"},
       &Law::G_f},
      {{"A1", "Pa", Range::positive, kRequired, "solid: linear"}, &Law::A1},
      {{"A2", "Pa", Range::any, 0.0, "solid: quadratic"}, &Law::A2},
      {{"A3", "Pa", Range::any, 0.0, "solid: cubic"}, &Law::A3},
      {{"B0", "1", Range::non_negative, 0.0, "solid: factor of rho e"}, &Law::B0},
      {{"B1", "1", Range::non_negative, 0.0, "solid: growth of that with nu"}, &Law::B1},
      {{"T1", "Pa", Range::positive, kRequired, "solid in tension: linear"}, &Law::T1},
      {{"T2", "Pa", Range::any, 0.0, "solid in tension: quadratic"}, &Law::T2},
      {{"distension", "1", Range::positive, kRequired, "alpha at the start: v over v of the solid",
        "alpha0"},
       &Law::alpha0},
      {{"elastic_pressure", "Pa", Range::non_negative, kRequired, "where pores begin to close",
        "p_el"},
       &Law::elastic_pressure},
      {{"compaction_pressure", "Pa", Range::positive, kRequired, "where no pore is left", "p_co"},
       &Law::compaction_pressure},
      {{"exponent", "1", Range::positive, 3.0, "of the crush curve", "NP"}, &Law::exponent},
  };

  struct Extension {
    static constexpr FieldInfo info{"extension", "1", 1, "largest -ln(rho/rho0) so far"};
  };
  struct MeanRate {
    static constexpr FieldInfo info{"mean_rate", "s^-1", 1, "strain rate, mean over ten steps"};
  };
  using State = Columns<field::Damage, field::Distension, Extension, MeanRate>;
  template <class Real>
  using Values = std::array<Real, 4>;
  Values<double> initial_state() const { return {0.0, alpha0, 0.0, 0.0}; }

  void prepare(const MaterialConstants& constants) {
    constexpr double MPa = 1e6;
    rho0 = constants.density;
    G = constants.shear_modulus;
    K = A1 / alpha0;
    c0 = std::sqrt(K / rho0);
    surfaces = {A, n, f_s, f_t, Q0, B, g_c, g_t, A_f, n_f};
    const double solid_density = alpha0 * rho0;
    solid = {A1, A2, A3, B0, B1, T1, T2, solid_density, std::sqrt(A1 / solid_density)};
    pores = {elastic_pressure, compaction_pressure, exponent, alpha0};
    p_t = surfaces.hugoniot_tension();
    power_c = rate < 0.5 ? 1.0 / (5.0 + 0.75 * f / MPa) : 0.0;
    power_t = rate < 0.5 ? 1.0 / (10.0 + 0.5 * f / MPa) : 0.0;
    own = G_f > 0 ? 0.0 : 1.0;
    per_length = G_f > 0 ? softening_work() / G_f : 0.0;
    parting = G_f > 0 ? -p_t * f / (2.0 * G_f) : 0.0;
    elastic_share = G_f > 0 ? p_t * p_t * f * f / (2.0 * T1 / alpha0 * G_f) : 0.0;
  }
  /// Stress of direct tension at a damage [1]: the root of t = (1 - D) Q2 failure(-t/3).
  double pulled(double D) const {
    double t = 0;
    for (int i = 0; i < 100; ++i) {
      const auto q = surfaces.meridians(-t / 3.0);
      const double at = (1.0 - D) * q.Q2 * surfaces.failure(-t / 3.0, q, {1.0, 1.0});
      t = 0.5 * (t + at);
    }
    return t;
  }
  /// Integral of it by D [Pa], by Simpson's rule.
  double softening_work() const {
    constexpr int parts = 64;
    double sum = 0;
    for (int i = 0; i < parts; ++i) {
      const double h = 1.0 / parts, D = i * h;
      sum += h / 6.0 * (pulled(D) + 4.0 * pulled(D + 0.5 * h) + pulled(D + h));
    }
    return sum * f;
  }
  /// Above it direct tension falls faster than it springs back, or the elastic energy of triaxial
  /// tension is all of G_f [m].
  double largest_length() const {
    if (!(G_f > 0)) return 0.0;
    const double E = 9.0 * K * G / (3.0 * K + G), end = 1e-3;
    const double steepest = pulled(1.0 - end) / end * f;  // |dt/dD| is largest there
    return std::fmin(E / (steepest * per_length), 1.0 / elastic_share);
  }
  const char* problem() const {
    if (!(f_t < f_s && f_s < 1.0)) return "tensile_strength < shear_strength < 1 must hold";
    if (!(g_c <= 1.0 && g_t <= 1.0)) return "g_c and g_t: the elastic limit lies within failure";
    if (!(Q0 >= 0.5 && Q0 <= 1.0)) return "Q0 must lie between 0.5 and 1";
    if (!(p_t < 0)) return "the surface never closes in tension: 1/Q0 exceeds f_s/(Q1 f_t)";
    if (!(alpha0 >= 1.0)) return "distension must be 1 at least";
    if (!(exponent >= 1.0)) return "exponent must be 1 at least";
    if (!(compaction_pressure > elastic_pressure))
      return "compaction_pressure must lie above elastic_pressure";
    return nullptr;
  }

  /// Increase of strength with the rate.
  template <class Real>
  KRATER_FORCE_INLINE RhtSurfaces::Rates<Real> factors(Real mean_rate) const {
    const Real at = log(max(Real(1e-12), mean_rate));
    const auto factor = [&](double quiet, double power) {
      return exp(power * max(Real(0.0), at - std::log(quiet)));
    };
    return {factor(3e-5, power_c), factor(3e-6, power_t)};
  }
  template <class Real>
  KRATER_FORCE_INLINE Real fracture_strain(Real p, Real D) const {
    const Real above = max(Real(0.0), fnma(Real(p_t), Real(1.0) - D, p));
    return max(Real(eps_f_min), D1 * positive_power(above, D2));
  }
  /// dD per plastic strain.
  template <class Real>
  KRATER_FORCE_INLINE Real per_strain(Real p, Real D, Real length) const {
    const Real plain = Real(1.0) / fracture_strain(p, D);
    return select(p < Real(0.0), fma(Real(per_length), length, own * plain), plain);
  }

  /// Surfaces of the step in Pa.
  template <class Real>
  struct Step {
    Real elastic, failure, residual;
    Real per_strain;  ///< damage
  };
  /// Of the elastic limit, in units of f: p, where it begins without flow, where it ends.
  template <class Real>
  struct Cap {
    Real x, opens, closes;
  };
  template <class Real>
  struct Flow {
    Real plastic, damage;
  };
  template <class Real>
  struct Concrete {
    const Rht& law;
    Values<Real> state;

    KRATER_FORCE_INLINE CoupledUpdate<Real, 4> update(const CoupledStep<Real>& step) const {
      const auto& [damage, alpha, extension, mean] = state;
      constexpr double memory = 0.1;
      const Real rate = fma(Real(memory), step.strain * (1.0 / step.dt) - mean, mean);
      const Real at = closed_pores(law.pores, law.solid, alpha, step.rho, step.v, step.energy);
      const Real per = Real(1.0) / at;
      const PressureSplit<Real> s = law.solid.split(at * step.rho, step.v * per);
      const PressureSplit<Real> split{s.cold * per, s.thermal * per};
      const auto F = law.factors(rate);
      const Real cut = law.p_t * law.f * F.tension * (Real(1.0) - damage);
      const Real own = fma(split.thermal, step.energy, split.cold), p = max(cut, own);
      const Cap<Real> cap{p * (1.0 / law.f), F.compression * (law.g_c / 3.0),
                          law.pores.crush_pressure(at) * (1.0 / law.f)};
      const Step<Real> surfaces = surfaces_at(step, p, F);
      const Flow<Real> flow = flow_of(capped(surfaces, cap, step.plastic_strain), step);
      const Real q = min(step.q, fnma(Real(3.0 * law.G), flow.plastic, step.q));
      const Real drawn = max(extension, -log(step.rho * (1.0 / law.rho0)));
      const Real after = min(Real(1.0), flow.damage + parted(step.length, drawn));
      const Real modulus =
          law.solid.bulk_modulus(at * step.rho, step.v * per, own * at, step.energy) * per;
      // maxima and choices may lose a NaN of the state: it must be seen
      const Real seen = Real(0.0) * (extension + damage + mean);
      return {max(Real(0.0), q),
              flow.plastic + seen,
              split,
              cut,
              modulus,
              max(Real(0.0), own * (alpha - at) * per) * step.v,  // pores hold no energy
              {after, at, drawn, rate},
              after >= Real(1.0)};
    }
    KRATER_FORCE_INLINE Step<Real> capped(Step<Real> s, const Cap<Real>& cap, Real eps_p) const {
      const Real opens = fma(eps_p, Real(law.xi * law.G / law.f), cap.opens);
      const Real into =
          clamp((cap.x - opens) / max(Real(1e-9), cap.closes - opens), Real(0.0), Real(1.0));
      // On the crush curve the root would make 1e-5 of strength of the 1e-11 by which p is known.
      constexpr double noise = 1e-9;
      s.elastic = s.elastic * sqrt(max(Real(0.0), fnma(into, into, Real(1.0 - noise))));
      return s;
    }
    /// The elastic limit is that without the cap.
    KRATER_FORCE_INLINE Step<Real> surfaces_at(const CoupledStep<Real>& step, Real p,
                                               const RhtSurfaces::Rates<Real>& F) const {
      const Real x = p * (1.0 / law.f);
      const auto meridians = law.surfaces.meridians(x);
      const Real lode = law.f * willam_warnke(lode_cosine(step.trial, step.q), meridians.Q2);
      const Real failure = law.surfaces.failure(x, meridians, F);
      return {lode * law.surfaces.elastic(x, meridians, F), lode * failure,
              lode * law.surfaces.residual(x, failure), law.per_strain(x, state[0], step.length)};
    }
    /// Along the line to failure, then along that to the residual strength.
    KRATER_FORCE_INLINE Flow<Real> flow_of(const Step<Real>& s,
                                           const CoupledStep<Real>& step) const {
      const Real D = state[0], stiff = Real(3.0 * law.G), slope = stiff * law.xi;
      const Real hardened = fma(slope, step.plastic_strain, s.elastic);
      const Real way = max(Real(0.0), s.failure - hardened) / slope;
      const Real wished = max(Real(0.0), step.q - hardened) / (stiff + slope);
      const Real first = select(D > Real(0.0), Real(0.0), min(way, wished));
      // Softening.
      const Real fall = s.failure - s.residual, at = fnma(D, fall, s.failure);
      const Real left = max(Real(0.0), fnma(stiff, first, step.q) - at);
      const Real resist = fnma(fall, s.per_strain, stiff);
      const Real longest = (Real(1.0) - D) / s.per_strain;
      const Real wanted = select(resist > Real(0.0), left / resist, longest);
      const Real second = select(left > Real(0.0), min(longest, wanted), Real(0.0));
      const Real end = min(Real(1.0), fma(second, s.per_strain, D));
      const Real rest = fnma(stiff, first + second, step.q) - fnma(end, fall, s.failure);
      const Real more = select(left > Real(0.0), max(Real(0.0), rest) / stiff, Real(0.0));
      return {first + second + more, end};
    }
    /// Damage of new volume strains beyond that of the cut.
    KRATER_FORCE_INLINE Real parted(Real length, Real drawn) const {
      constexpr double least = 1e-3;  // longer cells are refused
      const double start = -law.p_t * law.f * law.alpha0 / law.T1;
      const Real grown = max(Real(0.0), drawn - start) - max(Real(0.0), state[2] - start);
      const Real left = max(Real(least), fnma(Real(law.elastic_share), length, Real(1.0)));
      return law.parting * length / left * grown;
    }
  };
  template <class Real>
  KRATER_FORCE_INLINE Concrete<Real> at(const Values<Real>& state) const {
    return {*this, state};
  }
};

}  // namespace krater::inline KRATER_ISA
