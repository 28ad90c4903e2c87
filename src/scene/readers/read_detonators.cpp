// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "scene/readers/readers.hpp"

namespace krater::scene {

namespace {

/// `line: [[0, 0], [0, 20 mm]]`.
void read_line(const Node& node, Detonator& detonator, Block& block, Reading& reading) {
  detonator.kind = Detonator::Kind::line;
  if (node.kind != Node::Kind::list || node.items.size() != 2)
    return block.fail(node, "expected the two ends of the line, [[0, 0], [0, 20 mm]]");
  const auto a = read_place(node.items[0], reading), b = read_place(node.items[1], reading);
  if (a && b) {
    detonator.a = *a;
    detonator.b = *b;
    if (*a == *b) block.fail(node, "the ends of the line are one point; use point");
  }
}

/// `plane: {through: [0, 0], normal: [0, 1]}`.
void read_plane(const Node& node, Detonator& detonator, Block& parent, Reading& reading) {
  detonator.kind = Detonator::Kind::plane;
  Block block{detonator_plane_block(), &node, node.path, node, reading.problems};
  const Node *through = block.require("through", "a point of the plane"),
             *normal = block.require("normal", "for example [0, 1]");
  if (through && normal) {
    const auto a = read_place(*through, reading);
    const auto n = read_vector(*normal, "1", reading);
    if (a && n) {
      const double length = std::hypot((*n)[0], (*n)[1], (*n)[2]);
      if (!(length > 0)) return block.fail(*normal, "the normal has no direction");
      detonator.a = *a;
      for (std::size_t k = 0; k < 3; ++k) detonator.b[k] = (*n)[k] / length;
    }
    block.record("through", *through);
    block.record("normal", *normal);
  }
  parent.record("plane", block.finish());
}

Node read_detonator(const Node& node, Reading& reading) {
  Detonator detonator;
  detonator.name = node.key;
  Block block{detonator_block(), &node, node.path, node, reading.problems};
  detonator.where = block.place().where();
  const Node *point = block.find("point"), *line = block.find("line"), *plane = block.find("plane");
  if ((point ? 1 : 0) + (line ? 1 : 0) + (plane ? 1 : 0) != 1)
    block.fail("expected one of point, line and plane");
  else if (point) {
    if (const auto place = read_place(*point, reading)) detonator.a = *place;
    block.record("point", *point);
  } else if (line) {
    read_line(*line, detonator, block, reading);
    block.record("line", *line);
  } else {
    read_plane(*plane, detonator, block, reading);
  }
  detonator.time = block.number("time");
  if (detonator.time < 0) block.fail("a detonator lights at the start, time: 0, or later");
  Node resolved = block.finish();
  reading.scene.detonators.push_back(std::move(detonator));
  return resolved;
}

}  // namespace

void read_detonators(Block& root, Reading& reading) {
  const Node* node = root.find_block("detonators");
  if (!node) return;
  if (node->kind != Node::Kind::map)
    return root.fail(*node, "expected a block of named detonators, found " + node->kind_name());
  Node resolved;
  resolved.kind = Node::Kind::map;
  for (const Node& item : node->items) {
    check_name(item, reading.problems);
    add_member(resolved, item.key, read_detonator(item, reading));
  }
  root.record("detonators", resolved);
}

}  // namespace krater::scene
