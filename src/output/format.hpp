// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file output/format.hpp
/// Numbers as text.
#include <array>
#include <cstdio>
#include <string>

namespace krater::output {

/// 17 significant digits: reads back as the same double.
inline std::string exact(double x) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.17g", x);
  return buffer.data();
}

/// Number of a frame in names of files and groups: six digits sort as text.
inline std::string six_digits(int number) {
  std::array<char, 16> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%06d", number);
  return buffer.data();
}

}  // namespace krater::output
