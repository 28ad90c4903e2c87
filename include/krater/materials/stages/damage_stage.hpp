// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How fast damage grows in this step: k = d phi/d eps and where growth starts, and what grows
/// without plastic strain, from the effective stresses (Decision 10), p~ (start_stage.hpp) and bulk
/// modulus of the start of the step, q~ and rate of the step (theory 4, 6, 7). With `coupling:
/// effective` it follows the return, with `rate` it precedes it.
#pragma once

#include "krater/materials/batch_access.hpp"
#include "krater/materials/damage/driver.hpp"

namespace krater::inline KRATER_ISA {

template <class Law>
class GrowthStage final : public Stage {
 public:
  GrowthStage(const Law& law, const MaterialConstants& constants, Layout& layout)
      : law_{law},
        c_{layout.input<field::SoundSpeed>(Law::name)},
        p_{layout.local_input<field::EffectivePressure>(Law::name)},
        shear_{layout.local_input<field::ShearModulus>(Law::name)},
        strain_{layout.local_input<field::StrainStep>(Law::name)},
        volumes_{layout.local_input<field::SpecificVolumes>(Law::name)},
        effective_{layout.local_input<field::EffectiveDeviator>(Law::name)},
        q_{layout.local_input<field::EquivalentStress>(Law::name)},
        growth_{layout.local_output<field::DamageGrowth>(Law::name)} {
    if constexpr (Law::reads_temperature)
      T_ = {layout.state<field::Temperature>(constants.initial_temperature, Law::name).offset};
  }

  void apply(const BatchData& batch) const override {
    const auto p_p = view(batch, p_);
    const auto c_p = view(batch, c_);
    const auto G_p = view(batch, shear_);
    const auto v_p = view(batch, volumes_);
    const auto growth_p = view(batch, growth_);
    const double per_dt = 1.0 / batch.dt;
    for (int g = 0; g < batch.groups; ++g) {
      DamageDriver<Pack> x;
      x.dt = batch.dt;
      x.s = load_sym3(view(batch, effective_), g);
      x.q = view(batch, q_)(g);
      const Pack c = c_p(g);
      x.pressure = p_p(g);
      x.G = G_p(g);
      x.triaxiality = -x.pressure / max(1e-6 * x.G, x.q);
      x.K = c * c / v_p(g, 0);
      x.rate = equivalent_strain(load_sym3(view(batch, strain_), g)) * per_dt;
      x.temperature = Pack(0.0);
      if constexpr (Law::reads_temperature) x.temperature = view(batch, T_)(g);
      const Growth<Pack> growth = law_.growth(x);
      growth_p.set(g, 0, growth.k);
      growth_p.set(g, 1, growth.eps_D);
      growth_p.set(g, 2, growth.phi_c);
      growth_p.set(g, 3, growth.source);
    }
  }

 private:
  Law law_;
  Input<field::SoundSpeed> c_;
  LocalInput<field::EffectivePressure> p_;
  LocalInput<field::ShearModulus> shear_;
  LocalInput<field::StrainStep> strain_;
  LocalInput<field::SpecificVolumes> volumes_;
  LocalInput<field::EffectiveDeviator> effective_;
  LocalInput<field::EquivalentStress> q_;
  LocalOutput<field::DamageGrowth> growth_;
  Input<field::Temperature> T_{-1};
};

}  // namespace krater::inline KRATER_ISA
