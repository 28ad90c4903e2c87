// SPDX-License-Identifier: GPL-3.0-or-later
// The factory of stages, and those stages that no family of many laws stands behind (compiled once
// per instruction-set level).
#include "krater/materials/factories.hpp"
#include "krater/materials/stages/heating_stage.hpp"
#include "krater/materials/stages/kinematics_stage.hpp"
#include "krater/materials/stages/signal_speed_stage.hpp"
#include "krater/materials/stages/viscosity_stage.hpp"
#include "materials/stage_makers.hpp"

namespace krater::inline KRATER_ISA {

namespace {

Stage* make(int index, const double* values, const MaterialConstants& constants, Layout& layout) {
  if (Stage* strength = make_strength(index, values, constants, layout)) return strength;
  if (Stage* model = make_model(index, values, constants, layout)) return model;
  return stage_of(AllLaws{}, index, [&]<class Law>() -> Stage* {
    if constexpr (Law::family == Family::viscosity) {
      return new ViscosityStage<Law>{make_law<Law>(values, constants), layout};
    } else if constexpr (Law::family == Family::heating && !requires { Law::needs_eos; }) {
      return new HeatingStage<Law>{make_law<Law>(values, constants), constants, layout};
    } else {
      return nullptr;
    }
  });
}

Stage* make_kinematics(bool keeps_F, Layout& layout) {
  const bool keeps_M = layout.find("domain") != nullptr && layout.find("half_width") == nullptr;
  if (keeps_F && keeps_M) return new KinematicsStage<true, true>{layout};
  if (keeps_F) return new KinematicsStage<true, false>{layout};
  if (keeps_M) return new KinematicsStage<false, true>{layout};
  return new KinematicsStage<false, false>{layout};
}

Stage* make_signal_speed(double q_lin, double q_quad, double density, Layout& layout) {
  if (layout.find("failed")) return new SignalSpeedStage<true>{q_lin, q_quad, density, layout};
  return new SignalSpeedStage<false>{q_lin, q_quad, density, layout};
}

constexpr StageFactory factory{
    make,      make_part,       make_eos,        make_energy_heating, make_cohesion,
    make_burn, make_heat_floor, make_kinematics, make_signal_speed};

}  // namespace

}  // namespace krater::inline KRATER_ISA

namespace krater {

const StageFactory* KRATER_CONCAT(stage_factory_, KRATER_ISA)() { return &factory; }

}  // namespace krater
