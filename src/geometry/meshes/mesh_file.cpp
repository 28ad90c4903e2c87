// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/geometry/meshes/mesh_file.hpp"

#include "geometry/meshes/mesh_formats.hpp"
#include "geometry/surfaces/file_text.hpp"

namespace krater {

ElementKind plain_kind(const std::string& name, int dimension, std::size_t corners) {
  ElementKind out{name, dimension, corners, "", std::nullopt};
  const bool simplex = (dimension == 3 && corners < 8) || (dimension == 2 && corners == 3);
  if (simplex) out.refusal = kSimplex;
  return out;
}

MeshFile read_mesh_file(const std::string& file) {
  const std::string ending = file_ending(file);
  const bool dyna = ending == "k" || ending == "key" || ending == "dyn";
  if (ending != "msh" && ending != "inp" && !dyna)
    throw std::invalid_argument(file +
                                ": files of elements are .msh (Gmsh), .inp (Abaqus) and .k, .key, "
                                ".dyn (LS-DYNA)");
  const std::string data = file_text(file);
  if (data.empty()) throw std::invalid_argument(file + ": the file is empty");
  MeshFile out = dyna ? read_dyna(file, data)
                      : (ending == "msh" ? read_gmsh(file, data) : read_abaqus(file, data));
  if (out.elements.empty()) throw std::invalid_argument(file + ": has no elements");
  return out;
}

}  // namespace krater
