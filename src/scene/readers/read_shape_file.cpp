// SPDX-License-Identifier: GPL-3.0-or-later
// What shapes that are read from files share.
#include <cstdint>
#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>

#include "geometry/surfaces/file_text.hpp"
#include "krater/scene/yaml/units.hpp"
#include "scene/readers/read_shapes.hpp"

namespace krater::scene {

namespace {

/// FNV-1a of all bytes: it tells one version of a file from another, not friend from foe.
std::string checksum_of(const std::string& path) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : file_text(path)) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3ULL;
  }
  return fmt::format("{:016x}", hash);
}

}  // namespace

double read_file_unit(const Node& node, Reading& reading) {
  const std::optional<std::string> word = read_word(node, reading.problems);
  if (!word) return 0;
  Node one = node;
  one.text = "1 " + *word;
  return read_number(one, "m", Range::positive, reading.problems).value_or(0);
}

std::string read_file_path(Block& block, const std::string& name, Reading& reading) {
  namespace fs = std::filesystem;
  const std::string path = (fs::path{reading.scene.file}.parent_path() / name).string();
  // Absolute: resolved.yaml lies elsewhere than the scene.
  std::error_code error;
  block.record("file", string_node(fs::absolute(path, error).lexically_normal().string()));
  const std::string found = checksum_of(path);
  if (const Node* given = block.find("checksum")) {
    const std::optional<std::string> expected = read_word(*given, reading.problems);
    if (expected && *expected != found)
      throw std::invalid_argument(name + " has changed: its checksum is " + found + ", not " +
                                  *expected +
                                  "; take back the file that was meant, or leave out checksum");
  }
  block.record("checksum", string_node(found));
  return path;
}

}  // namespace krater::scene
