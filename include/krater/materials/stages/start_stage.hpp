// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The start of the step on the undamaged area, for materials whose deviator is updated in several
/// stages: the pressure p~ = p^/w, got back from the carried one, and the shear modulus, which a
/// law may make of it. Every later stage of the deviator reads both here, so that neither damage
/// nor rates know which laws vary G or read p. Where spall has cut p^ off, p~ is the effective
/// tension which the material really bears. A coupled law may make its modulus of its own history.
#pragma once

#include "krater/materials/law_state.hpp"
#include "krater/materials/model/coupled.hpp"
#include "krater/materials/returns/start_reader.hpp"

namespace krater::inline KRATER_ISA {

/// Loss 1 - w of the carried pressure per unit of damage (Decision 6): 1 or 0.
struct PressureLoss {
  double tension, compression;
};
inline PressureLoss pressure_loss(bool degrades, DegradePressure mode) {
  return {degrades && mode != DegradePressure::none ? 1.0 : 0.0,
          degrades && mode == DegradePressure::all ? 1.0 : 0.0};
}

template <class Law, bool damaged>
class StartStage final : public Stage {
 public:
  StartStage(const Law& law, PressureLoss loss, const MaterialConstants& constants, Layout& layout)
      : law_{law},
        loss_{loss},
        G_{constants.shear_modulus},
        start_{constants, layout},
        shear_{layout.local_output<field::ShearModulus>(Law::name)} {
    if constexpr (reads_pressure) {
      p_ = layout.input<field::Pressure>(Law::name);
      effective_ = layout.local_output<field::EffectivePressure>(Law::name);
    }
    if constexpr (damaged) phi_ = layout.input<field::Damage>(Law::name);
    if constexpr (ShearOfState<Law>) state_ = StateReader<Law>{layout};
  }

  void apply(const BatchData& batch) const override {
    for (int g = 0; g < batch.groups; ++g) {
      Pack p = Pack(0.0);
      if constexpr (reads_pressure) {
        p = pressure(batch, g);
        view(batch, effective_).set(g, p);
      }
      if constexpr (ShearOfState<Law>) {
        view(batch, shear_).set(g, law_.shear_modulus(state_(batch, g)));
      } else {
        view(batch, shear_).set(g, Pack(shear_at(law_, start_(batch, g, p), G_)));
      }
    }
  }

 private:
  static constexpr bool reads_pressure = damaged || ReadsPressure<Law>;

  KRATER_FORCE_INLINE Pack pressure(const BatchData& batch, int g) const {
    const Pack p = view(batch, p_)(g);
    if constexpr (damaged) {
      const Pack share = select(p < Pack(0.0), Pack(loss_.tension), Pack(loss_.compression));
      return p / fnma(share, view(batch, phi_)(g), Pack(1.0));
    }
    return p;
  }

  Law law_;
  PressureLoss loss_;
  double G_;
  StartReader<Law> start_;
  LocalOutput<field::ShearModulus> shear_;
  Input<field::Pressure> p_{-1};  // these three: where they are read
  LocalOutput<field::EffectivePressure> effective_{-1};
  Input<field::Damage> phi_{-1};
  StateReader<Law> state_;
};

}  // namespace krater::inline KRATER_ISA
