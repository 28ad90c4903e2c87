// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "scene/readers/read_axes.hpp"
#include "scene/readers/readers.hpp"

namespace krater::scene {

namespace {

std::vector<std::string> body_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const BodyOptions& body : scene.bodies) names.push_back(body.name);
  return names;
}

}  // namespace

int read_body_name(const Node& node, Reading& reading) {
  const std::vector<std::string> bodies = body_names(reading.scene);
  const std::optional<std::string> word = read_word(node, reading.problems);
  if (!word) return -1;
  const auto found = std::find(bodies.begin(), bodies.end(), *word);
  if (bodies.empty()) return -1;  // said already
  if (found == bodies.end()) {
    report_unknown(node, "body", *word, bodies, reading.problems);
    return -1;
  }
  return static_cast<int>(found - bodies.begin());
}

namespace {

/// A required word out of a list; "" after a problem.
std::string required_word(Block& block, const char* key, const std::string& what,
                          const std::vector<std::string>& known, const std::string& hint) {
  const Node* node = block.require(key, hint);
  if (!node) return "";
  const std::optional<std::string> word = read_word(*node, block.problems());
  if (!word) return "";
  if (std::find(known.begin(), known.end(), *word) == known.end()) {
    report_unknown(*node, what, *word, known, block.problems());
    return "";
  }
  block.record(key, string_node(*word));
  return *word;
}

/// `at: {z: 5 mm}` or `at: {from_lower_end: 5 mm}`.
void read_at(const Node* node, MeasureOptions& measure, Block& parent, Reading& reading) {
  if (!node) return;
  Block block{measure_at_block(), node, node->path, parent.place(), reading.problems};
  const std::optional<double> z = block.optional_number("z");
  const std::optional<double> above = block.optional_number("from_lower_end");
  if (!node->find("z") == !node->find("from_lower_end")) {
    block.fail("expected one of {z: ...} and {from_lower_end: ...}");
  }
  measure.at = z.value_or(above.value_or(0.0));
  measure.at_from_end = above.has_value();
  block.record(above ? "from_lower_end" : "z", number_node(measure.at));
  parent.record("at", block.finish());
}

/// `within: {from_lower_end: 2 mm}`.
void read_within(MeasureOptions& measure, Block& parent, Reading& reading) {
  const Node* node = parent.find("within");
  if (!node) return;
  Block block{measure_within_block(), node, node->path, parent.place(), reading.problems};
  measure.level = block.number("from_lower_end");
  parent.record("within", block.finish());
}

/// The share of debris_extent is held by it, that of an extreme lies beyond it: 0 is one point.
void read_mass_share(Block& block, MeasureOptions& measure) {
  const bool extent = measure.kind == MeasureKind::debris_extent;
  measure.mass_share = block.number("mass_share", extent ? 1.0 : kExtremeShare);
  if (extent && measure.mass_share == 0) block.fail("mass_share must be positive");
}

/// `axis: z`, or any line: `axis: [1, 0, -1]`.
void read_direction(Block& block, MeasureOptions& measure, Reading& reading) {
  const Node* node = block.find("axis");
  if (!node || node->kind != Node::Kind::list) {
    measure.axis = read_axis(block, reading);
    return;
  }
  const std::optional<Triple> given = read_vector(*node, "1", reading);
  if (!given) return;
  const double length = std::hypot((*given)[0], (*given)[1], (*given)[2]);
  if (!(length > 0)) return block.fail(*node, "a direction needs a length");
  for (std::size_t a = 0; a < 3; ++a) measure.direction[a] = (*given)[a] / length;
  block.record("axis", vector_node(reading.scene.frame, measure.direction));
}

struct NamedPartner {
  std::string name;
  Partner partner;
};

/// Bodies that meet others, and sides of the domain that push.
std::vector<NamedPartner> known_partners(const Scene& scene) {
  std::vector<NamedPartner> out;
  for (std::size_t b = 0; b < scene.bodies.size() && scene.contact.active; ++b)
    out.push_back({scene.bodies[b].name, {Partner::Kind::body, static_cast<int>(b)}});
  for (int axis = 0; axis < dimension(scene.frame); ++axis)
    for (int side = 0; side < 2; ++side)
      if (scene.grid.boundary[static_cast<std::size_t>(axis)][static_cast<std::size_t>(side)]
              .pushes())
        out.push_back({side_name(scene.frame, axis, side), Partner::side(axis, side)});
  return out;
}

/// Says why a side's impulse on the measure's bodies is not known.
void check_side(const Node& node, const MeasureOptions& measure, Block& block, const Scene& scene) {
  if (!scene.contact.active && measure.selection.bodies.size() != scene.bodies.size())
    block.fail(node,
               "without contact: all bodies share one velocity field, and what a side gives "
               "them cannot be told apart: list all of them as body");
  if (scene.method.reference != Reference::current)
    block.fail(node,
               "on a fixed reference configuration walls push points one by one, and their "
               "impulse is not told apart: use wall_impulse of the history");
}

/// `by: plate` or `by: z_min`: a body in contact, or a side of the domain that pushes; `by: all` of
/// them.
void read_partner(Block& block, MeasureOptions& measure, Reading& reading) {
  const Scene& scene = reading.scene;
  const std::vector<NamedPartner> known = known_partners(scene);
  const Node* node =
      block.require("by", "who pushes: a body in contact, a wall or driven side, or all");
  const std::optional<std::string> word = node ? read_word(*node, reading.problems) : std::nullopt;
  if (!word) return;
  const std::vector<int>& on = measure.selection.bodies;
  const auto itself = [&](Partner p) {
    return p.kind == Partner::Kind::body && std::find(on.begin(), on.end(), p.number) != on.end();
  };
  std::vector<std::string> names;
  for (const NamedPartner& k : known) {
    names.push_back(k.name);
    if (k.name == *word || (*word == "all" && !itself(k.partner))) measure.by.push_back(k.partner);
  }
  if (measure.by.empty())
    return block.fail(*node,
                      quote(*word) +
                          " pushes nobody here: known are bodies where the scene "
                          "has contact:, and sides that are a wall or driven (" +
                          (known.empty() ? "none" : join(names)) +
                          "); what other closed sides give is in wall_impulse of the history");
  block.record("by", string_node(*word));
  if (itself(measure.by.front()))
    block.fail(*node, "a body gives itself no impulse: by must be another one");
  if (measure.by.back().kind == Partner::Kind::side) check_side(*node, measure, block, scene);
}

/// `face: z_max`: the face whose outward normal is +z.
void read_face(Block& block, MeasureOptions& measure, bool along_z, Reading& reading) {
  const Frame frame = reading.scene.frame;
  std::vector<std::string> faces;
  for (int axis = along_z ? dimension(frame) - 1 : 0; axis < dimension(frame); ++axis)
    for (int side = 0; side < 2; ++side) faces.push_back(side_name(frame, axis, side));
  const Node* node = block.require("face", "one of " + join(faces));
  if (!node) return;
  const std::optional<std::string> word = read_word(*node, reading.problems);
  if (!word) return;
  const auto [axis, side] = side_of(frame, *word);
  if (axis < 0 || (along_z && axis != dimension(frame) - 1)) {
    report_unknown(*node, "face", *word, faces, reading.problems);
    return;
  }
  measure.axis = axis;
  measure.side = side;
  block.record("face", string_node(side_name(frame, axis, side)));
}

/// `body: rod` or `body: [projectile, plate]`.
std::vector<int> read_bodies(Block& block, Reading& reading) {
  std::vector<int> indices;
  const Node* node = block.require("body", join(body_names(reading.scene)) + ", or a list of them");
  if (!node) return indices;
  const bool list = node->kind == Node::Kind::list;
  if (list && node->items.empty()) block.fail(*node, "an empty list measures nothing");
  std::vector<Node> resolved;
  for (const Node& item : list ? node->items : std::vector<Node>{*node}) {
    const int index = read_body_name(item, reading);
    if (index < 0) continue;
    if (std::find(indices.begin(), indices.end(), index) != indices.end())
      block.fail(item, quote(item.text) + " is listed twice");
    indices.push_back(index);
    resolved.push_back(string_node(item.text));
  }
  if (!resolved.empty()) block.record("body", list ? list_node(resolved) : resolved.front());
  return indices;
}

/// `region: {z_min: 8 mm, r_max: 3 mm}`.
void read_region(Block& parent, MeasureSelection& selection, Reading& reading) {
  const Node* node = parent.find("region");
  if (!node) return;
  Block block{bounds_block(), node, node->path, parent.place(), reading.problems};
  read_bounds(block, selection.region, reading);
  parent.record("region", block.finish());
}

/// Points of a piece two cells across, of the bodies the coarsest: less is not resolved.
int points_of_two_cells(const MeasureSelection& selection, const Scene& scene) {
  int least = 0;
  for (const int b : selection.bodies) {
    int points = 1;
    for (std::size_t d = 0; d < static_cast<std::size_t>(dimension(scene.frame)); ++d)
      points *= 2 * scene.bodies[static_cast<std::size_t>(b)].points.per_direction[d];
    least = least == 0 ? points : std::min(least, points);
  }
  return least;
}

void read_selection(Block& block, MeasureOptions& measure, Reading& reading) {
  const MeasureKindInfo& kind = info(measure.kind);
  MeasureSelection& selection = measure.selection;
  if (!kind.selects) return;
  selection.largest_piece =
      block.choice<bool>("piece", {{"all", false}, {"largest", true}}, kind.whole);
  const bool counts = measure.kind == MeasureKind::fragments;
  const int fallback = counts ? points_of_two_cells(selection, reading.scene) : 0;
  selection.least_points = block.integer("least_points", fallback);
  read_region(block, selection, reading);
}

bool takes(MeasureKind kind, std::string_view key) {
  const std::string keys = " " + std::string{info(kind).keys} + " ";
  return keys.find(" " + std::string{key} + " ") != std::string::npos;
}

void read_keys(Block& block, MeasureOptions& measure, Reading& reading) {
  const MeasureKind kind = measure.kind;
  if (takes(kind, "axis")) measure.axis = read_axis(block, reading);
  if (takes(kind, "direction")) read_direction(block, measure, reading);
  if (takes(kind, "turn") && reading.scene.frame == Frame::cartesian_3d)
    read_direction(block, measure, reading);
  if (takes(kind, "by")) read_partner(block, measure, reading);
  if (takes(kind, "at"))
    read_at(block.require("at", "{z: position} or {from_lower_end: distance}"), measure, block,
            reading);
  if (takes(kind, "field")) {
    std::vector<std::string> fields;
    for (const FieldName& field : known_fields()) fields.emplace_back(field.name);
    measure.field = required_word(block, "field", "field", fields, "the name of a field");
  }
  if (takes(kind, "target")) {
    const Node* node = block.require("target", "the body that is penetrated");
    if (node) measure.target = read_body_name(*node, reading);
    if (measure.target >= 0) block.record("target", string_node(node->text));
    const std::vector<int>& bodies = measure.selection.bodies;
    if (std::find(bodies.begin(), bodies.end(), measure.target) != bodies.end())
      block.fail("a body cannot penetrate itself: target must be another one");
  }
  if (takes(kind, "face")) read_face(block, measure, false, reading);
  if (takes(kind, "z_face")) read_face(block, measure, true, reading);
  if (takes(kind, "level")) measure.level = block.number("level", reading.scene.grid.cell);
  if (takes(kind, "within")) read_within(measure, block, reading);
  if (takes(kind, "mass_share")) read_mass_share(block, measure);
}

void read_when(Block& block, MeasureOptions& measure) {
  measure.keep = block.choice<Keep>(
      "keep", {{"now", Keep::now}, {"largest", Keep::largest}, {"smallest", Keep::smallest}},
      Keep::now);
  // An extreme needs every row anyway.
  measure.in_history =
      block.flag("history", info(measure.kind).in_history || measure.keep != Keep::now);
}

Node read_measure(const Node& node, Reading& reading) {
  MeasureOptions measure;
  measure.name = node.key;
  Block block{measure_block(), &node, node.path, node, reading.problems};
  measure.where = block.place().where();
  std::vector<std::string> names;
  for (const MeasureKindInfo& kind : measure_kinds()) names.emplace_back(kind.name);
  if (measure.name == "gauges") block.fail("the history keeps its gauges under this name");
  const std::string kind = required_word(block, "kind", "kind", names, join(names));
  if (kind.empty()) {
    reading.scene.measures.push_back(std::move(measure));  // references may name it
    return {};
  }
  for (const MeasureKindInfo& known : measure_kinds())
    if (kind == known.name) measure.kind = known.kind;
  if (info(measure.kind).round && reading.scene.frame == Frame::plane_strain)
    block.fail(kind +
               " is not defined in plane_strain, where a hole is a slot; use axisymmetric or 3d");
  if (info(measure.kind).turns && reading.scene.frame == Frame::axisymmetric)
    block.fail(kind +
               " is nothing about the axis of the axisymmetric frame; use plane_strain or 3d");
  measure.selection.bodies = read_bodies(block, reading);
  read_keys(block, measure, reading);
  read_selection(block, measure, reading);
  read_when(block, measure);
  Node resolved = block.finish();
  reading.scene.measures.push_back(std::move(measure));
  return resolved;
}

}  // namespace

