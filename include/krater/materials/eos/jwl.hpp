// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Detonation products, V = rho0/rho:
///   p = A (1 - omega/(R1 V)) e^(-R1 V) + B (1 - omega/(R2 V)) e^(-R2 V) + omega rho e
///   K_s = sum_i A_i e^(-R_i V) (R_i V - omega - omega/(R_i V)) + omega rho e + omega p
/// Theory 9. Reference: Lee, Hornig, Kury, UCRL-50422, 1968; form as in Menikoff, LA-UR-15-29536,
/// 2017, with the energy of detonation in e: the material starts burnt, at rho0 and e_0 = E0/rho0
/// (explosion at constant volume). No burn front.
#pragma once

#include "krater/core/lane_math.hpp"
#include "krater/materials/eos/split.hpp"
#include "krater/materials/law.hpp"

namespace krater::inline KRATER_ISA {

struct Jwl {
  double A, B, R1, R2, omega, E0;
  double rho0, c0, initial_energy;

  static constexpr Family family = Family::eos;
  static constexpr const char* name = "jwl";
  static constexpr const char* equation =
      "p = A (1 - omega/(R1 V)) exp(-R1 V) + B (1 - omega/(R2 V)) exp(-R2 V) + omega rho e, "
      "V = rho0/rho, e = E0/rho0 at the start";
  static constexpr const char* reference =
      "Lee, Hornig, Kury, UCRL-50422, 1968; Menikoff, LA-UR-15-29536, 2017";
  static constexpr Parameter<Jwl> parameters[] = {
      {{"A", "Pa", Range::positive, kRequired, "first factor"}, &Jwl::A},
      {{"B", "Pa", Range::any, kRequired, "second factor"}, &Jwl::B},
      {{"R1", "1", Range::positive, kRequired, "first exponent"}, &Jwl::R1},
      {{"R2", "1", Range::positive, kRequired, "second exponent"}, &Jwl::R2},
      {{"omega", "1", Range::positive, kRequired, "Grueneisen parameter"}, &Jwl::omega},
      {{"E0", "Pa", Range::non_negative, kRequired, "energy of detonation per reference volume"},
       &Jwl::E0},
  };

  void prepare(const MaterialConstants& constants) {
    rho0 = constants.density;
    initial_energy = E0 / rho0;
    const double v0 = 1.0 / rho0;
    const PressureSplit<double> start = split(rho0, v0);
    const double p = fma(start.thermal, initial_energy, start.cold);
    c0 = sqrt(bulk_modulus(rho0, v0, p, initial_energy) * v0);
  }
  /// At the start, over the cold curve int -p_cold dv: e = e_cold(v) + c_v T (Menikoff, eq. 5).
  double thermal_energy() const {
    return initial_energy - (A / R1 * exp(-R1) + B / R2 * exp(-R2)) / rho0;
  }
  const char* problem() const {
    return c0 > 0.0 ? nullptr : "these constants give no sound speed at rho0";
  }

  template <class Real>
  KRATER_FORCE_INLINE PressureSplit<Real> split(Real rho, Real v) const {
    const Real per_V = rho * (1.0 / rho0);
    const Real V = rho0 * v;
    const Real first = A * fnma(Real(omega / R1), per_V, Real(1.0)) * exp(-R1 * V);
    const Real second = B * fnma(Real(omega / R2), per_V, Real(1.0)) * exp(-R2 * V);
    return {first + second, omega * rho};
  }
  template <class Real>
  KRATER_FORCE_INLINE Real bulk_modulus(Real rho, Real v, Real p, Real e) const {
    const Real per_V = rho * (1.0 / rho0);
    const Real V = rho0 * v;
    const Real first = A * exp(-R1 * V) * fnma(Real(omega / R1), per_V, R1 * V - omega);
    const Real second = B * exp(-R2 * V) * fnma(Real(omega / R2), per_V, R2 * V - omega);
    return (first + second) + omega * fma(rho, e, p);
  }
};

}  // namespace krater::inline KRATER_ISA
