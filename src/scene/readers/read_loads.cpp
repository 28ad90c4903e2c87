// SPDX-License-Identifier: GPL-3.0-or-later
// `damping:`, `loads:` and functions of time.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "krater/core/errors.hpp"
#include "krater/scene/yaml/expression.hpp"
#include "krater/scene/yaml/units.hpp"
#include "scene/readers/readers.hpp"

namespace krater::scene {

namespace {

using Kind = FaceLoad::Kind;
using Table = std::vector<std::pair<double, double>>;

void fail(const Node& node, const std::string& message, Reading& reading) {
  reading.problems.add(node.file, node.line, node.path, message);
}

/// Linear between its rows; before the first and after the last as there.
double look_up(const Table& table, double t) {
  const auto after = std::upper_bound(
      table.begin(), table.end(), t,
      [](double time, const std::pair<double, double>& row) { return time < row.first; });
  if (after == table.begin()) return table.front().second;
  if (after == table.end()) return table.back().second;
  const auto before = after - 1;
  const double share = (t - before->first) / (after->first - before->first);
  return before->second + share * (after->second - before->second);
}

std::optional<ReadTime> read_table(const Node& node, const char* unit, Reading& reading) {
  Table table;
  std::vector<Node> resolved;
  for (const Node& row : node.items) {
    if (row.kind != Node::Kind::list || row.items.size() != 2) {
      fail(row, "expected rows of two, [time, value]", reading);
      return std::nullopt;
    }
    const auto t = read_number(row.items[0], "s", Range::any, reading.problems),
               value = read_number(row.items[1], unit, Range::any, reading.problems);
    if (!t || !value) return std::nullopt;
    if (!table.empty() && !(*t > table.back().first)) {
      fail(row,
           "the table goes back in time, or stands still: " + number_text(*t) + " s after " +
               number_text(table.back().first) + " s",
           reading);
      return std::nullopt;
    }
    table.emplace_back(*t, *value);
    resolved.push_back(list_node({number_node(*t), number_node(*value)}));
  }
  if (table.empty()) {
    fail(node, "expected rows, [[0 us, 0], [1 us, 1 GPa]]", reading);
    return std::nullopt;
  }
  ReadTime out;
  add_member(out.resolved, "table", list_node(resolved));
  out.value = [table](double t) { return look_up(table, t); };
  return out;
}

/// The bounds of a region, as measures take them.
void read_where(Block& parent, FaceLoad& load, Reading& reading) {
  const Node* node = parent.find("where");
  if (!node) return;
  MeasureSelection selection;
  Block block{bounds_block(), node, node->path, parent.place(), reading.problems};
  read_bounds(block, selection.region, reading);
  load.region = selection.region;
  parent.record("where", block.finish());
}

void read_bodies(Block& block, FaceLoad& load, Reading& reading) {
  const Node* node = block.require("body", "a body, or a list of them");
  if (!node) return;
  for (const Node& item : node->kind == Node::Kind::list ? node->items : std::vector{*node}) {
    const int body = read_body_name(item, reading);
    if (body < 0) continue;
    if (reading.scene.bodies[static_cast<std::size_t>(body)].rigid())
      fail(item, "a rigid body has no face to be loaded; give it a motion (rigid: {velocity: ...})",
           reading);
    load.bodies.push_back(body);
  }
  block.record("body", *node);
}

void read_value(Block& block, FaceLoad& load, Reading& reading) {
  const Node *pressure = block.find("pressure"), *traction = block.find("traction"),
             *velocity = block.find("velocity");
  const int given = (pressure ? 1 : 0) + (traction ? 1 : 0) + (velocity ? 1 : 0);
  if (given != 1) return block.fail("expected one of pressure, traction and velocity");
  if (pressure) {
    if (const auto read = read_time_function(*pressure, "Pa", reading)) {
      load.value[0] = read->value;
      block.record("pressure", read->resolved);
    }
    return;
  }
  load.kind = traction ? Kind::traction : Kind::velocity;
  const Node& node = traction ? *traction : *velocity;
  const char* key = traction ? "traction" : "velocity";
  const auto dim = static_cast<std::size_t>(dimension(reading.scene.frame));
  if (node.kind != Node::Kind::list || node.items.size() != dim)
    return fail(node,
                "expected " + std::to_string(dim) + " components along the axes of " +
                    std::string{name(reading.scene.frame)} +
                    ": numbers, expressions in t, {table: ...}" + (traction ? "" : ", or free"),
                reading);
  std::vector<Node> resolved;
  for (std::size_t a = 0; a < dim; ++a) {
    const Node& item = node.items[a];
    resolved.push_back(item);
    if (velocity && item.kind == Node::Kind::scalar && item.text == "free") continue;
    const auto read = read_time_function(item, traction ? "Pa" : "m/s", reading);
    if (!read) return;
    load.value[a] = read->value;
    resolved.back() = read->resolved;
  }
  block.record(key, list_node(resolved));
}

Node read_load(const Node& node, Reading& reading) {
  FaceLoad load;
  load.name = node.key;
  Block block{load_block(), &node, node.path, node, reading.problems};
  load.where = block.place().where();
  read_bodies(block, load, reading);
  if (const Node* face = block.find("face")) {
    std::tie(load.axis, load.side) = read_face_name(*face, reading);
    block.record("face", *face);
  }
  read_where(block, load, reading);
  if (const Node* inside = block.find("inside")) {
    const ReadSolid read = read_solid(*inside, reading);
    load.inside = [solid = read.solid, frame = reading.scene.frame](const Triple& x) {
      return solid->contains(frame, x);
    };
    block.record("inside", read.resolved);
  }
  read_value(block, load, reading);
  if (load.axis < 0 && load.kind != Kind::pressure && !reading.problems.any())
    block.fail(
        "a traction or velocity needs its face, as face: z_max; a pressure may act all "
        "around");
  Node resolved = block.finish();
  reading.scene.loads.faces.push_back(std::move(load));
  return resolved;
}

/// A pressure on a side of the box acts on the bodies that reach it.
void find_bodies(FaceLoad& load, Reading& reading) {
  const GridOptions& grid = reading.scene.grid;
  const auto a = static_cast<std::size_t>(load.axis);
  const double plane = load.side == 0 ? grid.min[a] : grid.max[a], near = 1e-6 * grid.cell;
  for (std::size_t b = 0; b < reading.scene.bodies.size(); ++b) {
    const BodyOptions& body = reading.scene.bodies[b];
    if (!body.solid || body.rigid()) continue;
    const Box extent = body.solid->extent(reading.scene.frame);
    const bool reaches =
        load.side == 0 ? extent.min[a] < plane + near : extent.max[a] > plane - near;
    if (reaches) load.bodies.push_back(static_cast<int>(b));
  }
  constexpr double kDepth = 5;  // cells: more than any mark
  load.region[a][load.side == 0 ? 1 : 0] = plane + (load.side == 0 ? kDepth : -kDepth) * grid.cell;
}

void check_loads(const Node* place, Reading& reading) {
  const Scene& scene = reading.scene;
  std::vector<int> count(scene.bodies.size());
  for (const FaceLoad& load : scene.loads.faces) {
    if (load.bodies.empty())
      reading.problems.add("", 0, load.where,
                           "no body reaches this side at the start, so the pressure has nothing to "
                           "act on; move the side or the body, or use loads: {NAME: {body, face, "
                           "pressure}}");
    for (const int b : load.bodies)
      if (++count[static_cast<std::size_t>(b)] > dimension(scene.frame) && place)
        fail(*place,
             "body " + quote(scene.bodies[static_cast<std::size_t>(b)].name) +
                 " has more loads than the frame has axes, which is the most it can carry",
             reading);
  }
  if (!scene.loads.any() || scene.method.transfer != Transfer::xpic) return;
  fail(*reading.root.find("method")->find("transfer"),
       "loads and damping do not go with transfer xpic; use tflip, flip or apic", reading);
}

}  // namespace

std::optional<ReadTime> read_time_function(const Node& node, const char* unit, Reading& reading) {
  ReadTime out;
  if (node.kind == Node::Kind::map) {
    const Node* table = node.find("table");
    if (table && table->kind == Node::Kind::list && node.items.size() == 1)
      return read_table(*table, unit, reading);
    fail(node, "expected {table: [[time, value], ...]}, a value or an expression in t", reading);
    return std::nullopt;
  }
  const bool quantity = node.kind != Node::Kind::scalar || looks_like_quantity(node.text) ||
                        parse_quantity(node.text, unit).problem.empty();
  if (quantity) {
    const auto value = read_number(node, unit, Range::any, reading.problems);
    if (!value) return std::nullopt;
    out.value = [v = *value](double) { return v; };
    out.resolved = number_node(*value);
    return out;
  }
  try {
    out.value = make_time_function(node.text);
  } catch (const InputError& error) {
    fail(node, error.what(), reading);
    return std::nullopt;
  }
  if (const double start = out.value(0); !std::isfinite(start)) {
    fail(node,
         fmt::format("is {} at t = 0: give a value, or {{table: [[time, value], ...]}}", start),
         reading);
    return std::nullopt;
  }
  out.resolved = string_node(node.text);
  return out;
}

void read_loads(Block& root, Reading& reading) {
  LoadOptions& loads = reading.scene.loads;
  if (const Node* node = root.find_block("damping")) {
    Block block{damping_block(), node, node->path, root.place(), reading.problems};
    loads.damping = block.number("mass");
    root.record("damping", block.finish());
  }
  for (FaceLoad& load : loads.faces) find_bodies(load, reading);
  const Node* node = root.find_block("loads");
  if (node && node->kind != Node::Kind::map) {
    fail(*node, "expected a block of named loads, found " + node->kind_name(), reading);
  } else if (node) {
    Node resolved;
    resolved.kind = Node::Kind::map;
    for (const Node& item : node->items) {
      check_name(item, reading.problems);
      add_member(resolved, item.key, read_load(item, reading));
    }
    root.record("loads", resolved);
  }
  if (!reading.problems.any()) check_loads(node, reading);
}

}  // namespace krater::scene
