// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file grid/overlaps.hpp
/// Where the nodes of a block lie in the tiles that overlap it, for sums outside the hot kernels.
#include <array>

#include "krater/grid/blocks.hpp"

namespace krater {

/// By corner of a tile and node of the block there: offset of the node's record in the tile, -1:
/// not in it.
using Overlaps = std::array<std::array<int, kBlockNodes>, 8>;

inline Overlaps find_overlaps(int dimension) {
  const int edge = block_edge(dimension), width = tile_edge(dimension);
  Overlaps out{};
  for (int corner = 0; corner < corner_count(dimension); ++corner)
    for (int n = 0; n < kBlockNodes; ++n) {
      int from = 0;
      bool inside = true;
      for (int a = 0, power = kBlockNodes / edge; a < dimension; ++a, power /= edge) {
        const int at = n / power % edge + edge * corner_offset(corner, a);
        inside = inside && at < width;
        from = from * width + at;
      }
      out[static_cast<std::size_t>(corner)][static_cast<std::size_t>(n)] =
          inside ? kNodeDoubles * from : -1;
    }
  return out;
}

}  // namespace krater
