// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a damage law is given and what it gives (theory 4, 6, 7). Stresses are effective, those of
/// the undamaged area: Decision 10. A damage law has
///   template <class Real> Growth<Real> growth(const DamageDriver<Real>&) const
///   bool degrades() const    the stress is (1 - phi) s~; otherwise phi only tells the failure
///   double limit() const     phi_c: the point fails there
///   static constexpr bool reads_temperature
///   static constexpr bool needs_flow    false: it grows by Growth::source, the strength need not
///                                       yield (true where a law does not say)
#pragma once

#include "krater/core/lane_math.hpp"
#include "krater/core/tensor.hpp"
#include "krater/materials/law.hpp"
#include "krater/materials/returns/rate_return.hpp"

namespace krater::inline KRATER_ISA {

template <class Real>
struct DamageDriver {
  Sym3<Real> s;  ///< s~
  Real q;        ///< q~
  Real pressure;
  Real triaxiality;  ///< chi = -p~/max(q~, 1e-6 G)
  Real K, G;         ///< bulk modulus (theory 9) and shear modulus
  Real rate;         ///< equivalent strain rate of the step
  Real temperature;  ///< zero for laws that do not read it
  double dt = 0;     ///< [s], for damage that grows with time
};

/// A damage law that grows with plastic strain alone: it needs a strength that yields.
template <class Law>
inline constexpr bool needs_flow = true;
template <class Law>
requires requires { Law::needs_flow; }
inline constexpr bool needs_flow<Law> = Law::needs_flow;

/// Damage is less than this wherever it degrades: 1 - phi is divided by.
inline constexpr double kMostDamage = 0.999;

/// A parameter phi_c that may not exceed it; texts for `problem()`.
inline const char* most_damage_problem(double phi_c) {
  if (!(phi_c > 0)) return "phi_c must be positive";
  return phi_c <= kMostDamage ? nullptr : "phi_c may be 0.999 at most";
}

/// R_v = 3K/(3K+G) + 9G/(3K+G) chi^2: CCF (11).
template <class Real>
KRATER_FORCE_INLINE Real triaxiality_function(const DamageDriver<Real>& x) {
  const Real three_K = 3.0 * x.K;
  return fma(9.0 * x.G, x.triaxiality * x.triaxiality, three_K) / (three_K + x.G);
}

/// x^y for x >= 0: zero stays out of the logarithm. The order of operands lets a NaN through.
template <class Real>
KRATER_FORCE_INLINE Real damage_power(Real x, double y) {
  constexpr double nothing = 1e-100;
  return select(x <= Real(nothing), Real(0.0), exp(y * log(max(Real(nothing), x))));
}

}  // namespace krater::inline KRATER_ISA
