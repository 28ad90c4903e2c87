// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/grid/levels.hpp"

#include <algorithm>

#include "krater/grid/blocks.hpp"

namespace krater {

BlockKey parent_of(const BlockKey& key, int dimension) {
  BlockKey out;
  out.level = key.level - 1;
  for (int a = 0; a < dimension; ++a) {
    const auto k = static_cast<std::size_t>(a);
    out.i[k] = floor_div(key.i[k], 2);
  }
  return out;
}

bool Levels::set(BlockSet refined) {
  const int dimension = geometry().dimension;
  std::vector<std::vector<BlockKey>> by_level(kMostLevels);
  for (const BlockKey& key : refined) by_level[static_cast<std::size_t>(key.level)].push_back(key);
  BlockSet graded;
  for (std::size_t l = by_level.size(); l-- > 0;)
    for (const BlockKey& key : by_level[l])
      if (graded.insert(key).second && l > 0)
        for (int slot = 0; slot < neighbour_count(dimension); ++slot)
          by_level[l - 1].push_back(parent_of(shifted(key, slot, dimension), dimension));
  if (graded == refined_) return false;
  refined_ = std::move(graded);
  known_.clear();
  int finest = 0;
  for (const BlockKey& key : refined_) finest = std::max(finest, key.level + 1);
  while (count() <= finest) geometries_.push_back(finer(geometries_.back()));
  return true;
}

std::vector<BlockKey> Levels::refined() const {
  std::vector<BlockKey> out(refined_.begin(), refined_.end());
  std::sort(out.begin(), out.end());
  return out;
}

BlockKey Levels::block_at(const double* position) const {
  BlockKey key = block_of(geometry(), position);
  while (!single() && is_refined(key)) key = block_of(geometry(key.level + 1), position);
  return key;
}

bool Levels::holds(const BlockKey& key) const {
  return key.level == 0 || is_refined(parent_of(key, geometry().dimension));
}

// Beyond a plane the cell is its mirror image.
bool Levels::holds_cell(const std::array<int, 3>& cell, int level) const {
  const GridGeometry& g = geometry(level);
  BlockKey key;
  key.level = level;
  for (int a = 0; a < g.dimension; ++a) {
    const auto k = static_cast<std::size_t>(a);
    const int first = static_cast<int>(g.origin), last = first + g.cells[k] - 1;
    int i = cell[k];
    if (i < first) i = 2 * first - 1 - i;
    if (i > last) i = 2 * last + 1 - i;
    key.i[k] = floor_div(i, block_edge(g.dimension));
  }
  return holds(key);
}

std::uint64_t Levels::tied_nodes(const BlockKey& key) const {
  if (key.level == 0) return 0;
  if (const auto found = known_.find(key); found != known_.end()) return found->second;
  const int dimension = geometry().dimension;
  std::uint64_t tied = 0;
  for (int n = 0; n < kBlockNodes; ++n) {
    const std::array<int, 3> node = index_in(key, n, dimension);
    for (int slot = 0; slot < neighbour_count(dimension); ++slot) {
      std::array<int, 3> cell = node;
      for (int a = 0; a < dimension; ++a)
        cell[static_cast<std::size_t>(a)] += slot_offset(slot, a, dimension) - 1;
      if (holds_cell(cell, key.level)) continue;
      tied |= std::uint64_t{1} << n;
      break;
    }
  }
  known_.emplace(key, tied);
  return tied;
}

}  // namespace krater
