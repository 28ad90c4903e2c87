// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/yaml/problems.hpp
/// What is wrong with a scene. Reading goes on after a problem, so that one attempt shows several
/// of them; a getter that reports a problem returns a harmless default, and no Scene leaves the
/// reader while there are problems.
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace krater::scene {

class Problems {
 public:
  /// `file` and `line` (0: none) order the list. Throws InputError at the tenth problem.
  void add(const std::string& file, int line, const std::string& path, const std::string& message);
  std::size_t size() const { return list_.size(); }
  bool any() const { return !list_.empty(); }
  /// Throws one InputError that lists every problem, one per line, if there are any.
  void throw_if_any() const;

 private:
  struct Problem {
    std::string file;
    int line;
    std::string text;
  };
  std::vector<Problem> list_;
};

/// "FILE:LINE: path" or, where there is no line or path, as much of it as there is.
std::string describe_place(const std::string& file, int line, const std::string& path);

/// The known name nearest to a mistyped one, or "" if none is near (edit distance, case ignored).
std::string nearest(std::string_view name, const std::vector<std::string>& known);

/// " (did you mean strength? known: eos, strength, ...)"
std::string suggestion(std::string_view name, const std::vector<std::string>& known);

/// "a, b, c"
std::string join(const std::vector<std::string>& words);

/// Text of the user as it may appear in a message: cut to a readable length, control characters
/// replaced.
std::string quote(std::string_view text);

}  // namespace krater::scene
