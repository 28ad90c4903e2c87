// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Temperature of the step from plastic work (theory 8). A scene without `heating:` has no such
/// stage; then the temperature is the constant of the law that reads it.
#pragma once

#include "krater/materials/batch_access.hpp"
#include "krater/materials/law.hpp"

namespace krater::inline KRATER_ISA {

template <class Law>
class HeatingStage final : public Stage {
 public:
  HeatingStage(const Law& law, const MaterialConstants& constants, Layout& layout)
      : law_{law},
        temperature_{layout.state<field::Temperature>(constants.initial_temperature, "heating")},
        mass_{layout.input<field::Mass>("heating")},
        plastic_work_{layout.local_input<field::PlasticWork>("heating")} {}

  void apply(const BatchData& batch) const override {
    const auto T_p = view(batch, temperature_);
    const auto m_p = view(batch, mass_);
    const auto w_p = view(batch, plastic_work_);
    for (int g = 0; g < batch.groups; ++g) {
      const Pack work = w_p(g);
      T_p.set(g, T_p(g) + law_(work));
      batch.ledger->plastic_heating += law_.fraction * sum(m_p(g) * work);
    }
  }

 private:
  Law law_;
  State<field::Temperature> temperature_;
  Input<field::Mass> mass_;
  LocalInput<field::PlasticWork> plastic_work_;
};

}  // namespace krater::inline KRATER_ISA
