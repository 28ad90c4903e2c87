// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstddef>

#include "krater/core/errors.hpp"
#include "krater/scene/yaml/expression.hpp"
#include "krater/scene/yaml/units.hpp"
#include "scene/readers/readers.hpp"

namespace krater::scene {

namespace {

/// A component: a number, or the text of an expression.
struct Component {
  const Node* node = nullptr;
  double value = 0;
  std::string expression;
  bool zero() const { return expression.empty() && value == 0; }
};

using Components = std::vector<Component>;

std::optional<Components> read_components(const Node& node, const char* unit, bool expressions,
                                          Reading& reading) {
  Problems& problems = reading.problems;
  const bool wrong_size = node.items.size() != 2 && node.items.size() != 3;
  if (node.kind != Node::Kind::list || wrong_size) {
    std::string found = node.kind == Node::Kind::list
                            ? std::to_string(node.items.size()) + " components"
                            : node.kind_name();
    if (node.items.size() == 1 && node.items[0].text.find(';') != std::string::npos)
      found += ": commas part them, not semicolons";
    problems.add(node.file, node.line, node.path,
                 "expected a vector, [radial or x, axial z] or [x, y, z], found " + found);
    return std::nullopt;
  }
  Components components;
  bool good = true;
  for (const Node& item : node.items) {
    Component component;
    component.node = &item;
    const bool is_expression =
        expressions && item.kind == Node::Kind::scalar && !looks_like_quantity(item.text);
    if (is_expression && !parse_quantity(item.text, unit).problem.empty() && !item.text.empty()) {
      component.expression = item.text;
    } else if (const auto value = read_number(item, unit, Range::any, problems)) {
      component.value = *value;
    } else {
      good = false;
    }
    components.push_back(component);
  }
  if (!good) return std::nullopt;
  return components;
}

void refuse(const Component& component, const std::string& message, Problems& problems) {
  problems.add(component.node->file, component.node->line, component.node->path, message);
}

/// Two or three components as one per grid axis.
std::optional<Components> along_grid_axes(const Components& given, Reading& reading) {
  const Frame frame = reading.scene.frame;
  const int dim = dimension(frame);
  if (dim == 2 && given.size() == 2) return given;
  if (dim == 3 && given.size() == 3) return given;
  if (dim == 3) {
    if (given[0].zero()) return Components{given[0], given[0], given[1]};
    refuse(
        given[0],
        "in 3d the first of two components must be 0, for it could mean x as well as r; give three "
        "components",
        reading.problems);
    return std::nullopt;
  }
  const std::string section = "must be 0 where the frame is " + std::string{name(frame)};
  if (!given[1].zero()) {
    refuse(given[1], section + "; three components are (x, y, z); a decimal comma makes two of one",
           reading.problems);
    return std::nullopt;
  }
  if (frame == Frame::axisymmetric && !given[0].zero()) {
    refuse(given[0], section + " and the vector is (x, y, z)", reading.problems);
    return std::nullopt;
  }
  return Components{given[0], given[2]};
}

Triple values_of(const Components& components) {
  Triple result{};
  for (std::size_t k = 0; k < components.size(); ++k) result[k] = components[k].value;
  return result;
}

}  // namespace

std::optional<Triple> read_vector(const Node& node, const char* unit, Reading& reading) {
  const auto given = read_components(node, unit, false, reading);
  if (!given) return std::nullopt;
  const auto components = along_grid_axes(*given, reading);
  if (!components) return std::nullopt;
  return values_of(*components);
}

std::optional<Triple> read_position(const Node& node, Reading& reading) {
  const auto given = read_components(node, "m", false, reading);
  if (!given) return std::nullopt;
  const Triple values = values_of(*given);
  if (given->size() == 3) return values;
  return Triple{values[0], 0.0, values[1]};
}

std::optional<Triple> read_place(const Node& node, Reading& reading) {
  const auto space = read_position(node, reading);
  if (!space) return std::nullopt;
  Triple grid{};
  for (int a = 0; a < dimension(reading.scene.frame); ++a)
    grid[static_cast<std::size_t>(a)] =
        (*space)[static_cast<std::size_t>(tensor_axis(reading.scene.frame, a))];
  return grid;
}

std::optional<ReadField> read_field(const Node& node, const char* unit, Reading& reading) {
  const auto given = read_components(node, unit, true, reading);
  if (!given) return std::nullopt;
  const auto components = along_grid_axes(*given, reading);
  if (!components) return std::nullopt;
  ReadField result;
  bool any_expression = false;
  bool any_value = false;
  std::vector<std::string> texts;
  std::vector<Node> resolved;
  for (const Component& component : *components) {
    const bool expression = !component.expression.empty();
    any_expression = any_expression || expression;
    any_value = any_value || !component.zero();
    texts.push_back(expression ? component.expression : number_text(component.value));
    resolved.push_back(expression ? string_node(texts.back()) : number_node(component.value));
  }
  result.resolved = list_node(resolved);
  result.expression = any_expression;
  if (any_expression) {
    try {
      result.field = make_expression_field(reading.scene.frame, texts);
    } catch (const InputError& error) {
      reading.problems.add(node.file, node.line, node.path, error.what());
      return std::nullopt;
    }
  } else if (any_value) {
    result.field = make_constant_field(values_of(*components));
  }
  return result;
}

Node vector_node(Frame frame, const Triple& value) {
  std::vector<Node> items;
  for (int k = 0; k < dimension(frame); ++k)
    items.push_back(number_node(value[static_cast<std::size_t>(k)]));
  return list_node(items);
}

std::optional<Box> read_corners(Block& block, Reading& reading) {
  std::optional<Triple> low, high;
  const Node* min = block.require("min", "[r or x, z] or [x, y, z]");
  const Node* max = block.require("max", "[r or x, z] or [x, y, z]");
  if (min) low = read_position(*min, reading);
  if (max) high = read_position(*max, reading);
  if (!low || !high) return {};
  Box box{};
  const int dim = dimension(reading.scene.frame);
  if (dim == 3) {
    if (max->items.size() == 2) {
      (*high)[1] = (*high)[0];
      (*low)[0] = (*low)[1] = -(*high)[0];
    }
    box = {*low, *high};
  } else {
    box = {{(*low)[0], (*low)[2], 0}, {(*high)[0], (*high)[2], 0}};
  }
  for (int a = 0; a < dim; ++a)
    if (!(box.length(a) > 0)) block.fail("max must lie beyond min along every axis");
  return box;
}

}  // namespace krater::scene
