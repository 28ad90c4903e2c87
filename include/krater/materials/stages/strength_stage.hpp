// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Deviator of the step: objective trial (returns/trial_deviator.hpp), radial return, and the work
/// of the deviator (v_n + v_{n+1})/2 (s_n + s_{n+1})/2 : dE of Algorithm 1, CCF (52)-(60). One
/// class for every yield law; a law that never yields has no plastic columns.
#pragma once

#include "krater/materials/batch_access.hpp"
#include "krater/materials/law.hpp"
#include "krater/materials/returns/pack_pair.hpp"
#include "krater/materials/returns/radial_return.hpp"
#include "krater/materials/returns/start_reader.hpp"
#include "krater/materials/returns/trial_deviator.hpp"

namespace krater::inline KRATER_ISA {

/// Elastic trial of a step and what the radial return needs of it.
template <class Real>
struct Trial {
  Sym3<Real> s;
  Real q;       ///< equivalent stress [Pa]
  Real strain;  ///< equivalent strain increment
};

template <class Real, class Modulus>
KRATER_FORCE_INLINE Trial<Real> trial_step(const Sym3<Real>& s, const Mat3<Real>& dtL,
                                           const Sym3<Real>& dE, Modulus G) {
  const Sym3<Real> trial = trial_deviator(s, dtL, G);
  return {trial, equivalent_stress(trial), equivalent_strain(dE)};
}

/// s_{n+1} = s_tr sigma_Y/q_tr. That is 1 - 3G d/q_tr without its cancellation: exactly zero in a
/// melt.
template <class Real>
KRATER_FORCE_INLINE Sym3<Real> returned(const Trial<Real>& trial, const PlasticStep<Real>& step) {
  return select(step.yielding, step.stress / trial.q, Real(1.0)) * trial.s;
}

template <class Real>
struct DeviatorUpdate {
  Sym3<Real> s;
  PlasticStep<Real> step;
};

/// One point's update by a yielding law; dE = sym H. The stage does the same in two halves.
template <class Real, class Law>
KRATER_FORCE_INLINE DeviatorUpdate<Real> update_deviator(const Law& law, const Sym3<Real>& s,
                                                         const Mat3<Real>& dtL,
                                                         const Sym3<Real>& dE, Real eps,
                                                         const StartState<Real>& start, double G0,
                                                         double dt) {
  const auto G = shear_at(law, start, G0);
  const Trial<Real> trial = trial_step(s, dtL, dE, G);
  const PlasticStep<Real> step = plastic_step(law, start, trial.q, eps, G, trial.strain, dt);
  return {returned(trial, step), step};
}

/// (v_n + v_{n+1})/2 (s_n + s_{n+1})/2 : dE; the deviators pick the deviatoric part of dE.
template <class Real>
KRATER_FORCE_INLINE Real deviatoric_work(const Sym3<Real>& s0, const Sym3<Real>& s1,
                                         const Sym3<Real>& dE, Real v0, Real v1) {
  return 0.25 * (v0 + v1) * contract(s0 + s1, dE);
}

KRATER_FORCE_INLINE StartState<PackPair> paired(const StartState<Pack>& a,
                                                const StartState<Pack>& b) {
  return {{a.temperature, b.temperature}, {a.pressure, b.pressure}, {a.compression, b.compression}};
}

template <class Law>
class StrengthStage final : public Stage {
 public:
  StrengthStage(const Law& law, const MaterialConstants& constants, Layout& layout)
      : law_{law},
        G_{constants.shear_modulus},
        start_{constants, layout},
        voids_{layout},
        s_{layout.state<field::DeviatoricStress>(0.0, Law::name)},
        mass_{layout.input<field::Mass>(Law::name)},
        dtL_{layout.local_input<field::StepGradient>(Law::name)},
        strain_{layout.local_input<field::StrainStep>(Law::name)},
        volumes_{layout.local_input<field::SpecificVolumes>(Law::name)},
        work_{layout.local_output<field::SpecificWork>(Law::name)},
        shear_{layout.local_output<field::ShearModulus>(Law::name)} {
    if constexpr (Yielding<Law>) {
      eps_ = layout.state<field::PlasticStrain>(0.0, Law::name);
      plastic_work_ = layout.local_output<field::PlasticWork>(Law::name);
      if constexpr (ReadsPressure<Law>) pressure_ = layout.input<field::Pressure>(Law::name);
    }
  }

  void apply(const BatchData& batch) const override {
    if constexpr (Yielding<Law> && !kSolvesPairs) {
      for (int g = 0; g < batch.groups; ++g) apply_one(batch, g);
    } else if constexpr (Yielding<Law>) {
      // Two groups at a time (returns/pack_pair.hpp); an odd last group is paired with itself.
      for (int g = 0; g < batch.groups; g += 2)
        apply_pair(batch, g, g + 1 < batch.groups ? g + 1 : g);
    } else {
      for (int g = 0; g < batch.groups; ++g) {
        const Mat3<Pack> dtL = load_mat3(view(batch, dtL_), g);
        finish(batch, g, trial_deviator(load_sym3(view(batch, s_), g), dtL, G_), Pack(G_));
      }
    }
  }

