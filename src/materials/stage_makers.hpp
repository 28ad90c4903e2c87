// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Stages of one instruction-set level, by family: each family is compiled in a file of its own, so
/// that no file takes a compiler minutes. Every function returns nullptr where a law has no such
/// stage.
#pragma once

#include "krater/materials/law_list.hpp"
#include "krater/materials/stage.hpp"

namespace krater::inline KRATER_ISA {

/// `make.template operator()<Law>()` of the law with that index in the catalogue.
template <class Make, class... Laws>
Stage* stage_of(LawList<Laws...>, int law, const Make& make) {
  Stage* made = nullptr;
  int index = 0;
  const auto one = [&]<class Law>() {
    if (index++ == law) made = make.template operator()<Law>();
  };
  (one.template operator()<Laws>(), ...);
  return made;
}

// stages_strength_hot.cpp: the deviator in one stage.
Stage* make_strength(int law, const double* values, const MaterialConstants& constants,
                     Layout& layout);
// stages_model_hot.cpp: strength, pressure and damage in one.
Stage* make_model(int law, const double* values, const MaterialConstants& constants,
                  Layout& layout);
// stages_parts_hot.cpp: the deviator in several stages.
Stage* make_part(const PartRequest& request, Layout& layout);
// stages_eos_hot.cpp: the pressure, and the temperature that follows from it.
Stage* make_eos(const EosRequest& request, Layout& layout);
StagesAround make_cohesion(int eos, const double* values, const MaterialConstants& constants,
                           Layout& layout);
Stage* make_burn(int eos, const double* values, const MaterialConstants& constants, Layout& layout);
Stage* make_energy_heating(const EnergyHeatingRequest& request, Layout& layout);
Stage* make_heat_floor(int eos, const double* values, const MaterialConstants& constants,
                       Layout& layout);

}  // namespace krater::inline KRATER_ISA
