// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/yaml/cards.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "krater/core/errors.hpp"
#include "krater/core/program.hpp"
#include "krater/materials/catalogue.hpp"
#include "krater/scene/scene.hpp"
#include "scene/yaml/keyword_card.hpp"
#include "scene/yaml/problems.hpp"

namespace krater::scene {

namespace {

namespace fs = std::filesystem;

/// The folder of cards that was installed, or built, with the program; "" where the system does not
/// tell where the program lies.
fs::path installed_cards() {
  std::error_code error;
  const fs::path program = program_path();
  if (program.empty()) return {};
  const fs::path built = program.parent_path() / "materials";  // a link to those of the sources
  const fs::path installed = program.parent_path() / KRATER_INSTALLED_CARDS;
  return (fs::is_directory(installed, error) ? installed : built).lexically_normal();
}

/// Folders of $KRATER_CARDS, separated by colons as those of $PATH are.
std::vector<fs::path> folders_of_environment() {
  std::vector<fs::path> folders;
  const char* value = std::getenv("KRATER_CARDS");
  std::istringstream text{value ? value : ""};
  for (std::string folder; std::getline(text, folder, ':');)
    if (!folder.empty()) folders.emplace_back(folder);
  return folders;
}

/// Folders that may hold cards by name, in the order in which they are tried.
std::vector<fs::path> card_folders(const fs::path& scene_folder) {
  std::vector<fs::path> folders;
  const auto add = [&](const fs::path& folder) {
    std::error_code error;
    if (folder.empty() || !fs::is_directory(folder, error)) return;
    if (std::find(folders.begin(), folders.end(), folder) == folders.end())
      folders.push_back(folder);
  };
  // Spelt as the user spelt it where possible: these paths appear in messages.
  add(scene_folder);
  add(scene_folder / "materials");
  for (const fs::path& folder : folders_of_environment()) add(folder);
  std::error_code error;
  fs::path above = fs::absolute(scene_folder, error).lexically_normal();
  while (!error && !above.empty()) {
    add(above / "materials");
    add(above / "inputs" / "materials");
    if (above == above.parent_path()) break;
    above = above.parent_path();
  }
  add(fs::path{"inputs"} / "materials");
  add(installed_cards());
  return folders;
}

/// Where cards are looked for, for a message.
std::string places_searched(const fs::path& scene_folder) {
  const char* environment = std::getenv("KRATER_CARDS");
  const std::string own = scene_folder.string();
  const fs::path installed = installed_cards();
  return "looked in " + own + " and " + (scene_folder / "materials").string() +
         ", $KRATER_CARDS (" + (environment && *environment ? environment : "not set") +
         "), materials and inputs/materials of the scene's folder and of every folder above it" +
         (installed.empty() ? "" : ", and the installation (" + installed.string() + ")");
}

/// Files of a folder that end in .yaml, their names without it.
std::vector<fs::path> yaml_files(const std::vector<fs::path>& folders) {
  std::vector<fs::path> files;
  for (const fs::path& folder : folders) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator{folder, error})
      if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  return files;
}

bool is_scene(const Node& tree) {
  return tree.find("bodies") != nullptr || tree.find("point") != nullptr;
}

/// A file's tree; null kind where it cannot be read.
Node try_to_read(const fs::path& file) {
  Problems ignored;
  try {
    return read_yaml_file(file.string(), "", ignored);
  } catch (const InputError&) {
    return {};
  }
}

/// Names of the cards in these folders that hold a key; of all of them without one.
std::vector<std::string> cards_in(const std::vector<fs::path>& folders,
                                  const std::string& key = "density") {
  std::vector<std::string> names;
  for (const fs::path& file : yaml_files(folders)) {
    const Node tree = try_to_read(file);
    if (!is_scene(tree) && tree.find(key) != nullptr) names.push_back(file.stem().string());
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

/// The scene's folder: of a bare file name the current one.
fs::path folder_of(const std::string& scene_file) {
  const fs::path folder = fs::path{scene_file}.parent_path();
  return folder.empty() ? fs::path{"."} : folder;
}

/// The card's file, or "" after a problem.
std::string find_card(const Node& card, const std::string& scene_file, Problems& problems) {
  const fs::path folder = folder_of(scene_file);
  const bool is_path = card.text.find('/') != std::string::npos;
  std::error_code error;
  const std::string name =
      card.text.ends_with(".yaml") ? card.text.substr(0, card.text.size() - 5) : card.text;
  if (is_path) {
    for (const fs::path& file : {folder / card.text, folder / (name + ".yaml")})
      if (fs::is_regular_file(file, error)) return file.string();
    problems.add(card.file, card.line, card.path,
                 "no such file: '" + (folder / card.text).string() +
                     "' (a path of a card is relative to the scene's folder)" +
                     suggestion(fs::path{name}.filename().string(),
                                cards_in({(folder / card.text).parent_path()})));
    return "";
  }
  const std::vector<fs::path> folders = card_folders(folder);
  for (const fs::path& place : folders) {
    const fs::path file = place / (name + ".yaml");
    // A scene may be called like its material: it is not a card.
    if (fs::is_regular_file(file, error) && !is_scene(try_to_read(file))) return file.string();
  }
  problems.add(card.file, card.line, card.path,
               "no card " + quote(card.text) + suggestion(name, cards_in(folders)) + "; " +
                   places_searched(folder));
  return "";
}

/// Keys of a card that count only where the scene asks for them.
constexpr const char* kOnRequest[] = {"damage", "spall_strength"};

bool takes_card(const Node* node) {
  return node != nullptr && node->kind == Node::Kind::scalar && node->text == "card";
}

void erase_member(Node& map, const std::string& key) {
  std::erase_if(map.items, [&](const Node& item) { return item.key == key; });
}

/// `key: card` where the card, if there is one, has no such key.
void report_not_in_card(const Node& asked, const std::string& key, const std::string& card,
                        const std::string& scene_file, Problems& problems) {
  const std::string known = join(cards_in(card_folders(folder_of(scene_file)), key));
  problems.add(asked.file, asked.line, asked.path,
               (card.empty() ? "'card' takes it from the material's card, and there is none (card: "
                               "NAME)"
                             : "the card " + quote(card) + " has no " + key) +
                   "; spell it out here" + (known.empty() ? "" : "; cards that have it: " + known));
}

/// The law that a block of damage names: its only member beside the settings that stand beside it.
const Node* law_of(const Node& damage) {
  for (const Node& item : damage.items)
    if (!is_damage_setting(item.key)) return &item;
  return nullptr;
}

/// Both Johnson-Cook laws have one fracture strain, and a card holds it under one of their names.
/// Naming the other keeps the card's constants that both know; any other law replaces the card's.
void share_fracture_strain(Node& card, const Node& own) {
  Node* damage = card.find("damage");
  const Node* asked = own.find("damage");
  const Node* law = damage ? law_of(*damage) : nullptr;
  const Node* other = asked ? law_of(*asked) : nullptr;
  const auto johnson_cook = [](const Node* n) {
    return n && (n->key == "johnson_cook" || n->key == "johnson_cook_uncoupled");
  };
  if (!johnson_cook(law) || !johnson_cook(other) || law->key == other->key) return;
  const LawInfo& info = catalogue()[static_cast<std::size_t>(find_law("damage", other->key))];
  Node& kept = *damage->find(law->key);
  std::erase_if(kept.items, [&](const Node& item) {
    return std::none_of(info.parameters.begin(), info.parameters.end(), [&](const auto& p) {
      return item.key == p.key || (p.alias && item.key == p.alias);
    });
  });
  kept.key = other->key;
}

/// Some value in the block comes from this file.
bool holds_value_of(const Node& node, const std::string& file) {
  if (node.items.empty()) return node.file == file;
  return std::any_of(node.items.begin(), node.items.end(),
                     [&](const Node& item) { return holds_value_of(item, file); });
}

const Node* find_path(const Node& map, const std::string& path) {
  const Node* node = &map;
  std::istringstream steps{path};
  for (std::string step; node && std::getline(steps, step, '.');) node = node->find(step);
  return node;
}

/// Takes the list `unsourced` out of a card.
std::vector<std::string> take_unsourced(Node& card, Problems& problems) {
  std::vector<std::string> paths;
  const Node* list = card.find("unsourced");
  if (!list) return paths;
  if (list->kind != Node::Kind::list)
    problems.add(list->file, list->line, list->path, "expected a list of the card's keys");
  for (const Node& item : list->items) {
    if (find_path(card, item.text) == nullptr)
      problems.add(item.file, item.line, item.path, "the card holds no " + quote(item.text));
    paths.push_back(item.text);
  }
  erase_member(card, "unsourced");
  return paths;
}

/// The card of a material, made or read; nothing after a problem.
std::optional<CardedMaterial> card_of(const Node& card, const std::string& path,
                                      const std::string& scene_file, Problems& problems) {
  if (card.kind == Node::Kind::map && card.items.size() == 1 && card.items[0].key == "keywords") {
    const Node& keywords = card.items[0];
    const std::size_t before = problems.size();
    const Node made = keyword_card(keywords, scene_file, problems);
    if (problems.size() > before) return std::nullopt;
    return CardedMaterial{placed(card, path, made), keywords.find("file")->text, {}, {}};
  }
  if (card.kind == Node::Kind::map)
    return CardedMaterial{generated_card(card, path, problems), "generated", {}, {}};
  if (card.kind != Node::Kind::scalar || card.text.empty()) {
    problems.add(card.file, card.line, card.path,
                 "expected the name or path of a card, found " + card.kind_name());
    return std::nullopt;
  }
  const std::string file = find_card(card, scene_file, problems);
  if (file.empty()) return std::nullopt;
  return CardedMaterial{read_yaml_file(file, path, problems), file, {}, {}};
}

}  // namespace

CardedMaterial with_card(const Node& material, const std::string& scene_file, Problems& problems) {
  const Node* card = material.find("card");
  Node own = material;
  for (const char* key : kOnRequest) {
    const Node* asked = material.find(key);
    if (card == nullptr && takes_card(asked))
      report_not_in_card(*asked, key, "", scene_file, problems);
  }
  if (!card) return {material, "", {}, {}};
  std::optional<CardedMaterial> read = card_of(*card, material.path, scene_file, problems);
  if (!read) return {material, "", {}, {}};
  CardedMaterial result = *std::move(read);
  Node& whole = result.block;
  const std::string file = result.file;
  whole.key = material.key;
  const std::vector<std::string> unsourced = take_unsourced(whole, problems);
  if (const Node* nested = whole.find("card")) {
    problems.add(nested->file, nested->line, nested->path, "a card cannot name another card");
  }
  for (const char* key : kOnRequest) {
    const Node* asked = material.find(key);
    const bool offered = whole.find(key) != nullptr;
    if (takes_card(asked)) {
      if (!offered) report_not_in_card(*asked, key, card->text, scene_file, problems);
      erase_member(own, key);
    } else if (asked == nullptr && offered) {
      result.unused.emplace_back(key);
      erase_member(whole, key);
    }
  }
  share_fracture_strain(whole, own);
  overlay(whole, own);
  for (const std::string& path : unsourced) {
    const Node* node = find_path(whole, path);
    if (node && holds_value_of(*node, file)) result.unsourced.push_back(path);
  }
  return result;
}

CardSummary read_card(const std::string& name) {
  Problems problems;
  Node card;
  card.kind = Node::Kind::scalar;
  card.text = name;
  card.path = "krater models";
  CardSummary out;
  out.file = find_card(card, "", problems);
  problems.throw_if_any();
  Node tree = read_yaml_file(out.file, "", problems);
  out.unsourced = take_unsourced(tree, problems);
  problems.throw_if_any();
  out.yaml = to_yaml(tree);
  return out;
}

std::vector<std::string> known_cards() { return cards_in(card_folders(folder_of(""))); }

}  // namespace krater::scene
