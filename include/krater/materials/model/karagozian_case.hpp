// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Concrete of Karagozian and Case, every constant generated from the strength f (others: keys).
/// p, eps_v = ln(rho/rho0) positive in compression, theta the Lode angle (returns/lode.hpp).
///
/// Strength: three surfaces (karagozian_surfaces.hpp), maximum m, yield y, residual r; damage
/// lambda
///   F = eta (m - y) + y for lambda <= lambda_m = 5.6e-5,   eta (m - r) + r beyond
///   q <= r'(theta, psi(p/r_f)) r_f F(p/r_f, lambda),        r_f: increase with the rate
///   d lambda = s_r h d eps_p,  1/h = [1 + (s/100)(r_f - 1)] z^b,  z = max(1 + p/(r_f f_t), 1e-3)
/// b = b1 for p >= 0, b2 below; eta(lambda) rises to 1 at lambda_m and falls to 0 at 5.7e-4. The
/// pieces of eta are walked, so a step solves q_tr - 3G d eps = F(lambda + h d eps) exactly; a
/// piece that falls faster than 3G snaps back and is passed at once.
/// In nearly triaxial tension, f_d = 1 - 10 q/|p| > 0, also
///   d lambda = b3 k_d f_d d<eps_tension - f_t/K0>  of new largest tension strains.
/// p >= -f_t r_f, after lambda_m -eta f_t r_f.
/// Dilation, `dilatancy` omega > 0: the potential q - omega F, so that with eps_d, volume that
/// shear opens and that is none of the matter's, p is that of ln(rho/rho0) + eps_d and
///   d eps_d = w d gamma,  d eps_p = d gamma sqrt(1 + 2/9 w^2),  w = omega F'(p) <3p/f, 1> eta
/// (eta: 1 before lambda_m), ours: none in tension, where cracks open by the cut, and none in
/// rubble. With M the slope of p the step solves q_tr - 3G d gamma = F + M w F' d gamma.
///
/// Regularised softening (default), ours: in tension after lambda_m
///   s_r = L g_t/G_f,   k_d = L f_t (lambda_m + integral of eta)/[b3 (G_f - L f_t^2/(2 K0))]
/// with g_t the work density of direct tension after its peak at s_r = 1, by quadrature, and L the
/// width over which it localises: direct tension after its peak, and triaxial tension with the
/// elastic energy that it loses, then dissipate G_f per area. Above
/// largest_length() the law snaps back. The published law (`softening: published`) dissipates g_t
/// L, 3.6 J/m^2 in cells of 5 mm. Compression after the peak has s_r = L g_c/G_fc where `G_fc` is
/// given.
///
/// Pressure: a table p(eps_v) of loading with unloading modulus K_u(eps_max), linear in eps_v, not
/// below the slope of loading, and
/// G = 3/2 K_u (1 - 2 nu)/(1 + nu). Crushing, and the shear energy that a growing G forgets, are
/// heat.
///
/// Assumptions: no energy in the pressure; the rate is the mean over about ten steps. The strength
/// of a step has the pressure of its end.
/// References: Malvar, Crawford, Wesevich, Simons, Int. J. Impact Eng. 19, 1997, 847-873; constants
/// and tables as they stand in public cards and from memory (design page of the concrete laws).
#pragma once

#include <cmath>

#include "krater/materials/model/coupled.hpp"
#include "krater/materials/model/karagozian_surfaces.hpp"
#include "krater/materials/returns/lode.hpp"

namespace krater::inline KRATER_ISA {

struct KaragozianCase {
  double f, f_t, K0, nu, G_f, d_max, G_fc, softening, b1, b2, b3, s_lambda;
  double rate_factor, compression_most, tension_most;
  double a0, a1, a2, a0y, a1y, a2y, a1f, a2f, omega;
  double rho0, c0, G, shear_per_bulk, regular;
  double strength_t, modulus0, fracture, per_length_t, per_length_c, fixed_c;
  double parting, elastic_share;  ///< k_d b3 = parting L/(1 - elastic_share L)
  KaragozianSurfaces surfaces;
  KaragozianRates rates;
  Polyline<10> pressure, modulus, eta;

