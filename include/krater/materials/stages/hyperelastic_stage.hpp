// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Stage of a law that gives the whole stress from F: deviator, pressure, energy and sound speed,
/// no equation of state. The kinematics stage keeps F; new points have F = I. The law sees
/// (J_bar/J)^(1/3) F with the cell-averaged volume J_bar = rho_0/rho: the force takes the averaged
/// pressure, and the work of one without the other is a source of energy (theory 18).
#pragma once

#include "krater/core/lane_math.hpp"
#include "krater/materials/batch_access.hpp"
#include "krater/materials/law.hpp"
#include "krater/materials/stages/strength_stage.hpp"

namespace krater::inline KRATER_ISA {

template <class Law>
concept WholeStress = requires {
  requires Law::whole_stress;
};

template <class Law>
class HyperelasticStage final : public Stage {
 public:
  HyperelasticStage(const Law& law, const MaterialConstants& constants, Layout& layout)
      : law_{law},
        c0_squared_{law.reference_modulus() / constants.density},
        F_{layout.input<field::DeformationGradient>(Law::name)},
        rho_{layout.input<field::Density>(Law::name)},
        s_{layout.state<field::DeviatoricStress>(0.0, Law::name)},
        p_{layout.state<field::Pressure>(0.0, Law::name)},
        e_{layout.state<field::InternalEnergy>(0.0, Law::name)},
        c_{layout.state<field::SoundSpeed>(sqrt(c0_squared_), Law::name)},
        mass_{layout.input<field::Mass>(Law::name)},
        strain_{layout.local_input<field::StrainStep>(Law::name)},
        volumes_{layout.local_input<field::SpecificVolumes>(Law::name)},
        work_{layout.local_input<field::SpecificWork>(Law::name)},
        shear_{layout.local_output<field::ShearModulus>(Law::name)} {}

  void apply(const BatchData& batch) const override {
    const auto F_p = view(batch, F_);
    const auto rho_p = view(batch, rho_);
    const auto p_p = view(batch, p_);
    const auto e_p = view(batch, e_);
    const auto c_p = view(batch, c_);
    const auto G_p = view(batch, shear_);
    const Mask alone = Pack(batch.energy_share) > Pack(0.0);  // else the ledger keeps e
    for (int g = 0; g < batch.groups; ++g) {
      const Mat3<Pack> F = load_mat3(F_p, g);
      const Pack averaged = law_.rho0 / (rho_p(g) * det(F));
      const auto response = law_(exp(1.0 / 3.0 * log(averaged)) * F);
      book_work(batch, g, response.s, response.pressure);
      store_sym3(view(batch, s_), g, response.s);
      p_p.set(g, response.pressure);
      e_p.set(g, select(alone, response.energy, e_p(g)));
      const Pack c_squared = response.modulus / rho_p(g);
      const Pack floor = Pack(0.01 * c0_squared_);
      const Mask floored = c_squared < floor;
      if (any(floored)) batch.ledger->sound_speed_floors += count_points(batch, g, floored);
      c_p.set(g, sqrt(max(floor, c_squared)));
      G_p.set(g, Pack(law_.G));
    }
  }

 private:
  /// Of the trapezium in s and p: psi of the start is not kept where the ledger keeps e.
  KRATER_FORCE_INLINE void book_work(const BatchData& batch, int g, const Sym3<Pack>& s,
                                     Pack p) const {
    const auto v = view(batch, volumes_);
    const Pack deviator = deviatoric_work(load_sym3(view(batch, s_), g), s,
                                          load_sym3(view(batch, strain_), g), v(g, 0), v(g, 1)) +
                          view(batch, work_)(g);
    const Pack work = fnma(view(batch, p_)(g) + p, 0.5 * (v(g, 1) - v(g, 0)), deviator);
    batch.ledger->barotropic_work += sum(view(batch, mass_)(g) * work);
  }

  Law law_;
  double c0_squared_;
  Input<field::DeformationGradient> F_;
  Input<field::Density> rho_;
  State<field::DeviatoricStress> s_;
  State<field::Pressure> p_;
  State<field::InternalEnergy> e_;
  State<field::SoundSpeed> c_;
  Input<field::Mass> mass_;
  LocalInput<field::StrainStep> strain_;
  LocalInput<field::SpecificVolumes> volumes_;
  LocalInput<field::SpecificWork> work_;  // of viscosity
  LocalOutput<field::ShearModulus> shear_;
};

}  // namespace krater::inline KRATER_ISA
