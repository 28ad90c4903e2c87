// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file materials/scalar_eos.hpp
/// An equation of state of the catalogue as functions of one state at a time, and the states behind
/// a steady shock into material at rest:
///   mass      rho0 Us = rho (Us - up)
///   momentum  p - p0 = rho0 Us up
///   energy    e - e0 = (p + p0)(1/rho0 - 1/rho)/2
/// The functions are the laws' own, those that the stages apply to batches; nothing is evaluated
/// twice. Assumption: a fluid (no deviator), one shock, no phase transition. A law with history is
/// taken on first loading from its state at the start.
#include <memory>

#include "krater/materials/stage.hpp"

namespace krater {

class ScalarEos {
 public:
  virtual ~ScalarEos() = default;
  /// [Pa], of density [kg/m^3] and specific internal energy [J/kg].
  virtual double pressure(double rho, double e) const = 0;
  virtual double bulk_modulus(double rho, double e) const = 0;  ///< isentropic K_s [Pa]
  virtual bool beyond_pole(double rho) const = 0;  ///< p_H is continued past its pole there

  double rho0 = 0;  ///< at rest [kg/m^3] ...
  double c0 = 0;    ///< [m/s] bulk sound speed
  double e0 = 0;    ///< [J/kg]
  double p0 = 0;    ///< [Pa]
};

/// `law`: index in catalogue() of a law of the family eos; `values`: its parameters.
std::unique_ptr<ScalarEos> make_scalar_eos(int law, const double* values,
                                           const MaterialConstants& constants);

struct ShockState {
  double particle_speed;  ///< up [m/s]
  double shock_speed;     ///< Us [m/s]
  double pressure, density, energy;
  double sound_speed;  ///< bulk, behind the shock [m/s]
};

/// The state of a particle speed [m/s] >= 0, to the last bits of the density. Throws InputError
/// where the law has none.
ShockState behind_shock(const ScalarEos& eos, double particle_speed);
/// The state of a density [kg/m^3] >= rho0. Throws InputError where the law has none: below rho0,
/// or beyond the greatest compression that a single shock can reach.
ShockState shocked_to_density(const ScalarEos& eos, double density);

}  // namespace krater
