// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file core/stability.hpp
/// What a step may do at CFL 1 beside waves (theory 12).

namespace krater {

/// Share of a cell that a point may travel, and of its volume that may open or close.
inline constexpr double kMostTravel = 0.5, kMostDilatation = 0.1;

}  // namespace krater
