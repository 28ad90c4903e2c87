// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "scene/readers.hpp"

namespace krater::scene {

namespace {

constexpr ParameterInfo kFromLowerEnd{
    "from_lower_end", "m", Range::non_negative, kRequired,
    "distance from the body's lower end at the time of measuring"};

const Words<MeasureKind>& kinds() {
  static const Words<MeasureKind> words{{"extent", MeasureKind::extent},
                                        {"max", MeasureKind::max},
                                        {"min", MeasureKind::min},
                                        {"diameter", MeasureKind::diameter},
                                        {"mean_velocity", MeasureKind::mean_velocity},
                                        {"mean", MeasureKind::mean},
                                        {"maximum", MeasureKind::maximum}};
  return words;
}

bool needs_field(MeasureKind kind) {
  return kind == MeasureKind::mean || kind == MeasureKind::maximum;
}

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
  Block block{node, node->path, parent.place(), reading.problems};
  const ParameterInfo height{"z", "m", Range::any, kRequired, "position on the z axis"};
  const std::optional<double> z = block.optional_number(height);
  const std::optional<double> above = block.optional_number(kFromLowerEnd);
  if (!node->find("z") == !node->find("from_lower_end")) {
    block.fail("expected one of {z: ...} and {from_lower_end: ...}");
  }
  measure.at = z.value_or(above.value_or(0.0));
  measure.at_from_end = above.has_value();
  block.record(above ? kFromLowerEnd.key : height.key, number_node(measure.at));
  parent.record("at", block.finish());
}

int read_axis(Block& block, Reading& reading) {
  const Frame frame = reading.scene.frame;
  std::vector<std::string> axes;
  for (int axis = 0; axis < dimension(frame); ++axis) axes.emplace_back(axis_name(frame, axis));
  const Node* node = block.require("axis", "one of " + join(axes));
  if (!node) return -1;
  std::optional<std::string> word = read_word(*node, reading.problems);
  if (!word) return -1;
  // In the half section the first axis is called r or x, so that one scene serves both 2D frames.
  const bool first = *word == "x" || *word == "r";
  const std::optional<int> axis = dimension(frame) == 2 && first ? 0 : axis_from_name(frame, *word);
  if (!axis) {
    report_unknown(*node, "axis", *word, axes, reading.problems);
    return -1;
  }
  block.record("axis", string_node(std::string{axis_name(frame, *axis)}));
  return *axis;
}

Node read_measure(const Node& node, Reading& reading) {
  MeasureOptions measure;
  measure.name = node.key;
  Block block{&node, node.path, node, reading.problems};
  measure.where = block.place().where();
  std::vector<std::string> names;
  for (const auto& [name, kind] : kinds()) names.emplace_back(name);
  const std::string kind = required_word(block, "kind", "kind", names, join(names));
  for (const auto& [name, value] : kinds()) {
    if (kind == name) measure.kind = value;
  }
  std::vector<std::string> bodies;
  for (const BodyOptions& body : reading.scene.bodies) bodies.push_back(body.name);
  const std::string body = required_word(block, "body", "body", bodies, join(bodies));
  const auto found = std::find(bodies.begin(), bodies.end(), body);
  if (found != bodies.end()) measure.body = static_cast<int>(found - bodies.begin());
  if (kind == "diameter") {
    read_at(block.require("at", "{z: position} or {from_lower_end: distance}"), measure, block,
            reading);
  } else if (needs_field(measure.kind)) {
    std::vector<std::string> fields;
    for (const FieldName& field : known_fields()) fields.emplace_back(field.name);
    measure.field = required_word(block, "field", "field", fields, "the name of a field");
  } else if (!kind.empty()) {
    measure.axis = read_axis(block, reading);
  }
  Node resolved = kind.empty() ? Node{} : block.finish();
  reading.scene.measures.push_back(std::move(measure));
  return resolved;
}

const char* unit_of(const MeasureOptions& measure) {
  if (measure.kind == MeasureKind::mean_velocity) return "m/s";
  if (!needs_field(measure.kind)) return "m";
  for (const FieldName& field : known_fields()) {
    if (measure.field == field.name) return field.unit;
  }
  return "1";
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
    if (check_name(item, reading.problems))
      add_member(resolved, item.key, read_measure(item, reading));
  }
  return resolved;
}

Node read_references(const Node* node, Reading& reading) {
  Block block{node, "references", reading.root, reading.problems};
  for (MeasureOptions& measure : reading.scene.measures) {
    const Node* item = block.find(measure.name.c_str());
    if (!item) continue;
    Block reference{item, item->path, block.place(), reading.problems};
    const ParameterInfo value{"value", unit_of(measure), Range::any, kRequired,
                              "what the measure should be"};
    measure.reference = reference.number(value);
    measure.reference_source = reference.text("source", "");
    block.record(measure.name, reference.finish());
  }
  return block.finish();
}

}  // namespace krater::scene
