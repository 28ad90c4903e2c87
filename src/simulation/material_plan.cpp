// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/simulation/material_plan.hpp"

namespace krater {

MaterialPlan material_plan(const MaterialOptions& material) {
  const auto planned = [](const std::optional<LawChoice>& choice) {
    return choice ? PlannedLaw{choice->law, choice->values.data()} : PlannedLaw{};
  };
  MaterialPlan plan;
  plan.constants = {material.density, material.shear_modulus, material.initial_temperature};
  plan.eos = planned(material.eos);
  plan.strength = planned(material.strength);
  plan.damage = planned(material.damage);
  plan.model = planned(material.model);
  plan.viscosity = planned(material.viscosity);
  plan.heating = planned(material.heating);
  plan.rate = material.rate;
  plan.coupling = material.coupling;
  plan.degrade = material.degrade_pressure;
  if (material.spall_strength) plan.spall_strength = *material.spall_strength;
  plan.spall_action = material.spall_action;
  if (material.viscosity) {
    plan.q_lin = material.viscosity->values.at(0);
    plan.q_quad = material.viscosity->values.at(1);
  }
  return plan;
}

}  // namespace krater
