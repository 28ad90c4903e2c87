// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/continuation.hpp
/// The command of a run as text for a shell.
#include <string>

#include "krater/app/run.hpp"

namespace krater {

std::string quoted(const std::string& word);
std::string command(const RunOptions& options, const std::string& folder);
/// The command that continues a run from its checkpoint.
std::string continuation(const RunOptions& options, const std::string& folder);

}  // namespace krater
