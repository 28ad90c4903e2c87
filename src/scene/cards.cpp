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

}  // namespace

Node with_card(const Node& material, const std::string& scene_file, Problems& problems) {
  const Node* card = material.find("card");
  if (!card) return material;
  if (card->kind != Node::Kind::scalar || card->text.empty()) {
    problems.add(card->file, card->line, card->path,
                 "expected the name or path of a card, found " + card->kind_name());
    return material;
  }
  const std::string file = find_card(*card, scene_file, problems);
  if (file.empty()) return material;
  Node whole = read_yaml_file(file, material.path, problems);
  whole.key = material.key;
  if (const Node* nested = whole.find("card")) {
    problems.add(nested->file, nested->line, nested->path, "a card cannot name another card");
  }
  overlay(whole, material);
  return whole;
}

}  // namespace krater::scene
