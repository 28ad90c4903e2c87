// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file materials/assembly.hpp
/// A material put together: which stages, in which order. Sound material with the default rate:
///   kinematics, viscosity, strength (trial, return and work in one), eos, heating, signal speed.
/// With damage, a spall that fails or another rate the strength is several stages, which hand the
/// effective deviator on in a local record:
///   start -> trial -> return -> growth of damage -> carried stress             coupling: effective
///   start -> trial -> flow stress -> growth -> return with damage -> carried   coupling: rate
/// so that neither rates nor damage laws multiply the compiled yield laws. A coupled law takes the
/// place of strength, damage and eos:
///   start -> trial -> model
/// An explosive burns before its equation of state (materials/stages/burn_stage.hpp).
/// With an equation of state whose solid parts, two stages stand about those of the strength
/// (materials/stages/cohesion_stage.hpp).
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "krater/materials/stage.hpp"

namespace krater {

/// A stage and what it is, for `krater check`.
struct NamedStage {
  std::string name;
  std::unique_ptr<const Stage> stage;
};

/// A law of the catalogue with its parameters in declared order; law < 0: there is none.
struct PlannedLaw {
  int law = -1;
  const double* values = nullptr;
};

struct MaterialPlan {
  MaterialConstants constants;
  PlannedLaw eos, strength, damage, viscosity, heating;
  PlannedLaw model;  ///< in place of the first three
  Rate rate = Rate::truesdell;
  Coupling coupling = Coupling::effective;
  DegradePressure degrade = DegradePressure::tension;
  double spall_strength = std::numeric_limits<double>::infinity();  ///< infinite: none
  SpallAction spall_action = SpallAction::fail;
  double q_lin = 0, q_quad = 0;  ///< of the viscosity
};

/// Does its damage weaken the stress, s = (1 - phi) s~?
bool degrades_stress(const MaterialPlan& plan);

/// The stages in the order in which they are applied. The method has declared its columns and
/// locals before; the layout is not yet checked.
std::vector<NamedStage> make_stages(const StageFactory& factory, const MaterialPlan& plan,
                                    Layout& layout);

}  // namespace krater
