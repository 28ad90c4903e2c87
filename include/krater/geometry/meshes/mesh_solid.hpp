// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file geometry/meshes/mesh_solid.hpp
/// The solid that a mesh fills. In 3d it is bounded by the exposed faces, each cut into two
/// triangles: where faces are warped its volume is not quite that of the elements. In the frames of
/// two dimensions it is bounded by the exposed edges, exactly.
#include <memory>

#include "krater/geometry/meshes/mesh.hpp"
#include "krater/geometry/solids/solid.hpp"

namespace krater {

/// elements() of it and of its images under maps is the mesh, mapped. Throws std::invalid_argument
/// where a plane mesh touches itself in a node, or crosses the axis.
std::shared_ptr<const Solid> make_mesh_solid(Mesh mesh, Frame frame);

}  // namespace krater
