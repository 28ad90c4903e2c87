// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file grid/neighbourhood.hpp
/// The blocks near some blocks, on whatever level. Blocks A and B of levels a and b are near when
///   max |A_u - B_u| <= width,   u = max(0, min(a, b) - 1),
/// where A_u is the block of level u that A lies in: on one level no more than `width` blocks
/// apart, among finer cells so many of the level above the coarser of the two, for nodes at the
/// edge of a level follow from those of the level above, and these from all that follow from them.
/// It is the same for A and B as for B and A.
#include <vector>

#include "krater/grid/levels.hpp"

namespace krater {

/// All keys up to `width` blocks from some of these along every axis, sorted.
std::vector<BlockKey> keys_within(std::vector<BlockKey> keys, int width, int dimension);

class Neighbourhood {
 public:
  Neighbourhood(const std::vector<BlockKey>& blocks, int width, int dimension);
  /// It is near one of the blocks, or one of them.
  bool holds(const BlockKey& key) const;

 private:
  int dimension_;
  /// By level: ancestors around the blocks of this level and finer ones, and of this level alone.
  std::vector<std::vector<BlockKey>> to_own_level_, to_finer_;
};

}  // namespace krater
