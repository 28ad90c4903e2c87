// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/history.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "krater/core/errors.hpp"
#include "output/format.hpp"
#include "output/hdf5_file.hpp"

namespace krater::output {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (;;) {
    const std::size_t end = line.find(',', begin);
    parts.push_back(line.substr(begin, end - begin));
    if (end == std::string::npos) return parts;
    begin = end + 1;
  }
}

/// `time [s]` -> time, s.
Quantity read_column(const std::string& title) {
  const std::size_t bracket = title.rfind(" [");
  if (bracket == std::string::npos || !title.ends_with(']')) return {title, "", 0};
  return {title.substr(0, bracket), title.substr(bracket + 2, title.size() - bracket - 3), 0};
}

/// The numbers of a line; empty when it is not one number per column.
std::vector<double> read_row(const std::string& line, std::size_t columns) {
  std::vector<double> row;
  for (const auto& part : split(line)) {
    char* end = nullptr;
    row.push_back(std::strtod(part.c_str(), &end));
    if (part.empty() || *end != '\0') return {};
  }
  return row.size() == columns ? row : std::vector<double>{};
}

bool same_columns(const std::vector<Quantity>& a, const std::vector<Quantity>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.name == y.name && x.unit == y.unit;
  });
}

/// The file has no quoting, so a title must not need any.
void require_usable(const std::vector<Quantity>& row) {
  for (const auto& column : row) {
    const std::string title = column.name + column.unit;
    if (column.name.empty() || title.find_first_of(",\"[]\r\n") != std::string::npos) {
      throw std::invalid_argument("history: unusable column '" + column.name + "'");
    }
  }
}

void save_series(const Node& group, const std::vector<SeriesTable>& series) {
  for (const SeriesTable& s : series) {
    const Node gauge = group.make_group(s.name);
    gauge.set(s.texts);
    for (const auto& [name, value] : s.numbers) gauge.set(name, value);
    std::vector<std::string> names;
    for (const TableColumn& c : s.columns) {
      const Node dataset = gauge.make_dataset(c.name, {c.values.size()}, c.values.data());
      dataset.set("unit", c.unit);
      dataset.set("meaning", c.meaning);
      names.push_back(c.name);
    }
    gauge.set("columns", names);
  }
}

}  // namespace

void History::remove_all() {
  for (const char* name : {"history.csv", "history.h5"}) {
    for (const char* suffix : {"", kPartSuffix}) {
      std::error_code error;
      const std::string path = folder_ + "/" + name + suffix;
      std::filesystem::remove(path, error);
      if (error) throw OutputError(path + ": cannot be removed: " + error.message());
    }
  }
}

void History::load() {
  std::ifstream stream(csv(), std::ios::binary);
  if (!stream) return;
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::string content = text.substr(begin, end - begin);
    if (columns_.empty()) {
      for (const auto& title : split(content)) columns_.push_back(read_column(title));
      values_.resize(columns_.size());
      continue;
    }
    const auto row = read_row(content, columns_.size());
    if (row.empty()) {
      throw InputError(csv() + ": not a history of krater: '" + content.substr(0, 60) + "'");
    }
    for (std::size_t k = 0; k < row.size(); ++k) values_[k].push_back(row[k]);
  }
  if (begin != text.size()) rewrite();
  saved_ = false;
}

std::string History::header() const {
  std::string result;
  for (const auto& column : columns_) {
    result += (result.empty() ? "" : ",") + column.name;
    if (!column.unit.empty()) result += " [" + column.unit + "]";
  }
  return result + "\n";
}

std::string History::line(std::size_t row) const {
  std::string result;
  for (const auto& column : values_) result += (result.empty() ? "" : ",") + exact(column[row]);
  return result + "\n";
}

void History::rewrite() {
  appender_.close();
  std::string text = columns_.empty() ? "" : header();
  for (std::size_t row = 0; !values_.empty() && row < values_.front().size(); ++row) {
    text += line(row);
  }
  replace_file(csv(), text);
}

void History::require_columns(const std::vector<Quantity>& row) const {
  if (columns_.empty() || same_columns(columns_, row)) return;
  throw InputError(csv() +
                   ": it has other columns than this run (another order of bodies, or other "
                   "measures) and cannot be continued; choose another folder with -o");
}

void History::truncate_after(double time) {
  if (values_.empty()) return;
  // Counted from the end: times never decrease, and a NaN must not hide the rows after it.
  std::size_t rows = values_.front().size();
  while (rows > 0 && !(values_.front()[rows - 1] <= time)) --rows;
  if (rows == values_.front().size()) return;
  for (auto& column : values_) column.resize(rows);
  rewrite();
  saved_ = false;
}

void History::append(const std::vector<Quantity>& row) {
  if (row.empty()) throw std::invalid_argument("history: a row without columns");
  if (columns_.empty()) {
    require_usable(row);
    columns_ = row;
    values_.resize(row.size());
    rewrite();
  }
  if (!same_columns(columns_, row)) throw std::invalid_argument("history: other columns");
  for (std::size_t k = 0; k < row.size(); ++k) values_[k].push_back(row[k].value);
  saved_ = false;
  if (!appender_.is_open()) appender_.open(csv());
  appender_.append(line(values_.front().size() - 1));
}

void History::set_series(SeriesTable table) {
  const auto at = std::find_if(series_.begin(), series_.end(),
                               [&](const SeriesTable& s) { return s.name == table.name; });
  if (at == series_.end())
    series_.push_back(std::move(table));
  else
    *at = std::move(table);
  saved_ = false;
}

void History::save_copy(const TextAttributes& attributes) {
  if (saved_) return;
  MemoryFile file(folder_ + "/history.h5");
  file.set(attributes);
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    const Node dataset =
        file.make_dataset(columns_[k].name, {values_[k].size()}, values_[k].data());
    dataset.set("unit", columns_[k].unit);
  }
  if (!series_.empty()) save_series(file.make_group(kGauges), series_);
  file.save();
  saved_ = true;
}

}  // namespace krater::output
