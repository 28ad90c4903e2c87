// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Ceramic and glass of Johnson and Holmquist, second law. p, mu = rho/rho0 - 1 positive in
/// compression; p* = p/P_HEL, T* = T/P_HEL, e* = rate of the whole deviatoric strain over epsdot0,
/// sigma_HEL = 3/2 (HEL - P_HEL):
///   intact       sigma*_i = A <p* + T*>^N (1 + C ln e*)
///   fractured    sigma*_f = min[ B <p*>^M (1 + C ln e*), S_f ]
///   strength     sigma = sigma_HEL [ (1 - D) sigma*_i + D sigma*_f ],  0 for p* <= -T*
///   damage       dD = d eps_p/eps_f,  eps_f = D1 <p* + T*>^D2; at once where that is 0
///   pressure     p = K1 mu + K2 mu^2 + K3 mu^3 + dP,  K1 mu + dP for mu < 0;  p >= -T (1 - D)
/// e* >= 1: slow rates do not weaken.
///
/// Bulking: elastic energy of shear that fracture sets free, beta of it, becomes pressure,
///   dU = [Y(p, D_old)^2 - Y(p, D_new)^2]/(6G)
///   dP <- -K1 mu + sqrt{ (K1 mu + dP)^2 + 2 beta K1 dU }
/// at the same p (ours: the yield stresses of two steps would mix the change of pressure into it),
/// for mu > 0, and used from the next step on. The strength of a step is that of the damage of its
/// start: explicit, first order in the step.
///
/// Assumptions: elastic deviator with constant G; no energy in the pressure; no fracture energy.
/// Reference: Johnson, Holmquist, High-Pressure Science and Technology 1993, AIP 1994, 981-984.
#pragma once

#include <cmath>

#include "krater/core/lane_math.hpp"
#include "krater/materials/model/coupled.hpp"
#include "krater/materials/returns/softening.hpp"

namespace krater::inline KRATER_ISA {

struct JohnsonHolmquist2 {
  double A, B, C, M, N, epsdot0, T, S_f, HEL, P_HEL, D1, D2, K1, K2, K3, beta;
  double rho0, c0, per_rho0, G, sigma_HEL, per_P;

  static constexpr Family family = Family::model;
  static constexpr const char* name = "johnson_holmquist_2";
  static constexpr const char* equation =
      "sigma = sigma_HEL [(1 - D) A (p* + T*)^N + D B p*^M] (1 + C ln e*); dD = d eps_p/(D1 (p* + "
      "T*)^D2); p = K1 mu + K2 mu^2 + K3 mu^3 + dP(bulking); p >= -T (1 - D)";
  static constexpr const char* reference =
      "Johnson, Holmquist, High-Pressure Science and Technology 1993, AIP 1994, 981-984";
  static constexpr bool needs_shear_modulus = true;
  static constexpr bool fails = true;
  using Law = JohnsonHolmquist2;
  static constexpr Parameter<Law> parameters[] = {
      {{"A", "1", Range::positive, kRequired, "intact: factor"}, &Law::A},
      {{"N", "1", Range::positive, kRequired, "intact: power of p* + T*"}, &Law::N},
      {{"B", "1", Range::non_negative, kRequired, "fractured: factor"}, &Law::B},
      {{"M", "1", Range::positive, kRequired, "fractured: power of p*"}, &Law::M},
      {{"C", "1", Range::non_negative, 0.0, "rate sensitivity"}, &Law::C},
      {{"epsdot0", "1/s", Range::positive, 1.0, "reference rate", "EPS0"}, &Law::epsdot0},
      {{"tensile_strength", "Pa", Range::positive, kRequired, "T: largest mean tension", "T"},
       &Law::T},
      {{"fractured_max", "1", Range::non_negative, 1e6,
        "S_f: largest fractured strength over sigma_HEL; default: no limit", "SFMAX"},
       &Law::S_f},
      {{"HEL", "Pa", Range::positive, kRequired, "Hugoniot elastic limit"}, &Law::HEL},
      {{"P_HEL", "Pa", Range::positive, kRequired, "pressure at it", "PHEL"}, &Law::P_HEL},
      {{"D1", "1", Range::non_negative, kRequired, "fracture strain: factor; 0: at first yield"},
       &Law::D1},
      {{"D2", "1", Range::non_negative, 1.0, "fracture strain: power of p* + T*"}, &Law::D2},
      {{"K1", "Pa", Range::positive, kRequired, "pressure: linear"}, &Law::K1},
      {{"K2", "Pa", Range::any, 0.0, "pressure: quadratic"}, &Law::K2},
      {{"K3", "Pa", Range::any, 0.0, "pressure: cubic"}, &Law::K3},
      {{"beta", "1", Range::fraction, 1.0, "share of the freed shear energy that bulks"},
       &Law::beta},
  };

