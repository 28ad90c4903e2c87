// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "scene/readers/readers.hpp"

namespace krater::scene {

namespace {

using When = StopOptions::When;

constexpr double kLooks = 200;  ///< over the run, unless told otherwise

/// A required body by its key.
int read_body(Block& block, const char* key, const std::string& hint, Reading& reading) {
  const Node* node = block.require(key, hint);
  const int body = node ? read_body_name(*node, reading) : -1;
  if (body >= 0) block.record(key, string_node(node->text));
  return body;
}

void check_pair(const OutcomeOptions& outcome, Block& block) {
  if (outcome.projectile >= 0 && outcome.projectile == outcome.target)
    block.fail("a body is not its own target");
}

/// One that `stop_when` needs: of the scene, or added to it.
int find_outcome(int projectile, int target, bool any_target, const Node& place, Reading& reading) {
  std::vector<OutcomeOptions>& all = reading.scene.outcomes;
  const auto known = std::find_if(all.begin(), all.end(), [&](const OutcomeOptions& o) {
    return o.projectile == projectile && (any_target || o.target == target);
  });
  if (known != all.end()) return static_cast<int>(known - all.begin());
  OutcomeOptions added;
  added.name = reading.scene.bodies[static_cast<std::size_t>(projectile)].name;
  while (std::any_of(all.begin(), all.end(),
                     [&](const OutcomeOptions& o) { return o.name == added.name; }))
    added.name += "_";
  added.where = place.where();
  added.projectile = projectile;
  added.target = target;
  added.every = reading.scene.time.end / kLooks;
  added.identity = "stop_when";
  all.push_back(added);
  return static_cast<int>(all.size()) - 1;
}

Node read_outcome(const Node& node, Reading& reading) {
  OutcomeOptions outcome;
  outcome.name = node.key;
  Block block{outcome_block(), &node, node.path, node, reading.problems};
  outcome.where = block.place().where();
  outcome.projectile = read_body(block, "projectile", "the body whose fate is asked", reading);
  outcome.target = read_body(block, "target", "the body that it meets", reading);
  check_pair(outcome, block);
  outcome.tolerance = block.number("tolerance");
  if (outcome.tolerance > 0.2) block.fail("a tolerance above 0.2 tells nothing");
  outcome.identity = node.key + " " + std::to_string(outcome.tolerance);
  for (const char* key : {"projectile", "target"})
    if (const Node* body = node.find(key)) outcome.identity += " " + body->text;
  outcome.every = block.number("every", reading.scene.time.end / kLooks);
  Node resolved = block.finish();
  if (outcome.projectile >= 0) reading.scene.outcomes.push_back(std::move(outcome));
  return resolved;
}

void read_perforated(const Node& node, StopOptions& stop, Reading& reading) {
  Block block{perforated_block(), &node, node.path, node, reading.problems};
  OutcomeOptions outcome;
  outcome.projectile = read_body(block, "projectile", "a body", reading);
  outcome.target = read_body(block, "target", "the body that it goes through", reading);
  check_pair(outcome, block);
  block.finish();
  if (reading.problems.any()) return;
  stop.outcome = find_outcome(outcome.projectile, outcome.target, false, node, reading);
  const auto name = [&](int b) { return reading.scene.bodies[static_cast<std::size_t>(b)].name; };
  stop.text = name(outcome.projectile) + " is through " + name(outcome.target);
}

}  // namespace

Node read_outcomes(const Node* node, Reading& reading) {
  Node resolved;
  resolved.kind = Node::Kind::map;
  if (!node) return resolved;
  if (node->kind != Node::Kind::map) {
    reading.problems.add(node->file, node->line, node->path,
                         "expected a block of named outcomes, found " + node->kind_name());
    return resolved;
  }
  for (const Node& item : node->items) {
    check_name(item, reading.problems);
    add_member(resolved, item.key, read_outcome(item, reading));
  }
  return resolved;
}

/// `{settled: BODY}`, `{perforated: {projectile: BODY, target: BODY}}`, `{energy: 2 %}` or an
/// expression of columns of the history.
void read_stop(const Node& node, Reading& reading) {
  StopOptions& stop = reading.scene.stop;
  stop.where = node.where();
  if (node.kind == Node::Kind::scalar) {
    stop.when = When::expression;
    stop.expression = stop.text = node.text;
    return;
  }
  const std::optional<Choice> choice = read_choice(node, "condition", reading.problems);
  if (!choice || !choice->value) return;
  if (choice->name == "settled") {
    stop.when = When::settled;
    const int body = read_body_name(*choice->value, reading);
    if (body < 0) return;
    stop.outcome = find_outcome(body, -1, true, node, reading);
    stop.text = choice->value->text + " has settled";
  } else if (choice->name == "perforated") {
    stop.when = When::perforated;
    read_perforated(*choice->value, stop, reading);
  } else if (choice->name == "energy") {
    stop.when = When::energy;
    if (const auto share = read_number(*choice->value, "1", Range::fraction, reading.problems))
      stop.share = *share;
    stop.text = "the kinetic energy is below " + choice->value->text + " of that at the start";
  } else {
    report_unknown(*choice->place, "condition", choice->name, {"settled", "perforated", "energy"},
                   reading.problems);
  }
}

}  // namespace krater::scene
