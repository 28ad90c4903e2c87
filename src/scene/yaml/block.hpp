// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/yaml/block.hpp
/// A block of keys while it is read. Only declared keys can be asked for, and their units, ranges,
/// words and defaults are those of the declaration. Every key asked for is known; whatever else the
/// block holds is an error, and so is anything missing, mistyped or out of range. Each value read,
/// given or by default, is recorded for resolved.yaml, which therefore cannot differ from what the
/// program used.
#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "krater/core/parameters.hpp"
#include "scene/yaml/declaration.hpp"
#include "scene/yaml/problems.hpp"
#include "scene/yaml/tree.hpp"

namespace krater::scene {

/// Words of a choice and what they stand for.
template <class T>
using Words = std::vector<std::pair<const char*, T>>;

class Block {
 public:
  /// `node` may be null (an absent block, all defaults) or `{}`; it must outlive the block.
  Block(const BlockInfo& info, const Node* node, std::string path, const Node& parent,
        Problems& problems);

  bool given() const { return node_ != nullptr; }
  const Node& place() const { return place_; }  ///< for messages and `where`

  /// Member of that name, or nullptr; from now on a known key.
  const Node* find(const char* key);
  const Node* find_block(const char* key);  ///< as find, but `key: none` is absence
  const Node* require(const char* key, const std::string& hint = "");

  /// A number with its declared alias, unit, range and default.
  double number(const char* key);
  double number(const char* key, double fallback);  ///< a default that the scene decides
  double number(const ParameterInfo& info);         ///< with another default, or another unit
  std::optional<double> optional_number(const char* key);  ///< the default is not used
  int integer(const char* key, int fallback);
  bool flag(const char* key, bool fallback);
  std::string text(const char* key, const std::string& fallback);
  template <class T>
  T choice(const char* key, const Words<T>& words, T fallback);

  const BlockInfo& info() const { return info_; }
  void record(const std::string& key, Node value) { add_member(resolved_, key, std::move(value)); }
  void fail(const std::string& message) { fail(place_, message); }
  void fail(const Node& at, const std::string& message);
  Problems& problems() { return problems_; }

  /// Report the keys nobody asked for; returns the block with all defaults.
  Node finish();

 private:
  std::optional<double> given_number(const ParameterInfo& info);
  /// A default of the code that is not the declared one is a mistake of the program.
  void require_fallback(const char* key, const std::string& fallback) const;
  void require_words(const char* key, const std::vector<std::string>& words) const;

  const BlockInfo& info_;
  Node place_;  ///< file, line and path only
  const Node* node_;
  Problems& problems_;
  Node resolved_;
  std::vector<std::string> known_;
};

/// A scalar as number in SI, range checked; nothing after a problem was reported.
std::optional<double> read_number(const Node& node, const char* unit, Range range,
                                  Problems& problems);

/// A scalar as a word; nothing after a problem was reported.
std::optional<std::string> read_word(const Node& node, Problems& problems);

/// The only member of a map, or a lone word: `{johnson_cook: {...}}`, `elastic`. `value` is null
/// for a word.
struct Choice {
  std::string name;
  const Node* place = nullptr;
  const Node* value = nullptr;
};
std::optional<Choice> read_choice(const Node& node, const std::string& what, Problems& problems);

/// Is this a name under which results can be filed (letters, digits, `_`, `-`)? Reports a problem
/// if not.
bool check_name(const Node& node, Problems& problems);

/// Report a word that is none of `known`.
void report_unknown(const Node& at, const std::string& what, std::string_view word,
                    const std::vector<std::string>& known, Problems& problems);

template <class T>
T Block::choice(const char* key, const Words<T>& words, T fallback) {
  std::vector<std::string> known;
  for (const auto& [name, value] : words) {
    known.emplace_back(name);
    if (value == fallback) require_fallback(key, name);
  }
  require_words(key, known);
  T result = fallback;
  if (const Node* node = find(key)) {
    const std::optional<std::string> word = read_word(*node, problems_);
    const auto at = word ? std::find(known.begin(), known.end(), *word) : known.end();
    if (at != known.end())
      result = words[static_cast<std::size_t>(at - known.begin())].second;
    else if (word)
      report_unknown(*node, "value", *word, known, problems_);
  }
  for (const auto& [name, value] : words) {
    if (value == result) {
      record(key, string_node(name));
      break;
    }
  }
  return result;
}

}  // namespace krater::scene
