// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/check.hpp
/// `krater check`: what would be run, as text or (`--json`) as one JSON object. Lengths, masses,
/// times and energies are in SI units, memory and results in bytes.
#include <string>
#include <vector>

#include "krater/app/forecast.hpp"
#include "krater/output/results.hpp"
#include "krater/scene/scene.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater {

/// A scene that passed the checks made before a run, and what was made to look at it.
struct Checked {
  const Scene& scene;
  const Simulation& sim;  ///< of the scene, or of one with longer cells
  const Forecast& cost;
  int coarser;  ///< by how much longer; 1: the scene itself
};

/// The facts that the text holds, by name (README, Run).
Json check_json(const Checked& of);

/// Of all materials and of the scene: what is odd, but keeps no run from starting.
std::vector<std::string> doubts_of(const Scene& scene);

/// What of the cards is not used, and what no source was read for.
std::vector<std::string> card_notes(const Scene& scene);

}  // namespace krater
