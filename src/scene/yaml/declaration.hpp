// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/yaml/declaration.hpp
/// What a scene may say: blocks, their keys, and of each key what it may be, its unit, range,
/// default and meaning. A Block reads a key by its declaration and no other key at all, so that the
/// declarations are whole; from them `krater schema` and the manual's reference are written.
/// Assumption: a declaration says what a value may look like; rules between keys are the reader's.
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "krater/core/parameters.hpp"

namespace krater::scene {

struct BlockInfo;

/// A function, since shapes hold shapes.
using BlockMaker = std::function<const BlockInfo&()>;

/// One of the forms that a value may have.
struct Form {
  enum class Kind { number, integer, flag, word, text, list, block, any };
  Kind kind = Kind::any;
  std::string unit = "1";          ///< number: SI unit in UDUNITS spelling
  Range range = Range::any;        ///< number
  int least = 0, most = 0;         ///< integer; list: how many items, 0: any number
  std::vector<std::string> words;  ///< word
  std::vector<Form> items;         ///< list: the forms of its items
  BlockMaker block;                ///< block
};

// For the tables of declarations/.
namespace forms {
Form number(const char* unit, Range range = Range::any);
Form integer(int least, int most);
Form flag();
Form word(std::vector<std::string> words);
Form text();  ///< a name, or an expression
Form list(std::vector<Form> items, int least = 0, int most = 0);
Form vector(const char* unit);  ///< two or three components
Form block(BlockMaker maker);
Form any();
}  // namespace forms

/// A default that the declaration cannot know: it begins with this, and says in words what it is.
inline constexpr char kDynamic = '(';
inline constexpr const char* kMust = "required";
inline constexpr const char* kWhereUsed = "(required where it applies)";

struct KeyInfo {
  std::string key;      ///< "*": any name
  std::string meaning;  ///< one line
  std::vector<Form> forms;
  /// As in YAML; "": nothing where it is left out; "(grid.cell)": made by the reader; kMust.
  std::string fallback;
  std::string alias = "";  ///< a second spelling that is accepted
};

struct BlockInfo {
  std::string name;  ///< unique
  std::string meaning;
  std::vector<KeyInfo> keys;
  bool one_of = false;  ///< holds one of its keys, or is that word alone
  bool carded = false;  ///< what it lacks may stand in a material card
  /// Where a word of one key says which others belong: the blocks of each word.
  std::vector<BlockInfo> variants = {};
};

/// The declaration of a key, or that of "*"; std::logic_error where there is none: the program
/// asks for what it does not declare.
const KeyInfo& declared(const BlockInfo& block, std::string_view key);

/// Unit, range and default of a key that is a number in one of its forms.
ParameterInfo parameter_of(const BlockInfo& block, const KeyInfo& key);

/// A number as declarations and messages write it, or of a ParameterInfo kMust.
std::string fallback_text(double value);

/// The block of a key in a block: `{cylinder: {...}}`.
const BlockInfo& member(const BlockInfo& block, std::string_view key);

}  // namespace krater::scene
