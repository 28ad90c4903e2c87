// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "krater/geometry/solids/csg.hpp"
#include "scene/readers/read_shapes.hpp"

namespace krater::scene {

namespace {

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
  if (known.empty()) return -1;  // that there are no materials is said already
  report_unknown(*node, "material", *word, known, reading.problems);
  return -1;
}

/// One number, or one per axis: [r or x, z] or [x, y, z].
std::array<int, 3> read_per_direction(Block& block, int fallback, int most, Reading& reading) {
  std::array<int, 3> out{fallback, fallback, fallback};
  const Node* node = block.find("per_direction");
  const bool list = node && node->kind == Node::Kind::list;
  if (list && node->items.size() != 2 && node->items.size() != 3) {
    block.fail(*node, "expected one number, or one per axis ([r or x, z] or [x, y, z])");
    return out;
  }
  std::vector<int> given;
  for (std::size_t k = 0; node && k < (list ? node->items.size() : 1); ++k) {
    const Node& item = list ? node->items[k] : *node;
    const auto value = read_number(item, "1", Range::positive, reading.problems);
    if (!value) return out;
    if (*value != static_cast<int>(*value) || *value > most) {
      block.fail(item, "must be a whole number from 1 to " + std::to_string(most));
      return out;
    }
    given.push_back(static_cast<int>(*value));
  }
  const bool full = dimension(reading.scene.frame) == 3;
  if (given.size() == 1) out.fill(given[0]);
  if (given.size() == 2)
    out =
        full ? std::array{given[0], given[0], given[1]} : std::array{given[0], given[1], given[1]};
  if (given.size() == 3)
    out =
        full ? std::array{given[0], given[1], given[2]} : std::array{given[0], given[2], given[2]};
  std::vector<Node> resolved;
  for (int a = 0; a < dimension(reading.scene.frame); ++a)
    resolved.push_back(scalar_node(std::to_string(out[static_cast<std::size_t>(a)])));
  block.record("per_direction", list_node(resolved));
  return out;
}

constexpr int kMostPerDirection = 8;

RefinedZone read_zone(const Node& node, Reading& reading) {
  Block block{zone_block(), &node, node.path, node, reading.problems};
  RefinedZone zone;
  if (const std::optional<Box> box = read_corners(block, reading)) zone.box = *box;
  zone.points_per_direction = read_per_direction(block, 4, kMostPerDirection, reading);
  zone.falloff = block.integer("falloff", 2);
  block.finish();
  return zone;
}

Node read_points(const Node* node, Block& body, PointOptions& points, Reading& reading) {
  const MethodOptions& method = reading.scene.method;
  Block block{points_block(), node, node ? node->path : body.place().path + ".points", body.place(),
              reading.problems};
  points.per_direction =
      read_per_direction(block, method.points_per_direction, kMostPerDirection, reading);
  points.fit_to_body = block.choice<bool>("lattice", {{"grid", false}, {"body", true}}, false);
  points.jitter = block.number("jitter", method.jitter);
  points.seed = static_cast<unsigned>(block.integer("seed", static_cast<int>(method.seed)));
  if (const Node* zones = block.find("zones")) {
    if (zones->kind != Node::Kind::list) {
      block.fail(*zones, "expected a list of zones, found " + zones->kind_name());
    } else {
      for (const Node& zone : zones->items) points.zones.push_back(read_zone(zone, reading));
      block.record("zones", *zones);
    }
    if (points.fit_to_body)
      block.fail(*zones, "a lattice fitted to the body has no zones of more points");
  }
  return block.finish();
}

Node read_body(const Node& node, Reading& reading) {
  BodyOptions body;
  body.name = node.key;
  Block block{body_block(), &node, node.path, node, reading.problems};
  body.where = block.place().where();
  body.material = read_material_name(block, reading);
  if (const Node* shape =
          block.require("shape", "for example {cylinder: {radius: 5 mm, height: 20 mm}}")) {
    ReadSolid read = read_solid(*shape, reading);
    body.solid = read.solid;
    block.record("shape", read.resolved);
  }
  body.velocity = read_motion(block, body.solid.get(), reading);
  if (const Node* rigid = block.find_block("rigid"))
    block.record("rigid", read_rigid(*rigid, body, reading));
  if (const Node* kinematics = block.find("kinematics"))
    block.record("kinematics", read_kinematics(*kinematics, body, reading));
  body.thin_allowed =
      block.choice<bool>("thin", {{"refused", false}, {"allowed", true}}, body.thin_allowed);
  const Node* points = block.find("points");
  Node resolved_points = read_points(points, block, body.points, reading);
  if (body.sph) body.points.per_direction.fill(particles_per_cell(body, reading.scene));
  if (body.material_points() || points != nullptr) block.record("points", resolved_points);
  if (const Node* losers = block.find("wins_over")) block.record("wins_over", *losers);
  Node resolved = block.finish();
  reading.scene.bodies.push_back(std::move(body));
  return resolved;
}

void read_wins_over(const Node& list, std::size_t winner, Reading& reading) {
  std::vector<BodyOptions>& bodies = reading.scene.bodies;
  if (list.kind != Node::Kind::list) {
    reading.problems.add(list.file, list.line, list.path,
                         "expected a list of bodies, found " + list.kind_name());
    return;
  }
  std::vector<std::string> known;
  for (const BodyOptions& body : bodies) known.push_back(body.name);
  for (const Node& item : list.items) {
    const std::optional<std::string> name = read_word(item, reading.problems);
    if (!name) continue;
    const auto loser =
        static_cast<std::size_t>(std::find(known.begin(), known.end(), *name) - known.begin());
    if (loser == known.size()) {
      report_unknown(item, "body", *name, known, reading.problems);
    } else if (loser == winner) {
      reading.problems.add(item.file, item.line, item.path, "a body cannot win over itself");
    } else {
      bodies[winner].wins_over.push_back(static_cast<int>(loser));
    }
  }
}

/// Cut the winners, as they were drawn, out of the losers.
void settle_overlaps(const Node& node, Reading& reading) {
  std::vector<BodyOptions>& bodies = reading.scene.bodies;
  for (std::size_t n = 0; n < bodies.size(); ++n) {
    const Node* body = node.find(bodies[n].name);
    if (const Node* list = body->find("wins_over")) read_wins_over(*list, n, reading);
  }
  if (reading.problems.any()) return;
  std::vector<std::shared_ptr<const Solid>> drawn;
  for (const BodyOptions& body : bodies) drawn.push_back(body.solid);
  for (std::size_t n = 0; n < bodies.size(); ++n) {
    for (const int loser : bodies[n].wins_over) {
      BodyOptions& other = bodies[static_cast<std::size_t>(loser)];
      const auto& back = other.wins_over;
      if (std::find(back.begin(), back.end(), static_cast<int>(n)) != back.end()) {
        const Node* place = node.find(bodies[n].name)->find("wins_over");
        reading.problems.add(place->file, place->line, place->path,
                             quote(other.name) + " wins over " + quote(bodies[n].name) + " too");
        return;
      }
      other.solid = make_boolean(Boolean::subtract, {other.solid, drawn[n]});
    }
  }
}

}  // namespace

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
    check_name(item, reading.problems);
    add_member(resolved, item.key, read_body(item, reading));
  }
  settle_overlaps(*node, reading);
  return resolved;
}

}  // namespace krater::scene
