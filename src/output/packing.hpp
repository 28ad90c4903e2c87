// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file output/packing.hpp
/// Chunks as HDF5's filters `shuffle` and `deflate` make them, so that any HDF5 reads them:
///
///     bytes sorted by weight, out[b n + i] = byte b of value i of n;  then a zlib stream.
///
/// The filters themselves call zlib (97 MB/s on fields of the Taylor rod; with ISA-L 1000 MB/s, and
/// a fifth more bytes), one thread at a time. The packed bytes may differ between processors, what
/// they hold does not.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace krater::output {

class Packer {
 public:
  /// The packed bytes; they stay until the next call. `plain`: the second filter was left out,
  /// because it gained nothing.
  struct Packed {
    std::span<const unsigned char> bytes;
    bool plain;
  };
  Packed pack(std::span<const std::uint64_t> values);

 private:
  std::vector<unsigned char> shuffled_, packed_;
};

/// Bytes of 8-byte values sorted by weight.
void shuffle(std::span<const std::uint64_t> values, unsigned char* out);

}  // namespace krater::output
