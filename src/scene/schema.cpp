// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/scene/schema.hpp"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "krater/output/results.hpp"
#include "scene/declarations/declarations.hpp"
#include "scene/yaml/problems.hpp"

namespace krater {

namespace {

using namespace scene;
using Kind = Form::Kind;

/// A number alone or with a unit behind it.
constexpr const char* kNumberText = R"(^\s*[-+]?(\d|\.\d))";

Json texts(const std::vector<std::string>& words) {
  Json out = Json::array();
  for (const std::string& word : words) out.items.push_back(Json::of(word));
  return out;
}

std::string place_of(const std::string& block) {
  std::string name = block;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

class Writer {
 public:
  Json write(const BlockInfo& root) {
    Json out;
    out["$schema"] = Json::of("http://json-schema.org/draft-07/schema#");
    out["title"] = Json::of("krater: " + root.name);
    out["allOf"] = one(reference(root));
    for (std::size_t done = 0; done < blocks_.size(); ++done) {
      const BlockInfo& next = *blocks_[done];  // writing it may add others
      const std::string name = place_of(next.name);
      if (std::count(definitions_.keys.begin(), definitions_.keys.end(), name) != 0)
        throw std::logic_error("two blocks are declared as " + name);
      definitions_[name] = of_block(next);
    }
    out["definitions"] = definitions_;
    return out;
  }

 private:
  static Json one(Json item) {
    Json out = Json::array();
    out.items.push_back(std::move(item));
    return out;
  }

  Json reference(const BlockInfo& block) {
    if (std::find(blocks_.begin(), blocks_.end(), &block) == blocks_.end())
      blocks_.push_back(&block);
    Json out;
    out["$ref"] = Json::of("#/definitions/" + place_of(block.name));
    return out;
  }

  static Json of_number(const Form& form) {
    Json out;
    out["type"] = texts({"number", "string"});
    out["pattern"] = Json::of(kNumberText);
    if (form.range == Range::positive) out["exclusiveMinimum"] = Json::of(0);
    if (form.range == Range::non_negative || form.range == Range::fraction)
      out["minimum"] = Json::of(0);
    if (form.range == Range::fraction) out["maximum"] = Json::of(1);
    return out;
  }

  /// YAML 1.1 reads off and on as no and yes.
  static Json of_words(const Form& form) {
    Json out, words = texts(form.words);
    for (const std::string& word : form.words)
      if (word == "off" || word == "on") words.items.push_back(Json::of(word == "on"));
    out["enum"] = words;
    return out;
  }

  Json of_list(const Form& form) {
    Json out;
    out["type"] = Json::of("array");
    out["items"] = any_of(form.items);
    if (form.least > 0) out["minItems"] = Json::of(form.least);
    if (form.most > 0) out["maxItems"] = Json::of(form.most);
    return out;
  }

  Json of_form(const Form& form) {
    Json out;
    switch (form.kind) {
      case Kind::number:
        return of_number(form);
      case Kind::integer:
        out["type"] = Json::of("integer");
        out["minimum"] = Json::of(form.least);
        out["maximum"] = Json::of(form.most);
        return out;
      case Kind::flag:
        out["type"] = Json::of("boolean");
        return out;
      case Kind::word:
        return of_words(form);
      case Kind::text:
        out["type"] = texts({"string", "number"});
        return out;
      case Kind::list:
        return of_list(form);
      case Kind::block:
        return reference(form.block());
      case Kind::any:
        break;
    }
    return out;
  }

  Json any_of(const std::vector<Form>& forms) {
    if (forms.size() == 1) return of_form(forms.front());
    Json out, all = Json::array();
    for (const Form& form : forms) all.items.push_back(of_form(form));
    out["anyOf"] = all;
    return out;
  }

  static std::string takes(const Form& form) {
    switch (form.kind) {
      case Kind::number:
        return number_takes(form);
      case Kind::integer:
        return fmt::format("whole number {} to {}", form.least, form.most);
      case Kind::flag:
        return "true or false";
      case Kind::word:
        return join(form.words);
      case Kind::text:
        return "text";
      case Kind::list:
        return "list of " + takes(form.items);
      case Kind::block:
        return "{" + form.block().name + "}";
      case Kind::any:
        break;
    }
    return "anything";
  }

  static std::string number_takes(const Form& form) {
    std::string out = form.range == Range::fraction ? "number from 0 to 1" : "number";
    if (form.range == Range::positive) out += " > 0";
    if (form.range == Range::non_negative) out += " >= 0";
    return form.unit == "1" || form.unit.empty() ? out : out + " [" + form.unit + "]";
  }

  static std::string takes(const std::vector<Form>& forms) {
    std::string out;
    for (const Form& form : forms) out += (out.empty() ? "" : " or ") + takes(form);
    return out;
  }

  Json of_key(const KeyInfo& key) {
    Json out = any_of(key.forms);
    if (!out.keys.empty() && out.keys.front() == "$ref") {  // nothing beside it would be read
      Json wrapped;
      wrapped["allOf"] = one(out);
      out = wrapped;
    }
    const std::string fallback = key.fallback.empty() ? "none" : key.fallback;
    out["description"] = Json::of(key.meaning + " (" + takes(key.forms) +
                                  (key.fallback.empty()               ? ")"
                                   : key.fallback.front() == kDynamic ? "; " + fallback.substr(1)
                                   : key.fallback == kMust            ? "; required)"
                                                           : "; default " + fallback + ")"));
    out["x-meaning"] = Json::of(key.meaning);
    out["x-takes"] = Json::of(takes(key.forms));
    out["x-default"] = Json::of(fallback);
    return out;
  }

  /// One of its variants: editors take the one whose word stands there.
  Json of_variants(const BlockInfo& block) {
    Json all = Json::array();
    for (const BlockInfo& variant : block.variants) all.items.push_back(reference(variant));
    return all;
  }

  Json of_block(const BlockInfo& block) {
    Json out, properties, required = Json::array();
    out["title"] = Json::of(block.name);
    out["description"] = Json::of(block.meaning);
    out["type"] = Json::of("object");
    if (!block.variants.empty()) {
      out["anyOf"] = of_variants(block);
      return out;
    }
    out["additionalProperties"] = Json::of(false);
    for (const KeyInfo& key : block.keys) {
      if (key.key == "*") {
        out["additionalProperties"] = of_key(key);
        continue;
      }
      properties[key.key] = of_key(key);
      if (!key.alias.empty()) properties[key.alias] = of_key(key);
      if (key.fallback == kMust && key.alias.empty() && !block.carded)
        required.items.push_back(Json::of(key.key));
    }
    out["properties"] = properties;
    if (!required.items.empty()) out["required"] = required;
    if (block.one_of) {
      out["minProperties"] = Json::of(1);
      out["maxProperties"] = Json::of(1);
    }
    return out;
  }

  std::vector<const BlockInfo*> blocks_;  ///< in the order in which they are met
  Json definitions_;
};

}  // namespace

std::string schema_text(bool loading_path) {
  return to_text(Writer{}.write(loading_path ? point_scene_block() : scene_block())) + "\n";
}

}  // namespace krater
