// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/continuation.hpp
/// The command of a run as text for a shell, and which checkpoints a scene may go on from.
#include <string>
#include <vector>

#include "krater/app/run.hpp"
#include "krater/output/results.hpp"
#include "krater/scene/compare.hpp"
#include "krater/scene/scene.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater {

std::string quoted(const std::string& word);
std::string command(const RunOptions& options, const std::string& folder);
/// The command and what it set, as summary.json tells them.
void add_command(Json& machine, const RunOptions& options, const std::string& folder);
/// The command that continues a run from its checkpoint.
std::string continuation(const RunOptions& options, const std::string& folder);

/// A state means something only to the scene it is a state of: with another density or law under it
/// every later number would be wrong, and nothing would say so.
/// Returns what differs and may; throws InputError where something else does. `file`: of the
/// checkpoint.
std::vector<SceneDifference> require_same_scene(const Checkpoint& checkpoint,
                                                const std::string& file, const Scene& scene);

/// Throws InputError, which names the file.
void restore(Simulation& sim, const Checkpoint& checkpoint, const std::string& file);

/// Where results go that nobody gave a place.
std::string default_output(const std::string& scene);

}  // namespace krater
