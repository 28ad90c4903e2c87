// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Concrete of Holmquist, Johnson and Cook. Pressure p, mu = rho/rho0 - 1 and strains positive in
/// compression; p* = p/f, T* = T/f, e* = rate of the whole deviatoric strain over epsdot0.
///
/// Pressure, from mu and the largest mu so far alone, never from the last p:
///   loading     K_el mu up to (mu_crush, p_crush);  a line to p_lock, where all pores are closed;
///               g(x) = K1 x + K2 x^2 + K3 x^3 beyond, x = (mu - mu_L)/(1 + mu_L), strain of grains
///   unloading   p = p_load(mu_max) - K_u (mu_max - mu), and up again on the same line;
///               K_u = K_el to mu_crush, then linear in mu_max to K_D = max(K1, g'(x))/(1 + mu_L)
///   tension     p >= -T (1 - D); the material parts there, pressure returns on closing only
/// `lock_strain: grain` (default) reads mu_lock = mu_L, the density of the grains over rho0, so the
/// crushing ends at mu_L + x_B (1 + mu_L) with g(x_B) = p_lock; `pressure` ends it at mu_lock. The
/// larger of K1 and g' is ours: the published K1 alone is shallower than the loading curve where
/// g' > K1 (cards of 20 and 44 MPa), and a closed cycle then makes energy.
///
/// Strength, with the pressure of the end of the step:
///   sigma* = min{ [A (1 - D) + B p*^N] (1 + C ln e*), S_max }       p* >= 0
///   sigma* = A <1 - D + p*/T*> (1 + C ln e*)                        p* < 0: zero at the cut
/// with e* >= 1: slow rates do not weaken. S_max caps after the rate. Rubble (D = 1) keeps its
/// friction B p*^N; it bears no tension, which is what `failed` says here.
///
/// Damage, by plastic strain and by crushing:
///   dD = (d eps_p + d mu_p)/eps_f,   eps_f = max(D1 (p* + T*)^D2, eps_f_min)
/// mu_p = mu_max - p_load(mu_max)/K_u is what stays after unloading; it counts up to the end of
/// crushing. The strength of a step sees the crushing of this step and the flow of the last ones:
/// explicit, first order in the step.
///
/// Assumptions: no energy in the pressure (crushing becomes heat by the work); elastic deviator
/// with constant G; no third invariant; no fracture energy, so softening in tension depends on the
/// cell. The sound speed is that of unloading, K_u, the stiffest line at every mu_max and
/// continuous in it.
/// References: Holmquist, Johnson, Cook, 14th Int. Symp. on Ballistics, Quebec 1993; constants of
/// 48 MPa concrete there.
#pragma once

#include <cmath>

#include "krater/core/lane_math.hpp"
#include "krater/materials/model/coupled.hpp"
#include "krater/materials/returns/softening.hpp"

namespace krater::inline KRATER_ISA {

struct HolmquistJohnsonCook {
  double f, A, B, N, C, epsdot0, S_max, D1, D2, eps_f_min, T;
  double p_crush, mu_crush, p_lock, mu_lock, lock_reading, K1, K2, K3;
  double rho0, c0, per_rho0, G;
  double K_el, mu_L, per_grain;  ///< 1/(1 + mu_L)
  double mu_pl;                  ///< where crushing ends
  double crush_slope, K_closed;  ///< of the crush line; K_u at its end
  double mu_p_most;              ///< mu_p at mu_pl

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
    K_el = p_crush / mu_crush;
    c0 = std::sqrt(K_el / rho0);
    const double x = locking_strain();
    const bool grain = lock_reading < 0.5;
    mu_L = grain ? mu_lock : (mu_lock - x) / (1.0 + x);
    mu_pl = grain ? mu_lock + x * (1.0 + mu_lock) : mu_lock;
    per_grain = 1.0 / (1.0 + mu_L);
    crush_slope = (p_lock - p_crush) / (mu_pl - mu_crush);
    K_closed = std::fmax(K1, grain_slope(x)) * per_grain;
    mu_p_most = mu_pl - p_lock / K_closed;
  }
  const char* problem() const {
    const double x = locking_strain();
    if (!(p_lock > p_crush)) return "lock_pressure must lie above crush_pressure";
    if (!std::isfinite(x) || std::fabs(grain(x) - p_lock) > 1e-9 * p_lock)
      return "K1, K2, K3 never reach lock_pressure";
    if (!(mu_pl > mu_crush)) return "lock_compression must lie above crush_compression";
    if (!(K_closed >= K_el))
      return "compact material may not be softer than crush_pressure/crush_compression";
    if (!(crush_slope <= K_el)) return "the crush line may not be steeper than the elastic one";
    return nullptr;
  }

