// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "krater/output/results.hpp"

namespace krater::output {
namespace {

[[noreturn]] void fail(const std::string& path, int error_number) {
  throw OutputError(path + ": cannot be written: " + reason(error_number));
}

/// Zero, or the errno of the write that failed.
int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

}  // namespace

std::string reason(int error_number) { return std::generic_category().message(error_number); }

PartFile::PartFile(std::string path) : path_{std::move(path)}, part_{path_ + kPartSuffix} {
  descriptor_ = ::open(part_.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(path_, errno);
}

PartFile::~PartFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(part_.c_str());
}

void PartFile::write(std::uint64_t at, const void* data, std::size_t size) noexcept {
  size_ = std::max(size_, at + size);
  const char* from = static_cast<const char*>(data);
  while (size > 0 && error_ == 0) {
    const ssize_t written = ::pwrite(descriptor_, from, size, static_cast<off_t>(at));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      error_ = errno;
      return;
    }
    from += written;
    at += static_cast<std::uint64_t>(written);
    size -= static_cast<std::size_t>(written);
  }
}

void PartFile::read(std::uint64_t at, void* data, std::size_t size) const noexcept {
  char* to = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = ::pread(descriptor_, to, size, static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    to += got;
    at += static_cast<std::uint64_t>(got);
    size -= static_cast<std::size_t>(got);
  }
  std::fill_n(to, size, '\0');
}

void PartFile::commit() {
  // A file that ends in a hole is as long as it says.
  if (error_ == 0 && ::ftruncate(descriptor_, static_cast<off_t>(size_)) != 0) error_ = errno;
  // A rename that reaches the disk before the data would replace a good checkpoint by an empty one
  // when the power fails.
  if (error_ == 0 && ::fsync(descriptor_) != 0 && errno != EINVAL && errno != ENOTSUP)
    error_ = errno;
  if (::close(std::exchange(descriptor_, -1)) != 0 && error_ == 0) error_ = errno;
  if (error_ == 0 && std::rename(part_.c_str(), path_.c_str()) != 0) error_ = errno;
  if (error_ == 0) return;
  ::unlink(part_.c_str());
  fail(path_, error_);
}

void replace_file(const std::string& path, std::string_view bytes) {
  PartFile file{path};
  file.write(0, bytes.data(), bytes.size());
  file.commit();
}

void replace_tail(const std::string& path, std::size_t begin, std::string_view bytes) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor < 0) fail(path, errno);
  struct stat status {};
  int error = ::fstat(descriptor, &status) != 0 ? errno : 0;
  const auto from = static_cast<off_t>(begin);
  std::string old(static_cast<std::size_t>(std::max<off_t>(status.st_size - from, 0)), '\0');
  if (error == 0 && ::pread(descriptor, old.data(), old.size(), from) < 0) error = errno;
  if (error == 0 && ::lseek(descriptor, from, SEEK_SET) < 0) error = errno;
  if (error == 0) error = write_all(descriptor, bytes);
  const auto end = from + static_cast<off_t>(error == 0 ? bytes.size() : old.size());
  // What was there fits again: its bytes are still allotted to the file.
  if (error != 0 && ::lseek(descriptor, from, SEEK_SET) >= 0) write_all(descriptor, old);
  if (::ftruncate(descriptor, end) != 0 && error == 0) error = errno;
  if (error == 0 && ::fsync(descriptor) != 0 && errno != EINVAL && errno != ENOTSUP) error = errno;
  if (::close(descriptor) != 0 && error == 0) error = errno;
  if (error != 0) fail(path, error);
}

LineAppender::~LineAppender() { close(); }

void LineAppender::open(const std::string& path) {
  close();
  path_ = path;
  descriptor_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(path_, errno);
}

void LineAppender::append(std::string_view line) {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) fail(path_, errno);
  const int error = write_all(descriptor_, line);
  if (error == 0) return;
  // The disk is full in mid-line: take back the piece that was written.
  if (::ftruncate(descriptor_, status.st_size) != 0) close();
  fail(path_, error);
}

void LineAppender::close() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

}  // namespace krater::output
