// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Concrete of Holmquist, Johnson and Cook. Pressure p, mu = rho/rho0 - 1 and strains positive in
/// compression; p* = p/f, T* = T/f, e* = rate of the whole deviatoric strain over epsdot0.
///
/// Pressure: crush_curve.hpp; in tension p >= -T (1 - D). The material parts there: pressure
/// returns on closing only. `tension_cut: intact` keeps -T, as some codes do.
///
/// Strength, with the pressure of the end of the step:
///   sigma* = min{ [A (1 - D) + B p*^N] (1 + C ln e*), S_max }       p* >= 0
///   sigma* = A <1 - D + p*/T*> (1 + C ln e*)                        p* < 0: zero at the cut
/// with e* >= 1: slow rates do not weaken. S_max caps after the rate. Rubble (D = 1) keeps its
/// friction B p*^N; it bears no tension, which is what `failed` says here. `tension: scaled` is
/// A (1 - D) <1 + p*/T*>, as Radioss LAW126 and IMPETUS have it. `cohesion: closing` takes
/// A = 1 - B/3^N, so that intact concrete breaks at f in the unconfined test; with the printed A
/// it breaks at about 2 f, for the surface is fitted at pressure.
///
/// Damage, by plastic strain and by crushing:
///   dD = (d eps_p + d mu_p)/eps_f,   eps_f = max(D1 (p* + T*)^D2, eps_f_min)
/// mu_p = mu_max - p_load(mu_max)/K_u is what stays after unloading; it counts up to the end of
/// crushing. The strength of a step sees the crushing of this step and the flow of the last ones:
/// explicit, first order in the step.
///
/// `fracture_energy` G_f, ours and off by default: in tension (p < 0) eps_f = 2 G_f/(t0 L), where
/// t0 = A/(1/f + A/(3T)) is the peak of direct tension, a stress of 2.28 T in concrete of 48 MPa: T
/// limits the pressure only. Softening there is t0 (1 - D), linear, so direct tension dissipates
/// G_f per area of a crack whatever the width L over which it localises. Triaxial tension has no
/// plastic strain and never softens.
///
/// Assumptions: no energy in the pressure (crushing becomes heat by the work); elastic deviator
/// with constant G; no third invariant; without G_f softening depends on the cell. The sound speed
/// is that of unloading, K_u, the stiffest line at every mu_max and continuous in it.
/// References: Holmquist, Johnson, Cook, 14th Int. Symp. on Ballistics, Quebec 1993; constants of
/// 48 MPa concrete there.
#pragma once

#include <cmath>

#include "krater/core/lane_math.hpp"
#include "krater/materials/model/coupled.hpp"
#include "krater/materials/model/crush_curve.hpp"
#include "krater/materials/returns/softening.hpp"

namespace krater::inline KRATER_ISA {

struct HolmquistJohnsonCook : CrushCurve {
  double f, A, B, N, C, epsdot0, S_max, D1, D2, eps_f_min, T, G_f;
  double cohesion, tension, tension_cut;  ///< index of a word
  double rho0, c0, per_rho0, G;
  double scaled, softened;        ///< 1 or 0: D scales the slope in tension; D lowers the cut
  double own, per_strain_length;  ///< 1/eps_f in tension: own times the law's + this times L

