// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/level_report.hpp
/// What `krater check` says of the levels of a scene's cells: points, memory and time of each, what
/// one level would cost, and where an edge of finer cells lies badly.
#include <string>
#include <vector>

#include "krater/output/results.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater {

/// Lines of the report; none for one level. `coarser`: cells of the simulation are so many times as
/// long as the scene's, which is meant.
std::vector<std::string> report_levels(const Simulation& sim, int coarser);

/// The same facts by name: of each level cell, points, blocks, memory, share of the time; and the
/// points of one level and how many times as many they are.
Json levels_json(const Simulation& sim, int coarser);

/// An edge through the joint of two bodies or the foot of a body at a side of the domain, and
/// bodies of fewer than four cells where these are coarse.
std::vector<std::string> doubt_levels(const Simulation& sim);

}  // namespace krater
