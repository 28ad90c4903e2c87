// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Heat that may be taken from a point without cooling it below absolute zero; the ledger takes no
/// more (kinematics/mpm/ledger.hpp). Not one of a material's stages: applied where heat is taken.
///   a = e - e_0(rho),   e_0 = e_s(rho) - 1e-3 c0^2   (a solid at its reference state), or
///                       e_0 = e_s(rho) - e_s(rho0) T_s(rho)/T_ref   (a gas: its energy is heat
///                                                                    from the start)
/// with the isentrope e_s, T_s through the reference state (heating/isentrope.hpp); 1e-3 c0^2 is a
/// tenth of c_v T at room temperature in metals. An expanded solid, which may hold voids or have
/// failed, is judged by e_s(rho0): its cold tension is not its own. e_0 is a table of chords over
/// rho/rho0: e_s is convex, they lie above it, and what they leave untouched is 1e-5 c0^2.
#pragma once

#include <cmath>

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
      : per_rho0_{1.0 / law.rho0},
        rho_{layout.input<field::Density>(kName)},
        e_{layout.input<field::InternalEnergy>(kName)},
        distension_{layout.optional<field::Distension>()},
        heat_{layout.local_output<field::AvailableHeat>(kName)} {
    Isentrope isentrope;
    isentrope.tabulate(law, 1.0);
    const double start = energy_at_start(law), least = start > 0 ? 0.0 : 1e-3 * law.c0 * law.c0;
    for (int i = 0; i <= kRows; ++i) {
      const double x = static_cast<double>(i) / kPerUnit;
      const auto reference = isentrope.at(x - 1.0);
      const double cold = x < 1 ? std::fmin(reference.energy, start) : reference.energy;
      coldest_[i] = cold - start * reference.temperature - least;
    }
    for (int i = 0; i < kRows; ++i) rise_[i] = coldest_[i + 1] - coldest_[i];
  }

  void apply(const BatchData& batch) const override {
    const auto heat_p = view(batch, heat_);
    const auto rho_p = view(batch, rho_);
    const auto e_p = view(batch, e_);
    for (int g = 0; g < batch.groups; ++g) {
      Pack x = rho_p(g) * per_rho0_;
      if (distension_.offset >= 0) x = x * view(batch, distension_)(g);
      const Pack place = clamp(x * kPerUnit, Pack(0.0), Pack(kRows - 1e-9)), row = floor(place);
      alignas(64) double at[kLanes], low[kLanes], rise[kLanes];
      store(at, select(row == row, row, Pack(0.0)));  // a NaN is no index; it comes through `place`
      for (int l = 0; l < kLanes; ++l) {
        const int i = static_cast<int>(at[l]);
        low[l] = coldest_[i];
        rise[l] = rise_[i];
      }
      heat_p.set(g, max(Pack(0.0), e_p(g) - fma(load(rise), place - row, load(low))));
    }
  }

 private:
  static constexpr const char* kName = "heat floor";

  static constexpr int kPerUnit = 128, kRows = 12 * kPerUnit;  // to the end of the isentrope

  double per_rho0_;
  double coldest_[kRows + 1], rise_[kRows];  ///< e_0 at the rows, and to the next
  Input<field::Density> rho_;
  Input<field::InternalEnergy> e_;
  Optional<field::Distension> distension_;
  LocalOutput<field::AvailableHeat> heat_;
};

}  // namespace krater::inline KRATER_ISA
