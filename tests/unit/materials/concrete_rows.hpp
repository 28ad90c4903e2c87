// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Rows of tests/data/concrete_reference.csv (its header says how they were computed).
#pragma once

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace krater::test {

struct ConcreteRow {
  std::string step;
  std::map<std::string, double> values;
  bool has(const char* column) const { return values.contains(column); }
  double operator[](const char* column) const { return values.at(column); }
};

/// Rows of a model, card and path, in the order of the file; throws where there are none.
inline std::vector<ConcreteRow> concrete_rows(const std::string& model, const std::string& card,
                                              const std::string& path) {
  std::ifstream file{std::string{KRATER_SOURCE_DIR} + "/tests/data/concrete_reference.csv"};
  const auto split = [](const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream text{line + ","};
    for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
    return cells;
  };
  std::vector<std::string> names;
  std::vector<ConcreteRow> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    const std::vector<std::string> cells = split(line);
    if (names.empty()) {
      names = cells;
      continue;
    }
    if (cells.at(0) != model || cells.at(1) != card || cells.at(2) != path) continue;
    ConcreteRow row{cells.at(3), {}};
    for (std::size_t i = 4; i < cells.size() && i < names.size(); ++i)
      if (!cells[i].empty()) row.values[names[i]] = std::strtod(cells[i].c_str(), nullptr);
    rows.push_back(row);
  }
  if (rows.empty()) throw std::runtime_error{"no rows of " + model + ", " + card + ", " + path};
  return rows;
}

}  // namespace krater::test
