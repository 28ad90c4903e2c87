// SPDX-License-Identifier: GPL-3.0-or-later
// A small mesh of two parts, written in the formats that krater reads.
#pragma once

#include <string>
#include <vector>

#include "krater/geometry/meshes/mesh_file.hpp"

namespace krater::test {

/// Two bricks of a rod above each other, and a plate of one: nodes 1 to 20, elements 1 to 3.
struct SmallMesh {
  std::vector<Vector3> nodes;
  std::vector<std::vector<int>> elements;  ///< corners, from 1
  std::vector<std::string> parts;          ///< of each element
  bool plane = false;                      ///< quadrilaterals in (x, y)
};

SmallMesh small_bricks();
/// Two quadrilaterals of a disc and one of a plate.
SmallMesh small_quadrilaterals();

std::string as_gmsh2(const SmallMesh& mesh);
std::string as_gmsh4(const SmallMesh& mesh);
/// `type`: C3D8R and so on; `parts`: as *PART blocks, else as element sets.
std::string as_abaqus(const SmallMesh& mesh, const std::string& type, bool parts = false);
/// `form`: elform of plane elements; `commas`: free format.
std::string as_dyna(const SmallMesh& mesh, int form = 0, bool commas = false);

}  // namespace krater::test
