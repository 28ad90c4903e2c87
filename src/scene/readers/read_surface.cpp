// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdexcept>

#include "krater/geometry/surfaces/surface.hpp"
#include "scene/readers/read_shapes.hpp"

namespace krater::scene {

namespace {

RepairOptions read_repair(const Node* node, Block& parent, Reading& reading) {
  Block block{repair_block(), node, node ? node->path : "", parent.place(), reading.problems};
  RepairOptions repair;
  repair.merge_vertices = block.number("merge_vertices");
  repair.drop_facets = block.flag("drop_facets", false);
  repair.orient = block.flag("orient", false);
  repair.close_holes = block.number("close_holes");
  parent.record("repair", block.finish());
  return repair;
}

}  // namespace

std::shared_ptr<const Solid> read_surface(Block& block, Reading& reading) {
  const Node* file = block.require("file", "an .stl, .off, .obj or .ply file beside the scene");
  const Node* unit = block.require("unit",
                                   "of the file's numbers, for example mm: it is not stated "
                                   "in the file");
  const RepairOptions repair = read_repair(block.find("repair"), block, reading);
  const std::optional<std::string> name = file ? read_word(*file, reading.problems) : std::nullopt;
  const double metres = unit ? read_file_unit(*unit, reading) : 0;
  if (reading.problems.any() || !name) return nullptr;
  const std::string path = read_file_path(block, *name, reading);
  block.record("unit", string_node(unit->text));
  Triangles triangles = read_triangles(path, metres);
  for (const std::string& done : repair_surface(triangles, repair))
    reading.scene.notes.push_back(block.place().where() + ": " + *name + ": " + done);
  const SurfaceDefects defects = examine_surface(triangles);
  if (defects.any())
    throw std::invalid_argument(*name + " bounds no volume: " + defects.text(metres, unit->text));
  return make_surface_solid(std::move(triangles));
}

}  // namespace krater::scene
