// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From the effective deviator to what the material carries: the one place where damage degrades
/// the deviator (theory 4):
///   phi_{n+1} = phi(d), failure at phi_c or by snap-back,
///   s_{n+1} = (1 - phi_{n+1}) s~_{n+1}, zero after failure;
/// then the work (v_n + v_{n+1})/2 (s_n + s_{n+1})/2 : dE and the plastic work q_{n+1} d/rho of the
/// carried stresses. A point that fails in this step has no deviator and no tension before e is
/// formed, so the elastic energy it releases stays in e as heat. What the pressure loses is told to
/// the equation of state: 1 - w.
#pragma once

#include "krater/materials/stages/damage_stage.hpp"
#include "krater/materials/stages/start_stage.hpp"
#include "krater/materials/stages/strength_stage.hpp"

namespace krater::inline KRATER_ISA {

/// Plastic work of the step, `q` the carried stress. `dilates`: flow opened voids against `p_`.
template <bool dilates>
class PlasticWorkOfStep {
 public:
  explicit PlasticWorkOfStep(Layout& layout)
      : increment_{layout.local_optional<field::PlasticIncrement>()} {
    if constexpr (dilates) {
      p_ = layout.input<field::Pressure>("plastic work");
      opened_ = layout.local_input<field::OpenedVolume>("plastic work");
    }
  }
  KRATER_FORCE_INLINE Pack operator()(const BatchData& batch, int g, Pack q, Pack v) const {
    const Pack work = q * view(batch, increment_)(g) * v;
    if constexpr (dilates) return dilatant_work(work, view(batch, p_)(g), view(batch, opened_)(g));
    return work;
  }

 private:
  LocalOptional<field::PlasticIncrement> increment_;  // absent: a law that never yields
  Input<field::Pressure> p_{-1};
  LocalInput<field::OpenedVolume> opened_{-1};
};

/// A sound material whose deviator was updated in several stages for its rate's sake.
template <bool dilates>
class SoundStage final : public Stage {
 public:
  explicit SoundStage(Layout& layout)
      : flow_{layout},
        s_{layout.state<field::DeviatoricStress>(0.0, kName)},
        mass_{layout.input<field::Mass>(kName)},
        strain_{layout.local_input<field::StrainStep>(kName)},
        volumes_{layout.local_input<field::SpecificVolumes>(kName)},
        effective_{layout.local_input<field::EffectiveDeviator>(kName)},
        q_{layout.local_optional<field::EquivalentStress>()},
        work_{layout.local_output<field::SpecificWork>(kName)},
        plastic_work_{layout.local_output<field::PlasticWork>(kName)} {}

  void apply(const BatchData& batch) const override {
    const auto s_p = view(batch, s_);
    const auto v = view(batch, volumes_);
    const auto work = view(batch, work_);
    for (int g = 0; g < batch.groups; ++g) {
      const Sym3<Pack> s = load_sym3(view(batch, effective_), g);
      const Sym3<Pack> dE = load_sym3(view(batch, strain_), g);
      work.set(g, work(g) + deviatoric_work(load_sym3(s_p, g), s, dE, v(g, 0), v(g, 1)));
      store_sym3(s_p, g, s);
      const Pack plastic = flow_(batch, g, view(batch, q_)(g), v(g, 1));
      view(batch, plastic_work_).set(g, plastic);
      batch.ledger->plastic_work += sum(view(batch, mass_)(g) * plastic);
    }
  }

 private:
  static constexpr const char* kName = "deviator";
  PlasticWorkOfStep<dilates> flow_;
  State<field::DeviatoricStress> s_;
  Input<field::Mass> mass_;
  LocalInput<field::StrainStep> strain_;
  LocalInput<field::SpecificVolumes> volumes_;
  LocalInput<field::EffectiveDeviator> effective_;
  LocalOptional<field::EquivalentStress> q_;  // yielding laws only
  LocalOutput<field::SpecificWork> work_;
  LocalOutput<field::PlasticWork> plastic_work_;
};

/// `grows`: a damage law says how phi grows; otherwise points fail by spall alone (eos_stage.hpp).
template <bool dilates, bool grows>
class CarriedStage final : public Stage {
 public:
  CarriedStage(bool degrades, DegradePressure mode, Layout& layout)
      : degrades_{degrades ? 1.0 : 0.0},
        loss_{pressure_loss(degrades, mode)},
        flow_{layout},
        s_{layout.state<field::DeviatoricStress>(0.0, kName)},
        failed_{layout.state<field::Failed>(0.0, kName)},
        mass_{layout.input<field::Mass>(kName)},
        strain_{layout.local_input<field::StrainStep>(kName)},
        volumes_{layout.local_input<field::SpecificVolumes>(kName)},
        effective_{layout.local_input<field::EffectiveDeviator>(kName)},
        q_{layout.local_optional<field::EquivalentStress>()},
        work_{layout.local_output<field::SpecificWork>(kName)},
        shear_{layout.local_output<field::ShearModulus>(kName)},
        plastic_work_{layout.local_output<field::PlasticWork>(kName)},
        carried_loss_{layout.local_output<field::CarriedLoss>(kName)} {
    if constexpr (grows) {
      phi_ = layout.state<field::Damage>(0.0, kName);
      eps_ = layout.optional<field::PlasticStrain>();
      increment_ = layout.local_optional<field::PlasticIncrement>();
      growth_ = layout.local_input<field::DamageGrowth>(kName);
      snap_back_ = layout.local_optional<field::SnapBack>();
    }
  }

