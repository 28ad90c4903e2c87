// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file output/history.hpp
/// The time series of a run: history.csv grows by whole lines, history.h5 is its copy at every
/// flush, and holds the gauges too.
#include <string>
#include <vector>

#include "krater/output/results.hpp"
#include "output/atomic_file.hpp"

namespace krater::output {

inline constexpr const char* kGauges = "gauges";  ///< the group of series in history.h5

class History {
 public:
  explicit History(std::string folder) : folder_(std::move(folder)) {}

  void remove_all();
  void load();  ///< rows of an earlier run that is continued; half a last line is dropped
  void require_columns(const std::vector<Quantity>& row) const;  ///< throws InputError: others
  void truncate_after(double time);
  void append(const std::vector<Quantity>& row);
  /// Joins history.h5 as the group gauges/NAME, in place of an earlier one of the name.
  void set_series(SeriesTable table);
  void save_copy(const TextAttributes& attributes);  ///< history.h5, when there is something new

 private:
  std::string csv() const { return folder_ + "/history.csv"; }
  std::string header() const;
  std::string line(std::size_t row) const;
  void rewrite();
  std::string folder_;
  std::vector<Quantity> columns_;            ///< names and units; the first is time
  std::vector<std::vector<double>> values_;  ///< by column
  std::vector<SeriesTable> series_;
  LineAppender appender_;
  bool saved_ = true;
};

}  // namespace krater::output
