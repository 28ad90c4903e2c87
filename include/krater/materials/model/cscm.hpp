// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Continuous surface cap model of concrete, every constant generated from the strength f
/// (cscm_constants.hpp). J1 = 3p, p and volume strain compression positive, J2 = q^2/3; stresses
/// with a bar are those of the undamaged material:
///   shear      sqrt(J2) <= R F_f(J1) sqrt(C),  F_f = alpha - lambda exp(-beta J1) + theta J1
///   R          Willam and Warnke's section (returns/lode.hpp) with the meridians' ratio
///              Q2 = alpha2 - lambda2 exp(-beta2 J1) + theta2 J1 in [1/2, 1]; 1/2 for J1 < 0
///   cap, flow  associated, returns/cap_return.hpp; eps_c counts compaction only, no retreat
///   pressure   p~ = K (ln(rho/rho0) - plastic volume)
/// F_f has no bound under pressure: `strength_max` gives it one (7 f is a sensible one).
///
/// Which set: `auto` is FHWA's from 26 MPa on and the refit below. FHWA's closes at f because its
/// cap acts in the unconfined test; the refit closes where the cap does not, so its first cap is
/// put off to X0 = max(X0, f + R F_f(f)) (`cap_start: published` leaves it).
///
/// Tension: what flow leaves below the apex of F_f opens the material; the gap closes at p = 0
/// before pressure returns.
///
/// Rate (Duvaut and Lions): all that flow and gap do in a step is times (dt/eta)/(1 + dt/eta), so
/// at constant rates flow lags by eta: q~ - q = 3G eta d eps_p/dt, p~ - p = K eta d eps_v/dt.
///   eta = eta_t + trans (eta_c - eta_t) in compression, eta_t in tension
///   trans = min(1, |J1|/q)^n, n = 5,   eta_c,t = base/rate^power,   E rate eta <= overstress
/// The rate is the mean over about ten steps.
///
/// Damage: s = (1 - d) s~, d = max(d_b, d_d); p = (1 - d) p~ in tension, (1 - d_d) p~ in
/// compression: cracks that close carry pressure. p = 0 at the switch, so it makes no energy.
///   brittle    1 - d_b = (1 + D) e/(1 + D e), e = exp(-C z), z = sqrt(E) eps_1, where p < 0
///   ductile    1 - d_d = (1 + B) e/(1 + B e), e = exp(-A z), z = sqrt(r^2 + w/2) - r, p >= 0
/// eps_1: largest principal plastic strain (flow and gap in tension, as if its axes stayed); w:
/// plastic work of the undamaged material on the shear surface, r^2 its elastic energy where that
/// is first reached. In direct tension and unconfined compression these are the published
/// sqrt(E) eps_max and sqrt(s~:eps/2) less their thresholds; elsewhere the published grow with an
/// elastic load too. Compaction damages nothing, and d_d <= (q/J1)^(3/2): confined concrete bears.
/// Dissipation per area by width L (step.length), with the elastic energy lost at the peak:
///   C = r_b (1 + D) ln(1 + D)/(D [G_f/L - f_t^2/2E]),   r_b = f_t/sqrt(E)
///   4L (1 + B)/(A B) [r ln(1 + B) - Li2(-B)/A] + L r^2 = G_fs + trans (G_fc - G_fs)
/// Heat: what damage and flow take, in crush and plastic work.
///
/// Assumptions: no energy in the pressure; fracture energies do not grow with the rate (the
/// overstress dissipates more by itself); damage once done stays in the deviator (the published
/// model gives back what was brittle). Explicit in the damage: first order.
/// References: Murray, FHWA-HRT-05-062, 2007; Schwer, Murray, Int. J. Numer. Anal. Methods
/// Geomech. 18, 1994.
#pragma once

#include <cmath>

#include "krater/materials/model/coupled.hpp"
#include "krater/materials/model/cscm_constants.hpp"
#include "krater/materials/returns/lode.hpp"
#include "krater/materials/returns/softening.hpp"

namespace krater::inline KRATER_ISA {

struct Cscm {
  double f, set, cap_start, strength_max, rate, damage, G_f, d_max, G_fc, G_fs, B, D;
  double rho0, c0, K, G, E, root_E;
  double f_t, viscous, damages;  ///< the last two: 1 or 0
  double fracture, crushing, shearing;
  double brittle, ln_B, dilog_B;  ///< C = brittle/(G_f/L - f_t^2/2E); ln(1 + B), -Li2(-B)
  CscmConstants constants;

