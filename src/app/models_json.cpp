// SPDX-License-Identifier: GPL-3.0-or-later
// `krater models --json`: laws and cards for scripts, editors and the manual.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/models.hpp"
#include "krater/app/command_line.hpp"
#include "krater/materials/catalogue.hpp"
#include "krater/output/results.hpp"
#include "krater/scene/scene.hpp"

namespace krater {

namespace {

Json parameter_json(const ParameterInfo& p) {
  Json out;
  out["key"] = Json::of(p.key);
  if (p.alias != nullptr) out["also"] = Json::of(p.alias);
  out["meaning"] = Json::of(p.meaning);
  const std::vector<std::string> words = parameter_words(p);
  if (words.empty()) {
    out["unit"] = Json::of(p.unit);
    out["range"] = Json::of(range_text(p.range));
    if (!std::isnan(p.fallback)) out["default"] = Json::of(p.fallback);
  } else {
    Json& list = out["words"] = Json::array();
    for (const std::string& word : words) list.items.push_back(Json::of(word));
    out["default"] = Json::of(words.at(static_cast<std::size_t>(p.fallback)));
  }
  out["required"] = Json::of(words.empty() && std::isnan(p.fallback));
  return out;
}

Json law_json(const LawInfo& law) {
  Json out, parameters = Json::array(), columns = Json::array();
  for (const ParameterInfo& p : law.parameters) parameters.items.push_back(parameter_json(p));
  for (const FieldInfo* column : law.columns) {
    Json& field = columns.items.emplace_back();
    field["name"] = Json::of(column->name);
    field["unit"] = Json::of(column->unit);
    field["meaning"] = Json::of(column->meaning);
  }
  out["family"] = Json::of(law.family);
  out["name"] = Json::of(law.name);
  out["equation"] = Json::of(law.equation);
  out["reference"] = Json::of(law.reference);
  out["parameters"] = parameters;
  out["fields"] = columns;
  return out;
}

Json card_json(const std::string& name, bool whole) {
  const CardSummary card = scene::read_card(name);
  Json out, unsourced = Json::array();
  for (const std::string& key : card.unsourced) unsourced.items.push_back(Json::of(key));
  out["name"] = Json::of(name);
  out["file"] = Json::of(card.file);
  out["unsourced"] = unsourced;
  if (whole) out["yaml"] = Json::of(card.yaml);
  return out;
}

}  // namespace

void print_models_json(const char* name) {
  Json out, laws = Json::array(), cards = Json::array(), generated = Json::array();
  for (const LawInfo& law : catalogue())
    if (name == nullptr || law.name == name) laws.items.push_back(law_json(law));
  for (const std::string& card : scene::known_cards())
    if (name == nullptr || card == name) cards.items.push_back(card_json(card, name != nullptr));
  if (name == nullptr)
    for (const std::string& card : scene::generated_cards())
      generated.items.push_back(Json::of(card));
  if (laws.items.empty() && cards.items.empty()) throw no_such_model(name);
  out["laws"] = laws;
  out["cards"] = cards;
  if (name == nullptr) out["generated_cards"] = generated;
  fmt::print("{}", to_text(out));
}

}  // namespace krater
