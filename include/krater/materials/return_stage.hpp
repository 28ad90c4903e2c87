// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Plastic return on the effective deviator, for materials whose deviator is updated in several
/// stages (materials/assembly.hpp): one class per coupling of damage (Decision 8). What the
/// material carries of the result is the business of carried_stage.hpp.
#pragma once

#include "krater/materials/strength/rate_return.hpp"
#include "krater/materials/strength_stage.hpp"

namespace krater::inline KRATER_ISA {

/// What every stage of a yield law needs here.
template <class Law>
class YieldingStage : public Stage {
 public:
  YieldingStage(const Law& law, const MaterialConstants& constants, Layout& layout)
      : law_{law},
        G_{constants.shear_modulus},
        eps_{layout.state<field::PlasticStrain>(0.0, Law::name)},
        strain_{layout.local_input<field::StrainStep>(Law::name)},
        effective_{layout.local_output<field::EffectiveDeviator>(Law::name)},
        q_{layout.local_output<field::EquivalentStress>(Law::name)} {
    if constexpr (Law::reads_temperature) {
      // Declared, never written here: without heating it is the constant initial temperature.
      temperature_ = {
          layout.state<field::Temperature>(constants.initial_temperature, Law::name).offset};
    }
  }

  StageOrder order() const override { return StageOrder::strength; }

 protected:
  KRATER_FORCE_INLINE Trial<Pack> trial(const BatchData& batch, int g) const {
    const Sym3<Pack> s = load_sym3(view(batch, effective_), g);
    return {s, equivalent_stress(s), equivalent_strain(load_sym3(view(batch, strain_), g))};
  }
  KRATER_FORCE_INLINE Pack temperature(const BatchData& batch, int g) const {
    if constexpr (Law::reads_temperature) return view(batch, temperature_)(g);
    return Pack(0.0);
  }

  Law law_;
  double G_;
  State<field::PlasticStrain> eps_;
  LocalInput<field::StrainStep> strain_;
  LocalOutput<field::EffectiveDeviator> effective_;
  LocalOutput<field::EquivalentStress> q_;
  Input<field::Temperature> temperature_{-1};
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
      const auto curve = this->law_.at(this->temperature(batch, g));
      const auto hardening = curve.hardening(eps_p(g));
      // eps may be zero, where slopes are infinite; only the stress is wanted.
      const Pack flow =
          curve.flow(hardening, max(Pack(1e-300), eps_p(g)), trial.strain * per_dt).stress;
      view(batch, this->q_).set(g, min(flow, trial.q));
    }
  }
};

/// `coupling: effective`, also for sound materials: strength/radial_return.hpp.
template <class Law>
class PlasticReturnStage final : public YieldingStage<Law> {
 public:
  PlasticReturnStage(const Law& law, const MaterialConstants& constants, Layout& layout)
      : YieldingStage<Law>{law, constants, layout},
        increment_{layout.local_output<field::PlasticIncrement>(Law::name)} {}

  void apply(const BatchData& batch) const override {
    // Two groups at a time (strength/pack_pair.hpp); an odd last group is paired with itself.
    for (int g = 0; g < batch.groups; g += 2)
      apply_pair(batch, g, g + 1 < batch.groups ? g + 1 : g);
  }

 private:
  KRATER_FORCE_INLINE void apply_pair(const BatchData& batch, int g, int h) const {
    const Trial<Pack> a = this->trial(batch, g), b = this->trial(batch, h);
    const auto eps = view(batch, this->eps_);
    const PackPair T{this->temperature(batch, g), this->temperature(batch, h)};
    const PlasticStep<PackPair> step =
        radial_return(this->law_.at(T), PackPair{a.q, b.q}, PackPair{eps(g), eps(h)}, this->G_,
                      PackPair{a.strain, b.strain}, batch.dt);
    finish(batch, g, a, {step.d.a, step.stress.a, step.yielding.a, step.unconverged.a});
    if (h != g) finish(batch, h, b, {step.d.b, step.stress.b, step.yielding.b, step.unconverged.b});
  }

  KRATER_FORCE_INLINE void finish(const BatchData& batch, int g, const Trial<Pack>& trial,
                                  const PlasticStep<Pack>& step) const {
    const auto eps = view(batch, this->eps_);
    eps.set(g, eps(g) + step.d);
    view(batch, increment_).set(g, step.d);
    view(batch, this->q_).set(g, select(step.yielding, step.stress, trial.q));
    store_sym3(view(batch, this->effective_), g, returned(trial, step));
    if (!any(step.unconverged)) return;
    batch.ledger->unconverged += count_points(batch, g, step.unconverged);
    report(batch, FaultKind::no_convergence, g, step.unconverged);
  }

  LocalOutput<field::PlasticIncrement> increment_;
};

/// `coupling: rate`: strength/rate_return.hpp.
template <class Law>
class RateReturnStage final : public YieldingStage<Law> {
 public:
  RateReturnStage(const Law& law, const MaterialConstants& constants, Layout& layout)
      : YieldingStage<Law>{law, constants, layout},
        phi_{layout.input<field::Damage>(Law::name)},
        growth_{layout.local_input<field::DamageGrowth>(Law::name)},
        increment_{layout.local_output<field::PlasticIncrement>(Law::name)},
        snap_back_{layout.local_output<field::SnapBack>(Law::name)} {}

  void apply(const BatchData& batch) const override {
    const auto eps = view(batch, this->eps_);
    const auto growth_p = view(batch, growth_);
    for (int g = 0; g < batch.groups; ++g) {
      const Trial<Pack> trial = this->trial(batch, g);
      const Growth<Pack> growth{growth_p(g, 0), growth_p(g, 1), growth_p(g, 2)};
      const RateStep<Pack> result =
          rate_return(this->law_.at(this->temperature(batch, g)), trial.q, eps(g), this->G_,
                      view(batch, phi_)(g), growth, trial.strain, batch.dt);
      const PlasticStep<Pack>& step = result.step;
      eps.set(g, eps(g) + step.d);
      view(batch, increment_).set(g, step.d);
      view(batch, this->q_).set(g, select(step.yielding, step.stress, trial.q));
      view(batch, snap_back_).set(g, select(result.snapped, Pack(1.0), Pack(0.0)));
      store_sym3(view(batch, this->effective_), g, returned(trial, step));
      if (any(result.snapped)) batch.ledger->snap_backs += count_points(batch, g, result.snapped);
      if (!any(step.unconverged)) continue;
      batch.ledger->unconverged += count_points(batch, g, step.unconverged);
      report(batch, FaultKind::no_convergence, g, step.unconverged);
    }
  }

 private:
  Input<field::Damage> phi_;
  LocalInput<field::DamageGrowth> growth_;
  LocalOutput<field::PlasticIncrement> increment_;
  LocalOutput<field::SnapBack> snap_back_;
};

}  // namespace krater::inline KRATER_ISA
