// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/machine.hpp
/// What the operating system knows of this process.
#include <cstdint>

#include "krater/simulation/simulation.hpp"

namespace krater {

/// Largest resident memory of this process so far [bytes], 0 where the system does not say. From
/// /proc/self/status: getrusage also counts what the program that started this one had in use.
std::int64_t peak_resident_bytes();

/// Machine, threads and what the run took on them: what is not the same on another machine.
Json machine_json(const Simulation& sim, double seconds, double point_steps);

/// Version, revision, compiler and build.
Json program_json();

}  // namespace krater