  static constexpr double kMost = 0.999;  ///< damage
  static constexpr Family family = Family::model;
  static constexpr const char* name = "cscm";
  static constexpr const char* equation =
      "sqrt(J2) <= R [alpha - lambda exp(-beta J1) + theta J1] sqrt(1 - <(J1 - kappa)/(X - "
      "kappa)>^2), cap moved by compaction; damage by energies per area; flow lags by eta(rate)";
  static constexpr const char* reference =
      "Murray, FHWA-HRT-05-062, 2007; Schwer, Murray, Int. J. Numer. Anal. Methods Geomech. 18, "
      "1994";
  static constexpr bool needs_shear_modulus = false;  // of the material: it has its own
  static constexpr bool fails = true;
  using Law = Cscm;
  static constexpr Parameter<Law> parameters[] = {
      {{"compressive_strength", "Pa", Range::positive, kRequired, "f: unconfined", "f_c"}, &Law::f},
      {{"set", "1", Range::any, 0.0, "of constants; auto: fhwa from 26 MPa, rev3 below", nullptr,
        "auto|fhwa|rev3"},
       &Law::set},
      {{"cap_start", "1", Range::any, 0.0,
        "first cap of rev3 below 38 MPa: where the unconfined test does not meet it, or published",
        nullptr, "strength|published"},
       &Law::cap_start},
      {{"strength_max", "1", Range::non_negative, 0.0, "largest q over f; 0: none"},
       &Law::strength_max},
      {{"rate_factor", "1", Range::any, 0.0, "strength increase with the rate", nullptr,
        "viscous|none"},
       &Law::rate},
      {{"softening", "1", Range::any, 0.0, "by the energies and the cell, or not at all", nullptr,
        "regularised|none"},
       &Law::damage},
      {{"fracture_energy", "J/m^2", Range::non_negative, 0.0,
        "G_f in tension; 0: CEB, (21 + 0.5357 d/mm) (f/10 MPa)^0.7", "G_f"},
       &Law::G_f},
      {{"aggregate_size", "m", Range::positive, 9.5e-3, "d: largest grain, for G_f"}, &Law::d_max},
      {{"crushing_energy", "J/m^2", Range::non_negative, 0.0, "unconfined; 0: 100 G_f", "G_fc"},
       &Law::G_fc},
      {{"shear_energy", "J/m^2", Range::non_negative, 0.0, "pure shear; 0: G_f", "G_fs"},
       &Law::G_fs},
      {{"B", "1", Range::positive, 100.0, "ductile damage: bluntness of the peak"}, &Law::B},
      {{"D", "1", Range::positive, 0.1, "brittle damage: bluntness of the peak"}, &Law::D},
  };

  struct Ductile {
    static constexpr FieldInfo info{"ductile_damage", "1", 1, "damage of flow under pressure"};
  };
  struct Cap {
    static constexpr FieldInfo info{"cap", "Pa", 1, "kappa: 3p where the cap begins"};
  };
  struct PlasticVolume {
    static constexpr FieldInfo info{"plastic_volume", "1", 1,
                                    "volume strain of flow and gap, compression positive"};
  };
  struct Gap {
    static constexpr FieldInfo info{"gap", "1", 1, "open volume strain that closes without force"};
  };
  struct Crack {
    static constexpr FieldInfo info{"crack", "1", 1, "largest principal plastic strain in tension"};
  };
  struct ShearWork {
    static constexpr FieldInfo info{"shear_work", "J m^-3", 1,
                                    "plastic work of the undamaged shear surface under pressure"};
  };
  struct Threshold {
    static constexpr FieldInfo info{"threshold", "J m^-3", 1, "elastic energy where it began"};
  };
  struct MeanRate {
    static constexpr FieldInfo info{"mean_rate", "s^-1", 1, "strain rate, mean over ten steps"};
  };
  using State = Columns<field::Damage, Ductile, Cap, PlasticVolume, Gap, Crack, ShearWork,
                        Threshold, MeanRate>;
  template <class Real>
  using Values = std::array<Real, 9>;
  Values<double> initial_state() const { return {0, 0, first_corner, 0, 0, 0, 0, 0, 0}; }
  double first_corner;  ///< kappa0

  bool refit() const { return set > 1.5 || (set < 0.5 && f < 26e6); }

