// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// p = K mu, mu = rho/rho0 - 1: theory 9. Barotropic: the energy carries no pressure,
/// K_s = K rho/rho0. For elastic problems and weak compression.
#pragma once

#include "krater/materials/eos/split.hpp"
#include "krater/materials/law.hpp"

namespace krater::inline KRATER_ISA {

struct LinearEos {
  double K;
  double rho0, c0;
  double per_rho0;

  static constexpr Family family = Family::eos;
  static constexpr bool barotropic = true;
  static constexpr const char* name = "linear";
  static constexpr const char* equation = "p = K (rho/rho0 - 1)";
  static constexpr const char* reference = "Hooke's law for the pressure";
  static constexpr Parameter<LinearEos> parameters[] = {
      {{"bulk_modulus", "Pa", Range::positive, kRequired, "bulk modulus", "K"}, &LinearEos::K},
  };

  void prepare(const MaterialConstants& constants) {
    rho0 = constants.density;
    per_rho0 = 1.0 / rho0;
    c0 = sqrt(K / rho0);
  }

  template <class Real>
  KRATER_FORCE_INLINE PressureSplit<Real> split(Real rho, Real) const {
    return {K * ((rho - rho0) * per_rho0), Real(0.0)};
  }
  template <class Real>
  KRATER_FORCE_INLINE Real bulk_modulus(Real rho, Real, Real, Real) const {
    return K * (rho * per_rho0);
  }
};

}  // namespace krater::inline KRATER_ISA
