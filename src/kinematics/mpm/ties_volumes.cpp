// SPDX-License-Identifier: GPL-3.0-or-later
// What contact reads near the edges of levels.
#include <algorithm>

#include "krater/core/parallel.hpp"
#include "krater/kinematics/mpm/ties.hpp"

namespace krater {

void Ties::link_parents() {
  parents_.clear();
  if (grid_.levels().single()) return;
  const int dimension = grid_.geometry().dimension;
  // Contact looks at blocks that fields share, two nodes around them; and what these are made of.
  BlockSet shared;
  for (std::size_t b = 1; b < grid_.node_blocks().size(); ++b)
    if (grid_.node_blocks()[b].key == grid_.node_blocks()[b - 1].key)
      for (BlockKey key = grid_.node_blocks()[b].key; shared.insert(key).second && key.level > 0;)
        key = parent_of(key, dimension);
  const auto near_shared = [&](const BlockKey& key) {
    for (int s = 0; s < neighbour_count(dimension); ++s)
      if (shared.contains(shifted(key, s, dimension))) return true;
    return false;
  };
  for (std::size_t b = grid_.node_blocks().size(); b-- > 0;) {
    const NodeBlock& block = grid_.node_blocks()[b];
    if (!near_shared(block.key)) continue;
    Parent parent{b, {}};
    BlockKey centre = block.key;
    centre.level += 1;
    for (int a = 0; a < dimension; ++a) centre.i[static_cast<std::size_t>(a)] *= 2;
    bool any = false;
    for (int s = 0; s < neighbour_count(dimension); ++s) {
      const int finer = grid_.find_node_block(shifted(centre, s, dimension), block.field);
      parent.finer[static_cast<std::size_t>(s)] = finer;
      any = any || finer >= 0;
    }
    if (any) parents_.push_back(parent);
  }
}

// The children of node J are 2J - 2 .. 2J + 1 with the weights (1 3 3 1)/4. Tied ones are in its
// sum already.
void Ties::add_children(const Parent& parent) {
  const int dimension = grid_.geometry().dimension, edge = block_edge(dimension);
  NodeBlock& block = grid_.node_blocks()[parent.block];
  int count = 1;
  for (int a = 0; a < dimension; ++a) count *= 4;
  for (int n = 0; n < kBlockNodes; ++n) {
    std::array<int, 3> first{};  // child, from the first node of the finer blocks
    for (int a = dimension - 1, rest = n; a >= 0; --a, rest /= edge)
      first[static_cast<std::size_t>(a)] = 2 * (rest % edge) - 2 + edge;
    double sum = 0;
    for (int c = 0; c < count; ++c) {
      int slot = 0, local = 0;
      double w = 1;
      for (int a = 0, shift = 2 * (dimension - 1); a < dimension; ++a, shift -= 2) {
        const int k = c >> shift & 3, i = first[static_cast<std::size_t>(a)] + k;
        w *= k == 0 || k == 3 ? 0.25 : 0.75;
        slot = 3 * slot + i / edge;
        local = local * edge + i % edge;
      }
      const std::int32_t finer = parent.finer[static_cast<std::size_t>(slot)];
      if (finer < 0) continue;
      const NodeBlock& from = grid_.node_blocks()[static_cast<std::size_t>(finer)];
      if ((from.tied >> local & 1U) == 0)
        sum += w * from.nodes[kNodeDoubles * local + moved::volume];
    }
    block.nodes[kNodeDoubles * n + moved::volume] += sum;
  }
}

void Ties::complete_volumes() {
  if (!any()) return;
  // Of a level all from the finished one below.
  for (std::size_t first = 0, end = 0; first < parents_.size(); first = end) {
    const auto level = [this](std::size_t p) {
      return grid_.node_blocks()[parents_[p].block].key.level;
    };
    while (end < parents_.size() && level(end) == level(first)) ++end;
    for_each(end - first, [&](std::size_t i) { add_children(parents_[first + i]); });
  }
  const int corners = corner_count(grid_.geometry().dimension);
  for (const Tied& tied : tied_) {
    double coarse = 0;
    for (int c = 0; c < corners; ++c) {
      const auto n = static_cast<std::size_t>(tied.masters[static_cast<std::size_t>(c)]);
      const Master& master = masters_[static_cast<std::size_t>(master_at_[n])];
      if (master.whole > 0) coarse += weight(tied, c) * master.own_volume / master.whole;
    }
    record(tied.node)[moved::volume] = tied.sums[summed::volume] + tied.whole * coarse;
  }
}

}  // namespace krater
