// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Elastic trial of the effective deviator by a chosen rate (returns/rates.hpp), for materials
/// whose deviator is updated in several stages. The column `deviatoric_stress` holds what the
/// material carries, s = (1 - phi) s~; here, and only here, s~ is got back from it. That costs a
/// division and saves six columns. A failed point carries nothing, so its trial is zero.
#pragma once

#include "krater/materials/batch_access.hpp"
#include "krater/materials/returns/rates.hpp"
#include "krater/materials/stage.hpp"

namespace krater::inline KRATER_ISA {

/// Damage, where it is a column of this body, degrades the stress where `degrades`.
template <class RateForm, Integrity integrity>
class TrialStage final : public Stage {
 public:
  TrialStage(bool degrades, Layout& layout)
      : degrades_{degrades ? 1.0 : 0.0},
        s_{layout.input<field::DeviatoricStress>(kName)},
        dtL_{layout.local_input<field::StepGradient>(kName)},
        strain_{layout.local_input<field::StrainStep>(kName)},
        shear_{layout.local_input<field::ShearModulus>(kName)},
        effective_{layout.local_output<field::EffectiveDeviator>(kName)} {
    if constexpr (RateForm::needs_F) F_ = layout.input<field::DeformationGradient>(kName);
    if constexpr (integrity == Integrity::damaged) phi_ = layout.input<field::Damage>(kName);
    if constexpr (integrity != Integrity::sound) failed_ = layout.input<field::Failed>(kName);
  }

  void apply(const BatchData& batch) const override {
    const auto s_p = view(batch, s_);
    const auto dtL_p = view(batch, dtL_);
    const auto dE_p = view(batch, strain_);
    for (int g = 0; g < batch.groups; ++g) {
      Sym3<Pack> s = load_sym3(s_p, g);
      if constexpr (integrity == Integrity::damaged)
        s = (Pack(1.0) / fnma(Pack(degrades_), view(batch, phi_)(g), Pack(1.0))) * s;
      StepMotion<Pack> motion{load_mat3(dtL_p, g), load_sym3(dE_p, g), {}};
      if constexpr (RateForm::needs_F) motion.F = load_mat3(view(batch, F_), g);
      Sym3<Pack> trial = RateForm::trial(s, motion, view(batch, shear_)(g));
      if constexpr (integrity != Integrity::sound) {
        const Mask failed = view(batch, failed_)(g) > Pack(0.5);
        const auto kept = [&](Pack x) { return select(failed, Pack(0.0), x); };
        trial = {kept(trial.xx), kept(trial.yy), kept(trial.zz),
                 kept(trial.yz), kept(trial.xz), kept(trial.xy)};
      }
      store_sym3(view(batch, effective_), g, trial);
    }
  }

 private:
  static constexpr const char* kName = "rate";
  double degrades_;
  Input<field::DeviatoricStress> s_;
  LocalInput<field::StepGradient> dtL_;
  LocalInput<field::StrainStep> strain_;
  LocalInput<field::ShearModulus> shear_;
  LocalOutput<field::EffectiveDeviator> effective_;
  Input<field::DeformationGradient> F_{-1};
  Input<field::Damage> phi_{-1};
  Input<field::Failed> failed_{-1};
};

}  // namespace krater::inline KRATER_ISA
