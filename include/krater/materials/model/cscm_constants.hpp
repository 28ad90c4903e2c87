// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The two public sets of constants of the continuous surface cap model, of concrete of strength f
/// (cscm.hpp says which is used where), and its shear surface. P = A f^2 + B f + C, f and stresses
/// in MPa as the sources have them, in Pa here:
///   fhwa   FHWA's polynomials, fitted at 28 to 46 MPa: unconfined concrete breaks at f within
///          2.5 % there, because the cap acts in that test
///   rev3   a refit of FHWA's (revision 3): closes where the cap does not act
/// The coefficients of the rates take f in psi: with MPa they are three times and 0.8 of
/// themselves, which a public generator gets wrong.
/// References: Murray, FHWA-HRT-05-062, 2007 (sets and equations read in public decks and a public
/// generator; the report's tables were not at hand).
#pragma once

#include <cmath>

#include "krater/materials/returns/cap_return.hpp"

namespace krater::inline KRATER_ISA {

/// F_f = alpha - lambda exp(-beta J1) + theta J1 [Pa], at most `most`.
struct CscmSurface {
  double alpha, lambda, beta, theta, most, shape, apex;

  template <class Real>
  KRATER_FORCE_INLINE CapSurface<Real> at(Real J1) const {
    const Real bent = lambda * exp(-beta * J1);
    const Real F = fma(Real(theta), J1, alpha - bent), slope = fma(Real(beta), bent, Real(theta));
    const MaskOf<Real> limited = F > Real(most);
    return {select(limited, Real(most), F), select(limited, Real(0.0), slope),
            select(limited, Real(0.0), -beta * beta * bent)};
  }
  /// J1 of F_f = 0: Newton from the far side of a concave function rises to it.
  void find_apex() {
    double J1 = -alpha / theta;
    for (int i = 0; i < 200; ++i) {
      const double bent = lambda * std::exp(-beta * J1);
      J1 -= (alpha - bent + theta * J1) / (beta * bent + theta);
    }
    apex = J1;
  }
};

/// Tensile over compressive strength at a pressure: 1/2 where J1 < 0.
struct CscmMeridian {
  double alpha, lambda, beta, theta;
  template <class Real>
  KRATER_FORCE_INLINE Real operator()(Real J1) const {
    const Real pressed = max(Real(0.0), J1);
    const Real ratio = fma(Real(theta), pressed, alpha - lambda * exp(-beta * pressed));
    return select(J1 < Real(0.0), Real(0.5), clamp(ratio, Real(0.5), Real(1.0)));
  }
};

/// eta = base/rate^power of compression and tension [s], and the largest overstress [Pa].
struct CscmRates {
  double base_c, power_c, base_t, power_t, overstress;
};

struct CscmConstants {
  CscmSurface shear;
  CscmMeridian meridian;
  CapHardening cap;
  CscmRates rates;
  double E, nu;

  /// `refit`: revision 3.
  static CscmConstants of(double f_Pa, bool refit) {
    constexpr double MPa = 1e6;
    const double f = f_Pa / MPa;
    CscmConstants c = refit ? revision_3(f) : fhwa(f);
    c.rates = rates_of(f);
    c.E = 18.275e9 * std::cbrt(f / 10.0);
    c.nu = 0.15;
    c.shear.most = 1e30;
    c.shear.find_apex();
    return c;
  }

 private:
  static double quadratic(double f, double A, double B, double C) { return (A * f + B) * f + C; }

  static CscmConstants fhwa(double f) {
    constexpr double MPa = 1e6;
    const double bent = quadratic(f, -1.9972e-5, 2.2655e-4, 8.2748e-2);
    return {{quadratic(f, -0.003, 0.3169747, 7.7047) * MPa, 10.5 * MPa, 0.01929 / MPa,
             quadratic(f, 1.3216e-5, 2.3548e-3, 0.2140058), 0.0, 5.0, 0.0},
            {0.66, 0.16, bent / MPa, quadratic(f, -4.8697e-7, -1.8883e-6, 1.8822e-3) / MPa},
            {0.05, 2.5e-4 / MPa, 3.49e-7 / (MPa * MPa),
             quadratic(f, 8.769178e-3, -7.3302306e-2, 84.85) * MPa},
            {},
            0.0,
            0.0};
  }
  static CscmConstants revision_3(double f) {
    constexpr double MPa = 1e6;
    const double lambda2 = 0.30029 * std::pow(f, -0.042269);
    return {{quadratic(f, 2.5801e-3, 0.16405, 0.43506) * MPa, 3.022e-3 * std::pow(f, 2.0231) * MPa,
             12.317 * std::pow(f, -1.5974) / MPa, quadratic(f, -3.4286e-6, -3.7971e-4, 0.35436),
             0.0, quadratic(f, 5e-4, -0.059, 3.66), 0.0},
            {0.5 + lambda2, lambda2, 0.28898 * std::pow(f, -0.94776) / MPa, 0.0},
            {0.065, 6.11e-4 / MPa, 2.225e-6 / (MPa * MPa), (4.0224 * f - 70.784) * MPa},
            {},
            0.0,
            0.0};
  }
  static CscmRates rates_of(double f) {
    constexpr double MPa = 1e6, psi = 145.037738;  // psi in a MPa
    const double g = f * psi;
    return {quadratic(g, 1.2772337e-11, -1.0613722e-7, 3.203497e-4), 0.78,
            quadratic(g, 8.0614774e-13, -9.77736719e-10, 5.0752351e-5), 0.48,
            quadratic(f, 1.309663e-2, -0.3927659, 21.45) * MPa};
  }
};

}  // namespace krater::inline KRATER_ISA
