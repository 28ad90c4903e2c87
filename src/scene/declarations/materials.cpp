// SPDX-License-Identifier: GPL-3.0-or-later
// Materials. The laws and their parameters are those of the catalogue.
#include <cmath>
#include <deque>
#include <iterator>
#include <string_view>
#include <utility>

#include "krater/materials/catalogue.hpp"
#include "krater/materials/stage.hpp"
#include "scene/declarations/declarations.hpp"

namespace krater::scene {

using namespace forms;

namespace {

/// Parameters that the material's own constants give where the law's block does not.
std::string parameter_fallback(const ParameterInfo& p) {
  const std::string_view key = p.key;
  if (!std::isnan(p.fallback)) return fallback_text(p.fallback);
  const bool elastic = key == "bulk_modulus" || key == "lame_lambda";
  return elastic ? "(from the material's elastic constants)" : kMust;
}

KeyInfo parameter_key(const ParameterInfo& p) {
  const std::vector<std::string> words = parameter_words(p);
  KeyInfo key{p.key, p.meaning, {}, "", p.alias ? p.alias : ""};
  key.forms = {words.empty() ? number(p.unit, p.range) : word(words)};
  key.fallback =
      words.empty() ? parameter_fallback(p) : words.at(static_cast<std::size_t>(p.fallback));
  return key;
}

const std::deque<BlockInfo>& law_blocks() {
  static const std::deque<BlockInfo> blocks = [] {
    std::deque<BlockInfo> made;
    for (const LawInfo& law : catalogue()) {
      BlockInfo& info = made.emplace_back();
      info.name = law.family + "." + law.name;
      info.meaning = law.equation + ". " + law.reference;
      info.carded = true;
      for (const ParameterInfo& p : law.parameters) info.keys.push_back(parameter_key(p));
    }
    return made;
  }();
  return blocks;
}

std::vector<KeyInfo> keys_of_laws(std::string_view family) {
  std::vector<KeyInfo> keys;
  for (std::size_t i = 0; i < catalogue().size(); ++i) {
    const LawInfo& law = catalogue()[i];
    if (law.family != family) continue;
    keys.push_back({law.name,
                    law.equation,
                    {block([i]() -> const BlockInfo& { return law_blocks()[i]; })},
                    ""});
  }
  return keys;
}

/// `{eos: {mie_gruneisen: {...}}}` or, where the law needs nothing, its name alone.
KeyInfo family_key(const char* family, const char* meaning) {
  std::vector<std::string> words{"none"};
  for (const std::string& name : law_names(family)) words.push_back(name);
  const auto laws = [family, meaning]() -> const BlockInfo& {
    static std::deque<BlockInfo> made;
    for (const BlockInfo& known : made)
      if (known.name == family) return known;
    return made.emplace_back(BlockInfo{family, meaning, keys_of_laws(family), true, true});
  };
  return {family, meaning, {word(words), block(laws)}, ""};
}

KeyInfo damage_key() {
  std::vector<std::string> words{"none", "card"};
  for (const std::string& name : law_names("damage")) words.push_back(name);
  return {"damage",
          "growth of damage and failure; `card` takes that of the card",
          {word(words), block(damage_block)},
          ""};
}

/// Its first law goes without saying.
KeyInfo viscosity_key() {
  KeyInfo key = family_key("viscosity", "artificial viscosity of shocks");
  const int first = find_law("viscosity", law_names("viscosity").front());
  key.forms.push_back(block([first]() -> const BlockInfo& { return law_block(first); }));
  return key;
}

}  // namespace

const BlockInfo& law_block(int law) { return law_blocks()[static_cast<std::size_t>(law)]; }

const BlockInfo& material_block() {
  static const BlockInfo info{
      "material",
      "A material: its density, elastic constants and laws, here or in its card. Of the elastic "
      "constants two at most are given.",
      {{"card",
        "a card by name or path, or what one is generated from; keys here stand over its own",
        {text(), block([]() -> const BlockInfo& {
           static const BlockInfo card{
               "card",
               "What a card is generated from.",
               {{"concrete", "all constants from the strength", {block(generated_card_block)}, ""},
                {"keywords",
                 "the cards of a keyword file of LS-DYNA",
                 {block(keyword_card_block)},
                 ""}},
               true};
           return card;
         })},
        ""},
       {"unsourced", "of a card: values that no source was read for", {list({text()})}, ""},
       {"density", "density at rest", {number("kg/m^3", Range::positive)}, kMust},
       {"shear_modulus", "G", {number("Pa", Range::positive)}, "", "G"},
       {"bulk_modulus", "K", {number("Pa", Range::positive)}, "", "K"},
       {"youngs_modulus", "E", {number("Pa", Range::positive)}, "", "E"},
       {"poisson_ratio", "nu", {number("1")}, "", "nu"},
       {"initial_temperature", "at the start", {number("K", Range::positive)}, "293"},
       family_key("eos", "pressure from density and energy"),
       family_key("strength", "deviatoric stress, yield and hardening"),
       family_key("model", "a law that gives strength, pressure and damage together"),
       {"rate",
        "objective rate in which the strength's stress is integrated",
        {word({std::begin(kRateNames), std::end(kRateNames)})},
        "truesdell"},
       {"spall",
        "tension at which the material parts, with what happens then",
        {word({"none"}), number("Pa", Range::positive), block(spall_block)},
        ""},
       {"spall_strength",
        "tension at which the material parts; `card` takes that of the card",
        {number("Pa", Range::positive), word({"card"})},
        ""},
       damage_key(),
       {"failure", "what becomes of points that have failed", {block(failure_block)}, ""},
       family_key("heating", "temperature"),
       viscosity_key()},
      false,
      true};
  return info;
}

const BlockInfo& generated_card_block() {
  static const BlockInfo info{
      "card.concrete",
      "Concrete by its strength, uncalibrated.",
      {{"fc",
        "unconfined strength",
        {number("Pa", Range::positive)},
        kMust,
        "compressive_strength"},
       {"density", "of ordinary concrete", {number("kg/m^3", Range::positive)}, "2300"},
       {"aggregate_size",
        "largest grain, for the fracture energy",
        {number("m", Range::positive)},
        "0.0095"},
       {"model", "the law that is generated", {word({"karagozian_case", "cscm"})}, kMust}}};
  return info;
}

const BlockInfo& keyword_card_block() {
  static const BlockInfo info{
      "card.keywords",
      "Cards of LS-DYNA: *MAT_015, *MAT_098, *MAT_008, *EOS_GRUNEISEN, *EOS_JWL.",
      {{"file", "a .k file of one material, beside the scene", {text()}, kMust},
       {"units",
        "of mass, length and time in the file, as [g, mm, ms] or [ton, mm, s]",
        {list({text()}, 3, 3)},
        kMust}}};
  return info;
}

const BlockInfo& damage_block() {
  static const BlockInfo info = [] {
    BlockInfo made{"damage",
                   "One law of damage, and what stands beside it.",
                   {{"coupling",
                     "how damage acts on the stress: on its size, or in its rate",
                     {word({"effective", "rate"})},
                     "effective"},
                    {"degrade_pressure",
                     "which pressure damage takes away",
                     {word({"tension", "none", "all"})},
                     "tension"}},
                   false,
                   true};
    for (KeyInfo& key : keys_of_laws("damage")) made.keys.push_back(std::move(key));
    return made;
  }();
  return info;
}

const BlockInfo& failure_block() {
  static const BlockInfo info{"failure",
                              "What becomes of points that have failed.",
                              {{"action",
                                "they bear compression only, or are removed",
                                {word({"strength_loss", "remove"})},
                                "strength_loss"}}};
  return info;
}

const BlockInfo& spall_block() {
  static const BlockInfo info{
      "spall",
      "Failure by tension.",
      {{"strength", "tension at which the material parts", {number("Pa", Range::positive)}, kMust},
       {"action",
        "the point fails and the material parts, or the tension is cut off",
        {word({"fail", "limit"})},
        "fail"}}};
  return info;
}

}  // namespace krater::scene
