// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Compressible neo-Hooke solid, the whole stress from F (theory 5, for manufactured solutions):
///   sigma = lambda ln J / J I + G/J (F F^T - I),
///   W = G/2 (tr F F^T - 3) - G ln J + lambda/2 (ln J)^2 per reference volume.
/// Reference: Bonet and Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 2nd ed.,
/// 2008, chapter 6. Used without an equation of state. Assumes no damage and no heat: the internal
/// energy is the stored energy, so the work of an artificial viscosity, if the scene asks for one,
/// is not kept in it.
///
/// Signal speed: a small longitudinal wave along a principal direction of stretch l has
///   rho c_L^2 = [G (l^2 + 1) + lambda (1 - ln J)] / J,
/// and the largest eigenvalue l^2 of B = F F^T is bounded by its largest absolute row sum (exact at
/// rest). The bulk sound speed returned is the one that gives this c_L with the shear modulus G:
/// rho c^2 = rho c_L^2 - 4G/3.
#pragma once

#include "krater/core/lane_math.hpp"
#include "krater/core/tensor.hpp"
#include "krater/materials/law.hpp"

namespace krater::inline KRATER_ISA {

struct NeoHookean {
  double lame_lambda;
  double G;
  double rho0;

  static constexpr Family family = Family::strength;
  static constexpr const char* name = "neo_hookean";
  static constexpr const char* equation = "sigma = lambda ln J / J I + G/J (F F^T - I)";
  static constexpr const char* reference = "Bonet and Wood 2008, section 6.4.3";
  static constexpr bool needs_shear_modulus = true;
  static constexpr bool whole_stress = true;  ///< pressure and energy too: no equation of state
  static constexpr Parameter<NeoHookean> parameters[] = {
      {{"lame_lambda", "Pa", Range::non_negative, kRequired, "first Lame constant", "lambda"},
       &NeoHookean::lame_lambda},
  };

  void prepare(const MaterialConstants& constants) {
    G = constants.shear_modulus;
    rho0 = constants.density;
  }

  template <class Real>
  struct Response {
    Sym3<Real> s;   ///< deviator [Pa]
    Real pressure;  ///< [Pa]
    Real energy;    ///< W/rho0 [J/kg]
    Real modulus;   ///< rho c^2 [Pa]
  };

  double reference_modulus() const { return lame_lambda + 2.0 / 3.0 * G; }

  template <class Real>
  KRATER_FORCE_INLINE Response<Real> operator()(const Mat3<Real>& F) const {
    const Sym3<Real> B = product_transposed(F, F);
    const Real J = det(F);
    const Real per_J = Real(1.0) / J;
    const Real log_J = log(J);
    const Real excess = (B.xx - 1.0) + (B.yy - 1.0) + (B.zz - 1.0);  // tr B - 3
    const Real lambda_log = lame_lambda * log_J;
    const Real pressure = -per_J * fma(Real(G / 3.0), excess, lambda_log);
    const Real W = fma(Real(0.5 * G), excess, log_J * fma(Real(0.5), lambda_log, Real(-G)));
    const Real row = max(B.xx + (abs(B.xy) + abs(B.xz)),
                         max(B.yy + (abs(B.xy) + abs(B.yz)), B.zz + (abs(B.xz) + abs(B.yz))));
    const Real longitudinal = fma(Real(G), row + 1.0, lame_lambda - lambda_log) * per_J;
    return {G * per_J * dev(B), pressure, W * (1.0 / rho0), longitudinal - 4.0 / 3.0 * G};
  }
};

}  // namespace krater::inline KRATER_ISA
