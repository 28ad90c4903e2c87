// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file output/part_driver.hpp
/// HDF5's way to a PartFile: what the library writes goes straight to disk, so that a file needs no
/// memory of its own. HDF5 1.10 crashes, then or at exit, when a write fails (tried with a limited
/// file size): the library is told that every write succeeds, and PartFile::commit() tells the
/// truth.
#include <hdf5.h>

#include "output/atomic_file.hpp"

namespace krater::output {

/// The file access list `access` leads to `file`, which must outlive the HDF5 file.
herr_t use_part_file(hid_t access, PartFile& file);

}  // namespace krater::output
