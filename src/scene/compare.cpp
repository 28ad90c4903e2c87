// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/scene/compare.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

#include "scene/yaml/problems.hpp"
#include "scene/yaml/tree.hpp"

namespace krater {

namespace {

using scene::Node;

/// Path -> text of every leaf; an empty map or list is a leaf too.
void collect(const Node& node, std::map<std::string, std::string>& leaves) {
  if (!node.items.empty()) {
    for (const Node& item : node.items) collect(item, leaves);
  } else if (node.kind == Node::Kind::map || node.kind == Node::Kind::list) {
    leaves[node.path] = node.kind == Node::Kind::map ? "{}" : "[]";
  } else {
    leaves[node.path] = node.kind == Node::Kind::null ? "~" : node.text;
  }
}

std::map<std::string, std::string> leaves_of(const std::string& resolved) {
  scene::Problems problems;
  const Node tree = scene::parse_yaml(resolved, "scene of the checkpoint", "", problems);
  problems.throw_if_any();
  std::map<std::string, std::string> leaves;
  collect(tree, leaves);
  return leaves;
}

}  // namespace

std::vector<SceneDifference> scene_differences(const std::string& before, const std::string& now) {
  const std::map<std::string, std::string> old = leaves_of(before), current = leaves_of(now);
  std::vector<SceneDifference> out;
  for (const auto& [path, text] : old) {
    const auto at = current.find(path);
    if (at == current.end())
      out.push_back({path, text, "none"});
    else if (at->second != text)
      out.push_back({path, text, at->second});
  }
  for (const auto& [path, text] : current)
    if (!old.contains(path)) out.push_back({path, "none", text});
  return out;
}

bool may_differ(const SceneDifference& difference) {
  // Blocks at rest are passed over with the same bits.
  static constexpr std::array<std::string_view, 9> free{
      "title",      "time",     "output",
      "measures",   "outcomes", "gauges",
      "references", "expect",   "method.dormant_blocks"};
  return std::any_of(free.begin(), free.end(), [&difference](std::string_view key) {
    const std::string& path = difference.path;
    return path.starts_with(key) && (path.size() == key.size() || path[key.size()] == '.');
  });
}

std::vector<std::string> changed_measures(const std::vector<SceneDifference>& differences) {
  constexpr std::string_view block = "measures.";
  std::vector<std::string> names;
  for (const SceneDifference& d : differences) {
    if (!d.path.starts_with(block)) continue;
    const std::string rest = d.path.substr(block.size());
    names.push_back(rest.substr(0, rest.find('.')));
  }
  return names;
}

}  // namespace krater