  static constexpr double kPeak = 5.6e-5, kEnd = 5.7e-4;
  static constexpr unsigned kPieces = 9, kPeakPiece = 4;  ///< of eta; the first that softens

  static constexpr Family family = Family::model;
  static constexpr const char* name = "karagozian_case";
  static constexpr const char* equation =
      "q <= r'(theta, psi) r_f [eta(lambda) (m - y or r) + y or r](p/r_f); d lambda = h(p) d "
      "eps_p; "
      "p(eps_v, largest) by tables; all from f";
  static constexpr const char* reference =
      "Malvar, Crawford, Wesevich, Simons, Int. J. Impact Eng. 19, 1997, 847-873";
  static constexpr bool needs_shear_modulus = false;  // of the material: it has its own
  static constexpr bool fails = true;
  using Law = KaragozianCase;
  static constexpr Parameter<Law> parameters[] = {
      {{"compressive_strength", "Pa", Range::positive, kRequired, "f: unconfined", "f_c"}, &Law::f},
      {{"tensile_strength", "Pa", Range::non_negative, 0.0, "f_t; 0: 1.58 (f^2/145)^(1/3), in MPa",
        "f_t"},
       &Law::f_t},
      {{"K0", "Pa", Range::non_negative, 0.0,
        "bulk modulus at rest; 0: 14.56 GPa sqrt(f/45.4 MPa)"},
       &Law::K0},
      {{"poisson_ratio", "1", Range::non_negative, 0.19, "of G from K_u"}, &Law::nu},
      {{"fracture_energy", "J/m^2", Range::non_negative, 0.0,
        "G_f in tension; 0: CEB, (21 + 0.5357 d/mm) (f/10 MPa)^0.7", "G_f"},
       &Law::G_f},
      {{"aggregate_size", "m", Range::positive, 9.5e-3, "d: largest grain, for G_f"}, &Law::d_max},
      {{"crushing_energy", "J/m^2", Range::non_negative, 0.0,
        "of unconfined compression after the peak; 0: as b1 gives it", "G_fc"},
       &Law::G_fc},
      {{"softening", "1", Range::any, 0.0, "in tension by G_f and the cell, or by b2 alone",
        nullptr, "regularised|published"},
       &Law::softening},
      {{"b1", "1", Range::any, 1.6, "damage in compression: power"}, &Law::b1},
      {{"b2", "1", Range::any, 1.35, "damage in tension: power"}, &Law::b2},
      {{"b3", "1", Range::positive, 1.15, "damage in triaxial tension, published softening"},
       &Law::b3},
      {{"s_lambda", "1", Range::non_negative, 100.0, "slows damage as the rate strengthens",
        "SLAMBDA"},
       &Law::s_lambda},
      {{"rate_factor", "1", Range::any, 0.0, "strength increase with the rate", nullptr,
        "table|none"},
       &Law::rate_factor},
      {{"compression_factor_max", "1", Range::positive, 1e6, "limit of the increase",
        "dif_max_compression"},
       &Law::compression_most},
      {{"tension_factor_max", "1", Range::positive, 1e6, "the same in tension", "dif_max_tension"},
       &Law::tension_most},
      {{"a0", "1", Range::non_negative, 0.2956, "maximum surface, over f"}, &Law::a0},
      {{"a1", "1", Range::positive, 0.4463, "maximum"}, &Law::a1},
      {{"a2", "1", Range::non_negative, 0.0808, "maximum, times f"}, &Law::a2},
      {{"a0y", "1", Range::non_negative, 0.2232, "yield surface, over f"}, &Law::a0y},
      {{"a1y", "1", Range::positive, 0.625, "yield"}, &Law::a1y},
      {{"a2y", "1", Range::non_negative, 0.2575, "yield, times f"}, &Law::a2y},
      {{"a1f", "1", Range::positive, 0.4417, "residual"}, &Law::a1f},
      {{"a2f", "1", Range::non_negative, 0.1183, "residual, times f"}, &Law::a2f},
      {{"dilatancy", "1", Range::fraction, 0.0, "share of the associated dilation", "omega"},
       &Law::omega},
  };

