// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/readers/read_path.hpp
/// The loading path of a point file: `path: {uniaxial_stress: {strain: 0.5, rate: 1 s^-1}}`.
#include "krater/scene/point.hpp"
#include "scene/readers/readers.hpp"

namespace krater::scene {

/// Fills `path`, reports what is wrong and returns the block with all defaults.
Node read_path(const Node& node, PathOptions& path, Reading& reading);

}  // namespace krater::scene
