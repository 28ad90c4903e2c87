// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file measure/selections.hpp
/// What measures share of the points they look at.
#include <vector>

#include "krater/measure/measurements.hpp"

namespace krater {

/// Domain, boundaries and point spacing of bodies whose points were gathered for measures.
MeasureContext cells_of(const Simulation& sim, const std::vector<int>& bodies);

/// Whether its value is asked for in every row of history, shown or not.
bool in_row(const MeasureOptions& measure);

}  // namespace krater
