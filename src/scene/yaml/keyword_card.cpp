// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/yaml/keyword_card.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "krater/scene/yaml/units.hpp"
#include "scene/declarations/declarations.hpp"
#include "scene/yaml/block.hpp"

namespace krater::scene {

namespace {

constexpr std::size_t kColumns = 10, kPerRow = 8;

/// One keyword of the file: the numbers of its rows by the name of their field.
struct Keyword {
  std::string name;
  int line = 0;
  std::map<std::string, double> values;
};

struct Layout {
  const char* name;    ///< without _TITLE and number
  const char* number;  ///< its other spelling
  std::vector<std::vector<const char*>> rows;
};

const std::vector<Layout>& layouts() {
  static const std::vector<Layout> known{
      {"*MAT_JOHNSON_COOK",
       "*MAT_015",
       {{"MID", "RO", "G", "E", "PR", "DTF", "VP", "RATEOP"},
        {"A", "B", "N", "C", "M", "TM", "TR", "EPSO"},
        {"CP", "PC", "SPALL", "IT", "D1", "D2", "D3", "D4"},
        {"D5", "C2", "EROD", "EFMIN", "NUMINT", "K", "D", "SPARE"}}},
      {"*MAT_SIMPLIFIED_JOHNSON_COOK",
       "*MAT_098",
       {{"MID", "RO", "E", "PR", "VP", "SPARE"},
        {"A", "B", "N", "C", "PSFAIL", "SIGMAX", "SIGSAT", "EPSO"}}},
      {"*MAT_HIGH_EXPLOSIVE_BURN",
       "*MAT_008",
       {{"MID", "RO", "D", "PCJ", "BETA", "K", "G", "SIGY"}}},
      {"*EOS_GRUNEISEN",
       "*EOS_004",
       {{"EOSID", "C", "S1", "S2", "S3", "GAMAO", "A", "E0"}, {"V0"}}},
      {"*EOS_JWL", "*EOS_002", {{"EOSID", "A", "B", "R1", "R2", "OMEG", "E0", "V0"}}}};
  return known;
}

std::string known_keywords() {
  std::string names;
  for (const Layout& layout : layouts())
    names += (names.empty() ? "" : ", ") + std::string{layout.name};
  return names;
}

std::string trimmed(std::string text) {
  const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!text.empty() && blank(text.back())) text.pop_back();
  while (!text.empty() && blank(text.front())) text.erase(text.begin());
  return text;
}

/// Fields of one row: parted by commas, or ten columns each.
std::vector<std::string> fields_of(const std::string& row) {
  std::vector<std::string> fields;
  if (row.find(',') != std::string::npos) {
    std::istringstream parts{row};
    for (std::string part; std::getline(parts, part, ',');) fields.push_back(trimmed(part));
    return fields;
  }
  for (std::size_t k = 0; k < kPerRow && k * kColumns < row.size(); ++k)
    fields.push_back(trimmed(row.substr(k * kColumns, kColumns)));
  return fields;
}

/// Fortran's numbers too: `.5`, `2.8D-3`, `1.2+3`.
std::optional<double> fortran_number(std::string text) {
  for (char& c : text)
    if (c == 'd' || c == 'D') c = 'e';
  for (std::size_t i = 1; i < text.size(); ++i)
    if ((text[i] == '+' || text[i] == '-') && text[i - 1] != 'e' && text[i - 1] != 'E') {
      text.insert(i, "e");
      break;
    }
  const QuantityText number = parse_quantity(text, "1");
  return number.problem.empty() ? std::optional{number.value} : std::nullopt;
}

class KeywordFile {
 public:
  KeywordFile(std::string path, Problems& problems) : path_{std::move(path)}, problems_{problems} {}

  std::vector<Keyword> read() {
    std::ifstream file{path_};
    std::vector<Keyword> found;
    const Layout* layout = nullptr;
    std::size_t row = 0;
    bool title = false;
    int number = 0;
    for (std::string line; std::getline(file, line);) {
      ++number;
      while (!line.empty() && line.back() == '\r') line.pop_back();
      if (line.empty() || line[0] == '$') continue;
      if (line[0] == '*') {
        layout = start(line, number, title);
        row = 0;
        if (layout) found.push_back({layout->name, number, {}});
        continue;
      }
      if (!layout) continue;
      if (std::exchange(title, false)) continue;
      if (row < layout->rows.size()) take(line, number, layout->rows[row], found.back());
      ++row;
    }
    return found;
  }

 private:
  void fail(int line, const std::string& message) { problems_.add(path_, line, "", message); }

