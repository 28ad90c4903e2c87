// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/card_doctor.hpp
/// Doubts about the numbers of a material, for `krater check`: they do not keep a run from
/// starting.
#include <optional>
#include <string>
#include <vector>

#include "krater/scene/scene.hpp"

namespace krater {

/// One sentence per doubt: elastic constants against the equation of state, temperatures, specific
/// heat and melting point against metals of that density, a missing limit of tension.
std::vector<std::string> examine(const MaterialOptions& material);

/// Of them those of a model's card (concrete, ceramic): what does not fit together.
void check_model(const MaterialOptions& material, std::vector<std::string>& doubts);

/// Numbers of a material that are wrong by powers of ten, with the unit that was probably meant.
std::vector<std::string> doubt_magnitudes(const MaterialOptions& material);

/// For `krater point`, which shows all else itself: these, and if there are none those of a model.
std::vector<std::string> doubt_constants(const MaterialOptions& material);

/// Numbers that are wrong by powers of ten of a scene's sizes, speeds and times.
std::vector<std::string> doubt_scene(const Scene& scene);

/// A parameter of a law by its key; empty if the law has no such parameter.
std::optional<double> parameter(const std::optional<LawChoice>& choice, const char* key);

/// rho0 c0^2 of the material's equation of state [Pa]; 0 without one.
double bulk_modulus_at_rest(const MaterialOptions& material);

}  // namespace krater
