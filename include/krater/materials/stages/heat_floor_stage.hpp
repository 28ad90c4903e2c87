// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Heat that may be taken from a point without cooling it below absolute zero; the ledger takes no
/// more (kinematics/mpm/ledger.hpp). Not one of a material's stages: applied where heat is taken.
///   a = e - e_0,   e_0 = e_s(rho) - 1e-3 c0^2   (a solid at its reference state), or
///                  e_0 = e_s(rho) - e_s(rho0) T_s(rho)/T_ref   (a gas: its energy is heat
///                                                               from the start)
/// with the isentrope e_s, T_s through the reference state (heating/isentrope.hpp); 1e-3 c0^2 is a
/// tenth of c_v T at room temperature in metals. e_0 is a table of chords over rho/rho0: e_s is
/// convex, they lie above it, and what they leave untouched is 1e-5 c0^2.
/// An expanded solid has in e_s(rho) - e_s(rho0) what its tension has stored. That is its own as
/// far as it bears the tension p~ of its equation of state, w = p^/p~; failed or cut off (w = 0) it
/// holds voids, and its matter is at rho0:
///   rho < rho0:   e_0 = e_s(rho0) + w [e_s(rho) - e_s(rho0)] - 1e-3 c0^2
/// With w = 0 for all, ends of bars at 8 km/s under 50 GPa of tension gave 4 MJ/kg, to -3000 K.
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
      : law_{law},
        per_rho0_{1.0 / law.rho0},
        rho_{layout.input<field::Density>(kName)},
        e_{layout.input<field::InternalEnergy>(kName)},
        p_{layout.input<field::Pressure>(kName)},
        distension_{layout.optional<field::Distension>()},
        heat_{layout.local_output<field::AvailableHeat>(kName)} {
    Isentrope isentrope;
    isentrope.tabulate(law, 1.0);
    const double start = energy_at_start(law), least = start > 0 ? 0.0 : 1e-3 * law.c0 * law.c0;
    for (int i = 0; i <= kRows; ++i) {
      const double x = static_cast<double>(i) / kPerUnit;
      const auto reference = isentrope.at(x - 1.0);
      stored_[i] = x < 1 ? std::fmax(reference.energy - start, 0.0) : 0.0;
      coldest_[i] = reference.energy - stored_[i] - start * reference.temperature - least;
    }
  }

  void apply(const BatchData& batch) const override {
    const auto heat_p = view(batch, heat_);
    const auto rho_p = view(batch, rho_);
    const auto e_p = view(batch, e_);
    const auto p_p = view(batch, p_);
    for (int g = 0; g < batch.groups; ++g) {
      Pack rho = rho_p(g), p = p_p(g);
      if (distension_.offset >= 0) {
        const Pack alpha = view(batch, distension_)(g);
        rho = alpha * rho;
        p = alpha * p;
      }
      const Row row = row_at(rho * per_rho0_);
      const Pack e = e_p(g), own = pressure_at(law_, rho, 1.0 / rho, e);
      const Pack borne = select(own < Pack(0.0), clamp(p / own, Pack(0.0), Pack(1.0)), Pack(1.0));
      const Pack least = fma(borne, row.of(stored_), row.of(coldest_));
      heat_p.set(g, max(Pack(0.0), e - least));
    }
  }

 private:
  static constexpr const char* kName = "heat floor";

  static constexpr int kPerUnit = 128, kRows = 12 * kPerUnit;  // to the end of the isentrope

  /// Rows of the tables that 8 points lie at or above, and how far.
  struct Row {
    alignas(64) double at[kLanes];
    Pack beyond;
    KRATER_FORCE_INLINE Pack of(const double* table) const {
      alignas(64) double low[kLanes], rise[kLanes];
      for (int l = 0; l < kLanes; ++l) {
        const double* row = table + static_cast<int>(at[l]);
        low[l] = row[0];
        rise[l] = row[1] - row[0];
      }
      return fma(load(rise), beyond, load(low));
    }
  };
  KRATER_FORCE_INLINE static Row row_at(Pack x) {
    const Pack place = clamp(x * kPerUnit, Pack(0.0), Pack(kRows - 1e-9)), row = floor(place);
    Row out;
    store(out.at, select(row == row, row, Pack(0.0)));  // a NaN is no index; it comes through
    out.beyond = place - row;
    return out;
  }

  Law law_;
  double per_rho0_;
  double coldest_[kRows + 1];  ///< e_0 where no tension is borne
  double stored_[kRows + 1];   ///< what the tension has stored
  Input<field::Density> rho_;
  Input<field::InternalEnergy> e_;
  Input<field::Pressure> p_;
  Optional<field::Distension> distension_;
  LocalOutput<field::AvailableHeat> heat_;
};

}  // namespace krater::inline KRATER_ISA
