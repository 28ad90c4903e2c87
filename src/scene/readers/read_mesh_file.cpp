// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>

#include "krater/geometry/meshes/mesh_file.hpp"
#include "krater/geometry/meshes/mesh_solid.hpp"
#include "scene/readers/read_shapes.hpp"

namespace krater::scene {

namespace {}  // namespace

std::shared_ptr<const Solid> read_mesh(Block& block, Reading& reading) {
  const Node* file = block.require("file", "a .msh, .inp or .k file beside the scene");
  const Node* unit = block.require("unit",
                                   "of the file's numbers, for example mm: it is not stated in "
                                   "the file");
  PartOptions options;
  options.merge_nodes = block.number("merge_nodes");
  if (const Node* part = block.find("part")) {
    options.part = read_word(*part, reading.problems);
    block.record("part", *part);
  }
  const std::optional<std::string> name = file ? read_word(*file, reading.problems) : std::nullopt;
  options.unit = unit ? read_file_unit(*unit, reading) : 0;
  if (reading.problems.any() || !name) return nullptr;
  const std::string path = read_file_path(block, *name, reading);
  block.record("unit", string_node(unit->text));
  PartMesh part = part_mesh(read_mesh_file(path), reading.scene.frame, options);
  for (const std::string& note : part.notes)
    reading.scene.notes.push_back(block.place().where() + ": " + *name + ": " + note);
  return make_mesh_solid(std::move(part.mesh), reading.scene.frame);
}

}  // namespace krater::scene
