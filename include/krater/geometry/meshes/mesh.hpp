// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file geometry/meshes/mesh.hpp
/// A mesh of hexahedra or quadrilaterals: where its nodes are and which are whose corners. Corners
/// 0-3 of a hexahedron are the bottom, counter-clockwise seen from the top, 4-7 lie above them;
/// those of a quadrilateral run counter-clockwise (kinematics/mesh/element.hpp).
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "krater/geometry/frame.hpp"
#include "krater/geometry/seeds/line.hpp"
#include "krater/geometry/solids/affine.hpp"

namespace krater {

struct Mesh {
  int dimension = 3;
  std::vector<Vector3> nodes;          ///< along grid axes [m]; the third is 0 in two dimensions
  std::vector<std::int32_t> elements;  ///< 8 or 4 corners each

  int corners() const { return dimension == 3 ? 8 : 4; }
  std::size_t element_count() const {
    return elements.size() / static_cast<std::size_t>(corners());
  }
  const Vector3& corner(std::size_t element, std::size_t I) const {
    const std::size_t at = element * static_cast<std::size_t>(corners()) + I;
    return nodes[static_cast<std::size_t>(elements[at])];
  }
};

/// Steps from corner 0 along the axes of an element; the first four are those of a quadrilateral.
inline constexpr std::array<std::array<int, 3>, 8> kCornerSteps{
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

/// A block between two corners, `counts` elements along each grid axis.
Mesh block_mesh(int dimension, const Vector3& lower, const Vector3& upper,
                const std::array<int, 3>& counts);

/// Whole numbers of elements of about `element` [m] along each axis of a block, one at least.
std::array<int, 3> elements_along(Frame frame, const Vector3& lower, const Vector3& upper,
                                  double element);

/// Corners of a face, in order around it; -1 for the last two of an edge, the face of a
/// quadrilateral.
using MeshFace = std::array<std::int32_t, 4>;

/// Which corners of an element its faces have, in order around each as below.
const std::vector<std::vector<std::size_t>>& element_faces(int dimension);

/// The faces of an element, right-handed about the normal outwards (in two dimensions edges with
/// the outside at their right).
std::vector<MeshFace> faces_of_element(const Mesh& mesh, std::size_t element);

/// Faces that no two elements share.
std::vector<MeshFace> exposed_faces(const Mesh& mesh);

/// Edges of faces, each once.
std::vector<std::array<std::int32_t, 2>> surface_edges(const std::vector<MeshFace>& faces);

/// How good the elements of a mesh are. The scaled Jacobian of a corner is the determinant of the
/// unit vectors along its edges: 1 in a brick, sin of the angle in a plane, 0 flat, below 0 folded
/// (Knupp 2000, IJNME 48, 1165).
struct MeshQuality {
  double least_jacobian = 1;  ///< least scaled Jacobian of all corners
  std::size_t worst_element = 0;
  double shortest = 0, longest = 0;  ///< edges [m]
};
MeshQuality mesh_quality(const Mesh& mesh);

/// Scaled Jacobian of corner I of an element: 0 where an edge has no length.
double scaled_jacobian(const Mesh& mesh, std::size_t element, std::size_t I);

/// The mesh and its image in the plane x_axis = 0, on which its least or greatest nodes lie
/// exactly; with `both` false the image alone.
Mesh mirrored(const Mesh& mesh, std::size_t axis, bool both);

/// A plane mesh drawn along the third axis, from `low` to `high` in `layers` layers.
Mesh extruded(const Mesh& plane, double low, double high, int layers);

/// The image under a map of space that keeps right-handedness; in two dimensions the section y = 0
/// must stay in its plane: throws std::invalid_argument where it does not.
Mesh mapped(const Mesh& mesh, Frame frame, const Affine& map);

}  // namespace krater