  struct Bulking {
    static constexpr FieldInfo info{"bulking_pressure", "Pa", 1, "pressure of the fractured bulk"};
  };
  using State = Columns<field::Damage, Bulking>;
  std::array<double, 2> initial_state() const { return {0.0, 0.0}; }

  void prepare(const MaterialConstants& constants) {
    rho0 = constants.density;
    per_rho0 = 1.0 / rho0;
    G = constants.shear_modulus;
    c0 = std::sqrt(K1 / rho0);
    sigma_HEL = 1.5 * (HEL - P_HEL);
    per_P = 1.0 / P_HEL;
  }
  const char* problem() const {
    if (!(HEL > P_HEL)) return "HEL must exceed P_HEL: they differ by 2/3 of the strength there";
    // Cards of mixed units: K2 in GPa beside K1 in MPa lies here by a factor of a thousand.
    constexpr double largest_mu = 0.3;
    for (int i = 0; i <= 30; ++i) {
      const double mu = largest_mu * i / 30.0;
      if (!(K1 + 2.0 * K2 * mu + 3.0 * K3 * mu * mu > 0))
        return "K1, K2, K3: the pressure falls with compression below mu = 0.3";
    }
    return nullptr;
  }

  /// sigma_Y [Pa] of damage D at p* given, `faster` = 1 + C ln e*.
  template <class Real>
  struct Strength {
    Real intact, fractured;
    KRATER_FORCE_INLINE Real at(Real D) const { return fma(D, fractured - intact, intact); }
  };
  template <class Real>
  KRATER_FORCE_INLINE Strength<Real> strength(Real p, Real faster) const {
    const Real above = max(Real(0.0), p + T * per_P), pressed = max(Real(0.0), p);
    const Real broken = min(Real(S_f), B * positive_power(pressed, M) * faster);
    // In tension the fractured material bears nothing and the intact one falls to zero at -T.
    return {sigma_HEL * A * positive_power(above, N) * faster, sigma_HEL * broken};
  }
  template <class Real>
  KRATER_FORCE_INLINE Real fracture_strain(Real p) const {
    return D1 * positive_power(max(Real(0.0), p + T * per_P), D2);
  }

  template <class Real>
  struct Ceramic {
    const JohnsonHolmquist2& law;
    Real damage, bulking;

    KRATER_FORCE_INLINE CoupledUpdate<Real, 2> update(const CoupledStep<Real>& step) const {
      const Real mu = (step.rho - law.rho0) * law.per_rho0, pressed = max(Real(0.0), mu);
      const Real curved = pressed * pressed * fma(pressed, Real(law.K3), Real(law.K2));
      const Real own = fma(Real(law.K1), mu, curved) + bulking;
      const Real cut = -law.T * (Real(1.0) - damage), p = max(cut, own) * law.per_P;
      const Real rate = max(Real(1.0), step.strain * (1.0 / (step.dt * law.epsdot0)));
      const auto strength = law.strength(p, fma(Real(law.C), log(rate), Real(1.0)));
      const Real flow = strength.at(damage);
      const Real q = min(step.q, flow);  // this order keeps a NaN of the state
      const Real plastic = (step.q - q) * (1.0 / (3.0 * law.G));
      const Real eps_f = law.fracture_strain(p);
      // Growth is at most 1: a division by a tiny strain is kept out.
      const Real grown = select(plastic >= eps_f, select(plastic > Real(0.0), Real(1.0), plastic),
                                plastic / eps_f);
      const Real after = min(Real(1.0), damage + grown);
      return {q,
              plastic,
              {own, Real(0.0)},
              cut,
              (mu + 1.0) *
                  fma(pressed, fma(pressed, Real(3.0 * law.K3), Real(2.0 * law.K2)), Real(law.K1)),
              Real(0.0),
              {after, bulked(mu, flow, strength.at(after))},
              after >= Real(1.0)};
    }
    /// dP after the strength fell from `from` to `to` at one pressure.
    KRATER_FORCE_INLINE Real bulked(Real mu, Real from, Real to) const {
      const Real freed = max(Real(0.0), fms(from, from, to * to)) * (1.0 / (6.0 * law.G));
      const Real linear = law.K1 * mu, now = linear + bulking;
      const Real then = sqrt(fma(now, now, 2.0 * law.beta * law.K1 * freed)) - linear;
      return select((mu > Real(0.0)) & (freed > Real(0.0)), then, bulking);
    }
  };
  template <class Real>
  KRATER_FORCE_INLINE Ceramic<Real> at(const std::array<Real, 2>& state) const {
    return {*this, state[0], state[1]};
  }
};

}  // namespace krater::inline KRATER_ISA
