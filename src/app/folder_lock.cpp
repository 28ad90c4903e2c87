// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/folder_lock.hpp"

#include <cerrno>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include "krater/core/errors.hpp"

namespace krater {

FolderLock::~FolderLock() {
  if (descriptor_ < 0) return;
  unlink(file_.c_str());
  close(descriptor_);
}

void FolderLock::take(const std::string& folder) {
  std::error_code unmade;  // the first file written there gives the reason
  std::filesystem::create_directories(folder, unmade);
  file_ = folder + "/.running";
  const int descriptor = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) return;
  struct flock whole {};
  whole.l_type = F_WRLCK;
  whole.l_whence = SEEK_SET;
  if (fcntl(descriptor, F_OFD_SETLK, &whole) == 0) {
    descriptor_ = descriptor;
    return;
  }
  const bool taken = errno == EAGAIN || errno == EACCES;
  close(descriptor);
  if (taken)
    throw InputError(folder +
                     ": another run of krater is writing there; wait for it, or choose another "
                     "folder with -o");
}

}  // namespace krater
