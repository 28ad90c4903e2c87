// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/readers/read_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "krater/core/errors.hpp"
#include "krater/scene/yaml/expression.hpp"
#include "krater/scene/yaml/units.hpp"

namespace krater {

namespace {

constexpr std::array<const char*, 10> kPathNames{
    "uniaxial_stress", "uniaxial_strain", "simple_shear",      "triaxial", "hydrostatic",
    "biaxial",         "stretch",         "velocity_gradient", "hugoniot", "release_isentrope"};
constexpr std::array<PathKind, 10> kPathKinds{
    PathKind::uniaxial_stress,  PathKind::uniaxial_strain,   PathKind::simple_shear,
    PathKind::triaxial,         PathKind::hydrostatic,       PathKind::biaxial,
    PathKind::stretch,          PathKind::velocity_gradient, PathKind::hugoniot,
    PathKind::release_isentrope};

}  // namespace

const char* name(PathKind kind) {
  const auto at = std::find(kPathKinds.begin(), kPathKinds.end(), kind) - kPathKinds.begin();
  return kPathNames.at(static_cast<std::size_t>(at));
}

namespace scene {

namespace {

struct PathReader {
  Block& block;
  Reading& reading;
  PathOptions& path;

  void fail(const Node& at, const std::string& message) {
    reading.problems.add(at.file, at.line, at.path, message);
  }

  /// `0.5`, `[0.5, 0, 0.7]` or `{from: a, to: b, count: n}`.
  std::vector<double> numbers(const Node& node, const char* unit, Range range) {
    std::vector<double> values;
    if (node.kind == Node::Kind::map) {
      values = evenly_spaced(node, unit, range);
    } else if (node.kind == Node::Kind::list) {
      for (const Node& item : node.items)
        if (const auto value = read_number(item, unit, range, reading.problems))
          values.push_back(*value);
      if (node.items.empty()) fail(node, "the list is empty");
    } else if (const auto value = read_number(node, unit, range, reading.problems)) {
      values.push_back(*value);
    }
    return values;
  }

  std::vector<double> evenly_spaced(const Node& node, const char* unit, Range range) {
    Block even{even_block(), &node, node.path, node, reading.problems};
    ParameterInfo from = parameter_of(even.info(), declared(even.info(), "from")),
                  to = parameter_of(even.info(), declared(even.info(), "to"));
    from.unit = to.unit = unit;
    from.range = to.range = range;
    const double a = even.number(from), b = even.number(to);
    const int count = even.integer("count", 21);
    even.finish();
    std::vector<double> values;
    for (int i = 0; i < count; ++i) values.push_back(a + (b - a) * i / (count - 1));
    return values;
  }

  void record(const char* key, const std::vector<double>& values) {
    std::vector<Node> items;
    for (const double v : values) items.push_back(number_node(v));
    block.record(key, values.size() == 1 ? items.front() : list_node(items));
  }

  /// Strain or shear, a number or the values at which the path turns round, and its rate.
  void turns(const char* key, const char* unit = "1") {
    if (const Node* node = block.require(key, "a number, or a list of where the path turns")) {
      path.turns = numbers(*node, unit, Range::any);
      double before = 0;
      for (const double turn : path.turns) {
        if (turn == before) fail(*node, "two turns of the path are the same (it starts at 0)");
        before = turn;
      }
      record(key, path.turns);
    }
    path.rate = block.number("rate");
  }

  /// `compression: [0.1, 0.05]` (rho/rho0 - 1) or `pressure: [100 MPa, 0]`.
  void hydrostatic() {
    path.by_pressure = block.find("pressure") != nullptr;
    if (path.by_pressure == (block.find("compression") != nullptr)) {
      block.fail("give one of compression (rho/rho0 - 1) and pressure");
      return;
    }
    turns(path.by_pressure ? "pressure" : "compression", path.by_pressure ? "Pa" : "1");
    if (path.by_pressure) return;
    for (const double mu : path.turns)
      if (!(mu > -1)) block.fail("compression is rho/rho0 - 1: it must exceed -1");
  }

  void biaxial() {
    turns("strain");
    path.lateral_stress = block.optional_number("lateral_stress");
    if (path.lateral_stress) block.record("lateral_stress", number_node(*path.lateral_stress));
  }

  void triaxial() {
    path.lateral_stress = block.optional_number("lateral_stress");
    path.triaxiality = block.optional_number("triaxiality");
    if (path.lateral_stress.has_value() == path.triaxiality.has_value())
      block.fail("give one of lateral_stress and triaxiality");
    if (path.lateral_stress) block.record("lateral_stress", number_node(*path.lateral_stress));
    if (path.triaxiality) block.record("triaxiality", number_node(*path.triaxiality));
  }

