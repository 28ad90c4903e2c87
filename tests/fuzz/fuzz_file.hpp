// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file fuzz/fuzz_file.hpp
/// What the targets of libFuzzer share: a file that lives in memory, in a folder without cards or
/// meshes, and what may be thrown at who gave it.
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

namespace krater::fuzz {

/// The process's own file of this ending; it goes when the process ends.
class MemoryFile {
 public:
  explicit MemoryFile(const std::string& ending)
      : path_{"/dev/shm/krater_fuzz_" + std::to_string(getpid()) + "." + ending} {}
  ~MemoryFile() { std::remove(path_.c_str()); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  /// Puts these bytes in; false where there is no memory for them.
  bool write(const std::uint8_t* data, std::size_t size) const {
    std::FILE* file = std::fopen(path_.c_str(), "wb");
    if (file == nullptr) return false;
    const std::size_t written = std::fwrite(data, 1, size, file);
    return std::fclose(file) == 0 && written == size;
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// What is refused has its reason; what is thrown otherwise ends the fuzzer.
inline void require_reason(const std::exception& error) {
  if (std::string{error.what()}.empty()) std::abort();
}

}  // namespace krater::fuzz
