// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Failure without degradation before it; phi is the used part of the limit.
///   cockcroft_latham        int <sigma_1> d eps = W_c, sigma_1 the largest principal stress
///   maximum_plastic_strain  eps = eps_max
/// Reference: Cockcroft and Latham 1968.
#pragma once

#include "krater/materials/damage/driver.hpp"

namespace krater::inline KRATER_ISA {

/// Largest principal value of a deviator: the largest root of t^3 - J2 t - J3 = 0. Newton from
/// 2 sqrt(J2/3), which is never to its left, descends to it. A double root (uniaxial compression)
/// is approached linearly: half the error per step.
template <class Real>
KRATER_FORCE_INLINE Real largest_principal(const Sym3<Real>& s) {
  constexpr int cap = 60;
  const Real J2 = 0.5 * contract(s, s), J3 = det(s);
  Real t = 2.0 * sqrt(J2 * (1.0 / 3.0));
  MaskOf<Real> active = t > Real(0.0);
  for (int i = 0; i < cap && any(active); ++i) {
    const Real value = fms(fma(t, t, -J2), t, J3), slope = fma(3.0 * t, t, -J2);
    const Real step = select(slope > Real(0.0), value / slope, Real(0.0));
    t = select(active, t - step, t);
    active = active & (step > 1e-14 * t);
  }
  return t;
}

struct CockcroftLatham {
  double W_c;

  static constexpr Family family = Family::damage;
  static constexpr const char* name = "cockcroft_latham";
  static constexpr const char* equation = "failure at int max(sigma_1, 0) d eps = W_c";
  static constexpr const char* reference = "Cockcroft and Latham 1968";
  static constexpr bool reads_temperature = false;
  static constexpr Parameter<CockcroftLatham> parameters[] = {
      {{"W_c", "Pa", Range::positive, kRequired, "plastic work of the largest tension at failure"},
       &CockcroftLatham::W_c},
  };
  void prepare(const MaterialConstants&) {}
  bool degrades() const { return false; }
  double limit() const { return 1.0; }

  template <class Real>
  KRATER_FORCE_INLINE Growth<Real> growth(const DamageDriver<Real>& x) const {
    const Real tension = max(Real(0.0), largest_principal(x.s) - x.pressure);
    return {tension * (1.0 / W_c), Real(0.0), Real(1.0)};
  }
};

struct MaximumPlasticStrain {
  double eps_max;

  static constexpr Family family = Family::damage;
  static constexpr const char* name = "maximum_plastic_strain";
  static constexpr const char* equation = "failure at eps = eps_max";
  static constexpr const char* reference = "the plainest criterion: a limit of plastic strain";
  static constexpr bool reads_temperature = false;
  static constexpr Parameter<MaximumPlasticStrain> parameters[] = {
      {{"eps_max", "1", Range::positive, kRequired, "plastic strain at failure"},
       &MaximumPlasticStrain::eps_max},
  };
  void prepare(const MaterialConstants&) {}
  bool degrades() const { return false; }
  double limit() const { return 1.0; }

  template <class Real>
  KRATER_FORCE_INLINE Growth<Real> growth(const DamageDriver<Real>&) const {
    return {Real(1.0 / eps_max), Real(0.0), Real(1.0)};
  }
};

}  // namespace krater::inline KRATER_ISA
