// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/table.hpp"

#include <stdexcept>

#include "output/atomic_file.hpp"
#include "output/format.hpp"
#include "output/hdf5_file.hpp"

namespace krater::output {

namespace {

std::string as_csv(const std::vector<TableColumn>& columns) {
  std::string text;
  for (const TableColumn& c : columns)
    text += (text.empty() ? "" : ",") + c.name + (c.unit.empty() ? "" : " [" + c.unit + "]");
  text += "\n";
  const std::size_t rows = columns.empty() ? 0 : columns.front().values.size();
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t k = 0; k < columns.size(); ++k)
      text += (k == 0 ? "" : ",") + exact(columns[k].values[row]);
    text += "\n";
  }
  return text;
}

void require_table(const std::vector<TableColumn>& columns) {
  for (const TableColumn& c : columns)
    if (c.values.size() != columns.front().values.size())
      throw std::invalid_argument("table: column '" + c.name + "' has another length");
}

}  // namespace

void save_csv(const std::string& path, const std::vector<TableColumn>& columns) {
  require_table(columns);
  replace_file(path + ".csv", as_csv(columns));
}

void save_table(const std::string& path, const std::vector<TableColumn>& columns,
                const TextAttributes& attributes) {
  save_csv(path, columns);
  std::vector<std::string> names;
  for (const TableColumn& c : columns) names.push_back(c.name);
  MemoryFile file(path + ".h5");
  file.set(attributes);
  file.set("columns", names);
  for (const TableColumn& c : columns) {
    const Node dataset = file.make_dataset(c.name, {c.values.size()}, c.values.data());
    dataset.set("unit", c.unit);
    dataset.set("meaning", c.meaning);
  }
  file.save();
}

}  // namespace krater::output
