// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file output/atomic_file.hpp
/// Files that appear complete or not at all. Assumes POSIX: rename within a folder is atomic.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace krater::output {

inline constexpr const char* kPartSuffix = ".part";  ///< of a file still being written

/// "text of errno", without the C library's static buffer.
std::string reason(int error_number);

/// `path`.part while it is written, in any order; `path` once it is committed. Thrown away unless
/// committed. What fails while writing is told by commit(), as an OutputError.
class PartFile {
 public:
  explicit PartFile(std::string path);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  const std::string& path() const { return path_; }
  void write(std::uint64_t at, const void* data, std::size_t size) noexcept;
  void read(std::uint64_t at, void* data, std::size_t size) const noexcept;  ///< zeros past the end
  std::uint64_t size() const { return size_; }  ///< end of the last byte written
  void commit();                                ///< to disk, then renamed

 private:
  std::string path_, part_;
  int descriptor_ = -1;
  int error_ = 0;  ///< errno of the first write that failed
  std::uint64_t size_ = 0;
};

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
