// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// ideal_gas:      p = (gamma - 1) rho e
/// stiffened_gas:  p = (gamma - 1) rho e - gamma p_inf
/// K_s = gamma (p + p_inf), theory 9. References: Harlow and Amsden, LA-4700, 1971; Menikoff and
/// Plohr, Rev. Mod. Phys. 61, 1989. The material starts at `initial_pressure` with the energy that
/// goes with it, e_0 = (p_0 + gamma p_inf)/((gamma - 1) rho0). A stiffened gas carries tension down
/// to -p_inf; it has no other limit here.
#pragma once

#include "krater/materials/eos/split.hpp"
#include "krater/materials/law.hpp"

namespace krater::inline KRATER_ISA {

template <bool stiff>
struct GasLaw {
  double gamma, p_inf, initial_pressure;
  double rho0, c0, initial_energy;

  static constexpr Family family = Family::eos;
  static constexpr const char* name = stiff ? "stiffened_gas" : "ideal_gas";
  static constexpr const char* equation =
      stiff ? "p = (gamma - 1) rho e - gamma p_inf" : "p = (gamma - 1) rho e";
  static constexpr const char* reference = stiff ? "Harlow and Amsden, LA-4700, 1971; Menikoff and "
                                                   "Plohr, Rev. Mod. Phys. 61, 1989"
                                                 : "ideal gas of constant specific heats";
  static constexpr ParameterInfo kGamma{"gamma", "1", Range::positive, kRequired,
                                        "ratio of specific heats, > 1"};
  static constexpr ParameterInfo kStart{
      "initial_pressure", "Pa", Range::non_negative, kRequired, "pressure at the start", "p0"};
  static constexpr ParameterInfo kStiffness{"p_inf",
                                            "Pa",
                                            Range::non_negative,
                                            kRequired,
                                            "stiffness: the pressure of the molecules' repulsion",
                                            "pinf"};

  void prepare(const MaterialConstants& constants) {
    rho0 = constants.density;
    initial_energy = (initial_pressure + gamma * p_inf) / ((gamma - 1.0) * rho0);
    c0 = sqrt(gamma * (initial_pressure + p_inf) / rho0);
  }
  /// e is all heat, e = c_v T (heating/internal_energy.hpp). A liquid's p_inf is a fit; its T is
  /// counted from the start.
  double thermal_energy() const requires(!stiff) { return initial_energy; }
  const char* problem() const {
    if (!(gamma > 1.0)) return "gamma must exceed 1";
    return initial_pressure + p_inf > 0.0 ? nullptr
                                          : "without pressure at the start there is no sound speed";
  }

  template <class Real>
  KRATER_FORCE_INLINE PressureSplit<Real> split(Real rho, Real) const {
    return {Real(-gamma * p_inf), (gamma - 1.0) * rho};
  }
  template <class Real>
  KRATER_FORCE_INLINE Real bulk_modulus(Real, Real, Real p, Real) const {
    return gamma * (p + p_inf);
  }
};

struct IdealGas : GasLaw<false> {
  static constexpr Parameter<IdealGas> parameters[] = {
      {kGamma, &IdealGas::gamma},
      {kStart, &IdealGas::initial_pressure},
  };
};
struct StiffenedGas : GasLaw<true> {
  static constexpr Parameter<StiffenedGas> parameters[] = {
      {kGamma, &StiffenedGas::gamma},
      {kStiffness, &StiffenedGas::p_inf},
      {kStart, &StiffenedGas::initial_pressure},
  };
};

}  // namespace krater::inline KRATER_ISA
