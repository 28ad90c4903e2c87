// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <string_view>

#include "scene/readers/readers.hpp"

namespace krater::scene {

namespace {

constexpr double kSamples = 1000;  // over the run, unless told otherwise

/// `at: [0, 3 mm]`, or a line `from`, `to`, `count`.
void read_places(Block& block, GaugeOptions& gauge, Reading& reading) {
  const Node *at = block.find("at"), *from = block.find("from"), *to = block.find("to");
  if (at ? from || to || block.find("count") : !(from && to))
    return block.fail("expected at: [r or x, z], or a line from: [...], to: [...], count: 5");
  if (at) {
    if (const auto place = read_place(*at, reading)) gauge.at.push_back(*place);
    block.record("at", *at);
    return;
  }
  const int count = block.integer("count", 2);
  const auto first = read_place(*from, reading), last = read_place(*to, reading);
  block.record("from", *from);
  block.record("to", *to);
  for (int i = 0; first && last && i < count; ++i) {
    Triple x{};
    for (std::size_t a = 0; a < 3; ++a)
      x[a] = (*first)[a] + ((*last)[a] - (*first)[a]) * i / (count - 1);
    gauge.at.push_back(x);
  }
}

void read_fields(Block& block, GaugeOptions& gauge, Reading& reading) {
  const Node* node = block.require("fields", "for example [velocity_z, pressure]");
  if (!node) return;
  if (node->kind != Node::Kind::list || node->items.empty())
    return block.fail(*node, "expected a list of fields, as [velocity_z, pressure]");
  for (const Node& item : node->items)
    if (const auto word = read_word(item, reading.problems)) gauge.fields.push_back(*word);
  block.record("fields", *node);
}

/// `measures: [push, push_rate]`: of the scene's measures block.
void read_measured(const Node& node, GaugeOptions& gauge, Reading& reading) {
  constexpr std::string_view kRate = "_rate";
  const std::vector<MeasureOptions>& measures = reading.scene.measures;
  if (node.kind != Node::Kind::list || node.items.empty())
    return reading.problems.add(node.file, node.line, node.path,
                                "expected a list of the scene's measures, as [push, depth_rate]");
  std::vector<std::string> known;
  for (const MeasureOptions& m : measures) known.push_back(m.name);
  for (const Node& item : node.items) {
    const auto word = read_word(item, reading.problems);
    if (!word) continue;
    const auto find = [&](std::string_view name) {
      return std::find_if(measures.begin(), measures.end(),
                          [&](const MeasureOptions& m) { return m.name == name; });
    };
    auto at = find(*word);
    const bool rate = at == measures.end() && word->ends_with(kRate);
    if (rate) at = find(std::string_view{*word}.substr(0, word->size() - kRate.size()));
    const auto complain = [&](const std::string& text) {
      reading.problems.add(item.file, item.line, item.path, text);
    };
    if (at == measures.end()) {
      report_unknown(item, "measure", *word, known, reading.problems);
    } else if (at->kind == MeasureKind::settling_time) {
      complain(at->name + " looks at the whole history: no gauge can record it");
    } else if (rate && (at->kind == MeasureKind::force || at->kind == MeasureKind::deceleration)) {
      complain(at->name + " is a rate already: record it without _rate");
    }
    gauge.fields.push_back(*word);
    gauge.measures.push_back(static_cast<int>(at - measures.begin()));
  }
}

/// `{butterworth: 1 MHz}`, `{cfc: 1000}` or `{moving_mean: 2 us}`.
void read_filter(const Node& node, GaugeOptions& gauge, Reading& reading) {
  const std::optional<Choice> choice = read_choice(node, "filter", reading.problems);
  if (!choice) return;
  const bool mean = choice->name == "moving_mean", cfc = choice->name == "cfc";
  if (!mean && !cfc && choice->name != "butterworth")
    return report_unknown(*choice->place, "filter", choice->name,
                          {"butterworth", "cfc", "moving_mean"}, reading.problems);
  if (!choice->value)
    return reading.problems.add(node.file, node.line, node.path,
                                "expected {butterworth: 1 MHz}, "
                                "{cfc: 1000} or {moving_mean: 2 us}");
  const auto value = read_number(*choice->value,
                                 mean  ? "s"
                                 : cfc ? "1"
                                       : "Hz",
                                 Range::positive, reading.problems);
  if (!value) return;
  gauge.filter = mean ? GaugeFilter::moving_mean : GaugeFilter::butterworth;
  constexpr double kClass = 5.0 / 3;  // SAE J211: -3 dB at 5/3 of the channel's class
  gauge.frequency = mean ? 1 / *value : cfc ? kClass * *value : *value;
  gauge.filter_name = choice->name + " " + choice->value->text;
  const double most = 0.25 / gauge.every;
  if (gauge.every > 0 && gauge.frequency > most)
    reading.problems.add(node.file, node.line, node.path,
                         "its frequency, " + number_text(gauge.frequency) +
                             " Hz, needs four samples a period: use every: " +
                             number_text(0.25 / gauge.frequency) + " or less");
}

void read_points(Block& block, GaugeOptions& gauge, Reading& reading) {
  const Node* body = block.require("body", "the body whose points it reads; or measures: [...]");
  if (body) {
    gauge.body = read_body_name(*body, reading);
    block.record("body", *body);
  }
  gauge.fixed = block.flag("fixed", false);
  if (const Node* section = block.find("section")) {
    gauge.normal = read_direction(*section, reading);
    block.record("section", *section);
  }
  read_places(block, gauge, reading);
  read_fields(block, gauge, reading);
}

Node read_gauge(const Node& node, Reading& reading) {
  GaugeOptions gauge;
  gauge.name = node.key;
  Block block{gauge_block(), &node, node.path, node, reading.problems};
  gauge.where = block.place().where();
  if (const Node* measures = block.find("measures")) {
    read_measured(*measures, gauge, reading);
    block.record("measures", *measures);
  } else {
    read_points(block, gauge, reading);
  }
  gauge.every = block.number("every", reading.scene.time.end / kSamples);
  if (const Node* filter = block.find("filter")) {
    read_filter(*filter, gauge, reading);
    block.record("filter", *filter);
  }
  Node resolved = block.finish();
  reading.scene.gauges.push_back(std::move(gauge));
  return resolved;
}

}  // namespace

Node read_gauges(const Node* node, Reading& reading) {
  Node resolved;
  resolved.kind = Node::Kind::map;
  if (node && node->kind != Node::Kind::map)
    reading.problems.add(node->file, node->line, node->path,
                         "expected a block of named gauges, found " + node->kind_name());
  if (!node || node->kind != Node::Kind::map) return resolved;
  for (const Node& item : node->items) {
    check_name(item, reading.problems);
    add_member(resolved, item.key, read_gauge(item, reading));
  }
  return resolved;
}

}  // namespace krater::scene
