// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Plastic return on the effective deviator, for materials whose deviator is updated in several
/// stages (materials/assembly.hpp): one class per coupling of damage (Decision 8). What the
/// material carries of the result is the business of carried_stage.hpp.
#pragma once

#include "krater/materials/returns/rate_return.hpp"
#include "krater/materials/stages/strength_stage.hpp"

namespace krater::inline KRATER_ISA {

/// What every stage of a yield law needs here.
template <class Law>
class YieldingStage : public Stage {
 public:
  YieldingStage(const Law& law, const MaterialConstants& constants, Layout& layout)
      : law_{law},
        start_{constants, layout},
        eps_{layout.state<field::PlasticStrain>(0.0, Law::name)},
        strain_{layout.local_input<field::StrainStep>(Law::name)},
        shear_{layout.local_input<field::ShearModulus>(Law::name)},
        effective_{layout.local_output<field::EffectiveDeviator>(Law::name)},
        q_{layout.local_output<field::EquivalentStress>(Law::name)} {
    if constexpr (ReadsPressure<Law>)
      pressure_ = layout.local_input<field::EffectivePressure>(Law::name);
  }

 protected:
  KRATER_FORCE_INLINE Trial<Pack> trial(const BatchData& batch, int g) const {
    const Sym3<Pack> s = load_sym3(view(batch, effective_), g);
    return {s, equivalent_stress(s), equivalent_strain(load_sym3(view(batch, strain_), g))};
  }
  KRATER_FORCE_INLINE StartState<Pack> start(const BatchData& batch, int g) const {
    if constexpr (ReadsPressure<Law>) return start_(batch, g, view(batch, pressure_)(g));
    return start_(batch, g, Pack(0.0));
  }

  Law law_;
  StartReader<Law> start_;
  State<field::PlasticStrain> eps_;
  LocalInput<field::StrainStep> strain_;
  LocalInput<field::ShearModulus> shear_;
  LocalOutput<field::EffectiveDeviator> effective_;
  LocalOutput<field::EquivalentStress> q_;
  LocalInput<field::EffectivePressure> pressure_{-1};  // laws that read it only
};

/// What every plastic return leaves behind; a dilatant law opens its voids.
template <class Law>
class FlowingStage : public YieldingStage<Law> {
 public:
  FlowingStage(const Law& law, const MaterialConstants& constants, Layout& layout)
      : YieldingStage<Law>{law, constants, layout},
        voids_{layout},
        volumes_{layout.local_input<field::SpecificVolumes>(Law::name)},
        increment_{layout.local_output<field::PlasticIncrement>(Law::name)} {
    if constexpr (Dilatant<Law>) opened_ = layout.local_output<field::OpenedVolume>(Law::name);
  }

 protected:
  KRATER_FORCE_INLINE void finish(const BatchData& batch, int g, const Trial<Pack>& trial,
                                  const PlasticStep<Pack>& step) const {
    const auto eps = view(batch, this->eps_);
    eps.set(g, eps(g) + step.d);
    view(batch, increment_).set(g, step.d);
    view(batch, this->q_).set(g, select(step.yielding, step.stress, trial.q));
    store_sym3(view(batch, this->effective_), g, returned(trial, step));
    if constexpr (Dilatant<Law>) {
      const Pack v = view(batch, volumes_)(g, 1);
      view(batch, opened_).set(g, voids_.open(batch, g, this->law_, step.d, v));
    }
    if (!any(step.unconverged)) return;
    batch.ledger->unconverged += count_points(batch, g, step.unconverged);
    report(batch, FaultKind::no_convergence, g, step.unconverged);
  }

 private:
  VoidsOf<Law> voids_;
  LocalInput<field::SpecificVolumes> volumes_;
  LocalOutput<field::PlasticIncrement> increment_;
  LocalOutput<field::OpenedVolume> opened_{-1};  // dilatant laws only
};

/// q~ before the return, min(q~_tr, sigma_Y at the strain rate of the step): what the growth of
/// damage needs where it enters the return.
template <class Law>
class FlowStressStage final : public YieldingStage<Law> {
 public:
  using YieldingStage<Law>::YieldingStage;

