// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <iterator>

#include "krater/core/parameters.hpp"
#include "krater/materials/catalogue.hpp"
#include "scene/declarations/declarations.hpp"
#include "scene/yaml/block.hpp"
#include "scene/yaml/cards.hpp"

namespace krater::scene {

namespace {

/// Laws that make all their constants of a strength and a grain.
constexpr const char* kGenerated[] = {"karagozian_case", "cscm"};

}  // namespace

Node placed(const Node& at, const std::string& path, Node value) {
  value.file = at.file;
  value.line = at.line;
  value.path = path;
  for (Node& item : value.items) item = placed(at, path + "." + item.key, item);
  return value;
}

Node generated_card(const Node& card, const std::string& path, Problems& problems) {
  Node made;
  made.kind = Node::Kind::map;
  if (card.items.size() != 1 || card.items[0].key != "concrete" ||
      card.items[0].kind != Node::Kind::map) {
    problems.add(card.file, card.line, card.path,
                 "a card is a name, a path, or what one is made from: {concrete: {fc: 39 MPa, "
                 "model: karagozian_case}} or {keywords: {file: steel.k, units: [g, mm, ms]}}");
    return made;
  }
  Block block{generated_card_block(), &card.items[0], card.path + ".concrete", card, problems};
  const double f = block.number("fc"), density = block.number("density"),
               grain = block.number("aggregate_size");
  const Node* model = block.require("model", "karagozian_case and cscm can be generated");
  const std::vector<std::string> known{std::begin(kGenerated), std::end(kGenerated)};
  if (model && std::count(known.begin(), known.end(), model->text) == 0) {
    if (find_law("model", model->text) >= 0)
      problems.add(model->file, model->line, model->path,
                   "no rule makes the constants of " + model->text +
                       " from a strength (known: " + join(known) +
                       "); take a card of it by name, as card: concrete_48 " + "(krater models)");
    else
      report_unknown(*model, "model to generate", model->text, known, problems);
  }
  block.finish();
  add_member(made, "density", number_node(density));
  Node law, family;
  law.kind = family.kind = Node::Kind::map;
  add_member(law, "compressive_strength", number_node(f));
  add_member(law, "aggregate_size", number_node(grain));
  add_member(family, model ? model->text : known[0], law);
  add_member(made, "model", family);
  return placed(card, path, made);
}

std::vector<std::string> generated_cards() {
  std::vector<std::string> cards;
  for (const char* model : kGenerated)
    cards.push_back(std::string{"{concrete: {fc: 39 MPa, model: "} + model + "}}");
  return cards;
}

}  // namespace krater::scene