  void prepare(const MaterialConstants& material) {
    rho0 = material.density;
    constants = CscmConstants::of(f, refit());
    E = constants.E;
    root_E = std::sqrt(E);
    K = E / (3.0 * (1.0 - 2.0 * constants.nu));
    G = E / (2.0 * (1.0 + constants.nu));
    c0 = std::sqrt(K / rho0);
    if (strength_max > 0) constants.shear.most = strength_max * f / std::sqrt(3.0);
    start_cap();
    f_t = direct_tension();
    viscous = rate < 0.5 ? 1.0 : 0.0;
    damages = damage < 0.5 ? 1.0 : 0.0;
    fracture = G_f > 0 ? G_f : (21.0 + 535.7 * d_max) * std::pow(f / 10e6, 0.7);
    crushing = G_fc > 0 ? G_fc : 100.0 * fracture;
    shearing = G_fs > 0 ? G_fs : fracture;
    brittle = f_t / root_E * (1.0 + D) * std::log1p(D) / D;
    ln_B = std::log1p(B);
    dilog_B = dilogarithm(B);
  }
  void start_cap() {
    CapHardening& cap = constants.cap;
    const CscmSurface& shear = constants.shear;
    if (refit() && cap_start < 0.5 && f < 38e6)
      cap.X0 = std::fmax(cap.X0, f + shear.shape * shear.at(f).strength);
    // Newton on kappa + R F_f(kappa) = X0, a concave function: from X0 it falls below the root at
    // once and rises to it.
    double kappa = cap.X0;
    for (int i = 0; i < 100; ++i) {
      const auto at = shear.at(kappa);
      kappa -= (kappa + shear.shape * at.strength - cap.X0) / (1.0 + shear.shape * at.slope);
    }
    first_corner = kappa;
  }
  /// t = (sqrt3/2) F_f(-t), by Newton.
  double direct_tension() const {
    double t = 0;
    for (int i = 0; i < 50; ++i) {
      const auto at = constants.shear.at(-t);
      t -= (t - std::sqrt(0.75) * at.strength) / (1.0 + std::sqrt(0.75) * at.slope);
    }
    return t;
  }
  /// q of unconfined compression: on the first cap, or where its compaction ends.
  double unconfined() const {
    const double least = first_corner;
    double corner = least, high = 100.0 * f;
    if (!(outward(least) > 0)) return on_path(least);
    for (int i = 0; i < 200; ++i) {
      const double mid = 0.5 * (corner + high);
      (outward(mid) > 0 ? corner : high) = mid;
    }
    return on_path(corner);
  }
  /// q = J1 on the surface that the cap at `corner` closes.
  double on_path(double corner) const {
    const double a = constants.shear.shape * constants.shear.at(corner).strength;
    double low = 0, high = corner + a;
    for (int i = 0; i < 100; ++i) {
      const double J1 = 0.5 * (low + high), x = std::fmax(0.0, J1 - corner) / a;
      const double q = std::sqrt(3.0 * (1.0 - x * x)) * constants.shear.at(J1).strength;
      (q > J1 ? low : high) = J1;
    }
    return low;
  }
  /// Above zero where flow compacts there.
  double outward(double corner) const {
    const double J1 = on_path(corner),
                 a = constants.shear.shape * constants.shear.at(corner).strength;
    const double x = std::fmax(0.0, J1 - corner) / a;
    const auto at = constants.shear.at(J1);
    return at.strength * x / a - at.slope * (1.0 - x * x);
  }
  /// -Li2(-B) = integral of ln(1 + t)/t from 0 to B: in s = ln t, by Simpson's rule.
  static double dilogarithm(double B) {
    constexpr int parts = 2000;
    const double low = std::log(B) - 40.0, width = 40.0 / parts;  // e^-40 of B is left out
    double sum = 0;
    for (int i = 0; i < parts; ++i) {
      const auto value = [&](double at) { return std::log1p(std::exp(low + at * width)); };
      sum += width / 6.0 * (value(i) + 4.0 * value(i + 0.5) + value(i + 1.0));
    }
    return sum;
  }
  std::array<Derived, 4> derived() const {
    const double share = unconfined() / f;
    return {{{refit() ? "first cap X0 of set rev3" : "first cap X0 of set fhwa", constants.cap.X0,
              "Pa"},
             {"unconfined strength over compressive_strength", share, "1"},
             {"direct tension", f_t, "Pa"},
             {"G_f", fracture, "J/m^2"}}};
  }
  bool degrades() const { return damages > 0.5; }
  /// Width at which the elastic energy of the peak is all there is, in tension or crushing [m].
  double largest_length() const {
    if (!degrades()) return 0.0;
    return 2.0 * E * std::fmin(fracture / (f_t * f_t), crushing / (f * f));
  }
  const char* problem() const {
    if (f < 20e6 || f > 58e6)
      return "compressive_strength (fc of a generated card): the constants are fitted for 20 to 58 "
             "MPa (a bare number is in Pa: write 39 MPa); use karagozian_case, or "
             "holmquist_johnson_cook with a card, beyond";
    return nullptr;
  }
  template <class Real>
  KRATER_FORCE_INLINE Real shear_modulus(const Values<Real>&) const {
    return Real(G);
  }

