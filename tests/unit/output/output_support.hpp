// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file unit/output/output_support.hpp
/// A folder that vanishes with the test, and a small frame to write into it.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "krater/output/results.hpp"

namespace krater::test {

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "krater_test_XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

inline std::string read_file(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline void write_file(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

template <class T>
Rows<T> rows_of(std::vector<T> values, int width = 1) {
  return [values = std::move(values), width](std::size_t first, std::size_t count, T* out) {
    const auto w = static_cast<std::size_t>(width);
    for (std::size_t i = 0; i < count * w; ++i) out[i] = values.at(first * w + i);
  };
}

/// Two points of a rod with every kind of field.
inline OutputFrame small_frame(int number, double time) {
  BodyFrame rod;
  rod.body = "rod";
  rod.points = 2;
  rod.ids = rows_of<std::int64_t>({3, 7});
  rod.coordinates = rows_of<double>({1, 0, 2, 3, 0, 4}, 3);
  rod.fields = {
      {"pressure", "Pa", "pressure", 1, {}, rows_of<double>({10, 20})},
      {"velocity", "m/s", "velocity", 3, {"r", "t", "z"}, rows_of<double>({1, 0, 2, 3, 0, 4}, 3)},
      {"stress",
       "Pa",
       "stress",
       6,
       {"xx", "yy", "zz", "yz", "xz", "xy"},
       rows_of<double>({1, 2, 3, 4, 5, 6, 11, 12, 13, 14, 15, 16}, 6)},
      {"affine_velocity",
       "1/s",
       "matrix",
       4,
       {"rr", "rz", "zr", "zz"},
       rows_of<double>({1, 2, 3, 4, 5, 6, 7, 8}, 4)}};
  return {number, time, 100 * number, {rod}};
}

/// The text of the exception that `action` throws, if it is an E; else a text that says so.
template <class E, class Action>
std::string message_of(const Action& action) {
  try {
    action();
  } catch (const E& error) {
    return error.what();
  } catch (const std::exception& error) {
    return std::string("another exception: ") + error.what();
  }
  return "no exception";
}

}  // namespace krater::test
