// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a law is: a plain struct of doubles (its parameters, and constants prepared from them) with
///   family, name, equation, reference      text for `krater models` and the manual
///   parameters                             one declaration each (core/parameters.hpp)
///   prepare(constants)                     once, after the parameters are set
///   problem()                              nullptr, or what is wrong between parameters (optional)
/// and force-inlined functions `template <class Real>` that hold the physics. A law knows no
/// dimension, mesh or method, and no stage; adding one is its header and a line in law_list.hpp.
#pragma once

#include <type_traits>

#include "krater/core/isa.hpp"
#include "krater/core/parameters.hpp"
#include "krater/materials/stage.hpp"

namespace krater {

/// The block of a scene that names a law.
/// `model`: strength, pressure and damage in one (model/coupled.hpp).
enum class Family : int { strength, damage, eos, viscosity, heating, model };
inline constexpr const char* kFamilyNames[] = {"strength",  "damage",  "eos",
                                               "viscosity", "heating", "model"};

}  // namespace krater

namespace krater::inline KRATER_ISA {

/// `parameters` of a law that has none.
template <class Law>
struct NoParameters {};

template <class Law>
inline constexpr int parameter_count = sizeof(Law::parameters) / sizeof(Parameter<Law>);
template <class Law>
requires std::is_same_v<std::remove_cv_t<decltype(Law::parameters)>, NoParameters<Law>>
inline constexpr int parameter_count<Law> = 0;

/// A law with its parameters in declared order and its derived constants.
template <class Law>
inline Law make_law(const double* values, const MaterialConstants& constants) {
  Law law{};
  if constexpr (parameter_count < Law >> 0) {
    for (int i = 0; i < parameter_count<Law>; ++i) law.*(Law::parameters[i].value) = values[i];
  }
  law.prepare(constants);
  return law;
}

}  // namespace krater::inline KRATER_ISA
