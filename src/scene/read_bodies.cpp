// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <stdexcept>

#include "krater/geometry/primitives.hpp"
#include "scene/readers.hpp"

namespace krater::scene {

namespace {

constexpr ParameterInfo kRadius{"radius", "m", Range::positive, kRequired, "radius"};
constexpr ParameterInfo kHeight{"height", "m", Range::positive, kRequired, "length along its axis"};

/// A position in 3D space by key; the origin by default.
Triple read_place(Block& block, const char* key, Reading& reading) {
  const Node* node = block.find(key);
  const Triple place = node ? read_position(*node, reading).value_or(Triple{}) : Triple{};
  block.record(key, vector_node(Frame::cartesian_3d, place));
  return place;
}

std::shared_ptr<const Solid> read_cylinder(Block& block, Reading& reading) {
  const double radius = block.number(kRadius);
  const double height = block.number(kHeight);
  const Triple base = read_place(block, "base", reading);
  const int axis = block.choice<int>("axis", {{"x", 0}, {"y", 1}, {"z", 2}}, 2);
  if (reading.problems.any()) return nullptr;
  return std::make_shared<CylinderSolid>(radius, height, base, axis);
}

std::shared_ptr<const Solid> read_sphere(Block& block, Reading& reading) {
  const double radius = block.number(kRadius);
  const Triple centre = read_place(block, "center", reading);
  if (reading.problems.any()) return nullptr;
  return std::make_shared<SphereSolid>(radius, centre);
}

/// Corners with two components are a section: 1 m thick about y = 0, and without meaning in 3d.
std::optional<Triple> read_corner(Block& block, const char* key, double y, Reading& reading) {
  const Node* node = block.require(key, "a corner of the box");
  if (!node) return std::nullopt;
  std::optional<Triple> corner = read_position(*node, reading);
  if (!corner) return std::nullopt;
  if (node->items.size() == 2) {
    (*corner)[1] = y;
    if (reading.scene.frame == Frame::cartesian_3d)
      block.fail(*node, "in 3d a box needs three components");
  }
  block.record(key, vector_node(Frame::cartesian_3d, *corner));
  return corner;
}

std::shared_ptr<const Solid> read_box(Block& block, Reading& reading) {
  const std::optional<Triple> min = read_corner(block, "min", -0.5, reading);
  const std::optional<Triple> max = read_corner(block, "max", 0.5, reading);
  if (reading.problems.any() || !min || !max) return nullptr;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!((*max)[k] > (*min)[k])) {
      block.fail("max must lie beyond min along every axis");
      return nullptr;
    }
  }
  return std::make_shared<BoxSolid>(Box{*min, *max});
}

struct ShapeReader {
  const char* name;
  std::shared_ptr<const Solid> (*read)(Block& block, Reading& reading);
};

constexpr ShapeReader kShapes[] = {
    {"cylinder", read_cylinder}, {"box", read_box}, {"sphere", read_sphere}};

int read_material_name(Block& block, Reading& reading) {
  const Node* node = block.require("material");
  if (!node) return -1;
  const std::optional<std::string> word = read_word(*node, reading.problems);
  if (!word) return -1;
  std::vector<std::string> known;
  for (const MaterialOptions& material : reading.scene.materials) known.push_back(material.name);
  const auto found = std::find(known.begin(), known.end(), *word);
  block.record("material", string_node(*word));
  if (found != known.end()) return static_cast<int>(found - known.begin());
  report_unknown(*node, "material", *word, known, reading.problems);
  return -1;
}

Node read_body(const Node& node, Reading& reading) {
  BodyOptions body;
  body.name = node.key;
  Block block{&node, node.path, node, reading.problems};
  body.where = block.place().where();
  body.material = read_material_name(block, reading);
  if (const Node* shape =
          block.require("shape", "for example {cylinder: {radius: 5 mm, height: 20 mm}}")) {
    ReadSolid read = read_solid(*shape, reading);
    body.solid = read.solid;
    block.record("shape", read.resolved);
  }
  if (const Node* velocity = block.find("velocity")) {
    if (const std::optional<ReadField> field = read_field(*velocity, "m/s", reading)) {
      body.velocity = field->field;
      block.record("velocity", field->resolved);
    }
  } else {
    block.record("velocity", vector_node(reading.scene.frame, Triple{}));
  }
  Node resolved = block.finish();
  reading.scene.bodies.push_back(std::move(body));
  return resolved;
}

}  // namespace

ReadSolid read_solid(const Node& shape, Reading& reading) {
  ReadSolid result;
  const std::optional<Choice> choice = read_choice(shape, "shape", reading.problems);
  if (!choice) return result;
  for (const ShapeReader& reader : kShapes) {
    if (choice->name != reader.name) continue;
    Block block{choice->value, shape.path + "." + choice->name, shape, reading.problems};
    try {
      result.solid = reader.read(block, reading);
      if (result.solid) result.solid->require(reading.scene.frame);
    } catch (const std::invalid_argument& error) {
      block.fail(error.what());
    }
    add_member(result.resolved, choice->name, block.finish());
    return result;
  }
  std::vector<std::string> known;
  for (const ShapeReader& reader : kShapes) known.emplace_back(reader.name);
  report_unknown(*choice->place, "shape", choice->name, known, reading.problems);
  return result;
}

Node read_bodies(const Node* node, Reading& reading) {
  Node resolved;
  resolved.kind = Node::Kind::map;
  if (!node) return resolved;
  if (node->kind != Node::Kind::map || node->items.empty()) {
    reading.problems.add(node->file, node->line, node->path,
                         "expected a block of named bodies, found " + node->kind_name());
    return resolved;
  }
  for (const Node& item : node->items) {
    if (check_name(item, reading.problems))
      add_member(resolved, item.key, read_body(item, reading));
  }
  return resolved;
}

}  // namespace krater::scene