 private:
  KRATER_FORCE_INLINE StartState<Pack> start(const BatchData& batch, int g) const {
    if constexpr (ReadsPressure<Law>) return start_(batch, g, view(batch, pressure_)(g));
    return start_(batch, g, Pack(0.0));
  }

  template <class Modulus>
  KRATER_FORCE_INLINE Trial<Pack> trial(const BatchData& batch, int g, Modulus G) const {
    return trial_step(load_sym3(view(batch, s_), g), load_mat3(view(batch, dtL_), g),
                      load_sym3(view(batch, strain_), g), G);
  }

  KRATER_FORCE_INLINE void apply_one(const BatchData& batch, int g) const {
    const StartState<Pack> at = start(batch, g);
    const auto G = shear_at(law_, at, G_);
    const Trial<Pack> of = trial(batch, g, G);
    yield(batch, g, of, G,
          plastic_step(law_, at, of.q, view(batch, eps_)(g), G, of.strain, batch.dt));
  }

  KRATER_FORCE_INLINE void apply_pair(const BatchData& batch, int g, int h) const {
    const StartState<Pack> start_g = start(batch, g), start_h = start(batch, h);
    const auto G_g = shear_at(law_, start_g, G_), G_h = shear_at(law_, start_h, G_);
    const Trial<Pack> trial_g = trial(batch, g, G_g);
    const Trial<Pack> trial_h = trial(batch, h, G_h);
    const auto eps = view(batch, eps_);
    const PlasticStep<PackPair> step = plastic_step(
        law_, paired(start_g, start_h), PackPair{trial_g.q, trial_h.q}, PackPair{eps(g), eps(h)},
        both(G_g, G_h), PackPair{trial_g.strain, trial_h.strain}, batch.dt);
    yield(batch, g, trial_g, G_g, {step.d.a, step.stress.a, step.yielding.a, step.unconverged.a});
    if (h != g)
      yield(batch, h, trial_h, G_h, {step.d.b, step.stress.b, step.yielding.b, step.unconverged.b});
  }

  /// The moduli of two groups: one double where the law's does not vary.
  KRATER_FORCE_INLINE static double both(double G, double) { return G; }
  KRATER_FORCE_INLINE static PackPair both(Pack G, Pack H) { return {G, H}; }

  KRATER_FORCE_INLINE Pack plastic_work(const BatchData& batch, int g,
                                        const PlasticStep<Pack>& step) const {
    const Pack v = view(batch, volumes_)(g, 1);
    const Pack work = step.stress * step.d * v;
    if constexpr (Dilatant<Law>) {
      const Pack opened = voids_.open(batch, g, law_, step.d, v);
      return dilatant_work(work, view(batch, pressure_)(g), opened);
    }
    return work;
  }

  template <class Modulus>
  KRATER_FORCE_INLINE void yield(const BatchData& batch, int g, const Trial<Pack>& trial, Modulus G,
                                 const PlasticStep<Pack>& step) const {
    const auto eps = view(batch, eps_);
    const Pack work = plastic_work(batch, g, step);
    eps.set(g, eps(g) + step.d);
    view(batch, plastic_work_).set(g, work);
    batch.ledger->plastic_work += sum(view(batch, mass_)(g) * work);
    if (any(step.unconverged)) {
      batch.ledger->unconverged += count_points(batch, g, step.unconverged);
      report(batch, FaultKind::no_convergence, g, step.unconverged);
    }
    finish(batch, g, returned(trial, step), Pack(G));
  }

  KRATER_FORCE_INLINE void finish(const BatchData& batch, int g, const Sym3<Pack>& s,
                                  Pack G) const {
    const auto s_p = view(batch, s_);
    const auto v = view(batch, volumes_);
    const auto work = view(batch, work_);
    const Sym3<Pack> dE = load_sym3(view(batch, strain_), g);
    work.set(g, work(g) + deviatoric_work(load_sym3(s_p, g), s, dE, v(g, 0), v(g, 1)));
    store_sym3(s_p, g, s);
    view(batch, shear_).set(g, G);
  }

  Law law_;
  double G_;
  StartReader<Law> start_;
  VoidsOf<Law> voids_;
  State<field::DeviatoricStress> s_;
  Input<field::Mass> mass_;
  LocalInput<field::StepGradient> dtL_;
  LocalInput<field::StrainStep> strain_;
  LocalInput<field::SpecificVolumes> volumes_;
  LocalOutput<field::SpecificWork> work_;
  LocalOutput<field::ShearModulus> shear_;
  State<field::PlasticStrain> eps_{-1};  // these two: yielding laws only
  LocalOutput<field::PlasticWork> plastic_work_{-1};
  Input<field::Pressure> pressure_{-1};  // laws that read it only
};

}  // namespace krater::inline KRATER_ISA