  void apply(const BatchData& batch) const override {
    const auto eps_p = view(batch, this->eps_);
    const Pack per_dt = Pack(1.0 / batch.dt);
    for (int g = 0; g < batch.groups; ++g) {
      const Trial<Pack> trial = this->trial(batch, g);
      const auto curve = curve_at(this->law_, this->start(batch, g));
      const auto hardening = curve.hardening(eps_p(g));
      // eps may be zero, where slopes are infinite; only the stress is wanted.
      const Pack flow =
          curve.flow(hardening, max(Pack(1e-300), eps_p(g)), trial.strain * per_dt).stress;
      view(batch, this->q_).set(g, min(flow, trial.q));
    }
  }
};

/// `coupling: effective`, also for sound materials: returns/radial_return.hpp.
template <class Law>
class PlasticReturnStage final : public FlowingStage<Law> {
 public:
  using FlowingStage<Law>::FlowingStage;

  void apply(const BatchData& batch) const override {
    if constexpr (kSolvesPairs) {
      // Two groups at a time (returns/pack_pair.hpp); an odd last group is paired with itself.
      for (int g = 0; g < batch.groups; g += 2)
        apply_pair(batch, g, g + 1 < batch.groups ? g + 1 : g);
    } else {
      for (int g = 0; g < batch.groups; ++g) apply_one(batch, g);
    }
  }

 private:
  KRATER_FORCE_INLINE void apply_one(const BatchData& batch, int g) const {
    const Trial<Pack> trial = this->trial(batch, g);
    const auto eps = view(batch, this->eps_);
    const auto G = view(batch, this->shear_);
    this->finish(batch, g, trial,
                 plastic_step(this->law_, this->start(batch, g), trial.q, eps(g), G(g),
                              trial.strain, batch.dt));
  }

  KRATER_FORCE_INLINE void apply_pair(const BatchData& batch, int g, int h) const {
    const Trial<Pack> a = this->trial(batch, g), b = this->trial(batch, h);
    const auto eps = view(batch, this->eps_);
    const auto G = view(batch, this->shear_);
    const PlasticStep<PackPair> step = plastic_step(
        this->law_, paired(this->start(batch, g), this->start(batch, h)), PackPair{a.q, b.q},
        PackPair{eps(g), eps(h)}, PackPair{G(g), G(h)}, PackPair{a.strain, b.strain}, batch.dt);
    this->finish(batch, g, a, {step.d.a, step.stress.a, step.yielding.a, step.unconverged.a});
    if (h != g)
      this->finish(batch, h, b, {step.d.b, step.stress.b, step.yielding.b, step.unconverged.b});
  }
};

/// A law that never yields, for brittle damage: q~ is that of the trial.
class ElasticReturnStage final : public Stage {
 public:
  explicit ElasticReturnStage(Layout& layout)
      : effective_{layout.local_input<field::EffectiveDeviator>("elastic")},
        q_{layout.local_output<field::EquivalentStress>("elastic")} {}

  void apply(const BatchData& batch) const override {
    for (int g = 0; g < batch.groups; ++g)
      view(batch, q_).set(g, equivalent_stress(load_sym3(view(batch, effective_), g)));
  }

 private:
  LocalInput<field::EffectiveDeviator> effective_;
  LocalOutput<field::EquivalentStress> q_;
};

/// `coupling: rate`: returns/rate_return.hpp.
template <class Law>
class RateReturnStage final : public FlowingStage<Law> {
 public:
  RateReturnStage(const Law& law, const MaterialConstants& constants, Layout& layout)
      : FlowingStage<Law>{law, constants, layout},
        phi_{layout.input<field::Damage>(Law::name)},
        growth_{layout.local_input<field::DamageGrowth>(Law::name)},
        snap_back_{layout.local_output<field::SnapBack>(Law::name)} {}

  void apply(const BatchData& batch) const override {
    const auto eps = view(batch, this->eps_);
    const auto growth_p = view(batch, growth_);
    for (int g = 0; g < batch.groups; ++g) {
      const Trial<Pack> trial = this->trial(batch, g);
      const Growth<Pack> growth{growth_p(g, 0), growth_p(g, 1), growth_p(g, 2)};
      const RateStep<Pack> result = rate_return(
          curve_at(this->law_, this->start(batch, g)), trial.q, eps(g),
          view(batch, this->shear_)(g), view(batch, phi_)(g), growth, trial.strain, batch.dt);
      view(batch, snap_back_).set(g, select(result.snapped, Pack(1.0), Pack(0.0)));
      if (any(result.snapped)) batch.ledger->snap_backs += count_points(batch, g, result.snapped);
      this->finish(batch, g, trial, result.step);
    }
  }

 private:
  Input<field::Damage> phi_;
  LocalInput<field::DamageGrowth> growth_;
  LocalOutput<field::SnapBack> snap_back_;
};

}  // namespace krater::inline KRATER_ISA
