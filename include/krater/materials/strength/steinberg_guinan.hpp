// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Rate-independent strength above 1e5 /s, with shear modulus and yield that grow with pressure and
/// fall with heat, x = rho/rho0:
///   G = G0 [1 + A p x^(-1/3) - B (T - 300 K)]
///   sigma_Y = min(Y0 (1 + beta (eps + eps_i))^n, Y_max) [1 + r A p x^(-1/3) - B (T - 300 K)]
///   T_m = T_melt exp(2a (1 - 1/x)) x^(2 (gamma0 - a - 1/3));  no strength at T >= T_m
/// Theory 5; A = G'_p/G0, B = -G'_T/G0, r = (Y'_p/Y0)/(G'_p/G0), 1 unless told (Steinberg's own
/// choice for want of data). Reference: Steinberg, Cochran, Guinan, J. Appl. Phys. 51, 1498, 1980;
/// melting: Steinberg, UCRL-MA-106439, 1996.
///
/// **A changing G.** The stage evaluates G once a step, at the start-of-step pressure, density and
/// temperature, and uses it on both sides of the step: b_e is read from s_n/G and the trial is
/// G dev(f b_e f^T). So the stored state is the stress; when G has changed since the last step the
/// stress is kept and the elastic strain re-read, which is the rate form ds/dt = 2G(p, T) D of the
/// reference. Keeping the strain instead (s scaled by G_{n+1}/G_n) would close cycles of strain but
/// move a point off its yield surface without flow, and would take the energy of the stiffening
/// from heat. Either way a cycle of shear and compression does not close by itself: the missing
/// term is a pressure v d(s:s/4G)/dv, of order G'_p (K/G) s:s/(4G), below 1 % of s, which the
/// reference neglects too. The total energy is untouched: Algorithm 1 books the work of the
/// stresses carried; only its split into elastic s:s/(4G rho) and the rest follows G.
#pragma once

#include "krater/materials/law.hpp"
#include "krater/materials/returns/flow.hpp"
#include "krater/materials/returns/softening.hpp"

namespace krater::inline KRATER_ISA {

struct SteinbergGuinan {
  double Y0, Y_max, beta, n, eps_i, A, B, r, T_melt, a, gamma0;
  double G0;
  double eps_cap;  ///< plastic strain at which hardening ends

  /// Least G/G0: s/G must stay meaningful in a melt, whose stress is zero by its yield.
  static constexpr double softest = 1e-3;

  static constexpr Family family = Family::strength;
  static constexpr const char* name = "steinberg_guinan";
  static constexpr const char* equation =
      "sigma_Y = min(Y0 (1 + beta (eps + eps_i))^n, Y_max) (1 + r A p x^(-1/3) - B (T - 300 K)), "
      "G = G0 (1 + A p x^(-1/3) - B (T - 300 K)), x = rho/rho0; "
      "zero at T >= T_melt exp(2a (1 - 1/x)) x^(2 (gamma0 - a - 1/3))";
  static constexpr const char* reference =
      "Steinberg, Cochran, Guinan, J. Appl. Phys. 51, 1498, 1980; Steinberg, UCRL-MA-106439, 1996";
  static constexpr bool needs_shear_modulus = true;
  static constexpr bool reads_temperature = true;
  static constexpr bool reads_pressure = true;
  static constexpr Parameter<SteinbergGuinan> parameters[] = {
      {{"Y0", "Pa", Range::positive, kRequired, "yield stress at p = 0, 300 K, no strain"},
       &SteinbergGuinan::Y0},
      {{"Y_max", "Pa", Range::positive, kRequired, "largest yield stress at p = 0, 300 K", "Ymax"},
       &SteinbergGuinan::Y_max},
      {{"beta", "1", Range::non_negative, kRequired, "hardening factor"}, &SteinbergGuinan::beta},
      {{"n", "1", Range::fraction, kRequired, "hardening exponent"}, &SteinbergGuinan::n},
      {{"eps_i", "1", Range::non_negative, 0.0, "initial plastic strain"}, &SteinbergGuinan::eps_i},
      {{"A", "1/Pa", Range::non_negative, kRequired, "(dG/dp)/G0"}, &SteinbergGuinan::A},
      {{"B", "1/K", Range::non_negative, kRequired, "-(dG/dT)/G0"}, &SteinbergGuinan::B},
      {{"r", "1", Range::non_negative, 1.0, "(dY/dp)/Y0 over (dG/dp)/G0"}, &SteinbergGuinan::r},
      {{"T_melt", "K", Range::non_negative, 0.0, "melting temperature at rho0; 0: never melts",
        "T_melt0"},
       &SteinbergGuinan::T_melt},
      {{"a", "1", Range::non_negative, 1.5, "melting: volume correction of gamma0"},
       &SteinbergGuinan::a},
      {{"gamma0", "1", Range::non_negative, 2.0, "melting: Grueneisen parameter at rest"},
       &SteinbergGuinan::gamma0},
  };

