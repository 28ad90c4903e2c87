// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/point.hpp
/// `krater point`: one material through a loading path, written as a table (point.csv, point.h5).
#include "krater/app/run.hpp"

namespace krater {

/// Returns an ExitCode; throws InputError before anything is written.
int run_point(const RunOptions& options);

}  // namespace krater