  static constexpr Family family = Family::model;
  static constexpr const char* name = "holmquist_johnson_cook";
  static constexpr const char* equation =
      "sigma* = min([A (1 - D) + B p*^N] (1 + C ln e*), S_max); dD = (d eps_p + d mu_p)/(D1 (p* + "
      "T*)^D2); p(mu, mu_max) elastic, crushing, compact; p >= -T (1 - D)";
  static constexpr const char* reference =
      "Holmquist, Johnson, Cook, 14th International Symposium on Ballistics, Quebec 1993";
  static constexpr bool needs_shear_modulus = true;
  static constexpr bool fails = true;
  using Law = HolmquistJohnsonCook;
  static constexpr Parameter<Law> parameters[] = {
      {{"compressive_strength", "Pa", Range::positive, kRequired, "f, unit of all stresses", "f_c"},
       &Law::f},
      {{"A", "1", Range::non_negative, kRequired, "cohesion over f"}, &Law::A},
      {{"B", "1", Range::non_negative, kRequired, "friction: factor"}, &Law::B},
      {{"N", "1", Range::positive, kRequired, "friction: power of p*"}, &Law::N},
      {{"C", "1", Range::non_negative, 0.0, "rate sensitivity"}, &Law::C},
      {{"epsdot0", "1/s", Range::positive, 1.0, "reference rate", "EPS0"}, &Law::epsdot0},
      {{"S_max", "1", Range::positive, kRequired, "largest strength over f", "SFMAX"}, &Law::S_max},
      {{"D1", "1", Range::positive, kRequired, "fracture strain: factor"}, &Law::D1},
      {{"D2", "1", Range::non_negative, 1.0, "fracture strain: power of p* + T*"}, &Law::D2},
      {{"eps_f_min", "1", Range::positive, 0.01, "least fracture strain", "EFMIN"},
       &Law::eps_f_min},
      {{"tensile_strength", "Pa", Range::positive, kRequired, "T: largest mean tension", "T"},
       &Law::T},
      {{"crush_pressure", "Pa", Range::positive, kRequired, "where pores begin to close",
        "P_crush"},
       &Law::p_crush},
      {{"crush_compression", "1", Range::positive, kRequired, "mu there: K = p/mu", "mu_crush"},
       &Law::mu_crush},
      {{"lock_pressure", "Pa", Range::positive, kRequired, "where all pores are closed", "P_lock"},
       &Law::p_lock},
      {{"lock_compression", "1", Range::positive, kRequired, "mu of the grains, see lock_strain",
        "mu_lock"},
       &Law::mu_lock},
      {{"lock_strain", "1", Range::any, 0.0,
        "is lock_compression that of unloaded grains or at p_lock", nullptr, "grain|pressure"},
       &Law::lock_reading},
      {{"K1", "Pa", Range::positive, kRequired, "compact: linear"}, &Law::K1},
      {{"K2", "Pa", Range::any, 0.0, "compact: quadratic"}, &Law::K2},
      {{"K3", "Pa", Range::any, 0.0, "compact: cubic"}, &Law::K3},
      {{"unloading", "1", Range::any, 0.0, "of compact material: max(K1, g'), or K1 as published",
        nullptr, "consistent|published"},
       &Law::unloading},
      {{"cohesion", "1", Range::any, 0.0, "A as given, or 1 - B/3^N: unconfined strength f",
        nullptr, "given|closing"},
       &Law::cohesion},
      {{"tension", "1", Range::any, 0.0, "strength at p < 0: A(1 - D + p/T), or A(1 - D)(1 + p/T)",
        nullptr, "continuous|scaled"},
       &Law::tension},
      {{"tension_cut", "1", Range::any, 0.0, "least pressure: -T(1 - D), or -T", nullptr,
        "damaged|intact"},
       &Law::tension_cut},
      {{"fracture_energy", "J/m^2", Range::non_negative, 0.0, "G_f in tension; 0: none", "G_f"},
       &Law::G_f},
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
    if (cohesion > 0.5) A = 1.0 - B / std::pow(3.0, N);
    scaled = tension > 0.5 ? 1.0 : 0.0;
    softened = tension_cut > 0.5 ? 0.0 : 1.0;
    own = G_f > 0 ? 0.0 : 1.0;
    per_strain_length = G_f > 0 ? direct_tension() / (2.0 * G_f) : 0.0;
    prepare_curve();
    c0 = std::sqrt(K_el / rho0);
  }
  const char* problem() const {
    if (!(A >= 0)) return "cohesion closing: B/3^N exceeds 1, the unconfined strength is above f";
    return curve_problem();
  }
  /// Peak stress of direct tension [Pa].
  double direct_tension() const { return A / (1.0 / f + A / (3.0 * T)); }
  /// Width at which the elastic energy of the peak is all of G_f [m].
  double largest_length() const {
    const double E = 9.0 * K_el * G / (3.0 * K_el + G), t = direct_tension();
    return 2.0 * E * G_f / (t * t);
  }

  /// sigma_Y/f, D and p* given, e* >= 1.
  template <class Real>
  KRATER_FORCE_INLINE Real strength(Real D, Real p, Real rate) const {
    const Real intact = Real(1.0) - D, faster = fma(Real(C), log(rate), Real(1.0));
    const Real friction = B * positive_power(max(Real(0.0), p), N);
    const Real pressed = min(Real(S_max), fma(Real(A), intact, friction) * faster);
    const Real slope = fnma(Real(scaled), D, Real(1.0));
    const Real pulled = A * max(Real(0.0), fma(slope * p, Real(f / T), intact)) * faster;
    return select(p < Real(0.0), pulled, pressed);
  }
  template <class Real>
  KRATER_FORCE_INLINE Real fracture_strain(Real p) const {
    return max(Real(eps_f_min), D1 * positive_power(max(Real(0.0), p + T / f), D2));
  }
  /// Damage per plastic strain; localised over `length`.
  template <class Real>
  KRATER_FORCE_INLINE Real per_strain(Real p, Real length) const {
    const Real plain = Real(1.0) / fracture_strain(p);
    return select(p < Real(0.0), fma(Real(per_strain_length), length, own * plain), plain);
  }

  /// The law at a state.
  template <class Real>
  struct Concrete {
    const HolmquistJohnsonCook& law;
    Real damage, mu_max;

    KRATER_FORCE_INLINE CoupledUpdate<Real, 2> update(const CoupledStep<Real>& step) const {
      const Real mu = (step.rho - law.rho0) * law.per_rho0;
      const Real reached = max(mu, mu_max);  // this order keeps a NaN of the state
      const CrushCurve::Line<Real> line = law.line(reached), before = law.line(mu_max);
      const Real rest = line.rest(), rest_before = before.rest(), own = line.at(mu);
      // p* enters the fracture strain, and the cut of p enters p*: the damage of the start.
      const Real cut = -law.T * fnma(Real(law.softened), damage, Real(1.0));
      const Real p = max(cut, own) * (1.0 / law.f);
      const Real per_strain = law.per_strain(p, step.length);
      const Real closed = law.crushed(line, rest) - law.crushed(before, rest_before);
      const Real D = min(Real(1.0), fma(closed, per_strain, damage));
      const Real rate = max(Real(1.0), step.strain * (1.0 / (step.dt * law.epsdot0)));
      const Real flow = law.f * law.strength(D, p, rate);
      const Real q = min(step.q, flow);  // this order keeps a NaN of the state
      const Real plastic = (step.q - q) * (1.0 / (3.0 * law.G));
      const Real after = min(Real(1.0), fma(plastic, per_strain, D));
      return {q,
              plastic,
              {own, Real(0.0)},
              cut,
              (mu + 1.0) * line.modulus,
              crush_heat(before, rest_before, line, rest, law.rho0),
              {after, reached},
              after >= Real(1.0)};
    }
  };
  template <class Real>
  KRATER_FORCE_INLINE Concrete<Real> at(const std::array<Real, 2>& state) const {
    return {*this, state[0], state[1]};
  }
};

}  // namespace krater::inline KRATER_ISA
