// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Temperature of the end of the step from its internal energy (heating/internal_energy.hpp). The
/// strength of the next step reads it, like that of plastic heating. Where a ledger keeps the
/// energy at the middle of the step, half of the step's work is added here, and here alone.
#pragma once

#include "krater/materials/batch_access.hpp"
#include "krater/materials/heating/internal_energy.hpp"
#include "krater/materials/heating/isentrope.hpp"
#include "krater/materials/stage.hpp"

namespace krater::inline KRATER_ISA {

/// `Law`: the equation of state, of a porous material that of its solid. `carries`: the carried
/// pressure may not be its own (damage, spall, a limit of tension). Voids of a dilatant strength
/// are outside of it.
template <class Law, bool carries>
class EnergyHeatingStage final : public Stage {
 public:
  EnergyHeatingStage(const Law& law, double c_v, bool degrades, const MaterialConstants& constants,
                     Layout& layout)
      : law_{law},
        per_cv_{1.0 / c_v},
        degrades_{degrades ? 1.0 : 0.0},
        temperature_{layout.state<field::Temperature>(constants.initial_temperature, kName)},
        rho_{layout.input<field::Density>(kName)},
        p_{layout.input<field::Pressure>(kName)},
        e_{layout.input<field::InternalEnergy>(kName)},
        s_{layout.optional<field::DeviatoricStress>()},
        phi_{layout.optional<field::Damage>()},
        voids_{layout.optional<field::VoidVolume>()},
        distension_{layout.optional<field::Distension>()},
        volumes_{layout.local_input<field::SpecificVolumes>(kName)},
        work_{layout.local_input<field::SpecificWork>(kName)},
        shear_{layout.local_optional<field::ShearModulus>()} {
    isentrope_.tabulate(law, constants.initial_temperature);
  }

  void apply(const BatchData& batch) const override {
    const auto T_p = view(batch, temperature_);
    const auto e_p = view(batch, e_);
    const auto p_p = view(batch, p_);
    const auto v_p = view(batch, volumes_);
    const auto work_p = view(batch, work_);
    const Pack missing = 0.5 - 0.5 * batch.energy_share;
    for (int g = 0; g < batch.groups; ++g) {
      const Pack e = fma(missing, work_p(g) - p_p(g) * (v_p(g, 1) - v_p(g, 0)), e_p(g));
      const auto reference = isentrope_.at((density(batch, g, e) - law_.rho0) * (1.0 / law_.rho0));
      T_p.set(g,
              fma(e - elastic(batch, g) - reference.energy, Pack(per_cv_), reference.temperature));
    }
  }

 private:
  static constexpr const char* kName = "heating";

  /// Of what the equation of state sees.
  KRATER_FORCE_INLINE Pack density(const BatchData& batch, int g, Pack e) const {
    Pack rho = view(batch, rho_)(g);
    if (voids_.offset >= 0) rho = 1.0 / (view(batch, volumes_)(g, 1) - view(batch, voids_)(g));
    Pack p = view(batch, p_)(g);
    if (distension_.offset >= 0) {
      const Pack alpha = view(batch, distension_)(g);
      rho = alpha * rho;
      p = alpha * p;
    }
    if constexpr (carries) return solid_density(law_, rho, p, e);
    return rho;
  }

  /// s:s/(4G (1 - phi) rho); nothing where there is no deviator.
  KRATER_FORCE_INLINE Pack elastic(const BatchData& batch, int g) const {
    const Sym3<Pack> s = load_sym3(view(batch, s_), g);
    const Pack intact = fnma(Pack(degrades_), view(batch, phi_)(g), Pack(1.0));
    const Pack four_G = max(Pack(1e-100), 4.0 * (view(batch, shear_)(g) * intact));
    return contract(s, s) * view(batch, volumes_)(g, 1) / four_G;
  }

  Law law_;
  double per_cv_, degrades_;
  Isentrope isentrope_;
  State<field::Temperature> temperature_;
  Input<field::Density> rho_;
  Input<field::Pressure> p_;
  Input<field::InternalEnergy> e_;
  Optional<field::DeviatoricStress> s_;
  Optional<field::Damage> phi_;
  Optional<field::VoidVolume> voids_;
  Optional<field::Distension> distension_;
  LocalInput<field::SpecificVolumes> volumes_;
  LocalInput<field::SpecificWork> work_;
  LocalOptional<field::ShearModulus> shear_;
};

}  // namespace krater::inline KRATER_ISA