  struct Lambda {
    static constexpr FieldInfo info{"lambda", "1", 1, "damage variable of the three surfaces"};
  };
  struct Compaction {
    static constexpr FieldInfo info{"compaction", "1", 1, "largest ln(rho/rho0) so far"};
  };
  struct Extension {
    static constexpr FieldInfo info{"extension", "1", 1, "largest -ln(rho/rho0) so far"};
  };
  struct MeanRate {
    static constexpr FieldInfo info{"mean_rate", "s^-1", 1, "strain rate, mean over ten steps"};
  };
  struct Dilation {
    static constexpr FieldInfo info{"dilation", "1", 1, "volume strain that shear opened"};
  };
  using State = Columns<field::Damage, Lambda, Compaction, Extension, MeanRate, Dilation>;
  template <class Real>
  using Values = std::array<Real, 6>;
  Values<double> initial_state() const { return {}; }

  void prepare(const MaterialConstants& constants) {
    constexpr double MPa = 1e6;
    rho0 = constants.density;
    strength_t = f_t > 0 ? f_t : 1.58 * std::cbrt(f * f / (145.0 * MPa * MPa)) * MPa;
    modulus0 = K0 > 0 ? K0 : 14.56e9 * std::sqrt(f / (45.4 * MPa));
    fracture = G_f > 0 ? G_f : (21.0 + 535.7 * d_max) * std::pow(f / (10.0 * MPa), 0.7);
    shear_per_bulk = 1.5 * (1.0 - 2.0 * nu) / (1.0 + nu);
    G = modulus0 * shear_per_bulk;
    c0 = std::sqrt(modulus0 / rho0);
    surfaces = {strength_t / f, a0, a1, a2, a0y, a1y, a2y, a1f, a2f, {}, 0.0};
    surfaces.prepare();
    rates = KaragozianRates::of(f / MPa, compression_most, tension_most, rate_factor < 0.5);
    make_tables();
    const double tail = after_peak([](double y) { return y; });
    regular = softening < 0.5 ? 1.0 : 0.0;
    per_length_t = regular * work_after_peak() / fracture;
    parting = regular * strength_t * (kPeak + tail) / fracture;
    elastic_share = regular * strength_t * strength_t / (2.0 * modulus0 * fracture);
    per_length_c = G_fc > 0 ? compression_work() / G_fc : 0.0;
    fixed_c = G_fc > 0 ? 0.0 : 1.0;
  }
  void make_tables() {
    const std::array<double, 10> strain{0,      0.0015, 0.0043, 0.0101, 0.0305,
                                        0.0513, 0.0726, 0.0943, 0.174,  0.208},
        p{0, 1, 2.18, 3.50, 6.65, 10.03, 14.23, 21.77, 127.1, 194.4},
        K{1, 1, 1.014, 1.065, 1.267, 1.470, 1.672, 1.825, 4.106, 5.0};
    pressure = Polyline<10>::through(strain, scaled(p, 0.0015 * modulus0), true);
    modulus = Polyline<10>::through(strain, scaled(K, modulus0), false);
    eta =
        Polyline<10>::through({0, 8e-6, 2.4e-5, 4e-5, kPeak, 7.2e-5, 8.8e-5, 3.2e-4, 5.2e-4, kEnd},
                              {0, 0.85, 0.97, 0.99, 1, 0.99, 0.97, 0.50, 0.10, 0}, false);
  }
  static std::array<double, 10> scaled(std::array<double, 10> values, double factor) {
    for (double& x : values) x *= factor;
    return values;
  }
  /// Integral over lambda of a function of eta after the peak, by Simpson's rule on each piece.
  template <class Function>
  double after_peak(Function of_eta) const {
    double sum = 0;
    for (unsigned k = kPeakPiece; k < kPieces; ++k) {
      constexpr int parts = 64;
      const double width = eta.width[k] / parts;
      for (int i = 0; i < parts; ++i) {
        const double from = eta.x[k] + i * width;
        sum +=
            width / 6.0 *
            (of_eta(eta(from)) + 4.0 * of_eta(eta(from + 0.5 * width)) + of_eta(eta(from + width)));
      }
    }
    return sum;
  }
  /// Plastic work of direct tension after the peak at s_r = 1 [J/m^3]: t = 1.5 eta/(1 + eta/2) f_t.
  double work_after_peak() const {
    return after_peak([this](double y) {
      const double t = 1.5 * y / (1.0 + 0.5 * y);
      return t * strength_t * std::pow(1.0 - t / 3.0, b2);
    });
  }
  /// The same of unconfined compression; q/f = eta m(q/3) + (1 - eta) r(q/3) by fixed point.
  double compression_work() const {
    return after_peak([this](double y) {
      double q = y;
      for (int i = 0; i < 200; ++i) {
        const double m = surfaces.maximum(q / 3.0, surfaces.psi(q / 3.0));
        q = y * m + (1.0 - y) * surfaces.residual(q / 3.0, m);
      }
      return q * f * std::pow(1.0 + q * f / (3.0 * strength_t), b1);
    });
  }
  /// Width above which direct tension falls faster than it springs back, or the elastic energy of
  /// triaxial tension exceeds G_f [m].
  double largest_length() const {
    if (regular < 0.5) return 0.0;
    double steepest = 0;
    for (unsigned k = kPeakPiece; k < kPieces; ++k)
      for (const double at : {0.0, 1.0}) {
        const double y = eta(eta.x[k] + at * eta.width[k]), share = 1.0 + 0.5 * y;
        const double h = std::pow(1.0 - 0.5 * y / share, -b2);
        steepest = std::fmax(steepest, -eta.slope[k] * h * 1.5 / (share * share));
      }
    const double E = 3.0 * modulus0 * (1.0 - 2.0 * nu);
    return std::fmin(E / (strength_t * steepest * per_length_t), 1.0 / elastic_share);
  }
  std::array<Derived, 2> derived() const {
    return {{{"direct tension", strength_t, "Pa"}, {"G_f", fracture, "J/m^2"}}};
  }
  const char* problem() const {
    constexpr double MPa = 1e6;
    if (!(nu < 0.5)) return "poisson_ratio must lie below 0.5";
    if (f < 10.0 * MPa || f > 100.0 * MPa)
      return "compressive_strength (fc of a generated card): the constants are generated for 10 to "
             "100 MPa (a bare number is in Pa: write 39 MPa); use holmquist_johnson_cook with a "
             "card beyond";
    if (!(strength_t < f / 3.0)) return "tensile_strength must lie below a third of f";
    for (const double at : {1.0 / 3.0, 2.3 / 3.0})
      if (!(surfaces.psi(at) >= 0.5 && surfaces.psi(at) <= 1.0))
        return "the surface never closes: the ratio of its meridians leaves 0.5 to 1 at low "
               "pressure "
               "(a0, a1, a2, tensile_strength)";
    return nullptr;
  }

