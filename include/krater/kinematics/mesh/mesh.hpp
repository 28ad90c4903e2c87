// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mesh/mesh.hpp
/// What a step needs of a mesh (geometry/meshes/mesh.hpp): whose corner a node is, and volumes.
#include <array>
#include <cstdint>
#include <vector>

#include "krater/contact/options.hpp"
#include "krater/geometry/meshes/mesh.hpp"

namespace krater {

/// Whose corner a node is, in order of elements: entries first[n] .. first[n + 1) of `places`,
/// element * corners + corner. Sums over it are the same for any number of threads.
struct NodeCorners {
  std::vector<std::uint32_t> first, places;
};
NodeCorners node_corners(const Mesh& mesh);

/// int N_I dV of every corner of every element, V over w = 1 or 2 pi r, by Gauss points: exact for
/// quadrilaterals and for hexahedra with plane or bilinear faces. They sum to the volume and keep
/// its centre.
std::vector<double> corner_volumes(const Mesh& mesh, bool axisymmetric);

/// The same of the parts of one element, cut into counts[k] along its axis k: part after part, the
/// first axis fastest; `counts` of an axis that is not there is 1.
std::vector<double> part_volumes(const Mesh& mesh, std::size_t element, bool axisymmetric,
                                 const std::array<int, 3>& counts);

/// The longest edge of an element along each of its axes, of its corners' places.
std::array<double, 3> longest_edges(int dimension, const std::array<Triple, 8>& x);

/// N_I of an element at a point of [-1, 1]^dim.
std::array<double, 8> corner_functions(int dimension, const std::array<double, 3>& xi);

}  // namespace krater
