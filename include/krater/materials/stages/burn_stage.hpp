// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Burn fraction of an explosive at the end of the step (eos/jwl_burn.hpp), before its equation of
/// state. The time since the front came by is a column of its own that each step advances, negative
/// until then: so a stage knows no clock, and an explosive that waits is not taken to be at rest.
#pragma once

#include "krater/materials/batch_access.hpp"
#include "krater/materials/stage.hpp"

namespace krater::inline KRATER_ISA {

template <class Law>
concept Burns = requires(const Law& law) {
  law.burnt(0.0, 0.0, 0.0, 1.0);
};

template <class Law>
class BurnStage final : public Stage {
 public:
  /// The stage of the equation of state has declared the burn fraction.
  BurnStage(const Law& law, Layout& layout)
      : law_{law},
        F_{layout.find(field::BurnFraction::info.name)->offset},
        since_{layout.state<field::SinceLighting>(kNeverLit, Law::name)},
        rho_{layout.input<field::Density>(Law::name)} {}

  void apply(const BatchData& batch) const override {
    const auto F_p = view(batch, F_);
    const auto since_p = view(batch, since_);
    const auto rho_p = view(batch, rho_);
    const ReadView length = lengths(batch);
    for (int g = 0; g < batch.groups; ++g) {
      const Pack since = since_p(g) + batch.dt;
      const Pack before = F_p(g);
      report(batch, FaultKind::not_finite_state, g, !is_finite(before + since));
      since_p.set(g, since);
      F_p.set(g, law_.burnt(before, since, rho_p(g), length(g)));
    }
  }

 private:
  Law law_;
  State<field::BurnFraction> F_;
  State<field::SinceLighting> since_;
  Input<field::Density> rho_;
};

}  // namespace krater::inline KRATER_ISA
