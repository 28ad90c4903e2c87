// SPDX-License-Identifier: GPL-3.0-or-later
// A small valid scene to bend, and files that disappear with the test.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "krater/scene/scene.hpp"

namespace krater::test {

/// A folder of its own under the system's temporary folder, removed at the end.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  /// Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& text) const;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A valid axisymmetric scene, one key or short block per line.
const std::string& small_scene();

/// `text` with its first `from` replaced by `to`; fails the test if there is none.
std::string replaced(std::string text, const std::string& from, const std::string& to);

/// Number of the first line that contains `part`, from 1; 0: none.
int line_of(const std::string& text, const std::string& part);

/// The whole content of a file.
std::string slurp(const std::string& file);

/// The message of the InputError that reading throws; "" if it succeeds. Any other exception
/// escapes.
std::string message_of(const std::string& file, const std::vector<std::string>& overrides = {});

/// Source folder of the project, "/inputs/" and so on appended.
std::string source_path(const std::string& relative);

}  // namespace krater::test
