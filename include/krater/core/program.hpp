// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file core/program.hpp
/// Where the program lies: cards and Python packages are found from there.
#include <filesystem>

namespace krater {

/// The program's file, links followed; empty where the system does not tell. /proc/self/exe or,
/// where /proc is not mounted (a bare root), what the kernel was asked to start.
std::filesystem::path program_path();

}  // namespace krater
