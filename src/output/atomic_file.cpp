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

void replace_file(const std::string& path, std::string_view bytes) {
  const std::string part = path + kPartSuffix;
  const int descriptor = ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) fail(path, errno);
  int error = write_all(descriptor, bytes);
  // A rename that reaches the disk before the data would replace a good checkpoint by an empty one
  // when the power fails.
  if (error == 0 && ::fsync(descriptor) != 0 && errno != EINVAL && errno != ENOTSUP) error = errno;
  if (::close(descriptor) != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(part.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(part.c_str());
    fail(path, error);
  }
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