  /// K_u of the table, and at least the slope of loading just beyond its eighth point, where the
  /// table's 1.825 K0 lies below 1.98 K0: a cycle there would make energy.
  template <class Real>
  KRATER_FORCE_INLINE Real bulk_modulus(Real largest) const {
    constexpr unsigned steep = 7;
    const MaskOf<Real> beyond = largest > Real(pressure.x[steep]);
    return max(select(beyond, Real(pressure.slope[steep]), Real(0.0)), modulus(largest));
  }
  template <class Real>
  KRATER_FORCE_INLINE Real shear_modulus(const Values<Real>& state) const {
    return shear_per_bulk * bulk_modulus(state[2]);
  }

  /// Surfaces of the step, in Pa, and what damage grows by.
  template <class Real>
  struct Step {
    Real maximum, yield, residual;  ///< stress differences, Lode factor and rate included
    Real before, after;             ///< d lambda per plastic strain before and after the peak
    Real opens, hardens;            ///< w, and M w F', by which dilation strengthens
    Real G;
  };
  template <class Real>
  struct Flow {
    Real plastic, lambda;
  };
  /// The walk along the pieces of eta.
  template <class Real>
  KRATER_FORCE_INLINE Flow<Real> flow(const Step<Real>& s, Real q_trial, Real lambda) const {
    const Real level = eta(lambda);
    const MaskOf<Real> softens = lambda > Real(kPeak);
    const Real base = select(softens, s.residual, s.yield);
    Real excess = q_trial - fma(level, s.maximum - base, base), plastic = Real(0.0), at = lambda;
    for (unsigned k = 0; k < kPieces; ++k) {
      const bool late = k >= kPeakPiece;
      const Real h = late ? s.after : s.before;
      const Real left = max(Real(0.0), eta.x[k + 1] - max(at, Real(eta.x[k])));
      const Real width = select(at < Real(eta.x[k + 1]), left, Real(0.0));
      const Real slope = eta.slope[k] * h * (s.maximum - (late ? s.residual : s.yield));
      const Real resist = fma(Real(3.0), s.G, slope) + s.hardens, longest = width / h;
      const Real wanted = select(resist > Real(0.0), excess / resist, longest);
      const Real d = select(excess > Real(0.0), min(longest, wanted), Real(0.0));
      excess = fnma(resist, d, excess);
      plastic = plastic + d;
      at = fma(h, d, at);
    }
    const Real rest = max(Real(0.0), excess) / fma(Real(3.0), s.G, s.hardens);  // keeps a NaN
    return {plastic + rest, fma(s.after, rest, at)};
  }

