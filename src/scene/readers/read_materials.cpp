// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "krater/materials/catalogue.hpp"
#include "scene/readers/elastic_constants.hpp"
#include "scene/readers/readers.hpp"
#include "scene/yaml/cards.hpp"

namespace krater::scene {

namespace {

/// Five digits, for messages.
std::string rounded(double value) {
  std::ostringstream text;
  text << std::setprecision(5) << value;
  return text.str();
}

const LawInfo& law_info(const LawChoice& choice) {
  return catalogue()[static_cast<std::size_t>(choice.law)];
}

/// Parameters of a law that the material's elastic constants give where the law's own block does
/// not.
std::optional<double> implied(const ParameterInfo& info, ElasticConstants& constants) {
  const std::string key = info.key;
  const bool elastic = key == "bulk_modulus" || key == "lame_lambda";
  if (elastic && !constants.known && std::isnan(info.fallback)) return 1.0;
  if (key == "bulk_modulus" && constants.bulk) constants.bulk_used = true;
  if (key == "bulk_modulus") return constants.bulk;
  if (key == "lame_lambda" && constants.bulk) {
    constants.bulk_used = true;
    return *constants.bulk - 2.0 / 3.0 * constants.shear;
  }
  return std::nullopt;
}

/// A parameter whose value is one of a few words: their index.
double word_value(const ParameterInfo& info, Block& block, Problems& problems) {
  const std::vector<std::string> words = parameter_words(info);
  auto index = static_cast<std::size_t>(info.fallback);
  if (const Node* node = block.find(info.key)) {
    const std::optional<std::string> word = read_word(*node, problems);
    const auto found = word ? std::find(words.begin(), words.end(), *word) : words.end();
    if (word && found == words.end()) report_unknown(*node, "value", *word, words, problems);
    if (found != words.end()) index = static_cast<std::size_t>(found - words.begin());
  }
  block.record(info.key, string_node(words.at(index)));
  return static_cast<double>(index);
}

struct LawReader {
  Reading& reading;
  ElasticConstants& constants;
  Block& material;
  MaterialOptions& options;

  /// The parameters of one law; `node` may be null: all defaults.
  Node read_parameters(LawChoice& choice, const Node* node, const std::string& path) {
    const LawInfo& law = law_info(choice);
    Block block{law_block(choice.law), node, path, material.place(), reading.problems};
    choice.where = block.place().where();
    const bool absent = node == nullptr;
    for (ParameterInfo info : law.parameters) {
      if (const auto value = implied(info, constants)) info.fallback = *value;
      choice.values.push_back(info.words ? word_value(info, block, reading.problems)
                                         : block.number(info));
    }
    if (absent) choice.where = material.place().where();
    const MaterialConstants shared{options.density, options.shear_modulus,
                                   options.initial_temperature};
    if (!reading.problems.any()) {
      if (const char* problem = law_problem(choice.law, choice.values.data(), shared))
        block.fail(problem);
    }
    return block.finish();
  }

  /// `strength: {johnson_cook: {...}}` or `strength: elastic`.
  std::optional<LawChoice> read_named(const char* family) {
    const Node* node = material.find_block(family);
    if (!node) return std::nullopt;
    Node resolved;
    const std::optional<LawChoice> choice = read_law(family, *node, resolved);
    if (choice) material.record(family, resolved);
    return choice;
  }

  /// The law named by the only key of `node`; its parameters are added to `resolved`.
  std::optional<LawChoice> read_law(const char* family, const Node& node, Node& resolved) {
    const std::optional<Choice> chosen = read_choice(node, "model", reading.problems);
    if (!chosen) return std::nullopt;
    LawChoice choice;
    choice.name = chosen->name;
    choice.law = find_law(family, chosen->name);
    if (choice.law < 0) {
      // The error names the block: that is where the user looks for the choice.
      Node place = *chosen->place;
      place.path = node.path;
      report_unknown(place, "model", chosen->name, law_names(family), reading.problems);
      return std::nullopt;
    }
    add_member(resolved, choice.name,
               read_parameters(choice, chosen->value, node.path + "." + choice.name));
    return choice;
  }

