// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What an equation of state gives the energy update (Algorithm 1, theory 9): p = A + B rho e,
/// linear in e. A law has `template <class Real>`
///   PressureSplit<Real> split(Real rho, Real v) const                  A and B rho
///   Real bulk_modulus(Real rho, Real v, Real p, Real e) const          isentropic K_s, Decision 5
/// with v = 1/rho, which is at hand and saves divisions; doubles rho0 and c0, the reference density
/// and bulk sound speed; and, if it has a pole that it continues past,
///   MaskOf<Real> beyond_pole(Real rho) const                           counted by the stage
#pragma once

#include "krater/core/simd.hpp"

namespace krater::inline KRATER_ISA {

template <class Real>
struct PressureSplit {
  Real cold;     ///< A [Pa]
  Real thermal;  ///< B rho = dp/de at constant rho [kg/m^3]
};

}  // namespace krater::inline KRATER_ISA
