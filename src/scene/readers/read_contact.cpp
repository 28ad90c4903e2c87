// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "scene/readers/readers.hpp"

namespace krater::scene {

namespace {

/// `{between: [a, b], friction: 0.1}`.
Node read_pair(const Node& item, Reading& reading) {
  ContactOptions& contact = reading.scene.contact;
  Block block{contact_pair_block(), &item, item.path, item, reading.problems};
  const Node* between = block.require("between", "two bodies, for example [projectile, plate]");
  const double friction = block.number("friction");
  if (between && (between->kind != Node::Kind::list || between->items.size() != 2)) {
    block.fail(*between, "expected two bodies, for example [projectile, plate]");
  } else if (between) {
    const int a = read_body_name(between->items[0], reading),
              b = read_body_name(between->items[1], reading);
    if (a >= 0 && a == b) block.fail(*between, "a body is not in contact with itself");
    if (a >= 0 && b >= 0) {
      const auto at = [&](int i, int j) -> double& {
        return contact.friction[static_cast<std::size_t>(i * contact.fields + j)];
      };
      at(a, b) = at(b, a) = friction;
      block.record(
          "between",
          list_node({string_node(reading.scene.bodies[static_cast<std::size_t>(a)].name),
                     string_node(reading.scene.bodies[static_cast<std::size_t>(b)].name)}));
    }
  }
  return block.finish();
}

}  // namespace

Node read_contact(const Node& node, Reading& reading) {
  ContactOptions& contact = reading.scene.contact;
  Block block{contact_block(), &node, node.path, node, reading.problems};
  contact.active = true;
  contact.where = block.place().where();
  contact.fields = static_cast<int>(reading.scene.bodies.size());
  contact.normal =
      block.choice<ContactNormal>("normal",
                                  {{"volume_gradient", ContactNormal::volume_gradient},
                                   {"logistic_regression", ContactNormal::logistic_regression}},
                                  contact.normal);
  const double friction = block.number("friction");
  contact.friction.assign(static_cast<std::size_t>(contact.fields * contact.fields), friction);
  if (const auto walls = block.optional_number("walls")) {
    block.record("walls", number_node(*walls));  // taken by the sides (read_boundary.cpp)
    const auto& sides = reading.scene.grid.boundary;
    const bool any = std::any_of(sides.begin(), sides.end(), [](const auto& axis) {
      return std::any_of(axis.begin(), axis.end(),
                         [](const Boundary& b) { return b.kind == BoundaryKind::wall; });
    });
    if (!any) block.fail(*node.find("walls"), "no side of the domain is a wall (grid.boundary)");
  }
  std::vector<Node> pairs;
  if (const Node* list = block.find("pairs")) {
    if (list->kind != Node::Kind::list)
      block.fail(*list, "expected a list of pairs, for example [{between: [a, b], friction: 0.1}]");
    else
      for (const Node& item : list->items) pairs.push_back(read_pair(item, reading));
  }
  if (!pairs.empty()) block.record("pairs", list_node(pairs));
  return block.finish();
}

}  // namespace krater::scene