Node read_measures(const Node* node, Reading& reading) {
  Node resolved;
  resolved.kind = Node::Kind::map;
  if (!node) return resolved;
  if (node->kind != Node::Kind::map) {
    reading.problems.add(node->file, node->line, node->path,
                         "expected a block of named measures, found " + node->kind_name());
    return resolved;
  }
  for (const Node& item : node->items) {
    check_name(item, reading.problems);
    add_member(resolved, item.key, read_measure(item, reading));
  }
  return resolved;
}

Node read_references(const Node* node, Reading& reading) {
  Block block{references_block(), node, "references", reading.root, reading.problems};
  for (MeasureOptions& measure : reading.scene.measures) {
    const Node* item = block.find(measure.name.c_str());
    if (!item) continue;
    Block reference{reference_block(), item, item->path, block.place(), reading.problems};
    ParameterInfo value = parameter_of(reference.info(), declared(reference.info(), "value"));
    value.unit = unit_of(measure);
    measure.reference = reference.number(value);
    if (reference.find("error")) {
      ParameterInfo error = parameter_of(reference.info(), declared(reference.info(), "error"));
      error.unit = unit_of(measure);
      measure.reference_error = reference.number(error);
    }
    measure.reference_source = reference.text("source", "");
    block.record(measure.name, reference.finish());
  }
  return block.finish();
}

}  // namespace krater::scene

namespace krater {

const char* unit_of(const MeasureOptions& measure) {
  const char* unit = info(measure.kind).unit;
  if (*unit != '\0') return unit;
  for (const scene::FieldName& field : scene::known_fields()) {
    if (measure.field == field.name) return field.unit;
  }
  return "1";
}

}  // namespace krater
