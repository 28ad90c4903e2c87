// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file output/atomic_file.hpp
/// Files that appear complete or not at all. Assumes POSIX: rename within a folder is atomic.
#include <cstddef>
#include <string>
#include <string_view>

namespace krater::output {

inline constexpr const char* kPartSuffix = ".part";  ///< of a file still being written

/// "text of errno", without the C library's static buffer.
std::string reason(int error_number);

/// Writes `path`.part, syncs it to disk and renames it to `path`. On failure removes the part file,
/// leaves an older `path` as it was, and throws OutputError.
void replace_file(const std::string& path, std::string_view bytes);

/// Writes `bytes` from `begin` on, as the new end of an existing file, in one write: a reader, or a
/// kill, sees the old end or the new one. On failure puts the old end back and throws OutputError.
void replace_tail(const std::string& path, std::size_t begin, std::string_view bytes);

/// Appends whole lines: one write per line, so that no reader and no kill ever sees half a line.
class LineAppender {
 public:
  LineAppender() = default;
  ~LineAppender();
  LineAppender(const LineAppender&) = delete;
  LineAppender& operator=(const LineAppender&) = delete;
  void open(const std::string& path);
  bool is_open() const { return descriptor_ >= 0; }
  void append(std::string_view line);  ///< `line` ends with '\n'
  void close();

 private:
  std::string path_;
  int descriptor_ = -1;
};

}  // namespace krater::output
