// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// q_v = rho l (q_quad l (tr D)^2 - q_lin c tr D) for tr D < 0, else 0: theory 10, Decision 7 (CCF
/// (64) as printed has D_H, no sound speed and a reversed sign). l the cell size, c the bulk sound
/// speed of the last update. Reference: von Neumann and Richtmyer 1950 (quadratic), Landshoff 1955
/// (linear).
#pragma once

#include "krater/core/simd.hpp"
#include "krater/materials/law.hpp"

namespace krater::inline KRATER_ISA {

struct BulkViscosity {
  double q_lin, q_quad;

  static constexpr Family family = Family::viscosity;
  static constexpr const char* name = "linear_quadratic";
  static constexpr const char* equation =
      "q = rho h (q_quad h (tr D)^2 - q_lin c tr D) where tr D < 0, else 0";
  static constexpr const char* reference = "von Neumann and Richtmyer 1950; Landshoff 1955";
  static constexpr Parameter<BulkViscosity> parameters[] = {
      {{"q_lin", "1", Range::non_negative, 0.3, "linear coefficient (0.5 above 4 km/s)"},
       &BulkViscosity::q_lin},
      {{"q_quad", "1", Range::non_negative, 2.0, "quadratic coefficient"}, &BulkViscosity::q_quad},
  };

  void prepare(const MaterialConstants&) {}

  template <class Real>
  KRATER_FORCE_INLINE Real operator()(Real rho, Real c, Real tr_D, Real length) const {
    // -tr D where it is negative; max(0, x) keeps a NaN.
    const Real closing = max(Real(0.0), -tr_D);
    return rho * length * closing * fma(q_quad * length, closing, q_lin * c);
  }
};

}  // namespace krater::inline KRATER_ISA
