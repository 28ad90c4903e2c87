// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/packing.hpp"

#include <isa-l/igzip_lib.h>

#include <array>
#include <bit>
#include <cstring>

namespace krater::output {

static_assert(std::endian::native == std::endian::little, "byte 0 of a value is its lowest");

namespace {

constexpr std::size_t kBytes = 8;

/// Byte i of word b <-> byte b of word i.
void transpose(std::array<std::uint64_t, kBytes>& x) {
  const auto exchange = [&x](std::size_t apart, unsigned shift, std::uint64_t low) {
    for (std::size_t i = 0; i < kBytes; ++i) {
      if ((i & apart) != 0) continue;
      const std::uint64_t change = ((x[i] >> shift) ^ x[i + apart]) & low;
      x[i + apart] ^= change;
      x[i] ^= change << shift;
    }
  };
  exchange(4, 32, 0x00000000ffffffff);
  exchange(2, 16, 0x0000ffff0000ffff);
  exchange(1, 8, 0x00ff00ff00ff00ff);
}

}  // namespace

void shuffle(std::span<const std::uint64_t> values, unsigned char* out) {
  const std::size_t n = values.size(), whole = n - n % kBytes;
  std::array<std::uint64_t, kBytes> block;
  for (std::size_t i = 0; i < whole; i += kBytes) {
    std::memcpy(block.data(), values.data() + i, sizeof block);
    transpose(block);
    for (std::size_t b = 0; b < kBytes; ++b) std::memcpy(out + b * n + i, &block[b], kBytes);
  }
  for (std::size_t i = whole; i < n; ++i)
    for (std::size_t b = 0; b < kBytes; ++b)
      out[b * n + i] = static_cast<unsigned char>(values[i] >> (8 * b));
}

Packer::Packed Packer::pack(std::span<const std::uint64_t> values) {
  shuffled_.resize(values.size_bytes());
  shuffle(values, shuffled_.data());
  packed_.resize(shuffled_.size());
  isal_zstream stream{};
  isal_deflate_stateless_init(&stream);
  stream.gzip_flag = IGZIP_ZLIB;
  stream.end_of_stream = 1;
  stream.next_in = shuffled_.data();
  stream.avail_in = static_cast<std::uint32_t>(shuffled_.size());
  stream.next_out = packed_.data();
  stream.avail_out = static_cast<std::uint32_t>(packed_.size());
  // No room: longer than it was.
  if (isal_deflate_stateless(&stream) != COMP_OK) return {shuffled_, true};
  return {{packed_.data(), stream.total_out}, false};
}

}  // namespace krater::output
