// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Deviator of an elastic body without yield: s = G dev(b_e), theory 3, Decision 1
/// (strength_stage.hpp holds it). Reference: CCF (7) with the Truesdell rate. Assumes constant G;
/// the pressure comes from the equation of state.
#pragma once

#include "krater/materials/law.hpp"

namespace krater::inline KRATER_ISA {

struct Elastic {
  static constexpr Family family = Family::strength;
  static constexpr const char* name = "elastic";
  static constexpr const char* equation = "s = G dev(b_e)";
  static constexpr const char* reference = "Zhou, Sha, Tamma, Miller, AIAA-2006-1758, eq. (7)";
  static constexpr bool needs_shear_modulus = true;
  static constexpr NoParameters<Elastic> parameters{};

  void prepare(const MaterialConstants&) {}
};

}  // namespace krater::inline KRATER_ISA
