// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/yaml/tree.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>

#include "krater/core/errors.hpp"
#include "scene/yaml/problems.hpp"

namespace krater::scene {

namespace {

constexpr std::array<const char*, 2> kDamageSettings{"coupling", "degrade_pressure"};

/// Maps whose single member is a choice: naming another one replaces the first instead of joining
/// it.
bool is_choice(const std::string& key) {
  static const std::array<const char*, 11> choices{"eos",       "strength",  "damage",   "model",
                                                   "heating",   "shape",     "transfer", "path",
                                                   "reference", "stop_when", "filter"};
  static const std::array<const char*, 4> axes{"x_", "y_", "z_", "r_"};
  const bool side = key.size() == 5 && std::any_of(axes.begin(), axes.end(), [&](const char* axis) {
                      return key.compare(0, 2, axis) == 0;
                    });
  return side || std::find(choices.begin(), choices.end(), key) != choices.end();
}

/// `over` chooses another law, shape or scheme than `base`.
bool chooses_another(const Node& base, const Node& over) {
  const auto names = [&](const Node& map) {
    std::vector<std::string> keys;
    for (const Node& item : map.items)
      if (map.key != "damage" || !is_damage_setting(item.key)) keys.push_back(item.key);
    return keys;
  };
  if (!is_choice(over.key) || base.items.empty()) return false;
  const std::vector<std::string> chosen = names(over);
  return chosen.size() == 1 && !names(base).empty() && base.find(chosen.front()) == nullptr;
}

/// A direction is given one way: the other goes when it comes.
void drop_other_direction(Node& base, const Node& over) {
  if (base.find("speed") == nullptr) return;
  const auto drop = [&](const char* mine, const char* other) {
    if (over.find(mine))
      std::erase_if(base.items, [other](const Node& item) { return item.key == other; });
  };
  drop("angle", "towards");
  drop("towards", "angle");
}

void set_path(Node& node, const std::string& path) {
  node.path = path;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const std::string step = node.kind == Node::Kind::map ? node.items[i].key : std::to_string(i);
    set_path(node.items[i], path.empty() ? step : path + "." + step);
  }
}

void forget_lines(Node& node) {
  node.line = 0;
  for (Node& item : node.items) forget_lines(item);
}

bool is_plain(const std::string& text) {
  if (text.empty()) return false;
  const bool letters = std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
  static const std::array<const char*, 8> words{"null", "Null", "NULL",  "true",
                                                "True", "TRUE", "false", "none"};
  return letters && (text[0] < '0' || text[0] > '9') &&
         std::find(words.begin(), words.end(), text) == words.end();
}

std::string in_double_quotes(const std::string& text) {
  std::string out = "\"";
  for (char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (code < 0x20 || code == 0x7f) {
      std::array<char, 8> escape{};
      std::snprintf(escape.data(), escape.size(), "\\x%02x", static_cast<unsigned>(code));
      out += escape.data();
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string scalar_text(const Node& node) {
  if (node.kind == Node::Kind::null) return "~";
  return node.in_quotes ? in_double_quotes(node.text) : node.text;
}

std::string key_text(const std::string& key) { return is_plain(key) ? key : in_double_quotes(key); }

std::string flow_text(const Node& node) {
  if (node.kind != Node::Kind::list && node.kind != Node::Kind::map) return scalar_text(node);
  const bool map = node.kind == Node::Kind::map;
  std::string out = map ? "{" : "[";
  for (const Node& item : node.items) {
    if (out.size() > 1) out += ", ";
    if (map) out += key_text(item.key) + ": ";
    out += flow_text(item);
  }
  return out + (map ? "}" : "]");
}

void write_block(const Node& map, int indent, std::string& out) {
  for (const Node& member : map.items) {
    out.append(static_cast<std::size_t>(indent), ' ');
    out += key_text(member.key) + ":";
    if (member.kind == Node::Kind::map && !member.items.empty()) {
      out += "\n";
      write_block(member, indent + 2, out);
    } else {
      out += " " + flow_text(member) + "\n";
    }
  }
}

}  // namespace

bool is_damage_setting(std::string_view key) {
  return std::find(kDamageSettings.begin(), kDamageSettings.end(), key) != kDamageSettings.end();
}

const Node* Node::find(std::string_view name) const {
  if (kind != Kind::map) return nullptr;
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const Node& item) { return item.key == name; });
  return found == items.end() ? nullptr : &*found;
}

Node* Node::find(std::string_view name) {
  return const_cast<Node*>(static_cast<const Node*>(this)->find(name));
}

std::string Node::where() const { return describe_place(file, line, path); }

std::string Node::kind_name() const {
  switch (kind) {
    case Kind::null:
      return "nothing";
    case Kind::scalar:
      return quote(text);
    case Kind::list:
      return "a list";
    case Kind::map:
      return "a block of keys";
  }
  return "";
}

void overlay(Node& base, const Node& over) {
  // The word of the law that is there already changes nothing.
  if (is_choice(over.key) && over.kind == Node::Kind::scalar && base.find(over.text)) return;
  if (base.kind != Node::Kind::map || over.kind != Node::Kind::map || chooses_another(base, over)) {
    const std::string path = base.path;
    base = over;
    set_path(base, path);
    return;
  }
  if (over.line > 0) {  // --set has no line: a block it reaches into stays where it is
    base.file = over.file;
    base.line = over.line;
  }
  drop_other_direction(base, over);
  for (const Node& item : over.items) {
    if (Node* existing = base.find(item.key)) {
      overlay(*existing, item);
    } else {
      base.items.push_back(item);
      set_path(base.items.back(), base.path.empty() ? item.key : base.path + "." + item.key);
    }
  }
}

void apply_override(Node& root, const std::string& setting, Problems& problems) {
  const std::string origin = "--set " + setting;
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError(origin + ": expected path=value, for example --set \"grid.cell=0.2 mm\"");
  }
  const std::string path = setting.substr(0, equals);
  const std::string text = setting.substr(equals + 1);
  if (path.front() == '.' || path.back() == '.' || path.find("..") != std::string::npos) {
    throw InputError(origin + ": the path has an empty step");
  }
  Node value = parse_yaml(text, origin, path, problems);
  // Wrap the value in the maps of its path, innermost first, and lay that over the scene.
  std::size_t end = path.size();
  while (true) {
    const std::size_t dot = path.rfind('.', end - 1);
    const std::size_t start = dot == std::string::npos ? 0 : dot + 1;
    value.key = path.substr(start, end - start);
    Node parent;
    parent.kind = Node::Kind::map;
    parent.file = origin;
    parent.items.push_back(std::move(value));
    value = std::move(parent);
    if (dot == std::string::npos) break;
    end = dot;
  }
  set_path(value, "");
  forget_lines(value);
  overlay(root, value);
}

std::string to_yaml(const Node& root) {
  std::string out;
  write_block(root, 0, out);
  return out;
}

Node scalar_node(const std::string& text) {
  Node node;
  node.kind = Node::Kind::scalar;
  node.text = text;
  return node;
}

Node string_node(const std::string& text) {
  Node node = scalar_node(text);
  node.in_quotes = !is_plain(text);
  return node;
}

Node number_node(double value) { return scalar_node(number_text(value)); }

Node list_node(const std::vector<Node>& items) {
  Node node;
  node.kind = Node::Kind::list;
  node.items = items;
  return node;
}

Node& add_member(Node& map, const std::string& key, Node value) {
  map.kind = Node::Kind::map;
  value.key = key;
  map.items.push_back(std::move(value));
  return map.items.back();
}

std::string number_text(double value) {
  std::array<char, 40> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

}  // namespace krater::scene
