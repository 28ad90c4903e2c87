// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/closing.hpp
/// The last words of a run: its measures beside their references, its energy, where the time went.
/// Told from what stands in summary.json, so that both say the same.
#include <array>
#include <string>
#include <vector>

#include "krater/output/results.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater {

/// What a run does outside its steps, for the account of its cost.
enum class Outside : std::size_t { setup, history_and_measures, frames, checkpoints };
inline constexpr std::array<const char*, 4> outside_names{"setup", "history_and_measures", "frames",
                                                          "checkpoints"};

/// Lines for people, in units that they use.
std::vector<std::string> closing_lines(const Json& summary);

/// What the scene asked for and took away: failed points, eroded elements.
std::vector<std::string> removal_notes(const Simulation& sim);

/// `krater run --json`: what summary.json holds, the folder, and how the program ends, which is
/// returned; kBadInput where standard output cannot be written.
int print_summary(Json summary, const std::string& folder, int code);

}  // namespace krater
