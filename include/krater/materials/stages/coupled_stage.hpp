// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The stage of a coupled law (model/coupled.hpp), after the elastic trial of the chosen rate
/// (start_stage.hpp, trial_stage.hpp):
///   s_{n+1} = s_tr q/q_tr,   p_{n+1} and e_{n+1} by Algorithm 1 (eos_stage.hpp), p >= `least`,
/// with the work of the deviator and of viscosity; then plastic work, sound speed, failure. A law
/// whose pressure needs no e has only the work in e. Plastic work is that of the deviator and what
/// crushing does not give back: both are heat. Rubble that is open (failed, p <= 0, q = 0) has no
/// stiffness until it closes, at rho0 or above: c^2 = max(c0^2, modulus/rho0) there, not by 1/rho
/// (signal_speed_stage.hpp does the same for G).
#pragma once

#include "krater/materials/model/coupled.hpp"
#include "krater/materials/stages/eos_stage.hpp"
#include "krater/materials/stages/strength_stage.hpp"

namespace krater::inline KRATER_ISA {

template <Coupled Law>
class CoupledStage final : public Stage {
 public:
  CoupledStage(const Law& law, Layout& layout)
      : law_{law},
        feels_energy_{feels_energy(matter_of(law))},
        state_{law, layout},
        s_{layout.state<field::DeviatoricStress>(0.0, Law::name)},
        p_{layout.state<field::Pressure>(0.0, Law::name)},
        e_{layout.state<field::InternalEnergy>(0.0, Law::name)},
        eps_{layout.state<field::PlasticStrain>(0.0, Law::name)},
        c_{layout.state<field::SoundSpeed>(law.c0, Law::name)},
        rho_{layout.input<field::Density>(Law::name)},
        mass_{layout.input<field::Mass>(Law::name)},
        trial_{layout.local_input<field::EffectiveDeviator>(Law::name)},
        strain_{layout.local_input<field::StrainStep>(Law::name)},
        volumes_{layout.local_input<field::SpecificVolumes>(Law::name)},
        work_{layout.local_input<field::SpecificWork>(Law::name)},
        plastic_work_{layout.local_output<field::PlasticWork>(Law::name)} {
    if constexpr (Fails<Law>) failed_ = layout.state<field::Failed>(0.0, Law::name);
  }

  void apply(const BatchData& batch) const override {
    for (int g = 0; g < batch.groups; ++g) {
      const Pack v0 = view(batch, volumes_)(g, 0), v1 = view(batch, volumes_)(g, 1);
      const CoupledStep<Pack> step = begin(batch, g, v1);
      const auto update = state_.at(law_, batch, g).update(step);
      const Pack work = view(batch, work_)(g) + yield(batch, g, step, update.q, {v0, v1});
      close(batch, g, update, v1 - v0, work);
      flow(batch, g, update, v1);
      sound(batch, g, stiffness(batch, g, update, v1));
      state_.set(batch, g, update.state);
      if constexpr (Fails<Law>) fail(batch, g, update.failed);
    }
  }

 private:
  struct Volumes {
    Pack start, end;
  };

  KRATER_FORCE_INLINE CoupledStep<Pack> begin(const BatchData& batch, int g, Pack v) const {
    const Sym3<Pack> trial = load_sym3(view(batch, trial_), g);
    return {trial,
            equivalent_stress(trial),
            equivalent_strain(load_sym3(view(batch, strain_), g)),
            view(batch, rho_)(g),
            v,
            view(batch, e_)(g),
            view(batch, eps_)(g),
            batch.dt,
            lengths(batch)(g)};
  }

  /// The deviator of the end; returns its work.
  KRATER_FORCE_INLINE Pack yield(const BatchData& batch, int g, const CoupledStep<Pack>& step,
                                 Pack q, const Volumes& v) const {
    const auto s_p = view(batch, s_);
    // Written so that a NaN in q reaches the stress; without a deviator there is nothing to scale.
    const Sym3<Pack> s = select(q >= step.q, Pack(1.0), q / step.q) * step.trial;
    const Sym3<Pack> dE = load_sym3(view(batch, strain_), g);
    const Pack work = deviatoric_work(load_sym3(s_p, g), s, dE, v.start, v.end);
    store_sym3(s_p, g, s);
    return work;
  }