  template <class Real>
  KRATER_FORCE_INLINE Real grain(Real x) const {
    return x * fma(x, fma(x, Real(K3), Real(K2)), Real(K1));
  }
  template <class Real>
  KRATER_FORCE_INLINE Real grain_slope(Real x) const {
    return fma(x, fma(x, Real(3.0 * K3), Real(2.0 * K2)), Real(K1));
  }
  /// x_B of g(x_B) = p_lock, by Newton from the linear part; NaN where there is none.
  double locking_strain() const {
    double x = p_lock / K1;
    for (int i = 0; i < 50; ++i) x -= (grain(x) - p_lock) / grain_slope(x);
    return x > 0 ? x : NAN;
  }

  /// The loading curve and the unloading line that leaves it there.
  template <class Real>
  struct Line {
    Real pressure, modulus;
  };
  template <class Real>
  KRATER_FORCE_INLINE Line<Real> line(Real mu_max) const {
    const Real x = (mu_max - mu_L) * per_grain;
    const Real share = (mu_max - mu_crush) * (1.0 / (mu_pl - mu_crush));
    const MaskOf<Real> elastic = mu_max <= Real(mu_crush), crushing = mu_max <= Real(mu_pl);
    const Real crush = fma(Real(crush_slope), mu_max - mu_crush, Real(p_crush));
    const Real partly = fma(share, Real(K_closed - K_el), Real(K_el));
    const Real compact = max(Real(K1), grain_slope(x)) * per_grain;
    return {select(elastic, K_el * mu_max, select(crushing, crush, grain(x))),
            select(elastic, Real(K_el), select(crushing, partly, compact))};
  }
  /// What stays of the compression after unloading from mu_max, up to the end of crushing.
  template <class Real>
  KRATER_FORCE_INLINE Real lasting(Real mu_max) const {
    const Line<Real> at = line(mu_max);
    return select(mu_max >= Real(mu_pl), Real(mu_p_most), mu_max - at.pressure / at.modulus);
  }
  /// sigma_Y/f, D and p* given, e* >= 1.
  template <class Real>
  KRATER_FORCE_INLINE Real strength(Real D, Real p, Real rate) const {
    const Real intact = Real(1.0) - D, faster = fma(Real(C), log(rate), Real(1.0));
    const Real friction = B * positive_power(max(Real(0.0), p), N);
    const Real pressed = min(Real(S_max), fma(Real(A), intact, friction) * faster);
    const Real pulled = A * max(Real(0.0), fma(p, Real(f / T), intact)) * faster;
    return select(p < Real(0.0), pulled, pressed);
  }
  template <class Real>
  KRATER_FORCE_INLINE Real fracture_strain(Real p) const {
    return max(Real(eps_f_min), D1 * positive_power(max(Real(0.0), p + T / f), D2));
  }

  /// The law at a state.
  template <class Real>
  struct Concrete {
    const HolmquistJohnsonCook& law;
    Real damage, mu_max;

    KRATER_FORCE_INLINE CoupledUpdate<Real, 2> update(const CoupledStep<Real>& step) const {
      const Real mu = (step.rho - law.rho0) * law.per_rho0;
      const Real reached = max(mu, mu_max);  // this order keeps a NaN of the state
      const Line<Real> line = law.line(reached);
      const Real own = fnma(line.modulus, reached - mu, line.pressure);
      // p* enters the fracture strain, and the cut of p enters p*: the damage of the start.
      const Real cut = -law.T * (Real(1.0) - damage), p = max(cut, own) * (1.0 / law.f);
      const Real per_strain = Real(1.0) / law.fracture_strain(p);
      const Real closed = law.lasting(reached) - law.lasting(mu_max);
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
