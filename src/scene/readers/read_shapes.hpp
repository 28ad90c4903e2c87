// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/readers/read_shapes.hpp
/// Shapes of bodies: primitives, surfaces, maps and booleans, nested to any depth.
#include <memory>

#include "scene/readers/readers.hpp"

namespace krater::scene {

/// `{cylinder: {...}}`, `{union: [...]}` and so on; a null solid after a problem.
ReadSolid read_shape(const Node& shape, Reading& reading);

/// `{surface: {file: part.stl, unit: mm, repair: {...}}}`.
std::shared_ptr<const Solid> read_surface(Block& block, Reading& reading);

}  // namespace krater::scene
