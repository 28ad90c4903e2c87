// SPDX-License-Identifier: GPL-3.0-or-later
// Every stage of every law, compiled once per instruction-set level (KRATER_ISA).
#include "krater/materials/eos_stage.hpp"
#include "krater/materials/factories.hpp"
#include "krater/materials/heating_stage.hpp"
#include "krater/materials/hyperelastic_stage.hpp"
#include "krater/materials/kinematics_stage.hpp"
#include "krater/materials/law_list.hpp"
#include "krater/materials/signal_speed_stage.hpp"
#include "krater/materials/strength_stage.hpp"
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
    return new EosStage<Law>{law, layout};
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

Stage* make_kinematics(Layout& layout) {
  if (has_deformation_gradient(layout)) return new KinematicsStage<true>{layout};
  return new KinematicsStage<false>{layout};
}

Stage* make_signal_speed(double q_lin, double q_quad, Layout& layout) {
  return new SignalSpeedStage{q_lin, q_quad, layout};
}

constexpr StageFactory factory{make, make_kinematics, make_signal_speed};

}  // namespace

}  // namespace krater::inline KRATER_ISA

namespace krater {

const StageFactory* KRATER_CONCAT(stage_factory_, KRATER_ISA)() { return &factory; }

}  // namespace krater
