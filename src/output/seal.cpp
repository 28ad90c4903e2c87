// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/seal.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "krater/core/errors.hpp"
#include "output/atomic_file.hpp"

namespace krater::output {
namespace {

constexpr std::string_view kName = "krater checkpoint, format ";
constexpr std::string_view kStart = "krater checkpoint, format 3, hash ";
constexpr std::size_t kDigits = 16;
constexpr std::size_t kPiece = 1 << 16;  ///< bytes read at once; a multiple of 8
constexpr std::string_view kOldFormat = "\x89HDF\r\n\x1a\n";  ///< format 1 was not sealed

/// FNV-1a over 64-bit words, each turned before it is mixed. Every step is a bijection of the word,
/// so no change within one word escapes; without the turn the topmost bits of two words could
/// cancel.
class Hash {
 public:
  /// All pieces but the last hold a multiple of 8 bytes.
  void add(std::string_view bytes) {
    std::size_t at = 0;
    for (; at + 8 <= bytes.size(); at += 8) add_word(bytes.data() + at, 8);
    if (at < bytes.size()) add_word(bytes.data() + at, bytes.size() - at);
    length_ += bytes.size();
  }
  std::string digits() const { return fmt::format("{:016x}", mixed(sum_, length_)); }

 private:
  static std::uint64_t mixed(std::uint64_t sum, std::uint64_t word) {
    return (std::rotl(sum, 23) ^ word) * 1099511628211u;
  }
  void add_word(const char* bytes, std::size_t count) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes, count);
    sum_ = mixed(sum_, word);
  }
  std::uint64_t sum_ = 14695981039346656037u, length_ = 0;
};

class Reader {
 public:
  explicit Reader(const std::string& path)
      : path_{path}, descriptor_{::open(path.c_str(), O_RDONLY | O_CLOEXEC)} {
    if (descriptor_ < 0) fail("cannot be read: " + reason(errno));
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
      ::close(descriptor_);
      fail("cannot be read: not a plain file");
    }
  }
  ~Reader() { ::close(descriptor_); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// Fills the buffer as far as the file goes.
  std::string_view read(std::vector<char>& buffer) {
    std::size_t filled = 0;
    while (filled < buffer.size()) {
      const ssize_t got = ::read(descriptor_, buffer.data() + filled, buffer.size() - filled);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) fail("cannot be read: " + reason(errno));
      if (got == 0) break;
      filled += static_cast<std::size_t>(got);
    }
    return {buffer.data(), filled};
  }
  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(path_ + ": " + problem);
  }

 private:
  std::string path_;
  int descriptor_;
};

/// The digits of a start that is ours; they are replaced by zeros.
std::string take_digits(const Reader& file, std::vector<char>& start, std::size_t size) {
  const std::string_view text{start.data(), size};
  if (text.starts_with(kOldFormat))
    file.fail(
        "not a checkpoint of krater, or one of format 1, which this program does not read (it "
        "reads format 3): use the version of krater that wrote it");
  if (!text.starts_with(kName))
    file.fail("not a checkpoint of krater, or damaged at its start, or cut short");
  if (!text.starts_with(kStart) || size < kSealBytes)
    file.fail(
        "a checkpoint of another format than 3, which this program reads, or damaged, or cut "
        "short; use the version of krater that wrote it, or an older checkpoint");
  char* digits = start.data() + kStart.size();
  const std::string found{digits, kDigits};
  std::fill_n(digits, kDigits, '0');
  return found;
}

}  // namespace

void seal(PartFile& file) {
  std::string start(kSealBytes, '\0');
  start.replace(0, kStart.size(), kStart);
  start.replace(kStart.size(), kDigits, kDigits, '0');
  start[kStart.size() + kDigits] = '\n';
  file.write(0, start.data(), start.size());
  std::vector<char> buffer(kPiece);
  Hash hash;
  for (std::uint64_t at = 0; at < file.size(); at += buffer.size()) {
    const std::size_t count = std::min<std::uint64_t>(buffer.size(), file.size() - at);
    file.read(at, buffer.data(), count);
    hash.add({buffer.data(), count});
  }
  const std::string digits = hash.digits();
  file.write(kStart.size(), digits.data(), digits.size());
}

void require_sealed(const std::string& path) {
  Reader file{path};
  std::vector<char> buffer(kPiece);
  std::string_view bytes = file.read(buffer);
  const std::string expected = take_digits(file, buffer, bytes.size());
  Hash hash;
  for (; !bytes.empty(); bytes = file.read(buffer)) hash.add(bytes);
  if (hash.digits() != expected)
    file.fail(
        "damaged or cut short: its bytes are not those that were written; use another "
        "checkpoint, or start again");
}

}  // namespace krater::output
