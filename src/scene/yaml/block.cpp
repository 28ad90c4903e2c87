// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/yaml/block.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "krater/scene/yaml/units.hpp"

namespace krater::scene {

namespace {

void report(const Node& at, const std::string& message, Problems& problems) {
  problems.add(at.file, at.line, at.path, message);
}

/// What is wrong with a value outside its range, or "".
std::string range_problem(double value, Range range) {
  switch (range) {
    case Range::any:
      return "";
    case Range::positive:
      return value > 0 ? "" : "must be positive";
    case Range::non_negative:
      return value >= 0 ? "" : "must not be negative";
    case Range::fraction:
      return value >= 0 && value <= 1 ? "" : "must lie between 0 and 1";
  }
  return "";
}

}  // namespace

Block::Block(const BlockInfo& info, const Node* node, std::string path, const Node& parent,
             Problems& problems)
    : info_{info}, node_{node}, problems_{problems} {
  resolved_.kind = Node::Kind::map;
  const Node& source = node ? *node : parent;
  place_.file = source.file;
  place_.line = source.line;
  place_.path = std::move(path);
  if (node && node->kind != Node::Kind::map) {
    const bool empty = node->kind == Node::Kind::null;
    report(*node,
           empty ? "has no value; give it keys, write {} for all defaults, or delete it"
                 : "expected a block of keys, found " + node->kind_name(),
           problems);
    node_ = nullptr;
  }
}

const Node* Block::find(const char* key) {
  declared(info_, key);
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
  return node_ ? node_->find(key) : nullptr;
}

const Node* Block::find_block(const char* key) {
  const Node* node = find(key);
  const bool none = node && node->kind == Node::Kind::scalar && node->text == "none";
  return none ? nullptr : node;
}

const Node* Block::require(const char* key, const std::string& hint) {
  const Node* node = find(key);
  if (!node)
    fail("missing key '" + std::string{key} + "'" + (hint.empty() ? "" : " (" + hint + ")"));
  return node;
}

void Block::require_fallback(const char* key, const std::string& fallback) const {
  const std::string& text = declared(info_, key).fallback;
  if (text == fallback || text == kMust || (!text.empty() && text[0] == kDynamic)) return;
  throw std::logic_error("the default of " + std::string{key} + " of " + info_.name + " is " +
                         fallback + ", declared is " + text);
}

void Block::require_words(const char* key, const std::vector<std::string>& words) const {
  for (const Form& form : declared(info_, key).forms)
    if (form.kind == Form::Kind::word && form.words.size() == words.size() &&
        std::all_of(words.begin(), words.end(), [&](const std::string& word) {
          return std::find(form.words.begin(), form.words.end(), word) != form.words.end();
        }))
      return;
  throw std::logic_error("the words of " + std::string{key} + " of " + info_.name +
                         " are not the declared ones");
}

double Block::number(const char* key) { return number(parameter_of(info_, declared(info_, key))); }

double Block::number(const char* key, double fallback) {
  const KeyInfo& info = declared(info_, key);
  if (info.fallback.empty() || info.fallback[0] != kDynamic)
    require_fallback(key, fallback_text(fallback));
  ParameterInfo parameter = parameter_of(info_, info);
  parameter.fallback = fallback;
  return number(parameter);
}

std::optional<double> Block::optional_number(const char* key) {
  return given_number(parameter_of(info_, declared(info_, key)));
}

std::optional<double> Block::given_number(const ParameterInfo& info) {
  const Node* node = find(info.key);
  if (info.alias && node_) {
    if (const Node* other = node_->find(info.alias)) {
      known_.emplace_back(info.alias);
      if (node)
        fail(*other, "means the same as " + std::string{info.key} + ", which is also given");
      if (!node) node = other;
    }
  }
  if (!node) return std::nullopt;
  return read_number(*node, info.unit, info.range, problems_);
}

double Block::number(const ParameterInfo& info) {
  const std::optional<double> given = given_number(info);
  const bool present = node_ && (node_->find(info.key) || (info.alias && node_->find(info.alias)));
  if (!present && std::isnan(info.fallback)) {
    fail("missing key '" + std::string{info.key} + "' (" + info.meaning +
         (std::string_view{info.unit} == "1" ? "" : ", in " + std::string{info.unit}) + ")");
  }
  // After a problem any harmless value will do: no Scene is made of it.
  const double value = given ? *given : (std::isnan(info.fallback) ? 1.0 : info.fallback);
  record(info.key, number_node(value));
  return value;
}

int Block::integer(const char* key, int fallback) {
  const KeyInfo& info = declared(info_, key);
  const auto form = std::find_if(info.forms.begin(), info.forms.end(),
                                 [](const Form& f) { return f.kind == Form::Kind::integer; });
  if (form == info.forms.end())
    throw std::logic_error(info.key + " of " + info_.name + " is not declared as an integer");
  require_fallback(key, std::to_string(fallback));
  const int least = form->least, most = form->most;
  int value = fallback;
  if (const Node* node = find(key)) {
    const std::optional<double> number = read_number(*node, "1", Range::any, problems_);
    if (number && (*number != std::floor(*number) || *number < least || *number > most)) {
      fail(*node, "must be a whole number from " + std::to_string(least) + " to " +
                      std::to_string(most) + ", found " + quote(node->text));
    } else if (number) {
      value = static_cast<int>(*number);
    }
  }
  record(key, scalar_node(std::to_string(value)));
  return value;
}

bool Block::flag(const char* key, bool fallback) {
  require_fallback(key, fallback ? "true" : "false");
  bool value = fallback;
  if (const Node* node = find(key)) {
    const bool yes = node->kind == Node::Kind::scalar && node->text == "true";
    const bool no = node->kind == Node::Kind::scalar && node->text == "false";
    if (!yes && !no) fail(*node, "must be true or false, found " + node->kind_name());
    value = yes || (value && !no);
  }
  record(key, scalar_node(value ? "true" : "false"));
  return value;
}

std::string Block::text(const char* key, const std::string& fallback) {
  std::string value = fallback;
  if (const Node* node = find(key)) {
    if (node->kind == Node::Kind::scalar) {
      value = node->text;
    } else {
      fail(*node, "expected a text, found " + node->kind_name());
    }
  }
  Node written = string_node(value);
  record(key, written);
  return value;
}

void Block::fail(const Node& at, const std::string& message) { report(at, message, problems_); }

Node Block::finish() {
  if (node_) {
    for (const Node& item : node_->items) {
      if (std::find(known_.begin(), known_.end(), item.key) != known_.end()) continue;
      report(item, "unknown key " + quote(item.key) + suggestion(item.key, known_), problems_);
    }
  }
  return resolved_;
}

std::optional<double> read_number(const Node& node, const char* unit, Range range,
                                  Problems& problems) {
  if (node.kind != Node::Kind::scalar) {
    const bool empty = node.kind == Node::Kind::null;
    report(node, empty ? "has no value" : "expected a number, found " + node.kind_name(), problems);
    return std::nullopt;
  }
  const QuantityText quantity = parse_quantity(node.text, unit);
  const std::string problem =
      quantity.problem.empty() ? range_problem(quantity.value, range) : quantity.problem;
  if (problem.empty()) return quantity.value;
  report(node, quantity.problem.empty() ? problem + ", found " + quote(node.text) : problem,
         problems);
  return std::nullopt;
}

std::optional<std::string> read_word(const Node& node, Problems& problems) {
  if (node.kind == Node::Kind::scalar) return node.text;
  report(
      node,
      node.kind == Node::Kind::null ? "has no value" : "expected a word, found " + node.kind_name(),
      problems);
  return std::nullopt;
}

std::optional<Choice> read_choice(const Node& node, const std::string& what, Problems& problems) {
  if (node.kind == Node::Kind::scalar) return Choice{node.text, &node, nullptr};
  if (node.kind == Node::Kind::map && node.items.size() == 1) {
    return Choice{node.items[0].key, &node.items[0], &node.items[0]};
  }
  if (node.kind == Node::Kind::map && node.items.size() > 1) {
    report(node.items[1],
           "only one " + what + " can be chosen, " + quote(node.items[0].key) + " is already",
           problems);
  } else {
    report(node,
           "expected one " + what + ", found " +
               (node.kind == Node::Kind::list ? "a list" : "nothing"),
           problems);
  }
  return std::nullopt;
}

bool check_name(const Node& node, Problems& problems) {
  const bool good = !node.key.empty() && node.key.size() <= 60 && node.key[0] != '-' &&
                    std::all_of(node.key.begin(), node.key.end(), [](char c) {
                      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                             (c >= '0' && c <= '9') || c == '_' || c == '-';
                    });
  if (!good)
    report(node, quote(node.key) + " is not a name: use letters, digits, _ and - (at most 60)",
           problems);
  return good;
}

void report_unknown(const Node& at, const std::string& what, std::string_view word,
                    const std::vector<std::string>& known, Problems& problems) {
  report(at, "unknown " + what + " " + quote(word) + suggestion(word, known), problems);
}

}  // namespace krater::scene
