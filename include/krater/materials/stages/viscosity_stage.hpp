// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Artificial viscous pressure of the step, and its work - (q_n + q_{n+1})/2 dv (theory 9, 10). It
/// is a stage of its own: a scene without a `viscosity:` block has neither the column nor the cost.
#pragma once

#include "krater/materials/batch_access.hpp"
#include "krater/materials/law.hpp"

namespace krater::inline KRATER_ISA {

template <class Law>
class ViscosityStage final : public Stage {
 public:
  ViscosityStage(const Law& law, Layout& layout)
      : law_{law},
        rho_{layout.input<field::Density>("viscosity")},
        c_{layout.input<field::SoundSpeed>("viscosity")},
        mass_{layout.input<field::Mass>("viscosity")},
        q_{layout.state<field::ViscousPressure>(0.0, "viscosity")},
        volumes_{layout.local_input<field::SpecificVolumes>("viscosity")},
        rate_{layout.local_input<field::DilatationRate>("viscosity")},
        work_{layout.local_output<field::SpecificWork>("viscosity")} {}

  void apply(const BatchData& batch) const override {
    const auto rho_p = view(batch, rho_);
    const auto c_p = view(batch, c_);
    const auto m_p = view(batch, mass_);
    const auto q_p = view(batch, q_);
    const auto v_p = view(batch, volumes_);
    const auto trD_p = view(batch, rate_);
    const auto w_p = view(batch, work_);
    const ReadView length = lengths(batch);
    for (int g = 0; g < batch.groups; ++g) {
      const Pack q = law_(rho_p(g), c_p(g), trD_p(g), length(g));
      const Pack work = -0.5 * (q_p(g) + q) * (v_p(g, 1) - v_p(g, 0));
      q_p.set(g, q);
      w_p.set(g, w_p(g) + work);
      batch.ledger->viscous_work += sum(m_p(g) * work);
    }
  }

 private:
  Law law_;
  Input<field::Density> rho_;
  Input<field::SoundSpeed> c_;
  Input<field::Mass> mass_;
  State<field::ViscousPressure> q_;
  LocalInput<field::SpecificVolumes> volumes_;
  LocalInput<field::DilatationRate> rate_;
  LocalOutput<field::SpecificWork> work_;
};

}  // namespace krater::inline KRATER_ISA