  /// `damage: {johnson_cook: {...}, coupling: rate, degrade_pressure: none}` and `failure: {...}`.
  void read_damage() {
    const Node* node = material.find_block("damage");
    const Node* failure = material.find_block("failure");
    const bool model_fails = options.model && law_info(*options.model).fails;
    if (failure && !node && !spalls() && !model_fails)
      material.fail(*failure, "needs damage or a spall that fails: nothing else makes points fail");
    if (failure || node) read_failure(failure);
    if (!node) return;
    Node resolved, law = *node;
    if (node->kind == Node::Kind::map) {
      Block block{damage_block(), node, node->path, material.place(), reading.problems};
      options.coupling = block.choice<Coupling>(
          "coupling", {{"effective", Coupling::effective}, {"rate", Coupling::rate}},
          options.coupling);
      options.degrade_pressure =
          block.choice<DegradePressure>("degrade_pressure",
                                        {{"tension", DegradePressure::tension},
                                         {"none", DegradePressure::none},
                                         {"all", DegradePressure::all}},
                                        options.degrade_pressure);
      std::erase_if(law.items, [](const Node& item) { return is_damage_setting(item.key); });
      add_member(resolved, "coupling",
                 string_node(options.coupling == Coupling::rate ? "rate" : "effective"));
      const char* const words[] = {"tension", "none", "all"};
      add_member(resolved, "degrade_pressure",
                 string_node(words[static_cast<int>(options.degrade_pressure)]));
    }
    options.damage = read_law("damage", law, resolved);
    material.record("damage", resolved);
  }

  bool spalls() const {
    return options.spall_strength && options.spall_action == SpallAction::fail;
  }

  void read_failure(const Node* failure) {
    Block action{failure_block(), failure, material.place().path + ".failure", material.place(),
                 reading.problems};
    options.failure = action.choice<FailureAction>(
        "action",
        {{"strength_loss", FailureAction::strength_loss}, {"remove", FailureAction::remove}},
        options.failure);
    material.record("failure", action.finish());
  }

  /// `spall: {strength: 1.2 GPa, action: fail}`; `spall_strength: 1.2 GPa`, or `spall: 1.2 GPa`, is
  /// the same.
  void read_spall() {
    std::optional<double> brief = material.optional_number("spall_strength");
    const Node* node = material.find_block("spall");
    if (brief && node)
      material.fail(*node, "spall_strength gives the strength already: keep one of the two");
    if (node && node->kind == Node::Kind::scalar) {
      brief = read_number(*node, "Pa", Range::positive, reading.problems);
      node = nullptr;
    }
    if (!brief && !node) return;
    const Node* place = material.find("spall");
    options.spall_where = (place ? place : material.find("spall_strength"))->where();
    Block block{spall_block(), node, material.place().path + ".spall", material.place(),
                reading.problems};
    if (brief) block.record("strength", number_node(*brief));
    options.spall_strength = brief ? *brief : block.number("strength");
    options.spall_action = block.choice<SpallAction>(
        "action", {{"fail", SpallAction::fail}, {"limit", SpallAction::limit}},
        options.spall_action);
    material.record("spall", block.finish());
  }

  void read_rate() {
    Words<Rate> words;
    for (int i = 0; i < 4; ++i) words.emplace_back(kRateNames[i], static_cast<Rate>(i));
    options.rate = material.choice<Rate>("rate", words, Rate::truesdell);
    if (const Node* node = material.find("rate")) options.rate_where = node->where();
  }

