// SPDX-License-Identifier: GPL-3.0-or-later
// grid.refine: where cells are finer.
#include <algorithm>
#include <cmath>

#include "krater/grid/levels.hpp"
#include "scene/readers/readers.hpp"

namespace krater::scene {

namespace {

constexpr const char* kExample =
    "a list of rules such as {region: {box: {min: [0, 0], max: [8 mm, 4 mm]}}, level: 1} or "
    "{follow: BODY, margin: 3 mm, level: 2} or {where: {field: plastic_strain, above: 0.1}}";

/// A box of the section, or any shape.
void read_region(const Node& node, RefineOptions& rule, Reading& reading) {
  if (const Node* box = node.find("box")) {
    Block block{corners_block(), box, box->path, *box, reading.problems};
    rule.box = read_corners(block, reading);
    block.finish();
    return;
  }
  rule.region = read_solid(node, reading).solid;
}

Node read_where(const Node& node, RefineOptions& rule, Reading& reading) {
  Block block{refine_where_block(), &node, node.path, node, reading.problems};
  const Node* field = block.require("field", "a scalar of the points, as plastic_strain");
  if (field == nullptr) return block.finish();
  if (const auto name = read_word(*field, reading.problems)) rule.field = *name;
  const std::vector<FieldName>& known = known_fields();
  const auto at = std::find_if(known.begin(), known.end(),
                               [&rule](const FieldName& f) { return rule.field == f.name; });
  std::vector<std::string> names;
  for (const FieldName& f : known) names.emplace_back(f.name);
  if (at == known.end()) {
    report_unknown(*field, "field", rule.field, names, reading.problems);
    block.find("above");
    return block.finish();
  }
  block.record("field", string_node(rule.field));
  ParameterInfo above = parameter_of(block.info(), declared(block.info(), "above"));
  above.unit = at->unit;
  rule.above = block.number(above);
  return block.finish();
}

RefineOptions read_rule(const Node& node, Reading& reading, Node& resolved) {
  Block block{refine_block(), &node, node.path, node, reading.problems};
  RefineOptions rule;
  rule.where = block.place().where();
  rule.level = block.integer("level", 1);
  const Node* region = block.find("region");
  const Node* follow = block.find("follow");
  const Node* where = block.find("where");
  if ((region != nullptr) + (follow != nullptr) + (where != nullptr) != 1) {
    block.fail("expected one of region, follow and where: " + std::string{kExample});
    if (follow != nullptr) block.find("margin");
  } else if (where != nullptr) {
    block.record("where", read_where(*where, rule, reading));
  } else if (region != nullptr) {
    read_region(*region, rule, reading);
    block.record("region", *region);
  } else {
    if (const auto name = read_word(*follow, reading.problems)) rule.follow_name = *name;
    block.record("follow", string_node(rule.follow_name));
    rule.margin = block.number("margin");
  }
  resolved = block.finish();
  return rule;
}

void refuse(const RefineOptions& rule, const std::string& message, Reading& reading) {
  const Node* grid = reading.root.find("grid");
  const Node* list = grid != nullptr ? grid->find("refine") : nullptr;
  const auto index = static_cast<std::size_t>(&rule - reading.scene.grid.refine.data());
  const Node& at =
      list != nullptr && index < list->items.size() ? list->items[index] : reading.root;
  reading.problems.add(at.file, at.line, "grid.refine", message);
}

/// What the methods of a scene would have to know of levels, and do not.
std::string what_is_not_ready(const Scene& scene) {
  const MethodOptions& m = scene.method;
  if (m.shape != Shape::quadratic_bspline)
    return "finer cells need method.shape: quadratic_bspline: only its functions nest";
  if (m.reference != Reference::current)
    return "finer cells need method.reference: current; points of a fixed reference never leave "
           "their cells, so that method.points_per_direction refines there";
  if (m.transfer == Transfer::xpic)
    return "finer cells need method.transfer: tflip, flip or apic; the filter of xpic knows one "
           "level";
  if (scene.contact.active && scene.contact.normal == ContactNormal::logistic_regression)
    return "finer cells need contact.normal: volume_gradient";
  for (const FaceLoad& load : scene.loads.faces)
    if (load.kind == FaceLoad::Kind::velocity)
      return "finer cells do not go with loads that drive a face by its velocity; use a rigid body "
             "or a side of the domain with a velocity";
  for (const BodyOptions& body : scene.bodies) {
    if (!body.material_points())
      return "finer cells are for bodies of material points; body " + quote(body.name) +
             " is none: its own mesh or spacing is what refines it";
    for (int a = 0; a < dimension(scene.frame); ++a)
      if (body.points.per_direction[static_cast<std::size_t>(a)] % 2 != 0)
        return "finer cells need an even number of points per direction, for one in the middle of "
               "a cell lies on the edge of finer ones; bodies." +
               body.name + " has " +
               std::to_string(body.points.per_direction[static_cast<std::size_t>(a)]);
  }
  return "";
}

}  // namespace

void read_refine(Block& grid, Reading& reading) {
  const Node* list = grid.find_block("refine");
  if (list != nullptr || grid.find("merge") != nullptr)
    reading.scene.grid.merge = grid.flag("merge", false);
  if (list == nullptr) return;
  if (list->kind != Node::Kind::list) {
    grid.fail(*list, std::string{"expected "} + kExample);
    return;
  }
  std::vector<Node> resolved(list->items.size());
  for (std::size_t i = 0; i < list->items.size(); ++i)
    reading.scene.grid.refine.push_back(read_rule(list->items[i], reading, resolved[i]));
  grid.record("refine", list_node(resolved));
}

/// Rules that lie in one another count once each for what they add to the rule around them.
double points_of_levels(const BodyOptions& body, const Scene& scene, double per_cell) {
  const int dim = dimension(scene.frame);
  const Box domain{scene.grid.min, scene.grid.max};
  const auto factor = [dim](int level) { return std::pow(2.0, dim * level); };
  const auto box_of_rule = [&](const RefineOptions& rule) {
    Box box = domain;
    if (rule.box) box = intersection(box, *rule.box, dim);
    if (rule.region) box = intersection(box, rule.region->extent(scene.frame), dim);
    return box;
  };
  double points = 0;
  for (const RefineOptions& rule : scene.grid.refine) {
    const bool follows = !rule.follow_name.empty();
    if (!rule.field.empty() || (follows && rule.follow_name != body.name)) continue;
    const Box box = box_of_rule(rule);
    if (is_empty(box, dim)) continue;
    int around = 0;
    for (const RefineOptions& other : scene.grid.refine)
      if ((other.box || other.region) && other.level < rule.level && !follows) {
        const Box common = intersection(box_of_rule(other), box, dim);
        if (common.min == box.min && common.max == box.max) around = std::max(around, other.level);
      }
    points += (factor(rule.level) - factor(around)) * per_cell *
              body.solid->part(scene.frame, box).section / std::pow(scene.grid.cell, dim);
  }
  return points;
}

void check_refine(Reading& reading) {
  Scene& scene = reading.scene;
  if (scene.grid.merge && scene.grid.refine.empty() &&
      scene.method.numerical_fracture != NumericalFracture::split) {
    const Node& merge = *reading.root.find("grid")->find("merge");
    reading.problems.add(merge.file, merge.line, "grid.merge",
                         "more points than cells need come from finer ones (grid.refine) or from "
                         "method.numerical_fracture: split, and neither is given");
  }
  if (scene.grid.refine.empty()) return;
  if (const std::string text = what_is_not_ready(scene); !text.empty())
    refuse(scene.grid.refine.front(), text, reading);
  const Box domain{scene.grid.min, scene.grid.max};
  const int dim = dimension(scene.frame);
  for (RefineOptions& rule : scene.grid.refine) {
    const std::optional<Box> extent =
        rule.region ? std::optional{rule.region->extent(scene.frame)} : rule.box;
    if (extent && is_empty(intersection(*extent, domain, dim), dim))
      refuse(rule, "the region lies outside the domain (grid.box)", reading);
    if (rule.follow_name.empty()) continue;
    std::vector<std::string> names;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
      names.push_back(scene.bodies[b].name);
      if (names.back() == rule.follow_name) rule.follow = static_cast<int>(b);
    }
    if (rule.follow < 0)
      refuse(rule, "follow: there is no body " + quote(rule.follow_name), reading);
  }
}

}  // namespace krater::scene
