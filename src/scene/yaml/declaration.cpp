// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/yaml/declaration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace krater::scene {

namespace forms {

Form number(const char* unit, Range range) {
  Form form;
  form.kind = Form::Kind::number;
  form.unit = unit;
  form.range = range;
  return form;
}

Form integer(int least, int most) {
  Form form;
  form.kind = Form::Kind::integer;
  form.least = least;
  form.most = most;
  return form;
}

Form flag() {
  Form form;
  form.kind = Form::Kind::flag;
  return form;
}

Form word(std::vector<std::string> words) {
  Form form;
  form.kind = Form::Kind::word;
  form.words = std::move(words);
  return form;
}

Form text() {
  Form form;
  form.kind = Form::Kind::text;
  return form;
}

Form list(std::vector<Form> items, int least, int most) {
  Form form;
  form.kind = Form::Kind::list;
  form.items = std::move(items);
  form.least = least;
  form.most = most;
  return form;
}

Form vector(const char* unit) { return list({number(unit)}, 2, 3); }

Form block(BlockMaker maker) {
  Form form;
  form.kind = Form::Kind::block;
  form.block = std::move(maker);
  return form;
}

Form any() { return {}; }

}  // namespace forms

const KeyInfo& declared(const BlockInfo& block, std::string_view key) {
  const KeyInfo* wildcard = nullptr;
  for (const KeyInfo& info : block.keys) {
    if (info.key == key || (!info.alias.empty() && info.alias == key)) return info;
    if (info.key == "*") wildcard = &info;
  }
  if (wildcard) return *wildcard;
  throw std::logic_error(
      fmt::format("the reader asks for a key that is not declared: {} of {}", key, block.name));
}

ParameterInfo parameter_of(const BlockInfo& block, const KeyInfo& key) {
  const auto form = std::find_if(key.forms.begin(), key.forms.end(),
                                 [](const Form& f) { return f.kind == Form::Kind::number; });
  if (form == key.forms.end())
    throw std::logic_error(fmt::format(
        "the reader takes {} of {} for a number, which is not declared", key.key, block.name));
  const bool known = !key.fallback.empty() && key.fallback != kMust && key.fallback[0] != kDynamic;
  return {key.key.c_str(),     form->unit.c_str(),
          form->range,         known ? std::strtod(key.fallback.c_str(), nullptr) : kRequired,
          key.meaning.c_str(), key.alias.empty() ? nullptr : key.alias.c_str()};
}

std::string fallback_text(double value) {
  return std::isnan(value) ? kMust : fmt::format("{}", value);
}

const BlockInfo& member(const BlockInfo& block, std::string_view key) {
  for (const Form& form : declared(block, key).forms)
    if (form.kind == Form::Kind::block) return form.block();
  throw std::logic_error(fmt::format("no block is declared for {} of {}", key, block.name));
}

}  // namespace krater::scene
