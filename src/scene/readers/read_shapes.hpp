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

/// `{mesh: {file: part.inp, unit: mm, part: rod, merge_nodes: 1 um}}`.
std::shared_ptr<const Solid> read_mesh(Block& block, Reading& reading);

/// Metres of one unit of a file's numbers; 0 after a problem.
double read_file_unit(const Node& node, Reading& reading);

/// The path of a file named in a scene, beside that; records it as absolute, and a checksum of its
/// bytes, so that a file that changes makes another scene. Throws std::invalid_argument where the
/// key `checksum` tells of other bytes, or the file cannot be read.
std::string read_file_path(Block& block, const std::string& name, Reading& reading);

}  // namespace krater::scene