  /// The layout of a keyword, null for one that frames a file; others are refused.
  const Layout* start(const std::string& line, int number, bool& title) {
    std::string word = trimmed(line);
    for (char& c : word) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    title = word.ends_with("_TITLE");
    if (title) word.resize(word.size() - 6);
    for (const Layout& layout : layouts())
      if (word == layout.name || word == layout.number) return &layout;
    if (word != "*KEYWORD" && word != "*END" && word != "*COMMENT" && word != "*TITLE")
      fail(number, "the keyword " + quote(word) + " is not understood (known: " + known_keywords() +
                       "); take the cards of one material into a file of their own");
    return nullptr;
  }

  void take(const std::string& line, int number, const std::vector<const char*>& names,
            Keyword& into) {
    const std::vector<std::string> fields = fields_of(line);
    for (std::size_t k = 0; k < fields.size() && k < names.size(); ++k) {
      if (fields[k].empty()) continue;
      const std::string name = names[k];
      if (name == "MID" || name == "EOSID") continue;  // a label may be a word
      if (const auto value = fortran_number(fields[k]))
        into.values[name] = *value;
      else
        fail(number, into.name + ": " + name + " is no number: " + quote(fields[k]) +
                         " (parameters of a deck must be filled in)");
    }
  }

  std::string path_;
  Problems& problems_;
};

/// Factors to SI.
struct UnitFactors {
  double mass = 1, length = 1, time = 1;
  double density() const { return mass / (length * length * length); }
  double pressure() const { return mass / (length * time * time); }
  double velocity() const { return length / time; }
};

/// `units: [g, mm, ms]`.
std::optional<UnitFactors> read_units(const Node* node, Block& block) {
  if (!node) return std::nullopt;
  constexpr std::array kUnits{"kg", "m", "s"};
  std::array<double, 3> out{};
  if (node->kind != Node::Kind::list || node->items.size() != 3) {
    block.fail(*node,
               "expected the units of mass, length and time, as [g, mm, ms] or [ton, mm, s]");
    return std::nullopt;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string word = node->items[k].text == "ton" ? "t" : node->items[k].text;
    const QuantityText read = parse_quantity("1 " + word, kUnits[k]);
    if (!read.problem.empty()) {
      block.fail(node->items[k], read.problem);
      return std::nullopt;
    }
    out[k] = read.value;
  }
  return UnitFactors{out[0], out[1], out[2]};
}

/// Builds a material's block out of keywords.
class Conversion {
 public:
  Conversion(const UnitFactors& units, std::string path, Problems& problems)
      : u_{units}, path_{std::move(path)}, problems_{problems} {}

  Node convert(const std::vector<Keyword>& found) {
    made_.kind = Node::Kind::map;
    const Keyword* burn = nullptr;
    for (const Keyword& k : found)
      if (k.name == "*MAT_HIGH_EXPLOSIVE_BURN") burn = &k;
    int materials = 0;
    for (const Keyword& k : found) {
      materials += k.name.starts_with("*MAT") ? 1 : 0;
      if (k.name == "*MAT_JOHNSON_COOK") johnson_cook(k);
      if (k.name == "*MAT_SIMPLIFIED_JOHNSON_COOK") simplified(k);
      if (k.name == "*MAT_HIGH_EXPLOSIVE_BURN") set(made_, "density", u_.density() * need(k, "RO"));
      if (k.name == "*EOS_GRUNEISEN") gruneisen(k);
      if (k.name == "*EOS_JWL") jwl(k, burn);
    }
    if (materials > 1)
      problems_.add(path_, 0, "",
                    "holds several materials; take one of them into a file of its own");
    if (materials == 0 && made_.items.empty())
      problems_.add(path_, 0, "",
                    "holds no material that is understood (known: " + known_keywords() + ")");
    return made_;
  }

 private:
  static double get(const Keyword& k, const char* name, double otherwise = 0) {
    const auto at = k.values.find(name);
    return at == k.values.end() ? otherwise : at->second;
  }
  double need(const Keyword& k, const char* name) {
    if (k.values.count(name) == 0)
      problems_.add(path_, k.line, "", k.name + ": " + name + " is missing");
    return get(k, name, 1);
  }
  /// A value of what no law here knows.
  void refuse(const Keyword& k, const char* name, const std::string& why) {
    if (get(k, name) != 0)
      problems_.add(path_, k.line, "",
                    k.name + ": " + name + " = " + number_text(get(k, name)) + ": " + why);
  }
  static void set(Node& map, const std::string& key, double value) {
    map.kind = Node::Kind::map;
    add_member(map, key, number_node(value));
  }
  void put(const char* family, const char* law, const Node& values) {
    Node block;
    block.kind = Node::Kind::map;
    add_member(block, law, values);
    add_member(made_, family, block);
  }

  void elastic(const Keyword& k) {
    set(made_, "density", u_.density() * need(k, "RO"));
    if (get(k, "G") > 0) return set(made_, "shear_modulus", u_.pressure() * get(k, "G"));
    const double E = need(k, "E"), nu = need(k, "PR");
    set(made_, "shear_modulus", u_.pressure() * E / (2 * (1 + nu)));
  }

