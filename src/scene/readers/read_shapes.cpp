// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <limits>
#include <stdexcept>

#include "krater/geometry/solids/csg.hpp"
#include "krater/geometry/solids/primitives.hpp"
#include "krater/geometry/solids/shapes.hpp"
#include "scene/readers/read_shapes.hpp"

namespace krater::scene {

namespace {

using SolidPointer = std::shared_ptr<const Solid>;

/// A position in 3D space by key; the origin by default.
Triple read_place(Block& block, const char* key, Reading& reading) {
  const Node* node = block.find(key);
  const Triple place = node ? read_position(*node, reading).value_or(Triple{}) : Triple{};
  block.record(key, vector_node(Frame::cartesian_3d, place));
  return place;
}

int read_axis(Block& block, int fallback = 2) {
  return block.choice<int>("axis", {{"x", 0}, {"y", 1}, {"z", 2}}, fallback);
}

/// `base` and `axis` (x, y, z, -x, -y, -z: from the base on) of a shape made along +z.
Affine read_placing(Block& block, const char* key, Reading& reading) {
  const Triple base = read_place(block, key, reading);
  const int axis =
      block.choice<int>("axis", {{"x", 0}, {"y", 1}, {"z", 2}, {"-x", 3}, {"-y", 4}, {"-z", 5}}, 2);
  return placing(base, axis % 3, axis > 2);
}

SolidPointer placed(SolidPointer solid, const Affine& map) {
  return transformed(std::move(solid), map);
}

SolidPointer read_cylinder(Block& block, Reading& reading) {
  const double radius = block.number("radius");
  const double height = block.number("height");
  const Triple base = read_place(block, "base", reading);
  const int axis = read_axis(block);
  if (reading.problems.any()) return nullptr;
  return std::make_shared<CylinderSolid>(radius, height, base, axis);
}

SolidPointer read_sphere(Block& block, Reading& reading) {
  const double radius = block.number("radius");
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

SolidPointer read_box(Block& block, Reading& reading) {
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

SolidPointer read_tube(Block& block, Reading& reading) {
  const double inner = block.number("inner_radius"), outer = block.number("outer_radius");
  const double height = block.number("height");
  const Affine map = read_placing(block, "base", reading);
  if (reading.problems.any()) return nullptr;
  return placed(make_tube(inner, outer, height), map);
}

SolidPointer read_cone(Block& block, Reading& reading) {
  const double radius = block.number("radius"), top = block.number("top_radius");
  const double height = block.number("height");
  const Affine map = read_placing(block, "base", reading);
  if (reading.problems.any()) return nullptr;
  return placed(make_cone(radius, top, height), map);
}

SolidPointer read_torus(Block& block, Reading& reading) {
  const double major = block.number("major_radius"), minor = block.number("minor_radius");
  const Affine map = read_placing(block, "center", reading);
  if (reading.problems.any()) return nullptr;
  return placed(make_torus(major, minor), map);
}

SolidPointer read_ellipsoid(Block& block, Reading& reading) {
  std::optional<Triple> axes;
  if (const Node* node = block.require("semi_axes", "[r, z] or [x, y, z]")) {
    axes = read_position(*node, reading);
    if (axes && node->items.size() == 2) (*axes)[1] = (*axes)[0];
  }
  if (axes) block.record("semi_axes", vector_node(Frame::cartesian_3d, *axes));
  const Triple centre = read_place(block, "center", reading);
  if (reading.problems.any() || !axes) return nullptr;
  return placed(make_ellipsoid(*axes), Affine::move(centre));
}

SolidPointer read_ogive(Block& block, Reading& reading) {
  const double radius = block.number("radius"), length = block.number("length");
  const double crh = block.number("crh");
  const Affine map = read_placing(block, "base", reading);
  if (reading.problems.any()) return nullptr;
  return placed(make_ogive(radius, length, crh), map);
}

SolidPointer read_slab(Block& block, Reading& reading) {
  const double inf = std::numeric_limits<double>::infinity();
  const auto bound = [&](const char* key, double none) {
    const std::optional<double> value = block.optional_number(key);
    if (value) block.record(key, number_node(*value));
    return value.value_or(none);
  };
  const int axis = read_axis(block);
  const double low = bound("min", -inf), high = bound("max", inf);
  if (reading.problems.any()) return nullptr;
  return make_slab(axis, low, high);
}

/// Corners of a polygon, two lengths each.
std::vector<std::array<double, 2>> read_polygon(Block& block, const char* hint, Reading& reading) {
  std::vector<std::array<double, 2>> corners;
  const Node* node = block.require("polygon", hint);
  if (!node) return corners;
  if (node->kind != Node::Kind::list) {
    block.fail(*node, "expected a list of corners, found " + node->kind_name());
    return corners;
  }
  std::vector<Node> resolved;
  for (const Node& item : node->items) {
    if (item.kind != Node::Kind::list || item.items.size() != 2) {
      block.fail(item, "a corner is a list of two lengths");
      return corners;
    }
    const auto u = read_number(item.items[0], "m", Range::any, reading.problems);
    const auto v = read_number(item.items[1], "m", Range::any, reading.problems);
    if (!u || !v) return corners;
    corners.push_back({*u, *v});
    resolved.push_back(list_node({number_node(*u), number_node(*v)}));
  }
  block.record("polygon", list_node(resolved));
  return corners;
}

/// Across `axis`: the corners are (y, z), (x, z) or (x, y).
SolidPointer read_extrusion(Block& block, Reading& reading) {
  auto corners = read_polygon(block, "[[x, z], ...], the other two axes in order", reading);
  const int axis = read_axis(block, 1);
  const double low = block.number("min"), high = block.number("max");
  if (reading.problems.any()) return nullptr;
  if (!(high > low)) throw std::invalid_argument("max must lie beyond min");
  Affine map;
  if (axis == 0) map.linear = {0, 0, 1, 1, 0, 0, 0, 1, 0};
  if (axis == 1) map.linear = {1, 0, 0, 0, 0, 1, 0, 1, 0};
  map.shift[static_cast<std::size_t>(axis)] = low;
  return placed(make_extrusion(polygon_profile(corners), high - low), map);
}

SolidPointer read_revolution(Block& block, Reading& reading) {
  const auto corners = read_polygon(block, "[[r, z], ...]", reading);
  const Affine map = read_placing(block, "base", reading);
  if (reading.problems.any()) return nullptr;
  return placed(make_revolution(polygon_profile(corners)), map);
}

SolidPointer read_inner(Block& block, Reading& reading) {
  const Node* node = block.require("shape", "the shape that is moved, turned or scaled");
  if (!node) return nullptr;
  ReadSolid inner = read_shape(*node, reading);
  block.record("shape", inner.resolved);
  return inner.solid;
}

SolidPointer read_move(Block& block, Reading& reading) {
  block.require("by", "a displacement");
  const Triple by = read_place(block, "by", reading);
  const SolidPointer inner = read_inner(block, reading);
  if (reading.problems.any() || !inner) return nullptr;
  return placed(inner, Affine::move(by));
}

SolidPointer read_rotate(Block& block, Reading& reading) {
  const int axis = read_axis(block);
  const double angle = block.number("angle");
  const Triple about = read_place(block, "about", reading);
  const SolidPointer inner = read_inner(block, reading);
  if (reading.problems.any() || !inner) return nullptr;
  Triple direction{};
  direction[static_cast<std::size_t>(axis)] = 1;
  return placed(inner, Affine::rotate(direction, angle, about));
}

/// One factor, or one per axis.
SolidPointer read_scale(Block& block, Reading& reading) {
  Triple factors{1, 1, 1};
  if (const Node* node = block.require("by", "a factor, or one per axis")) {
    const bool list = node->kind == Node::Kind::list;
    if (list && node->items.size() != 3) block.fail(*node, "expected one factor or three");
    for (std::size_t k = 0; k < 3 && (!list || node->items.size() == 3); ++k) {
      const Node& item = list ? node->items[k] : *node;
      factors[k] = read_number(item, "1", Range::positive, reading.problems).value_or(1);
      if (reading.problems.any()) break;
    }
  }
  block.record("by", vector_node(Frame::cartesian_3d, factors));
  const Triple about = read_place(block, "about", reading);
  const SolidPointer inner = read_inner(block, reading);
  if (reading.problems.any() || !inner) return nullptr;
  return placed(inner, Affine::scale(factors, about));
}

struct ShapeReader {
  const char* name;
  SolidPointer (*read)(Block& block, Reading& reading);
};

constexpr ShapeReader kShapes[] = {{"cylinder", read_cylinder},
                                   {"box", read_box},
                                   {"sphere", read_sphere},
                                   {"tube", read_tube},
                                   {"cone", read_cone},
                                   {"torus", read_torus},
                                   {"ellipsoid", read_ellipsoid},
                                   {"ogive", read_ogive},
                                   {"slab", read_slab},
                                   {"extrusion", read_extrusion},
                                   {"revolution", read_revolution},
                                   {"surface", read_surface},
                                   {"mesh", read_mesh},
                                   {"move", read_move},
                                   {"rotate", read_rotate},
                                   {"scale", read_scale}};

constexpr std::pair<const char*, Boolean> kBooleans[] = {{"union", Boolean::unite},
                                                         {"intersection", Boolean::intersect},
                                                         {"difference", Boolean::subtract}};

ReadSolid read_boolean(const Node& list, const char* name, Boolean operation, Reading& reading) {
  ReadSolid result;
  if (list.kind != Node::Kind::list) {
    reading.problems.add(list.file, list.line, list.path,
                         "expected a list of shapes, found " + list.kind_name());
    return result;
  }
  std::vector<SolidPointer> operands;
  std::vector<Node> resolved;
  for (const Node& item : list.items) {
    ReadSolid operand = read_shape(item, reading);
    operands.push_back(operand.solid);
    resolved.push_back(operand.resolved);
  }
  add_member(result.resolved, name, list_node(resolved));
  if (reading.problems.any()) return result;
  try {
    result.solid = make_boolean(operation, operands);
  } catch (const std::invalid_argument& error) {
    reading.problems.add(list.file, list.line, list.path, error.what());
  }
  return result;
}

}  // namespace

ReadSolid read_shape(const Node& shape, Reading& reading) {
  ReadSolid result;
  const std::optional<Choice> choice = read_choice(shape, "shape", reading.problems);
  if (!choice) return result;
  for (const auto& [name, operation] : kBooleans) {
    if (choice->name == name && choice->value)
      return read_boolean(*choice->value, name, operation, reading);
  }
  for (const ShapeReader& reader : kShapes) {
    if (choice->name != reader.name) continue;
    Block block{member(shape_block(), choice->name), choice->value, shape.path + "." + choice->name,
                shape, reading.problems};
    try {
      result.solid = reader.read(block, reading);
    } catch (const std::invalid_argument& error) {
      block.fail(error.what());
    }
    add_member(result.resolved, choice->name, block.finish());
    return result;
  }
  std::vector<std::string> known;
  for (const ShapeReader& reader : kShapes) known.emplace_back(reader.name);
  for (const auto& [name, operation] : kBooleans) known.emplace_back(name);
  report_unknown(*choice->place, "shape", choice->name, known, reading.problems);
  return result;
}

ReadSolid read_solid(const Node& shape, Reading& reading) {
  ReadSolid result = read_shape(shape, reading);
  if (!result.solid) return result;
  try {
    result.solid->require(reading.scene.frame);
  } catch (const std::invalid_argument& error) {
    const bool named = shape.kind == Node::Kind::map && shape.items.size() == 1;
    const Node& place = named ? shape.items[0] : shape;
    reading.problems.add(place.file, place.line, place.path, error.what());
  }
  return result;
}

}  // namespace krater::scene
