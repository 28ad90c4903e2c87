// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/folder_lock.hpp
/// One run at a time may write into a results folder: two would mix their rows and frames.
#include <string>

namespace krater {

/// Held until destruction or the end of the process, however that ends, by a lock on
/// FOLDER/.running.
class FolderLock {
 public:
  FolderLock() = default;
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// Makes the folder where there is none. Throws InputError when another run writes there; a file
  /// system without locks is no obstacle.
  void take(const std::string& folder);

 private:
  std::string file_;
  int descriptor_ = -1;
};

}  // namespace krater
