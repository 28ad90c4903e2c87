// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surfaces/file_text.hpp"

#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace krater {

namespace {

constexpr std::uintmax_t most_bytes = 8ULL << 30;

}  // namespace

std::string file_text(const std::string& file) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::exists(file, error)) throw std::invalid_argument(file + ": no such file");
  if (!fs::is_regular_file(file, error)) throw std::invalid_argument(file + ": not a plain file");
  const std::uintmax_t size = fs::file_size(file, error);
  if (error || size > most_bytes) {
    throw std::invalid_argument(file + ": cannot be read, or is larger than 8 GiB");
  }
  std::string data(static_cast<std::size_t>(size), '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(data.data(), static_cast<std::streamsize>(data.size()));
  if (stream.gcount() != static_cast<std::streamsize>(data.size())) {
    throw std::invalid_argument(file + ": cannot be read");
  }
  return data;
}

std::string file_ending(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending.empty() ? ending : ending.substr(1);
}

}  // namespace krater
