// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file output/table.hpp
/// A table as text and as HDF5.
#include <string>
#include <vector>

#include "krater/output/results.hpp"

namespace krater::output {

inline constexpr const char* kGauge = "gauge_";  ///< begins the names of files of gauges

/// Writes PATH.csv, all or nothing. Throws OutputError.
void save_csv(const std::string& path, const std::vector<TableColumn>& columns);

/// Writes PATH.csv and PATH.h5, each all or nothing. Throws OutputError.
void save_table(const std::string& path, const std::vector<TableColumn>& columns,
                const TextAttributes& attributes);

}  // namespace krater::output