  /// 1 - d of a damage variable z with its slope and bluntness.
  template <class Real>
  KRATER_FORCE_INLINE Real left(Real slope_z, double bluntness) const {
    const Real e = exp(-slope_z);
    return (1.0 + bluntness) * e / fma(Real(bluntness), e, Real(1.0));
  }
  /// C z of a crack strain.
  template <class Real>
  KRATER_FORCE_INLINE Real brittle_growth(Real crack, Real length) const {
    constexpr double least = 1e-3;  // longer cells are refused
    const Real whole = Real(fracture) / length;
    const Real share = max(least * whole, whole - f_t * f_t / (2.0 * E));
    return brittle * root_E * crack / share;
  }
  /// A z of plastic work on the shear surface; 1/A is the positive root of the second line above.
  template <class Real>
  KRATER_FORCE_INLINE Real ductile_growth(Real work, Real began, Real energy, Real length) const {
    constexpr double least = 1e-3;
    const Real whole = energy / length, share = max(least * whole, whole - began);
    const Real r = sqrt(began), z = 0.5 * work / (sqrt(fma(Real(0.5), work, began)) + r + 1e-30);
    const Real linear = ln_B * r, spread = share * (B / (1.0 + B));
    const Real per_A = 0.5 * spread / (linear + sqrt(fma(linear, linear, dilog_B * spread)));
    return z / per_A;
  }
  /// (dt/eta)/(1 + dt/eta) of a step: 1 without a rate.
  template <class Real>
  KRATER_FORCE_INLINE Real relaxed(Real J1, Real q, Real mean_rate, double dt) const {
    const CscmRates& r = constants.rates;
    const Real log_rate = log(max(Real(1e-12), mean_rate)), e = exp(log_rate);
    const Real most = Real(r.overstress / E) / e;
    const Real eta_t = min(most, r.base_t * exp(-r.power_t * log_rate));
    const Real eta_c = min(most, r.base_c * exp(-r.power_c * log_rate));
    const Real eta = select(J1 < Real(0.0), eta_t, fma(uniaxial(J1, q), eta_c - eta_t, eta_t));
    return dt / fma(Real(viscous), eta, Real(dt));
  }
  /// trans: 1 where J1 >= q, as in unconfined compression, 0 in shear.
  template <class Real>
  KRATER_FORCE_INLINE Real uniaxial(Real J1, Real q) const {
    const Real t = min(Real(1.0), abs(J1) / max(Real(1e-30), q)), t2 = t * t;
    return t2 * t2 * t;
  }

  /// Stresses of the undamaged material, and what flowed.
  template <class Real>
  struct Flow {
    Real p, q, kappa, plastic;
    Real volume, opened;  ///< plastic volume of the step, the gap's share (opening negative)
    Real cosine;          ///< of the Lode angle
  };
  template <class Real>
  struct Damages {
    Real whole, ductile, crack, work, began;
  };

  template <class Real>
  struct Concrete {
    const Cscm& law;
    Values<Real> state;