  /// Behind the shock: particle speeds or densities; one of them for a release.
  void shocked(bool one) {
    const Node* speeds = block.find("particle_speed");
    const Node* densities = block.find("density");
    if ((speeds == nullptr) == (densities == nullptr)) {
      block.fail("give one of particle_speed and density of the shocked state");
      return;
    }
    if (speeds) path.particle_speeds = numbers(*speeds, "m/s", Range::non_negative);
    if (densities) path.densities = numbers(*densities, "kg/m^3", Range::positive);
    const std::vector<double>& values = speeds ? path.particle_speeds : path.densities;
    if (one && values.size() > 1) fail(speeds ? *speeds : *densities, "must be one value");
    if (!values.empty()) record(speeds ? "particle_speed" : "density", values);
  }

  /// A number with a unit, or an expression in t.
  TimeFunction component(const Node& item, const char* unit, Node& resolved) {
    const bool expression =
        item.kind == Node::Kind::scalar && !item.text.empty() && !looks_like_quantity(item.text);
    if (!expression) {
      const double value = read_number(item, unit, Range::any, reading.problems).value_or(0);
      resolved = number_node(value);
      return [value](double) { return value; };
    }
    resolved = string_node(item.text);
    try {
      return make_time_function(item.text);
    } catch (const InputError& error) {
      fail(item, error.what());
      return [](double) { return 0.0; };
    }
  }

  /// Three rows of three, or the three components of the diagonal.
  void tensor(const char* key, const char* unit) {
    const Node* node = block.require(key, "three rows of three components, or the diagonal");
    if (!node) return;
    if (node->kind != Node::Kind::list || node->items.size() != 3) {
      fail(*node, "expected three rows of three components, or the diagonal");
      return;
    }
    std::vector<Node> rows;
    for (std::size_t i = 0; i < 3; ++i) {
      const Node& row = node->items[i];
      std::vector<Node> items(3, number_node(0));
      if (row.kind == Node::Kind::list && row.items.size() != 3) fail(row, "expected 3 components");
      for (std::size_t k = 0; k < 3; ++k) {
        if (row.kind == Node::Kind::list && row.items.size() == 3)
          path.tensor.push_back(component(row.items[k], unit, items[k]));
        else if (row.kind != Node::Kind::list && k == i)
          path.tensor.push_back(component(row, unit, items[k]));
        else
          path.tensor.push_back([](double) { return 0.0; });
      }
      rows.push_back(list_node(items));
    }
    block.record(key, list_node(rows));
    path.time = block.number("time");
  }

  /// A point starts undeformed.
  void stretch() {
    tensor("F", "1");
    if (reading.problems.any() || path.tensor.size() != 9) return;
    for (std::size_t k = 0; k < 9; ++k) {
      const double start = path.tensor[k](0), identity = k % 4 == 0 ? 1 : 0;
      if (!(std::fabs(start - identity) < 1e-12)) {
        block.fail("F must be the identity at t = 0; component " + std::to_string(k / 3 + 1) +
                   std::to_string(k % 3 + 1) + " is " + number_text(start));
        return;
      }
    }
  }

  void release() {
    shocked(true);
    path.pressure = block.number("pressure");
    path.rate = block.number("rate");
  }

  void read() {
    switch (path.kind) {
      case PathKind::uniaxial_stress:
      case PathKind::uniaxial_strain:
        return turns("strain");
      case PathKind::simple_shear:
        return turns("shear");
      case PathKind::triaxial:
        turns("strain");
        return triaxial();
      case PathKind::hydrostatic:
        return hydrostatic();
      case PathKind::biaxial:
        return biaxial();
      case PathKind::velocity_gradient:
        return tensor("L", "s^-1");
      case PathKind::stretch:
        return stretch();
      case PathKind::hugoniot:
        return shocked(false);
      case PathKind::release_isentrope:
        return release();
    }
  }
};

}  // namespace

Node read_path(const Node& node, PathOptions& path, Reading& reading) {
  Node resolved;
  const std::optional<Choice> chosen = read_choice(node, "path", reading.problems);
  if (!chosen) return resolved;
  const auto found = std::find(kPathNames.begin(), kPathNames.end(), chosen->name);
  if (found == kPathNames.end()) {
    Node place = *chosen->place;
    place.path = node.path;
    report_unknown(place, "path", chosen->name, {kPathNames.begin(), kPathNames.end()},
                   reading.problems);
    return resolved;
  }
  path.kind = kPathKinds.at(static_cast<std::size_t>(found - kPathNames.begin()));
  Block block{member(path_block(), chosen->name), chosen->value, node.path + "." + chosen->name,
              node, reading.problems};
  path.where = block.place().where();
  PathReader{block, reading, path}.read();
  add_member(resolved, chosen->name, block.finish());
  return resolved;
}

}  // namespace scene

}  // namespace krater