  template <class Real>
  struct Concrete {
    const KaragozianCase& law;
    Values<Real> state;

    KRATER_FORCE_INLINE CoupledUpdate<Real, 6> update(const CoupledStep<Real>& step) const {
      const auto& [damage, lambda, largest, extension, mean_rate, dilation] = state;
      const Real strain = log(step.rho * (1.0 / law.rho0)) + dilation;
      const Real reached = max(strain, largest);  // this order keeps a NaN of the state
      const Real K = law.bulk_modulus(reached),
                 own = fnma(K, reached - strain, law.pressure(reached));
      constexpr double memory = 0.1;
      const Real rate = fma(Real(memory), step.strain * (1.0 / step.dt) - mean_rate, mean_rate);
      const Real log_rate = log(max(Real(1e-12), rate));
      const Real tension = law.rates.tension(log_rate);
      const Real whole = law.rates.compression(log_rate) - tension;
      const Real level = max(Real(0.0), law.eta(lambda));  // round-off of its pieces' sum
      const Real cut_share = select(lambda > Real(kPeak), level, Real(1.0));
      const Real cut = -law.strength_t * tension * cut_share, p = max(cut, own);
      const Real into = clamp(p * (3.0 / law.f), Real(0.0), Real(1.0));
      const Real faster = fma(whole, into, tension);
      const Real slope = select(strain < largest, K, law.pressure.slope_at(strain));
      const Step<Real> s = surfaces_at(step, p, faster, law.omega * into * cut_share, slope);
      const Flow<Real> flow = law.flow(s, step.q, lambda);
      const Real opened = s.opens * flow.plastic;
      const Real q = min(step.q, max(Real(0.0), fnma(3.0 * s.G, flow.plastic, step.q)));
      const Real drawn = max(extension, -strain);
      const Real after = flow.lambda + parted(step.length, drawn, p, q);
      const Real shown =
          clamp(fms(Real(2.0), after / (after + kPeak), Real(1.0)), Real(0.0), Real(1.0));
      // These two are only remembered: a NaN in them must be seen.
      const Real seen = Real(0.0) * (damage + extension);
      return {q,
              flow.plastic + seen,
              {fma(slope, opened, own), Real(0.0)},
              cut,
              K,
              max(-q * flow.plastic * step.v,
                  fnma(max(Real(0.0), own) * step.v, opened, heat(step, reached, q, s.G))),
              {max(damage, shown), after, reached, drawn, rate, dilation + opened},
              after >= Real(kEnd)};
    }
    KRATER_FORCE_INLINE Step<Real> surfaces_at(const CoupledStep<Real>& step, Real p, Real faster,
                                               Real open, Real slope) const {
      const Real x = p / (law.f * faster), ratio = law.surfaces.psi(x);
      const Real lode = willam_warnke(lode_cosine(step.trial, step.q), ratio);
      const Real scale = law.f * faster * lode, m = law.surfaces.maximum(x, ratio);
      constexpr double floor = 1e-3;
      const Real z = max(Real(floor), fma(Real(1.0), p / (law.strength_t * faster), Real(1.0)));
      const MaskOf<Real> pulled = p < Real(0.0);
      const Real slow = fma(Real(0.01 * law.s_lambda), faster - 1.0, Real(1.0));
      const Real power = select(pulled, Real(law.b2), Real(law.b1));
      const Real level = max(Real(0.0), law.eta(state[1]));
      const Real base = select(state[1] > Real(kPeak), law.surfaces.residual_slope(x),
                               law.surfaces.yield_slope(x));
      const Real rise = lode * fma(level, law.surfaces.maximum_slope(x, ratio) - base, base);
      const Real opens = open * rise;
      const Real longer = sqrt(fma(Real(2.0 / 9.0), opens * opens, Real(1.0)));
      const Real h = exp(-power * log(z)) / slow * longer;
      const Real tensile = fma(Real(law.per_length_t), step.length, Real(1.0 - law.regular));
      const Real crushed = fma(Real(law.per_length_c), step.length, Real(law.fixed_c));
      return {scale * m,
              scale * law.surfaces.yield(x),
              scale * law.surfaces.residual(x, m),
              h,
              h * select(pulled, tensile, crushed),
              opens,
              slope * opens * rise,
              law.shear_modulus(state)};
    }
    /// Damage by triaxial tension.
    KRATER_FORCE_INLINE Real parted(Real length, Real drawn, Real p, Real q) const {
      constexpr double nearly = 10.0;
      const Real start = Real(law.strength_t / law.modulus0);
      const Real grown = max(Real(0.0), drawn - start) - max(Real(0.0), state[3] - start);
      const Real share =
          max(Real(0.0), fnma(Real(nearly), q / max(Real(1e-30), abs(p)), Real(1.0)));
      const Real published = Real((1.0 - law.regular) * law.b3);
      constexpr double least = 1e-3;  // longer cells are refused
      const Real left = max(Real(least), fnma(Real(law.elastic_share), length, Real(1.0)));
      const Real per_strain = law.parting * length / left + published;
      return select(p < Real(0.0), per_strain * share * grown, Real(0.0));
    }
    /// Of crushing, along the unloading lines p = K (eps - eps_p) before and after, and the shear
    /// energy q^2/6G that a larger G forgets; per mass.
    KRATER_FORCE_INLINE Real heat(const CoupledStep<Real>& step, Real reached, Real q,
                                  Real G) const {
      const Real K0 = law.bulk_modulus(state[2]), K1 = law.bulk_modulus(reached);
      const Real x0 = law.pressure(state[2]) / K0, x1 = law.pressure(reached) / K1;
      const Real x = 0.5 * (x0 + x1), lasting = (reached - x1) - (state[2] - x0);
      const Real curved = x * x * fma(x, Real(1.0 / 6.0), Real(0.5));
      const Real lost = fnma(curved, K1 - K0, 0.5 * (K0 + K1) * (x + curved) * lasting);
      const Real larger = max(G, law.shear_per_bulk * K1);
      const Real forgotten = q * q * (1.0 / 6.0) * (Real(1.0) / G - Real(1.0) / larger);
      return max(Real(0.0), lost + forgotten) * step.v;  // this order keeps a NaN
    }
  };
  template <class Real>
  KRATER_FORCE_INLINE Concrete<Real> at(const Values<Real>& state) const {
    return {*this, state};
  }
};

}  // namespace krater::inline KRATER_ISA