    KRATER_FORCE_INLINE CoupledUpdate<Real, 9> update(const CoupledStep<Real>& step) const {
      const auto& [damage, ductile, cap, volume, gap, crack, work, began, mean] = state;
      constexpr double memory = 0.1;
      const Real rate = fma(Real(memory), step.strain * (1.0 / step.dt) - mean, mean);
      const Real strain = log(step.rho * (1.0 / law.rho0));
      const Real closing = clamp(strain - volume, Real(0.0), gap);
      const Flow<Real> flow = flow_of(step, strain - volume - closing, rate);
      const Damages<Real> after = damaged(step, flow);
      const Real p_share = pressure_share(flow.p, after.whole, after.ductile);
      const Real q = min(step.q, fnma(after.whole, flow.q, flow.q));  // this order keeps a NaN
      // Elastic energy that damage frees, and the work of the plastic volume.
      const Real freed_q = flow.q * flow.q * (1.0 / (6.0 * law.G)) * (after.whole - damage);
      const Real freed_p = flow.p * flow.p * (1.0 / (2.0 * law.K)) *
                           (pressure_share(flow.p, damage, ductile) - p_share);
      const Real crush = fma(p_share * flow.p, flow.volume, freed_q + freed_p);
      // Some are only remembered: a NaN in them must be seen.
      const Real seen = Real(0.0) * (damage + ductile + gap + crack + work + began);
      return {q,
              flow.plastic + seen,
              {p_share * flow.p, Real(0.0)},
              Real(-1e30),  // its surface bounds it
              Real(law.K),
              max(-q * flow.plastic, crush) * step.v,  // this order keeps a NaN
              {after.whole, after.ductile, flow.kappa, volume + closing + flow.volume,
               gap - closing - flow.opened, after.crack, after.work, after.began, rate},
              after.whole >= Real(kMost)};
    }

    KRATER_FORCE_INLINE Real pressure_share(Real p, Real whole, Real ductile) const {
      return Real(1.0) - select(p < Real(0.0), whole, ductile);
    }
    /// `elastic`: volume strain that is not plastic, at the start.
    KRATER_FORCE_INLINE Flow<Real> flow_of(const CoupledStep<Real>& step, Real elastic,
                                           Real rate) const {
      const CscmConstants& c = law.constants;
      const double per_K = 1.0 / (3.0 * law.K);
      const Real trial = 3.0 * law.K * elastic, cosine = lode_cosine(step.trial, step.q);
      const Real lode = willam_warnke(cosine, c.meridian(trial));
      const CapEnd<Real> end = cap_return(c.shear, c.cap, ElasticPair{law.K, law.G}, 1.0, lode,
                                          CapState<Real>{trial, step.q, state[2]});
      const Real share = law.relaxed(trial, step.q, rate, step.dt);
      const Real volume = share * (trial - end.J1) * per_K, opened = share * end.parted * per_K;
      const Real lost = share * (step.q - end.q);
      return {law.K * (elastic - volume),
              step.q - lost,
              fma(share, end.kappa - state[2], state[2]),
              lost * (1.0 / (3.0 * law.G)),
              volume,
              opened,
              cosine};
    }
    KRATER_FORCE_INLINE Damages<Real> damaged(const CoupledStep<Real>& step,
                                              const Flow<Real>& flow) const {
      const auto& [damage, ductile, cap, volume, gap, crack, work, began, mean] = state;
      const MaskOf<Real> pulled = flow.p < Real(0.0);
      const Real opening = max(Real(0.0), flow.volume * (-1.0 / 3.0));
      const Real torn = fma(flow.plastic, flow.cosine, opening);
      const Real cracked = crack + select(pulled, torn, Real(0.0));
      // On the shear surface: nothing is compacted.
      const MaskOf<Real> pressed = !pulled;
      const MaskOf<Real> sheared =
          pressed & (flow.volume <= Real(0.0)) & (flow.plastic > Real(0.0));
      const Real done = max(Real(0.0), fma(flow.p, flow.volume, flow.q * flow.plastic));
      const Real worked = work + select(sheared, done, Real(0.0));
      const Real held =
          fma(flow.q * flow.q, Real(1.0 / (6.0 * law.G)), flow.p * flow.p * (1.0 / (2.0 * law.K)));
      const Real start = select(sheared & (began <= Real(0.0)), held, began);
      const Real energy = fma(law.uniaxial(3.0 * flow.p, flow.q), Real(law.crushing - law.shearing),
                              Real(law.shearing));
      const Real most = Real(law.damages * kMost);
      constexpr double shortest = 1e-9;  // a point that does not soften has no length
      const Real length = max(Real(shortest), step.length);
      const Real brittle = 1.0 - law.left(law.brittle_growth(cracked, length), law.D);
      const Real crushed = 1.0 - law.left(law.ductile_growth(worked, start, energy, length), law.B);
      const Real ratio = min(Real(1.0), flow.q / max(Real(1e-30), 3.0 * flow.p));
      const Real soft = max(ductile, min(min(most, ratio * sqrt(ratio)), crushed));
      return {max(max(damage, soft), min(most, brittle)), soft, cracked, worked, start};
    }
  };
  template <class Real>
  KRATER_FORCE_INLINE Concrete<Real> at(const Values<Real>& state) const {
    return {*this, state};
  }
};

}  // namespace krater::inline KRATER_ISA