  KRATER_FORCE_INLINE void close(const BatchData& batch, int g, const auto& update, Pack dv,
                                 Pack work) const {
    const auto p = view(batch, p_), e = view(batch, e_);
    const Pack share = batch.energy_share, ahead = work_share(batch);
    const VolumeChange<Pack> change{dv, batch.energy_alpha};
    const EnergyStep<Pack> step =
        limited(close_energy(update.pressure, share * p(g), e(g), change, ahead * work),
                update.least, change);
    report(batch, FaultKind::no_convergence, g, !(step.denominator > Pack(0.5)));
    if (!feels_energy_)
      batch.ledger->barotropic_work +=
          sum(view(batch, mass_)(g) * fnma(p(g) + step.pressure, 0.5 * dv, work));
    p.set(g, step.pressure);
    e.set(g, select(share > Pack(0.0), step.energy, e(g)));
  }

  KRATER_FORCE_INLINE void flow(const BatchData& batch, int g, const auto& update, Pack v) const {
    const auto eps = view(batch, eps_);
    const Pack strain = eps(g) + update.plastic;
    const Pack work = fma(update.q * update.plastic, v, update.crush);
    report(batch, FaultKind::not_finite_state, g, !is_finite(strain));
    eps.set(g, strain);
    view(batch, plastic_work_).set(g, work);
    batch.ledger->plastic_work += sum(view(batch, mass_)(g) * work);
  }

  /// c^2 of the end.
  KRATER_FORCE_INLINE Pack stiffness(const BatchData& batch, int g, const auto& update,
                                     Pack v) const {
    const Pack closed = update.modulus * v;
    if constexpr (!Fails<Law>) return closed;
    const Mask open = update.failed & !(view(batch, p_)(g) > Pack(0.0)) & !(update.q > Pack(0.0));
    const Pack rest = update.modulus * min(v, Pack(1.0 / law_.rho0));
    return select(open, max(Pack(law_.c0 * law_.c0), rest), closed);
  }

  KRATER_FORCE_INLINE void sound(const BatchData& batch, int g, Pack c_squared) const {
    const Pack floor = Pack(0.01 * law_.c0 * law_.c0);
    view(batch, c_).set(g, sqrt(max(floor, c_squared)));  // this order keeps a NaN
    const Mask floored = c_squared < floor;
    if (any(floored)) batch.ledger->sound_speed_floors += count_points(batch, g, floored);
  }

  KRATER_FORCE_INLINE void fail(const BatchData& batch, int g, Mask reached) const {
    const auto failed = view(batch, failed_);
    const Pack before = failed(g);
    report(batch, FaultKind::not_finite_state, g, !is_finite(before));
    const Mask fresh = reached & !(before > Pack(0.5));
    if (any(fresh)) batch.ledger->failures += count_points(batch, g, fresh);
    failed.set(g, select(fresh, Pack(1.0), before));
  }

  Law law_;
  bool feels_energy_;
  StateOf<Law> state_;
  State<field::DeviatoricStress> s_;
  State<field::Pressure> p_;
  State<field::InternalEnergy> e_;
  State<field::PlasticStrain> eps_;
  State<field::SoundSpeed> c_;
  Input<field::Density> rho_;
  Input<field::Mass> mass_;
  LocalInput<field::EffectiveDeviator> trial_;
  LocalInput<field::StrainStep> strain_;
  LocalInput<field::SpecificVolumes> volumes_;
  LocalInput<field::SpecificWork> work_;
  LocalOutput<field::PlasticWork> plastic_work_;
  State<field::Failed> failed_{-1};  // laws that fail only
};

}  // namespace krater::inline KRATER_ISA
