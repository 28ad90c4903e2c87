// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/cards.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "krater/core/errors.hpp"
#include "scene/problems.hpp"

namespace krater::scene {

namespace {

namespace fs = std::filesystem;

/// Folders that may hold cards by name, nearest first.
std::vector<fs::path> card_folders(const fs::path& scene_folder) {
  std::vector<fs::path> folders;
  const auto add = [&](const fs::path& folder) {
    std::error_code error;
    if (!fs::is_directory(folder, error)) return;
    if (std::find(folders.begin(), folders.end(), folder) == folders.end())
      folders.push_back(folder);
  };
  std::error_code error;
  // Spelt as the user spelt it where possible: these paths appear in messages.
  add(scene_folder / "materials");
  fs::path above = fs::absolute(scene_folder, error).lexically_normal();
  if (error) return folders;
  while (true) {
    add(above / "inputs" / "materials");
    if (above == above.parent_path() || above.empty()) break;
    above = above.parent_path();
  }
  add(fs::path{"inputs"} / "materials");
  return folders;
}

std::vector<std::string> cards_in(const std::vector<fs::path>& folders) {
  std::vector<std::string> names;
  for (const fs::path& folder : folders) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator{folder, error}) {
      if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
    }
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

/// The card's file, or "" after a problem.
std::string find_card(const Node& card, const std::string& scene_file, Problems& problems) {
  const fs::path folder = fs::path{scene_file}.parent_path();
  const bool is_path = card.text.find('/') != std::string::npos || card.text.ends_with(".yaml");
  std::error_code error;
  if (is_path) {
    const fs::path file = folder / card.text;
    if (fs::is_regular_file(file, error)) return file.string();
    problems.add(card.file, card.line, card.path, "no such file: " + quote(file.string()));
    return "";
  }
  const std::vector<fs::path> folders = card_folders(folder);
  for (const fs::path& place : folders) {
    const fs::path file = place / (card.text + ".yaml");
    if (fs::is_regular_file(file, error)) return file.string();
  }
  problems.add(card.file, card.line, card.path,
               "no card " + quote(card.text) + suggestion(card.text, cards_in(folders)));
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

/// Names of the cards that hold a key.
std::vector<std::string> cards_with(const std::string& key, const fs::path& scene_folder) {
  std::vector<std::string> names;
  for (const fs::path& folder : card_folders(scene_folder)) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator{folder, error}) {
      if (entry.path().extension() != ".yaml") continue;
      Problems ignored;
      try {
        if (read_yaml_file(entry.path().string(), "", ignored).find(key) != nullptr)
          names.push_back(entry.path().stem().string());
      } catch (const InputError&) {
        continue;  // not a card
      }
    }
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

/// `key: card` where the card, if there is one, has no such key.
void report_not_in_card(const Node& asked, const std::string& key, const std::string& card,
                        const std::string& scene_file, Problems& problems) {
  std::string known;
  for (const std::string& name : cards_with(key, fs::path{scene_file}.parent_path()))
    known += (known.empty() ? "" : ", ") + name;
  problems.add(asked.file, asked.line, asked.path,
               (card.empty() ? "'card' takes it from the material's card, and there is none (card: "
                               "NAME)"
                             : "the card " + quote(card) + " has no " + key) +
                   "; spell it out here" + (known.empty() ? "" : "; cards that have it: " + known));
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
  if (!card) return {material, {}};
  if (card->kind != Node::Kind::scalar || card->text.empty()) {
    problems.add(card->file, card->line, card->path,
                 "expected the name or path of a card, found " + card->kind_name());
    return {material, {}};
  }
  const std::string file = find_card(*card, scene_file, problems);
  if (file.empty()) return {material, {}};
  CardedMaterial result{read_yaml_file(file, material.path, problems), {}};
  Node& whole = result.block;
  whole.key = material.key;
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
  overlay(whole, own);
  return result;
}

}  // namespace krater::scene
