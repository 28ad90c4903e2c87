// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <fmt/format.h>

#include "krater/app/command_line.hpp"
#include "krater/core/errors.hpp"
#include "krater/materials/catalogue.hpp"

namespace krater {

namespace {

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

}  // namespace

void print_models(const char* name) {
  if (name == nullptr) {
    for (const LawInfo& law : catalogue())
      fmt::print("{:<10} {:<26} {}\n", law.family, law.name, law.equation);
    return;
  }
  bool found = false;
  std::string known;
  for (const LawInfo& law : catalogue()) {
    known += (known.empty() ? "" : ", ") + law.name;
    if (law.name != name) continue;
    print_law(law);
    found = true;
  }
  if (!found) throw InputError(fmt::format("krater models: no law '{}' (known: {})", name, known));
}

}  // namespace krater
