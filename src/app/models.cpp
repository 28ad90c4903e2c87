// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/models.hpp"
#include "krater/app/command_line.hpp"
#include "krater/materials/catalogue.hpp"
#include "krater/scene/scene.hpp"

namespace krater {

const char* range_text(Range r) {
  switch (r) {
    case Range::positive:
      return "> 0";
    case Range::non_negative:
      return ">= 0";
    case Range::fraction:
      return "0 .. 1";
    case Range::any:
      break;
  }
  return "any";
}

InputError no_such_model(const char* name) {
  std::string known;
  for (const LawInfo& law : catalogue()) known += (known.empty() ? "" : ", ") + law.name;
  return InputError{fmt::format("krater models: no law '{}' (known: {}; cards: {})", name, known,
                                fmt::join(scene::known_cards(), ", "))};
}

namespace {

void print_law(const LawInfo& law) {
  fmt::print("{}: {}\n  {}\n  {}\n", law.family, law.name, law.equation, law.reference);
  for (const ParameterInfo& p : law.parameters) {
    const std::vector<std::string> words = parameter_words(p);
    if (words.empty()) {
      fmt::print("  {:<14} [{}] {}{}  {}{}\n", p.key, p.unit, range_text(p.range),
                 std::isnan(p.fallback) ? ", required" : fmt::format(", default {:g}", p.fallback),
                 p.meaning, p.alias != nullptr ? fmt::format(" (also: {})", p.alias) : "");
    } else {
      fmt::print("  {:<14} {}, default {}  {}\n", p.key, p.words,
                 words.at(static_cast<std::size_t>(p.fallback)), p.meaning);
    }
  }
  if (law.family == "damage")
    fmt::print(
        "  a material card may hold this block: it is used only where the scene's material says\n"
        "  `damage: card`, or lays its own damage block over the card's\n");
}

void print_card(const std::string& name) {
  const CardSummary card = scene::read_card(name);
  fmt::print("card: {}\n  {}\n", name, card.file);
  if (!card.unsourced.empty()) fmt::print("  no source for: {}\n", fmt::join(card.unsourced, ", "));
  fmt::print("{}", card.yaml);
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// The file of a card; its comments say what it is and where it is from.
std::string text_of(const std::string& file) {
  std::ifstream in{file};
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

/// The first comment of a card up to its first full stop or colon.
std::string first_words(const std::string& text) {
  std::istringstream lines{text};
  std::string words;
  for (std::string line; std::getline(lines, line) && line.starts_with('#');)
    words += (words.empty() ? "" : " ") + line.substr(line.find_first_not_of("# "));
  const std::size_t stop = std::min(words.find(". "), words.find(": "));
  return words.substr(0, stop);
}

/// The laws of a card by family, as its values as written name them.
std::string laws_of(const std::string& yaml) {
  std::string names;
  for (const LawInfo& law : catalogue()) {
    const std::string block = fmt::format("\n{}:\n  {}:", law.family, law.name);
    const std::string word = fmt::format("\n{}: {}\n", law.family, law.name);
    const std::string whole = "\n" + yaml + "\n";
    if (whole.find(block) == std::string::npos && whole.find(word) == std::string::npos) continue;
    names += (names.empty() ? "" : ", ") + law.name;
  }
  return names;
}

}  // namespace

void print_cards(const std::string& word) {
  std::size_t found = 0;
  const std::vector<std::string> cards = scene::known_cards();
  for (const std::string& name : cards) {
    const CardSummary card = scene::read_card(name);
    const std::string text = text_of(card.file);
    if (lower(name + "\n" + text).find(lower(word)) == std::string::npos) continue;
    ++found;
    fmt::print("{:<26} {}\n{:<26} laws: {}\n", name, first_words(text), "", laws_of(card.yaml));
    if (!card.unsourced.empty())
      fmt::print("{:<26} no source for: {}\n", "", fmt::join(card.unsourced, ", "));
  }
  if (found == 0)
    throw InputError(fmt::format("krater models: no card holds the word '{}' (cards: {})", word,
                                 fmt::join(cards, ", ")));
}

void print_models(const char* name) {
  const std::vector<std::string> cards = scene::known_cards();
  if (name == nullptr) {
    for (const LawInfo& law : catalogue())
      fmt::print("{:<10} {:<26} {}\n", law.family, law.name, law.equation);
    for (const std::string& card : cards) {
      const std::vector<std::string> unsourced = scene::read_card(card).unsourced;
      fmt::print(
          "{:<10} {:<26} {}\n", "card", card,
          unsourced.empty() ? "" : fmt::format("no source for: {}", fmt::join(unsourced, ", ")));
    }
    for (const std::string& card : scene::generated_cards())
      fmt::print("{:<10} {}, generated from the strength, uncalibrated\n", "card", card);
    return;
  }
  bool found = std::find(cards.begin(), cards.end(), name) != cards.end();
  if (found) print_card(name);
  for (const LawInfo& law : catalogue()) {
    if (law.name != name) continue;
    print_law(law);
    found = true;
  }
  if (!found) throw no_such_model(name);
}

}  // namespace krater
