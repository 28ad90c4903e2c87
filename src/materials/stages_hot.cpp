// SPDX-License-Identifier: GPL-3.0-or-later
// Every stage of every law, compiled once per instruction-set level (KRATER_ISA).
#include <limits>

#include "krater/materials/carried_stage.hpp"
#include "krater/materials/eos_stage.hpp"
#include "krater/materials/factories.hpp"
#include "krater/materials/heating_stage.hpp"
#include "krater/materials/hyperelastic_stage.hpp"
#include "krater/materials/kinematics_stage.hpp"
#include "krater/materials/law_list.hpp"
#include "krater/materials/return_stage.hpp"
#include "krater/materials/signal_speed_stage.hpp"
#include "krater/materials/strength_stage.hpp"
#include "krater/materials/trial_stage.hpp"
#include "krater/materials/viscosity_stage.hpp"

namespace krater::inline KRATER_ISA {

namespace {

bool has_deformation_gradient(const Layout& layout) {
  return layout.find(field::DeformationGradient::info.name) != nullptr;
}

/// The stage of a law, by its family.
template <class Law>
Stage* make_stage(const double* values, const MaterialConstants& constants, Layout& layout) {
  const Law law = make_law<Law>(values, constants);
  if constexpr (WholeStress<Law>) {
    if (has_deformation_gradient(layout)) {
      return new HyperelasticStage<Law, false>{law, constants, layout};
    }
    return new HyperelasticStage<Law, true>{law, constants, layout};
  } else if constexpr (Law::family == Family::strength) {
    return new StrengthStage<Law>{law, constants, layout};
  } else if constexpr (Law::family == Family::eos) {
    return new EosStage<Law, false>{law, std::numeric_limits<double>::infinity(), layout};
  } else if constexpr (Law::family == Family::damage) {
    return nullptr;  // several stages: make_part
  } else if constexpr (Law::family == Family::viscosity) {
    return new ViscosityStage<Law>{law, layout};
  } else {
    static_assert(Law::family == Family::heating);
    return new HeatingStage<Law>{law, constants, layout};
  }
}

using Make = Stage* (*)(const double*, const MaterialConstants&, Layout&);

template <class... Laws>
Stage* make_indexed(LawList<Laws...>, int law, const double* values,
                    const MaterialConstants& constants, Layout& layout) {
  static constexpr Make makers[] = {&make_stage<Laws>...};
  if (law < 0 || law >= LawList<Laws...>::size) return nullptr;
  return makers[law](values, constants, layout);
}

Stage* make(int law, const double* values, const MaterialConstants& constants, Layout& layout) {
  return make_indexed(AllLaws{}, law, values, constants, layout);
}

template <class Law>
Stage* make_carrying(const double* values, const MaterialConstants& constants,
                     double spall_strength, Layout& layout) {
  if constexpr (Law::family == Family::eos) {
    return new EosStage<Law, true>{make_law<Law>(values, constants), spall_strength, layout};
  } else {
    return nullptr;
  }
}

template <class... Laws>
Stage* make_carrying_indexed(LawList<Laws...>, int law, const double* values,
                             const MaterialConstants& constants, double spall, Layout& layout) {
  using Maker = Stage* (*)(const double*, const MaterialConstants&, double, Layout&);
  static constexpr Maker makers[] = {&make_carrying<Laws>...};
  if (law < 0 || law >= LawList<Laws...>::size) return nullptr;
  return makers[law](values, constants, spall, layout);
}

Stage* make_carrying_eos(int law, const double* values, const MaterialConstants& constants,
                         double spall_strength, Layout& layout) {
  return make_carrying_indexed(AllLaws{}, law, values, constants, spall_strength, layout);
}

/// The part of a law of strength or damage; nullptr where it has none.
template <class Law>
Stage* make_law_part(const PartRequest& r, Layout& layout) {
  // A law that reads pressure or varies G has no parts yet: the scene refuses damage and other
  // rates.
  if constexpr (Yielding<Law> && !ReadsPressure<Law> && !VariesShear<Law>) {
    const Law law = make_law<Law>(r.values, r.constants);
    if (r.part == Part::flow_stress) return new FlowStressStage<Law>{law, r.constants, layout};
    if (r.part == Part::plastic_return)
      return new PlasticReturnStage<Law>{law, r.constants, layout};
    if (r.part == Part::rate_return) return new RateReturnStage<Law>{law, r.constants, layout};
  } else if constexpr (Law::family == Family::damage) {
    const Law law = make_law<Law>(r.values, r.constants);
    if (r.part == Part::growth) return new GrowthStage<Law>{law, r.degrade, r.constants, layout};
    if (r.part == Part::carried)
      return new CarriedStage{law.degrades(), r.degrade, r.constants, layout};
  }
  return nullptr;
}

/// 1 if the law degrades the stress.
template <class Law>
double degradation(const PartRequest& r) {
  if constexpr (Law::family == Family::damage)
    return make_law<Law>(r.values, r.constants).degrades() ? 1.0 : 0.0;
  return 0.0;
}

template <class RateForm>
Stage* make_trial(const PartRequest& r, double degrades, Layout& layout) {
  if (r.law < 0) return new TrialStage<RateForm, false>{r.constants.shear_modulus, 0.0, layout};
  return new TrialStage<RateForm, true>{r.constants.shear_modulus, degrades, layout};
}

template <class... Laws>
Stage* make_part_indexed(LawList<Laws...>, const PartRequest& r, Layout& layout) {
  using Maker = Stage* (*)(const PartRequest&, Layout&);
  using Degradation = double (*)(const PartRequest&);
  static constexpr Maker makers[] = {&make_law_part<Laws>...};
  static constexpr Degradation degradations[] = {&degradation<Laws>...};
  if (r.law >= LawList<Laws...>::size) return nullptr;
  if (r.part == Part::trial) {
    const double degrades = r.law < 0 ? 0.0 : degradations[r.law](r);
    switch (r.rate) {
      case Rate::truesdell:
        return make_trial<TruesdellRate>(r, degrades, layout);
      case Rate::truesdell_projected:
        return make_trial<TruesdellProjectedRate>(r, degrades, layout);
      case Rate::jaumann:
        return make_trial<JaumannRate>(r, degrades, layout);
      case Rate::green_naghdi:
        return make_trial<GreenNaghdiRate>(r, degrades, layout);
    }
  }
  if (r.part == Part::carried && r.law < 0) return new SoundStage{r.constants, layout};
  return r.law < 0 ? nullptr : makers[r.law](r, layout);
}

Stage* make_part(const PartRequest& request, Layout& layout) {
  return make_part_indexed(AllLaws{}, request, layout);
}

Stage* make_kinematics(Layout& layout) {
  if (has_deformation_gradient(layout)) return new KinematicsStage<true>{layout};
  return new KinematicsStage<false>{layout};
}

Stage* make_signal_speed(double q_lin, double q_quad, Layout& layout) {
  return new SignalSpeedStage{q_lin, q_quad, layout};
}

constexpr StageFactory factory{make, make_part, make_carrying_eos, make_kinematics,
                               make_signal_speed};

}  // namespace

}  // namespace krater::inline KRATER_ISA

namespace krater {

const StageFactory* KRATER_CONCAT(stage_factory_, KRATER_ISA)() { return &factory; }

}  // namespace krater
