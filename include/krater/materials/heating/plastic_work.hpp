// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// dT = fraction q_{n+1} d / (rho_{n+1} cp): theory 8, CCF (47), Decision 4 (Cauchy stress).
/// Reference: Taylor and Quinney 1934. Counts plastic heat only: shock heating is not seen (`check`
/// warns above 2 km/s).
#pragma once

#include "krater/core/simd.hpp"
#include "krater/materials/law.hpp"

namespace krater::inline KRATER_ISA {

struct PlasticWorkHeating {
  double fraction, cp;
  double per_cp;  ///< fraction/cp [K kg/J]

  static constexpr Family family = Family::heating;
  static constexpr const char* name = "plastic_work";
  static constexpr const char* equation = "dT = fraction q d_eps / (rho cp)";
  static constexpr const char* reference =
      "Taylor and Quinney 1934; Zhou, Sha, Tamma, Miller, AIAA-2006-1758, eq. (47)";
  static constexpr Parameter<PlasticWorkHeating> parameters[] = {
      {{"fraction", "1", Range::fraction, 0.9, "part of plastic work that heats", "chi"},
       &PlasticWorkHeating::fraction},
      {{"cp", "J/(kg.K)", Range::positive, kRequired, "specific heat", "specific_heat"},
       &PlasticWorkHeating::cp},
  };

  void prepare(const MaterialConstants&) { per_cp = fraction / cp; }

  /// Temperature step for specific plastic work q d / rho [J/kg].
  template <class Real>
  KRATER_FORCE_INLINE Real operator()(Real plastic_work) const {
    return per_cp * plastic_work;
  }
};

}  // namespace krater::inline KRATER_ISA
