// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/scene/point.hpp"

#include <filesystem>

#include "scene/readers/read_path.hpp"
#include "scene/readers/readers.hpp"

namespace krater {

namespace {

using namespace scene;

/// The material named, or the only one.
std::optional<MaterialOptions> choose_material(Block& point, Reading& reading) {
  const Node* node = point.find("material");
  const std::vector<MaterialOptions>& materials = reading.scene.materials;
  std::vector<std::string> names;
  for (const MaterialOptions& m : materials) names.push_back(m.name);
  if (!node) {
    if (materials.size() == 1) {
      point.record("material", string_node(names.front()));
      return materials.front();
    }
    point.fail("missing key 'material' (known: " + join(names) + ")");
    return std::nullopt;
  }
  const std::optional<std::string> word = read_word(*node, reading.problems);
  if (!word) return std::nullopt;
  for (const MaterialOptions& m : materials) {
    if (m.name != *word) continue;
    point.record("material", string_node(m.name));
    return m;
  }
  report_unknown(*node, "material", *word, names, reading.problems);
  return std::nullopt;
}

/// Only equations of state have a Hugoniot.
void check_combination(const PointScene& out, Block& point) {
  if (out.material.bare)
    point.fail("material " + quote(out.material.name) +
               " holds no law: give it an eos and a strength");
  const bool shocked =
      out.path.kind == PathKind::hugoniot || out.path.kind == PathKind::release_isentrope;
  if (shocked && !out.material.eos) {
    point.fail("path " + std::string{name(out.path.kind)} + " needs an eos: material " +
               out.material.name + " gives its stress from F");
  }
}

Node read_point_block(const Node* node, PointScene& out, Reading& reading) {
  Block point{point_block(), node, "point", reading.root, reading.problems};
  const std::optional<MaterialOptions> material = choose_material(point, reading);
  if (material) out.material = *material;
  if (const Node* path = point.require("path", "how the material is loaded")) {
    point.record("path", read_path(*path, out.path, reading));
  }
  out.steps = point.integer("steps", 1000);
  out.every = point.integer("every", 1);
  if (const auto temperature = point.optional_number("temperature"))
    out.material.initial_temperature = *temperature;
  point.record("temperature", number_node(out.material.initial_temperature));
  if (out.material.viscosity || softening_length(out.material)) {
    out.length = point.number("length");
    if (!reading.problems.any()) check_softening(out.material, out.length, point);
  } else if (const auto length = point.optional_number("length")) {
    out.length = *length;
    point.record("length", number_node(*length));
  }
  if (!reading.problems.any()) check_combination(out, point);
  return point.finish();
}

}  // namespace

PointScene read_point(const std::string& file, const std::vector<std::string>& overrides) {
  Problems problems;
  Node tree = read_yaml_file(file, "", problems);
  for (const std::string& setting : overrides) apply_override(tree, setting, problems);
  tree.line = 0;  // what the file as a whole lacks is missing on no line
  Scene scene;
  scene.file = file;
  PointScene out;
  out.file = file;
  Block root{point_scene_block(), &tree, "", tree, problems};
  Reading reading{scene, problems, tree};
  out.title = root.text("title", std::filesystem::path{file}.stem().string());
  for (const char* key : {"materials", "point"}) {
    const bool scene_file = tree.find("bodies") != nullptr;
    if (!tree.find(key))
      root.fail("missing key '" + std::string{key} + "'" +
                (scene_file ? " (a scene is computed by krater run)" : ""));
  }
  root.record("materials", read_materials(root.find("materials"), reading));
  const Node* point = root.find("point");
  if (point && !scene.materials.empty())
    root.record("point", read_point_block(point, out, reading));
  const Node resolved = root.finish();
  problems.throw_if_any();
  out.notes = scene.notes;
  out.resolved = "# Every value in SI, every default filled in. Written by krater from " +
                 quote(file) + ".\n" + to_yaml(resolved);
  return out;
}

}  // namespace krater
