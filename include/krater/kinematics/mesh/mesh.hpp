// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mesh/mesh.hpp
/// A mesh of hexahedra or quadrilaterals: where its nodes are and which are whose corners
/// (kinematics/mesh/element.hpp says in which order).
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "krater/contact/options.hpp"
#include "krater/geometry/frame.hpp"

namespace krater {

struct Mesh {
  int dimension = 3;
  std::vector<Triple> nodes;           ///< along grid axes [m]; the third is 0 in two dimensions
  std::vector<std::int32_t> elements;  ///< 8 or 4 corners each

  int corners() const { return dimension == 3 ? 8 : 4; }
  std::size_t element_count() const {
    return elements.size() / static_cast<std::size_t>(corners());
  }
};

/// A block between two corners, `counts` elements along each grid axis.
Mesh block_mesh(int dimension, const Triple& lower, const Triple& upper,
                const std::array<int, 3>& counts);

/// Whole numbers of elements of about `element` [m] along each axis of a block, one at least.
std::array<int, 3> elements_along(Frame frame, const Triple& lower, const Triple& upper,
                                  double element);

/// Whose corner a node is, in order of elements: entries first[n] .. first[n + 1) of `places`,
/// element * corners + corner. Sums over it are the same for any number of threads.
struct NodeCorners {
  std::vector<std::uint32_t> first, places;
};
NodeCorners node_corners(const Mesh& mesh);

/// Corners of the faces of an element, in order around each, with the outside at their right.
const std::vector<std::vector<std::size_t>>& element_faces(int dimension);

/// Corners of the faces that no two elements share, right-handed about the normal outwards; in two
/// dimensions edges with the outside at their right, and -1 for the last two corners.
std::vector<std::array<std::int32_t, 4>> exposed_faces(const Mesh& mesh);

/// Edges of faces, each once.
std::vector<std::array<std::int32_t, 2>> surface_edges(
    const std::vector<std::array<std::int32_t, 4>>& faces);

/// int N_I dV of every corner of every element, V over w = 1 or 2 pi r, by Gauss points: exact for
/// quadrilaterals and for hexahedra with plane or bilinear faces. They sum to the volume and keep
/// its centre.
std::vector<double> corner_volumes(const Mesh& mesh, bool axisymmetric);

}  // namespace krater
