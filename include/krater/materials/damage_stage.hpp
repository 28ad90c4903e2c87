// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How fast damage grows in this step: k = d phi/d eps and where growth starts, from the effective
/// stresses (Decision 10), p~ and bulk modulus of the start of the step, q~ and rate of the step
/// (theory 4, 6, 7). With `coupling: effective` it follows the return, with `rate` it precedes it.
/// The column `pressure` is the carried p^ = w p~; p~ is got back from it. Where spall has cut p^
/// off, that is the effective tension which the material really bears.
#pragma once

#include "krater/materials/batch_access.hpp"
#include "krater/materials/damage/driver.hpp"

namespace krater::inline KRATER_ISA {

/// Loss 1 - w of the carried pressure per unit of damage (Decision 6): 1 or 0.
struct PressureLoss {
  double tension, compression;
};
inline PressureLoss pressure_loss(bool degrades, DegradePressure mode) {
  return {degrades && mode != DegradePressure::none ? 1.0 : 0.0,
          degrades && mode == DegradePressure::all ? 1.0 : 0.0};
}

template <class Law>
class GrowthStage final : public Stage {
 public:
  GrowthStage(const Law& law, DegradePressure mode, const MaterialConstants& constants,
              Layout& layout)
      : law_{law},
        loss_{pressure_loss(law.degrades(), mode)},
        G_{constants.shear_modulus},
        p_{layout.input<field::Pressure>(Law::name)},
        c_{layout.input<field::SoundSpeed>(Law::name)},
        phi_{layout.input<field::Damage>(Law::name)},
        strain_{layout.local_input<field::StrainStep>(Law::name)},
        volumes_{layout.local_input<field::SpecificVolumes>(Law::name)},
        effective_{layout.local_input<field::EffectiveDeviator>(Law::name)},
        q_{layout.local_input<field::EquivalentStress>(Law::name)},
        growth_{layout.local_output<field::DamageGrowth>(Law::name)} {
    if constexpr (Law::reads_temperature)
      T_ = {layout.state<field::Temperature>(constants.initial_temperature, Law::name).offset};
  }

  StageOrder order() const override { return StageOrder::strength; }

  void apply(const BatchData& batch) const override {
    const auto p_p = view(batch, p_);
    const auto c_p = view(batch, c_);
    const auto phi_p = view(batch, phi_);
    const auto v_p = view(batch, volumes_);
    const auto growth_p = view(batch, growth_);
    const double per_dt = 1.0 / batch.dt;
    for (int g = 0; g < batch.groups; ++g) {
      DamageDriver<Pack> x;
      x.s = load_sym3(view(batch, effective_), g);
      x.q = view(batch, q_)(g);
      const Pack p = p_p(g), c = c_p(g);
      const Pack share = select(p < Pack(0.0), Pack(loss_.tension), Pack(loss_.compression));
      x.pressure = p / fnma(share, phi_p(g), Pack(1.0));
      x.triaxiality = -x.pressure / max(Pack(1e-6 * G_), x.q);
      x.K = c * c / v_p(g, 0);
      x.G = Pack(G_);
      x.rate = equivalent_strain(load_sym3(view(batch, strain_), g)) * per_dt;
      x.temperature = Pack(0.0);
      if constexpr (Law::reads_temperature) x.temperature = view(batch, T_)(g);
      const Growth<Pack> growth = law_.growth(x);
      growth_p.set(g, 0, growth.k);
      growth_p.set(g, 1, growth.eps_D);
      growth_p.set(g, 2, growth.phi_c);
    }
  }

 private:
  Law law_;
  PressureLoss loss_;
  double G_;
  Input<field::Pressure> p_;
  Input<field::SoundSpeed> c_;
  Input<field::Damage> phi_;
  LocalInput<field::StrainStep> strain_;
  LocalInput<field::SpecificVolumes> volumes_;
  LocalInput<field::EffectiveDeviator> effective_;
  LocalInput<field::EquivalentStress> q_;
  LocalOutput<field::DamageGrowth> growth_;
  Input<field::Temperature> T_{-1};
};

}  // namespace krater::inline KRATER_ISA
