// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What an equation of state gives the energy update (Algorithm 1, theory 9): p = A + B rho e,
/// linear in e. A law has `template <class Real>`
///   PressureSplit<Real> split(Real rho, Real v) const                  A and B rho
/// or, where p is not linear in e,
///   PressureSplit<Real> tangent(Real rho, Real v, Real e) const        of p at e, by dp/de > 0
/// and
///   Real bulk_modulus(Real rho, Real v, Real p, Real e) const          isentropic K_s, Decision 5
/// with v = 1/rho, which is at hand and saves divisions; doubles rho0 and c0, the reference density
/// and bulk sound speed; and, if it has a pole that it continues past,
///   MaskOf<Real> beyond_pole(Real rho) const                           counted by the stage
/// A material that is not at p = e = 0 at the start has a double initial_energy; a law without B
/// has `static constexpr bool barotropic = true`.
/// A law with history (materials/law_state.hpp) gives these functions by `at(state)`, and
///   std::array<Real, N> after(Real rho, Real v, Real e) const          the state at the end
#pragma once

#include "krater/core/simd.hpp"
#include "krater/materials/law_state.hpp"

namespace krater::inline KRATER_ISA {

template <class Real>
struct PressureSplit {
  Real cold;     ///< A [Pa]
  Real thermal;  ///< B rho = dp/de at constant rho [kg/m^3]
};

/// Share of its cold tension that a solid still carries at x = rho/rho0: all down to 0.8, none from
/// 0.5 on, where it has parted; smooth in between, so p and c^2 have no jump. Cold curves are
/// fitted in compression; carried on to the gas they would leave a vapour of 1e-4 of the density
/// with a tension of the size of the bulk modulus. The work up to there is near the heat of
/// vaporisation (aluminium, A = 75 GPa: 4 MJ/kg). No metal is known to reach 0.8 (ideal strengths
/// lie at 0.85 to 0.95); codes with this law cut the tension off in expanded states likewise
/// (Brundage, Procedia Engineering 58, 2013).
template <class Real>
struct Cohesion {
  Real share;
  Real by_x;  ///< slope
};
template <class Real>
KRATER_FORCE_INLINE Cohesion<Real> cohesion(Real x) {
  constexpr double whole = 0.8, parted = 0.5;
  const Real t = clamp((x - parted) * (1.0 / (whole - parted)), Real(0.0), Real(1.0));
  return {t * t * fnma(Real(2.0), t, Real(3.0)),
          Real(6.0 / (whole - parted)) * (t * (Real(1.0) - t))};
}

/// An equation of state that is a line in e at every density.
template <class Law>
concept LinearInEnergy = requires(const Law& law) {
  law.split(1.0, 1.0);
};

/// An equation of state that does not need e.
template <class Law>
concept Barotropic = requires {
  requires Law::barotropic;
};

/// p = cold + thermal e near e.
template <class Law, class Real>
KRATER_FORCE_INLINE PressureSplit<Real> split_at(const Law& law, Real rho, Real v, Real e) {
  if constexpr (LinearInEnergy<Law>) {
    return law.split(rho, v);
  } else {
    return law.tangent(rho, v, e);
  }
}
template <class Law, class Real>
KRATER_FORCE_INLINE Real pressure_at(const Law& law, Real rho, Real v, Real e) {
  const PressureSplit<Real> split = split_at(law, rho, v, e);
  return fma(split.thermal, e, split.cold);
}

/// What holds the heat of a law with history: the solid of a porous material, the products of an
/// explosive; else the law itself.
template <class Law>
KRATER_FORCE_INLINE const auto& matter_of(const Law& law) {
  if constexpr (requires { law.solid; }) {
    return law.solid;
  } else if constexpr (requires { law.products; }) {
    return law.products;
  } else {
    return law;
  }
}

/// State of a new point.
template <class Law>
KRATER_FORCE_INLINE double energy_at_start(const Law& law) {
  if constexpr (requires { law.initial_energy; }) {
    return law.initial_energy;
  } else {
    return 0.0;
  }
}
template <class Law>
KRATER_FORCE_INLINE double pressure_at_start(const Law& law) {
  return pressure_at(at_start(law), law.rho0, 1.0 / law.rho0, energy_at_start(law));
}

/// Whether the pressure of this matter knows its energy; that of most models does not.
template <class Matter>
bool feels_energy(const Matter& law) {
  if constexpr (LinearInEnergy<Matter> || requires { law.tangent(1.0, 1.0, 0.0); }) {
    const double rho = 1.2 * law.rho0;  // where a law of tension alone would differ
    return split_at(law, rho, 1.0 / rho, energy_at_start(law)).thermal > 0.0;
  } else {
    return false;
  }
}

}  // namespace krater::inline KRATER_ISA