  void apply(const BatchData& batch) const override {
    for (int g = 0; g < batch.groups; ++g) {
      if constexpr (grows) {
        const Mask failed = damage(batch, g);
        carry(batch, g, failed, view(batch, phi_)(g));
      } else {
        carry(batch, g, view(batch, failed_)(g) > Pack(0.5), Pack(0.0));
      }
    }
  }

 private:
  static constexpr const char* kName = "damage";

  /// phi and failure of the end of the step.
  KRATER_FORCE_INLINE Mask damage(const BatchData& batch, int g) const {
    const auto phi_p = view(batch, phi_);
    const auto failed_p = view(batch, failed_);
    const auto growth_p = view(batch, growth_);
    const Growth<Pack> growth{growth_p(g, 0), growth_p(g, 1), growth_p(g, 2), growth_p(g, 3)};
    const Pack before = failed_p(g);
    const Pack phi =
        damage_after(growth, phi_p(g), view(batch, eps_)(g), view(batch, increment_)(g));
    const Mask old = before > Pack(0.5);
    const Mask reached = (phi >= growth.phi_c) | (view(batch, snap_back_)(g) > Pack(0.5));
    const Mask fresh = reached & !old;
    if (any(fresh)) batch.ledger->failures += count_points(batch, g, fresh);
    report(batch, FaultKind::not_finite_state, g, !is_finite(phi + before));
    phi_p.set(g, phi);
    failed_p.set(g, select(fresh, Pack(1.0), before));
    return old | fresh;
  }

  KRATER_FORCE_INLINE void carry(const BatchData& batch, int g, Mask failed, Pack phi) const {
    const auto s_p = view(batch, s_);
    const auto v = view(batch, volumes_);
    const auto work = view(batch, work_);
    const auto loss = view(batch, carried_loss_);
    const Pack intact = select(failed, Pack(0.0), fnma(Pack(degrades_), phi, Pack(1.0)));
    const Sym3<Pack> s = intact * load_sym3(view(batch, effective_), g);
    const Sym3<Pack> dE = load_sym3(view(batch, strain_), g);
    work.set(g, work(g) + deviatoric_work(load_sym3(s_p, g), s, dE, v(g, 0), v(g, 1)));
    store_sym3(s_p, g, s);
    const auto shear = view(batch, shear_);
    shear.set(g, select(failed, Pack(0.0), shear(g)));
    const Pack plastic = flow_(batch, g, intact * view(batch, q_)(g), v(g, 1));
    view(batch, plastic_work_).set(g, plastic);
    batch.ledger->plastic_work += sum(view(batch, mass_)(g) * plastic);
    loss.set(g, 0, select(failed, Pack(1.0), loss_.tension * phi));
    loss.set(g, 1, loss_.compression * phi);
  }

  double degrades_;
  PressureLoss loss_;
  PlasticWorkOfStep<dilates> flow_;
  State<field::DeviatoricStress> s_;
  State<field::Failed> failed_;
  Input<field::Mass> mass_;
  LocalInput<field::StrainStep> strain_;
  LocalInput<field::SpecificVolumes> volumes_;
  LocalInput<field::EffectiveDeviator> effective_;
  LocalOptional<field::EquivalentStress> q_;  // yielding laws only
  LocalOutput<field::SpecificWork> work_;
  LocalOutput<field::ShearModulus> shear_;
  LocalOutput<field::PlasticWork> plastic_work_;
  LocalOutput<field::CarriedLoss> carried_loss_;
  State<field::Damage> phi_{-1};            // these five: where damage grows
  Optional<field::PlasticStrain> eps_{-1};  // absent: brittle damage of a law that never yields
  LocalOptional<field::PlasticIncrement> increment_{-1};
  LocalInput<field::DamageGrowth> growth_{-1};
  LocalOptional<field::SnapBack> snap_back_{-1};
};

}  // namespace krater::inline KRATER_ISA
