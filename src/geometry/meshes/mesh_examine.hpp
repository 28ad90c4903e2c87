// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file geometry/meshes/mesh_examine.hpp
/// Is a mesh one that can be computed with? All throw std::invalid_argument with the names of what
/// is wrong and a remedy.
#include <functional>
#include <string>
#include <vector>

#include "krater/geometry/meshes/mesh.hpp"

namespace krater {

/// What elements and nodes are called to the user.
struct MeshNames {
  std::function<std::string(std::size_t)> element, node;
};

/// Nodes nearer than `distance` to an earlier one become that one; `node_of` loses those that went.
/// Returns how many.
std::size_t merge_nodes(Mesh& mesh, double distance, std::vector<std::size_t>& node_of);

/// Quadrilaterals that run clockwise are turned; returns how many.
std::size_t turn_clockwise(Mesh& mesh);

/// No element is flat, inside out or folded at a corner.
void examine_elements(const Mesh& mesh, const MeshNames& names);

/// No face belongs to more than two elements, or to two on the same side of it; no node lies where
/// another does, nor in or on an element that it is no corner of (within 1e-6 of the element): the
/// parts of a mesh meet node by node.
void examine_joints(const Mesh& mesh, const MeshNames& names);

}  // namespace krater