  void prepare(const MaterialConstants& constants) {
    G0 = constants.shear_modulus;
    const bool hardens = beta > 0.0 && n > 0.0;
    eps_cap = hardens ? (pow(Y_max / Y0, 1.0 / n) - 1.0) / beta - eps_i : 1e300;
  }
  const char* problem() const { return Y_max >= Y0 ? nullptr : "Y_max must not lie below Y0"; }

  /// 1 + factor A p x^(-1/3) - B (T - 300 K).
  template <class Real>
  KRATER_FORCE_INLINE Real stiffening(Real T, Real p, Real x, double factor) const {
    return fma(factor * A * p, rcbrt(x), fnma(Real(B), T - 300.0, Real(1.0)));
  }
  template <class Real>
  KRATER_FORCE_INLINE Real shear_modulus(Real T, Real p, Real x) const {
    return G0 * max(Real(softest), stiffening(T, p, x, 1.0));  // this order keeps a NaN
  }
  template <class Real>
  KRATER_FORCE_INLINE Real melting_temperature(Real x) const {
    const Real growth = 2.0 * (gamma0 - a - 1.0 / 3.0) * log(x);
    return T_melt * exp(fma(Real(2.0 * a), Real(1.0) - Real(1.0) / x, growth));
  }

  template <class Real>
  struct Curve {
    const SteinbergGuinan& law;
    Real scale;  ///< of pressure and heat

    struct Hardening {
      Real stress;
      Real per_base;
    };
    KRATER_FORCE_INLINE Hardening hardening(Real eps) const {
      const Real base = fma(Real(law.beta), eps + law.eps_i, Real(1.0));
      const Real rising = law.Y0 * exp(law.n * log(base));
      const MaskOf<Real> capped = eps > Real(law.eps_cap);
      return {scale * select(capped, Real(law.Y_max), rising),
              select(capped, Real(0.0), law.beta / base)};
    }
    KRATER_FORCE_INLINE Flow<Real> flow(const Hardening& h, Real, Real) const {
      const Real d_eps = law.n * h.stress * h.per_base;
      return {h.stress, d_eps, Real(0.0), abs(1.0 - law.n) * d_eps * h.per_base};
    }
    KRATER_FORCE_INLINE MaskOf<Real> smooth_between(Real, Real) const {
      return Real(0.0) == Real(0.0);
    }
    KRATER_FORCE_INLINE MaskOf<Real> smooth_between_strains(Real eps0, Real eps1) const {
      const MaskOf<Real> crossed = (eps0 > Real(law.eps_cap)) ^ (eps1 > Real(law.eps_cap));
      return !crossed;
    }
  };

  /// Temperature, pressure and compression x = rho/rho0 at the start of the step.
  template <class Real>
  KRATER_FORCE_INLINE Curve<Real> at(Real T, Real p, Real x) const {
    const Real scale = max(Real(0.0), stiffening(T, p, x, r));
    if (T_melt == 0.0) return {*this, scale};
    return {*this, select(T >= melting_temperature(x), Real(0.0), scale)};
  }
};

}  // namespace krater::inline KRATER_ISA
