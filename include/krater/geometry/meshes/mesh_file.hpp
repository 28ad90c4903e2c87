// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file geometry/meshes/mesh_file.hpp
/// Files of elements: Gmsh .msh (ASCII, versions 2.2 and 4.1), Abaqus .inp, LS-DYNA .k, .key, .dyn.
/// They are read here and not by Gmsh's library (src/kinematics/README.md says why). First a file
/// is read as it stands, then one part of it is made a mesh and examined.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "krater/geometry/meshes/mesh.hpp"

namespace krater {

/// What a format's type of element is.
struct ElementKind {
  std::string name;            ///< as in the file
  int dimension = -1;          ///< of what it fills; -1: not known
  std::size_t corners = 0;     ///< 8 or 4 where it is of use
  std::string refusal;         ///< why not; empty: it is of use
  std::optional<Frame> frame;  ///< the only one that it is meant for
};

struct MeshFile {
  struct Element {
    std::int64_t number = 0;
    std::size_t line = 0, first = 0, count = 0;  ///< where its nodes stand in `nodes_of`
    std::size_t kind = 0;
  };
  struct Part {
    std::string name, also;  ///< also: another word for it, its number
    std::vector<std::size_t> elements;
  };
  std::string name;
  std::vector<Vector3> nodes;  ///< lengths as in the file
  std::vector<std::int64_t> node_numbers;
  std::vector<std::size_t> nodes_of;  ///< indices into `nodes`
  std::vector<ElementKind> kinds;
  std::vector<Element> elements;
  std::vector<Part> parts;
  bool any_case = false;  ///< capitals in names of parts mean nothing
};

/// Format by the file's ending. Throws std::invalid_argument with file, line and what is wrong.
MeshFile read_mesh_file(const std::string& file);

struct PartOptions {
  std::optional<std::string> part;  ///< none: the only one there is
  double unit = 1;                  ///< metres of one unit of the file
  double merge_nodes = 0;           ///< m: nodes nearer than this become one
};

struct PartMesh {
  Mesh mesh;
  std::vector<std::int64_t> numbers;  ///< of its elements in the file
  std::string part;
  std::vector<std::string> notes;  ///< what was done to it
};

/// The elements of one part for a frame: hexahedra in 3d, else quadrilaterals, whose plane (x, y)
/// or (x, z) becomes that of the frame. Throws std::invalid_argument with line or number of the
/// element and a remedy for: a part that is not there; elements that are no bricks of 8 or
/// quadrilaterals of 4 corners, or have one node twice; elements without volume, inside out or
/// folded; faces of more than two elements; neighbours on the same side of their face; nodes in the
/// same place as another's, or in or on an element that they do not belong to.
PartMesh part_mesh(const MeshFile& file, Frame frame, const PartOptions& options);

}  // namespace krater
