// SPDX-License-Identifier: GPL-3.0-or-later
// DIR/influence.tsv, as `krater study` of kind ablation writes it (tools/krater_study/results.py):
//   # scene NAME 0.000381
//   materials.copper.heating <tab> 1.2 <tab> foot_diameter <tab> keep
// paths that were changed together, joined by blanks; the greatest change in %, or `all` of a
// measure that has no value then; of which measure; advice.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "krater/app/effects.hpp"

namespace krater {

namespace {

namespace fs = std::filesystem;

/// What a file says of an effect.
void take_influence(std::istream& file, Effect& effect) {
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words{line};
    std::string paths, change, measure, verdict;
    std::getline(words, paths, '\t');
    std::getline(words, change, '\t');
    std::getline(words, measure, '\t');
    std::getline(words, verdict);
    if ((" " + paths + " ").find(" " + effect.key + " ") == std::string::npos) continue;
    const bool together = paths.find(' ') != std::string::npos;
    effect.influence = fmt::format("{}{} of {}{}", change, change == "all" ? "" : " %", measure,
                                   together ? ", with others" : "");
    effect.word = verdict;
    return;
  }
}

/// The newest ablation of a scene of this name in the folders beside it, the results and here.
fs::path newest(const Scene& scene, const std::string& results) {
  const auto parent = [](const std::string& path) {
    const fs::path above = fs::path{path}.lexically_normal().parent_path();
    return above.empty() ? fs::path{"."} : above;
  };
  std::vector<fs::path> places{parent(scene.file), fs::path{"."}};
  if (!results.empty()) places.push_back(parent(results));
  fs::path found;
  fs::file_time_type when{};
  std::error_code error;
  for (const fs::path& place : places)
    for (const auto& entry : fs::directory_iterator{place, error}) {
      const fs::path path = entry.path() / "influence.tsv";
      std::ifstream file{path};
      std::string mark, word, name;
      if (!(file >> mark >> word >> name) || name != fs::path{scene.file}.filename()) continue;
      const auto time = fs::last_write_time(path, error);
      if (!found.empty() && time <= when) continue;
      found = path;
      when = time;
    }
  return found;
}

}  // namespace

void add_influence(const Scene& scene, const std::string& results, std::vector<Effect>& effects) {
  const fs::path path = newest(scene, results);
  if (path.empty()) return;
  std::ifstream head{path};
  std::string mark, word, name;
  double cell = 0;
  head >> mark >> word >> name >> cell;
  std::error_code error;
  const bool old = fs::last_write_time(scene.file, error) > fs::last_write_time(path, error);
  for (Effect& effect : effects) {
    std::ifstream file{path};
    take_influence(file, effect);
    if (effect.influence.empty()) continue;
    if (old) effect.influence += ", scene changed since";
    if (std::abs(cell / scene.grid.cell - 1) > 1e-6)
      effect.influence += fmt::format(", at {:g} m", cell);
  }
}

}  // namespace krater
