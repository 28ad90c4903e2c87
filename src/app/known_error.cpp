// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/known_error.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "krater/app/forecast.hpp"

namespace krater {

namespace {

namespace fs = std::filesystem;

constexpr double kSame = 1e-9;  ///< relative: texts of the same double
constexpr double kCoarser =
    1.3;  ///< three cells against the finest, start of the programs included

struct Band {
  std::string measure;
  double cell = 0, value = 0, uncertainty = 0;
  std::string how, study;
};

bool same(double a, double b) { return std::abs(a - b) <= kSame * std::abs(b); }

/// Of one file, where it is of this scene.
void read_bands(const fs::path& folder, const std::string& scene, std::vector<Band>& bands) {
  std::ifstream file{folder / "uncertainty.tsv"};
  std::string line;
  if (!std::getline(file, line) || line != "# scene " + scene) return;
  while (std::getline(file, line)) {
    std::istringstream words{line};
    Band band;
    std::string cell, value, uncertainty;
    std::getline(words, band.measure, '\t');
    std::getline(words, cell, '\t');
    std::getline(words, value, '\t');
    std::getline(words, uncertainty, '\t');
    std::getline(words, band.how);
    band.cell = std::strtod(cell.c_str(), nullptr);
    band.value = std::strtod(value.c_str(), nullptr);
    band.uncertainty = std::strtod(uncertainty.c_str(), nullptr);
    band.study = folder.string();
    if (!uncertainty.empty()) bands.push_back(std::move(band));
  }
}

fs::path parent(const std::string& path) {
  const fs::path above = fs::path{path}.lexically_normal().parent_path();
  return above.empty() ? fs::path{"."} : above;
}

std::vector<Band> bands_beside(const FinishedRun& run) {
  std::vector<fs::path> places{parent(run.folder), parent(run.scene), fs::path{"."}};
  std::vector<Band> bands;
  std::error_code error;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto end = places.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::find(places.begin(), end, places[i]) != end) continue;
    for (const auto& entry : fs::directory_iterator{places[i], error})
      if (entry.is_directory(error))
        read_bands(entry.path().lexically_normal(), fs::path{run.scene}.filename().string(), bands);
  }
  return bands;
}

}  // namespace

std::vector<std::string> add_known_errors(const FinishedRun& run, Json& summary) {
  const std::vector<Band> bands = bands_beside(run);
  Json& measures = summary["measures"];
  std::vector<std::string> lines;
  int unknown = 0;
  for (std::size_t i = 0; i < measures.keys.size(); ++i) {
    Json& measure = measures.items[i];
    const Json value = measure["value"];
    if (value.kind != Json::Kind::number || !std::isfinite(value.number)) continue;
    const auto band = std::find_if(bands.begin(), bands.end(), [&](const Band& b) {
      return b.measure == measures.keys[i] && same(b.cell, run.cell) && same(b.value, value.number);
    });
    if (band == bands.end()) {
      ++unknown;
      continue;
    }
    measure["uncertainty"] = Json::of(band->uncertainty);
    measure["uncertainty_from"] = Json::of(band->how + "; " + band->study);
    lines.push_back(fmt::format("{} = {:.5g} +- {:.2g} {} ({}; {})", measures.keys[i], value.number,
                                band->uncertainty, measure["unit"].text, band->how, band->study));
  }
  if (unknown == 0) return lines;
  const std::string of =
      fmt::format("uncertainty of {} measure{} unknown: ", unknown, unknown > 1 ? "s" : "");
  lines.push_back(of + (bands.empty()
                            ? fmt::format("krater run {} --accuracy 2% takes {} or more", run.scene,
                                          duration_text(kCoarser * run.seconds))
                            : "what lies in " + bands.front().study +
                                  " is of other cells, or of another state of scene or program"));
  return lines;
}

}  // namespace krater
