// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/yaml/tree.hpp
/// A YAML document as our own tree: every node knows its file, line and path, keys are unique, and
/// trees can be laid over one another (a scene over a material card, `--set` over the scene). Only
/// tree_parse.cpp knows yaml-cpp.
#include <string>
#include <string_view>
#include <vector>

namespace krater::scene {

class Problems;

struct Node {
  enum class Kind { null, scalar, list, map };

  Kind kind = Kind::null;
  bool in_quotes = false;   ///< scalar written with quotes: never a number
  std::string text;         ///< scalar
  std::string key;          ///< member of a map: its name
  std::string file;         ///< or "--set grid.cell=1 mm"
  int line = 0;             ///< of the key, or of the value where there is none; 0: no line (--set)
  std::string path;         ///< materials.copper.density
  std::vector<Node> items;  ///< elements of a list, members of a map

  const Node* find(std::string_view name) const;  ///< member of a map or nullptr
  Node* find(std::string_view name);
  std::string where() const;      ///< "taylor.yaml:12: materials.copper.strength"
  std::string kind_name() const;  ///< "a list", for messages
};

/// Read one YAML document. Paths start with `path` (cards). Syntax errors, a second document, an
/// unreadable, empty or binary file throw InputError; duplicate and merge keys are added to
/// `problems`.
Node read_yaml_file(const std::string& file, const std::string& path, Problems& problems);
Node parse_yaml(const std::string& text, const std::string& file, const std::string& path,
                Problems& problems);

/// Is this a member of a `damage` block that stands beside its law?
bool is_damage_setting(std::string_view key);

/// Lay `over` on `base`: maps are merged member by member, anything else is replaced. A member that
/// names one law, shape or scheme out of several (`strength: {von_mises: ...}`) replaces one of
/// another name.
void overlay(Node& base, const Node& over);

/// Apply one "path=value" of --set.
void apply_override(Node& root, const std::string& setting, Problems& problems);

/// Block-style YAML text that parses to the same tree (comments, anchors and quotes aside).
std::string to_yaml(const Node& root);

// For building trees to be written.
Node scalar_node(const std::string& text);
Node string_node(const std::string& text);  ///< quoted where YAML or a unit might misread it
Node number_node(double value);             ///< shortest text with the same bits
Node list_node(const std::vector<Node>& items);
Node& add_member(Node& map, const std::string& key, Node value);

/// Shortest decimal text that reads back to the same bits.
std::string number_text(double value);

}  // namespace krater::scene
