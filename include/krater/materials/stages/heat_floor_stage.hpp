// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Heat that may be taken from a point without cooling it below absolute zero; the ledger takes no
/// more (kinematics/mpm/ledger.hpp). Not one of a material's stages: applied where heat is taken.
///   a = e - e_s(rho) + a_0,   a_0 = 1e-3 c0^2   (a solid at its reference state), or
///                            a_0 = e_0 T_s(rho)/T_ref   (a gas: its energy is heat from the start)
/// with the isentrope e_s, T_s through the reference state (heating/isentrope.hpp); 1e-3 c0^2 is a
/// tenth of c_v T at room temperature in metals. An expanded solid, which may hold voids or have
/// failed, is judged by e_s(rho0): its cold tension is not its own.
#pragma once

#include "krater/materials/batch_access.hpp"
#include "krater/materials/heating/isentrope.hpp"
#include "krater/materials/stage.hpp"
#include "krater/points/ledger_fields.hpp"

namespace krater::inline KRATER_ISA {

/// `Law`: of a porous material that of its solid.
template <class Law>
class HeatFloorStage final : public Stage {
 public:
  HeatFloorStage(const Law& law, Layout& layout)
      : start_{energy_at_start(law)},
        least_{start_ > 0 ? 0.0 : 1e-3 * law.c0 * law.c0},
        per_rho0_{1.0 / law.rho0},
        rho_{layout.input<field::Density>(kName)},
        e_{layout.input<field::InternalEnergy>(kName)},
        distension_{layout.optional<field::Distension>()},
        heat_{layout.local_output<field::AvailableHeat>(kName)} {
    isentrope_.tabulate(law, 1.0);
  }

  void apply(const BatchData& batch) const override {
    const auto heat_p = view(batch, heat_);
    const auto rho_p = view(batch, rho_);
    const auto e_p = view(batch, e_);
    for (int g = 0; g < batch.groups; ++g) {
      Pack x = rho_p(g) * per_rho0_;
      if (distension_.offset >= 0) x = x * view(batch, distension_)(g);
      const auto reference = isentrope_.at(x - 1.0);
      const Pack cold =
          select(x < Pack(1.0), min(reference.energy, Pack(start_)), reference.energy);
      const Pack own = fma(Pack(start_), reference.temperature, Pack(least_));
      heat_p.set(g, max(Pack(0.0), e_p(g) - cold + own));
    }
  }

 private:
  static constexpr const char* kName = "heat floor";

  double start_, least_, per_rho0_;
  Isentrope isentrope_;
  Input<field::Density> rho_;
  Input<field::InternalEnergy> e_;
  Optional<field::Distension> distension_;
  LocalOutput<field::AvailableHeat> heat_;
};

}  // namespace krater::inline KRATER_ISA