  /// A family whose first law goes without saying: `viscosity: {q_lin: 0.3}`, its parameters stand
  /// in the block itself.
  std::optional<LawChoice> read_unnamed(const char* family) {
    const Node* node = material.find_block(family);
    if (!node) return std::nullopt;
    if (node->items.size() == 1 && find_law(family, node->items[0].key) >= 0)
      return read_named(family);
    LawChoice choice;
    choice.name = law_names(family).front();
    choice.law = find_law(family, choice.name);
    material.record(family, read_parameters(choice, node, node->path));
    return choice;
  }
};

void check_damage(const MaterialOptions& material, Block& block) {
  if (!material.eos && material.spall_strength)
    block.fail("spall needs an eos: it acts on the pressure");
  if (!material.damage) return;
  const LawInfo* strength = material.strength ? &law_info(*material.strength) : nullptr;
  const LawInfo& damage = law_info(*material.damage);
  if (!damage.needs_flow && (!strength || strength->whole_stress))
    block.fail("damage " + damage.name + " needs a strength whose stress follows from a rate");
  if (!damage.needs_flow && material.coupling == Coupling::rate)
    block.fail("damage " + damage.name +
               " does not grow with plastic strain: coupling rate has nothing to couple");
  if (damage.needs_flow && (!strength || !strength->yields)) {
    std::string known;
    for (const LawInfo& law : catalogue()) {
      if (law.yields) known += (known.empty() ? "" : ", ") + law.name;
    }
    block.fail("damage " + damage.name +
               " grows with plastic strain: it needs a strength that yields (known: " + known +
               ")");
  }
  const MaterialConstants constants{material.density, material.shear_modulus,
                                    material.initial_temperature};
  if (damage.needs_flow && material.coupling == Coupling::rate &&
      !law_degrades(material.damage->law, material.damage->values.data(), constants)) {
    block.fail("damage " + material.damage->name +
               " does not degrade the stress: coupling rate has nothing to couple");
  }
}

/// `heating: energy` with an equation of state that knows its own heat at the start.
void check_heating(const MaterialOptions& material, Block& block) {
  if (!material.heating || !law_info(*material.heating).needs_eos) return;
  if (!material.eos) {
    block.fail("heating " + material.heating->name +
               " takes the temperature from an eos, and there is none; use plastic_work");
    return;
  }
  if (law_info(*material.eos).burns) {
    block.fail("heating energy knows the temperature of products only, not of the unburnt " +
               material.eos->name + "; leave heating out, or use eos jwl, which starts burnt");
    return;
  }
  const MaterialConstants constants{material.density, material.shear_modulus,
                                    material.initial_temperature};
  const std::optional<double> heat =
      thermal_energy_at_start(material.eos->law, material.eos->values.data(), constants);
  const double c_v = material.heating->values.at(0), T = material.initial_temperature;
  if (!heat || std::fabs(c_v * T - *heat) <= 0.01 * *heat) return;
  block.fail("eos " + material.eos->name + " starts with " + rounded(*heat) +
             " J/kg of heat: with c_v = " + rounded(c_v) + " J/(kg K) that is " +
             rounded(*heat / c_v) + " K, not initial_temperature " + rounded(T) +
             " K; set initial_temperature: " + rounded(*heat / c_v) +
             " K, or c_v: " + rounded(*heat / T) + " J/(kg K)");
}

/// A block of density alone is what a rigid body needs.
bool holds_no_law(const MaterialOptions& m) {
  return !m.eos && !m.strength && !m.damage && !m.model && !m.viscosity && !m.heating &&
         !m.spall_strength && m.rate == Rate::truesdell;
}

/// A model stands for strength, pressure and damage: nothing of those may stand beside it.
void check_model(const MaterialOptions& material, Block& block) {
  const LawInfo& model = law_info(*material.model);
  std::string beside;
  for (const auto& [key, given] :
       {std::pair{"strength", material.strength.has_value()},
        {"eos", material.eos.has_value()},
        {"damage", material.damage.has_value()},
        {"spall (spall_strength)", material.spall_strength.has_value()}}) {
    if (given) beside += (beside.empty() ? "" : ", ") + std::string{key};
  }
  if (!beside.empty())
    block.fail("model " + model.name + " gives strength, pressure and damage: remove " + beside);
  if (model.needs_shear_modulus && !(material.shear_modulus > 0))
    block.fail("model " + model.name + " needs shear_modulus, or youngs_modulus and poisson_ratio");
}

void check_combination(MaterialOptions& material, Block& block, Reading& reading) {
  material.bare = holds_no_law(material);
  if (material.bare) return;
  if (material.model) {
    check_model(material, block);
    check_heating(material, block);
    return;
  }
  const LawInfo* strength = material.strength ? &law_info(*material.strength) : nullptr;
  if (strength && strength->whole_stress && material.eos) {
    block.fail("strength " + strength->name + " gives the pressure too: remove eos");
  }
  if (!material.eos && !(strength && strength->whole_stress)) {
    std::string whole;
    for (const LawInfo& law : catalogue()) {
      if (law.whole_stress) whole += (whole.empty() ? "" : ", ") + law.name;
    }
    block.fail("missing key 'eos' (known: " + join(law_names("eos")) + "; only with strength " +
               whole + ", or with a model, there is none)");
  }
  if (strength && strength->needs_shear_modulus && !(material.shear_modulus > 0)) {
    block.fail("strength " + strength->name +
               " needs shear_modulus, or youngs_modulus and poisson_ratio");
  }
  if (material.rate != Rate::truesdell && (!strength || strength->whole_stress)) {
    block.fail("rate needs a strength whose stress follows from a rate");
  }
  check_damage(material, block);
  check_heating(material, block);
  if (strength && strength->name == "johnson_cook" && !material.heating) {
    reading.scene.notes.push_back(block.place().where() +
                                  ": johnson_cook without heating: plastic work does not "
                                  "soften the material");
  }
  if (material.heating && material.heating->name == "plastic_work" &&
      !(strength && strength->yields)) {
    reading.scene.notes.push_back(block.place().where() +
                                  ": heating has no effect without plastic flow");
  }
}

Node read_material(const Node& node, Reading& reading) {
  MaterialOptions material;
  material.name = node.key;
  Block block{material_block(), &node, node.path, node, reading.problems};
  material.where = block.place().where();
  block.find("card");  // already laid under the block
  material.density = block.number("density");
  ElasticConstants constants = read_elastic_constants(block);
  material.shear_modulus = constants.shear;
  material.bulk_modulus = constants.bulk;
  if (constants.shear > 0) block.record("shear_modulus", number_node(constants.shear));
  material.initial_temperature = block.number("initial_temperature");
  LawReader laws{reading, constants, block, material};
  material.eos = laws.read_named("eos");
  material.strength = laws.read_named("strength");
  material.model = laws.read_named("model");
  if (material.model && !reading.problems.any()) take_shear_modulus(material, block, reading);
  laws.read_rate();
  laws.read_spall();
  laws.read_damage();
  material.heating = laws.read_named("heating");
  material.viscosity = laws.read_unnamed("viscosity");
  if (constants.bulk_given && !constants.bulk_used && !reading.problems.any()) {
    block.fail(*node.find("bulk_modulus"),
               "is not used: no law of this material takes its bulk modulus from here");
  }
  Node resolved = block.finish();
  if (!reading.problems.any()) check_combination(material, block, reading);
  reading.scene.materials.push_back(std::move(material));
  return resolved;
}

}  // namespace

Node read_materials(const Node* node, Reading& reading) {
  Node resolved;
  resolved.kind = Node::Kind::map;
  if (!node) return resolved;
  if (node->kind != Node::Kind::map || node->items.empty()) {
    reading.problems.add(node->file, node->line, node->path,
                         "expected a block of named materials, found " + node->kind_name());
    return resolved;
  }
  for (const Node& item : node->items) {
    // A material that cannot be read still has its name: bodies that use it are not to blame.
    if (!check_name(item, reading.problems)) {
      reading.scene.materials.emplace_back().name = item.key;
      continue;
    }
    const std::size_t before = reading.problems.size();
    const CardedMaterial carded = with_card(item, reading.scene.file, reading.problems);
    if (reading.problems.size() > before) {
      // Without its card the block would only seem to lack keys.
      reading.scene.materials.emplace_back().name = item.key;
      continue;
    }
    add_member(resolved, item.key, read_material(carded.block, reading));
    MaterialOptions& material = reading.scene.materials.back();
    material.card = carded.file;
    material.unused = carded.unused;
    material.unsourced = carded.unsourced;
  }
  return resolved;
}

}  // namespace krater::scene
