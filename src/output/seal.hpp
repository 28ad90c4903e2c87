// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file output/seal.hpp
/// A file that proves to be whole before anybody parses it. HDF5 1.10 follows a flipped bit in the
/// strings or sizes of its headers into a segmentation fault or an endless loop, so its own
/// checksums come too late. The first 512 bytes (a user block, which HDF5 and h5py pass over) are a
/// line "krater checkpoint, format 3, hash 0123456789abcdef" and zeros; the hash is over all bytes
/// of the file with zeros for its digits.
#include <cstddef>
#include <string>

#include "output/atomic_file.hpp"

namespace krater::output {

inline constexpr std::size_t kSealBytes = 512;

/// Writes the seal into the first bytes of a file that is whole but for them.
void seal(PartFile& file);

/// Throws InputError: unreadable, not a checkpoint, of another format, damaged or cut short.
void require_sealed(const std::string& path);

}  // namespace krater::output