  Node flow(const Keyword& k) {
    Node law;
    for (const auto& [key, name] : {std::pair{"A", "A"}, {"B", "B"}})
      set(law, key, u_.pressure() * need(k, name));
    set(law, "n", need(k, "N"));
    set(law, "C", get(k, "C"));
    set(law, "epsdot0", get(k, "EPSO", 1) / u_.time);
    return law;
  }

  void johnson_cook(const Keyword& k) {
    refuse(k, "RATEOP", "only the logarithmic form of the rate is understood");
    elastic(k);
    Node law = flow(k);
    set(law, "m", need(k, "M"));
    set(law, "T_ref", need(k, "TR"));
    set(law, "T_melt", need(k, "TM"));
    put("strength", "johnson_cook", law);
    set(made_, "initial_temperature", need(k, "TR"));
    Node heating;
    set(heating, "cp", u_.velocity() * u_.velocity() * need(k, "CP"));
    put("heating", "plastic_work", heating);
    if (get(k, "PC") < 0) set(made_, "spall_strength", -u_.pressure() * get(k, "PC"));
    if (get(k, "D1") == 0 && get(k, "D2") == 0) return;
    Node damage;
    for (const char* name : {"D1", "D2", "D3", "D4", "D5"}) set(damage, name, get(k, name));
    set(damage, "epsdot0", get(k, "EPSO", 1) / u_.time);
    set(damage, "T_ref", need(k, "TR"));
    set(damage, "T_melt", need(k, "TM"));
    if (get(k, "EFMIN") > 0) set(damage, "eps_f_min", get(k, "EFMIN"));
    put("damage", "johnson_cook", damage);
  }

  /// Without heat: the temperature's factor is 1 as long as nothing heats.
  void simplified(const Keyword& k) {
    refuse(k, "SIGMAX", "a limit of the stress is not understood");
    refuse(k, "SIGSAT", "a limit of the stress is not understood");
    elastic(k);
    Node law = flow(k);
    for (const auto& [key, value] : {std::pair{"m", 1.0}, {"T_ref", 293.0}, {"T_melt", 1e6}})
      set(law, key, value);
    put("strength", "johnson_cook", law);
    if (!(get(k, "PSFAIL") > 0) || get(k, "PSFAIL") > 1e15) return;
    Node damage;
    set(damage, "eps_max", get(k, "PSFAIL"));
    put("damage", "maximum_plastic_strain", damage);
  }

  void gruneisen(const Keyword& k) {
    for (const char* name : {"S2", "S3", "A", "E0"})
      refuse(k, name, "only a linear Us-up Hugoniot from rest is understood");
    Node law;
    set(law, "c0", u_.velocity() * need(k, "C"));
    set(law, "S1", need(k, "S1"));
    set(law, "gamma0", need(k, "GAMAO"));
    put("eos", "mie_gruneisen_shock", law);
  }

  /// With *MAT_HIGH_EXPLOSIVE_BURN a front burns it; alone it is burnt from the start.
  void jwl(const Keyword& k, const Keyword* burn) {
    Node law;
    for (const auto& [key, name] : {std::pair{"A", "A"}, {"B", "B"}, {"E0", "E0"}})
      set(law, key, u_.pressure() * need(k, name));
    set(law, "R1", need(k, "R1"));
    set(law, "R2", need(k, "R2"));
    set(law, "omega", need(k, "OMEG"));
    if (!burn) return put("eos", "jwl", law);
    set(law, "D", u_.velocity() * need(*burn, "D"));
    set(law, "p_CJ", u_.pressure() * need(*burn, "PCJ"));
    if (get(*burn, "K") > 0) set(law, "bulk_modulus", u_.pressure() * get(*burn, "K"));
    put("eos", "jwl_burn", law);
  }

  UnitFactors u_;
  std::string path_;
  Problems& problems_;
  Node made_;
};

}  // namespace

Node keyword_card(const Node& node, const std::string& scene_file, Problems& problems) {
  Block block{keyword_card_block(), &node, node.path, node, problems};
  Node empty;
  empty.kind = Node::Kind::map;
  const Node* file = block.require("file", "a .k file of LS-DYNA beside the scene");
  const Node* system =
      block.require("units", "of mass, length and time, as [g, mm, ms]: keyword files state none");
  block.finish();
  const std::optional<UnitFactors> units = read_units(system, block);
  if (!file || !units) return empty;
  namespace fs = std::filesystem;
  const std::string path = (fs::path{scene_file}.parent_path() / file->text).string();
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    block.fail(*file,
               "no such file: " + quote(path) + " (a path is relative to the scene's folder)");
    return empty;
  }
  const std::size_t before = problems.size();
  const std::vector<Keyword> found = KeywordFile{path, problems}.read();
  if (problems.size() > before) return empty;
  const Node made = Conversion{*units, path, problems}.convert(found);
  return problems.size() > before ? empty : made;
}

}  // namespace krater::scene
