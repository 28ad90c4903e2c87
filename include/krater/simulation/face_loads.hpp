// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file simulation/face_loads.hpp
/// What the scene's loads on faces found at the start.
#include "krater/simulation/simulation.hpp"

namespace krater {

/// Throws InputError where a load has no point to act on.
void require_faces(const Simulation& sim);

}  // namespace krater
