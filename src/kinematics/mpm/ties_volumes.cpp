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
  KeyIndex shared;
  shared.clear(grid_.node_blocks().size());
  const auto add = [&shared](const BlockKey& key) {
    const bool is_new = shared.find(key, 0) < 0;
    if (is_new) shared.insert(key, 0, 0);
    return is_new;
  };
  for (std::size_t b = 1; b < grid_.node_blocks().size(); ++b)
    if (grid_.node_blocks()[b].key == grid_.node_blocks()[b - 1].key)
      for (BlockKey key = grid_.node_blocks()[b].key; add(key) && key.level > 0;)
        key = parent_of(key, dimension);
  const auto near_shared = [&](const BlockKey& key) {
    for (int s = 0; s < neighbour_count(dimension); ++s)
      if (shared.find(shifted(key, s, dimension), 0) >= 0) return true;
    return false;
  };
  const int finest = grid_.levels().count() - 1;
  for (std::size_t b = grid_.node_blocks().size(); b-- > 0;) {
    const NodeBlock& block = grid_.node_blocks()[b];
    if (block.key.level == finest || !near_shared(block.key)) continue;
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
    if (!any) continue;
    parents_.push_back(parent);
    grid_.node_blocks()[b].completed = true;
  }
}

namespace {

/// Volumes of the nodes of finer blocks that the nodes of one block draw on: 2 edge + 2 along each
/// axis, from two before the first child of its first node.
struct Children {
  static constexpr int kMost = 10 * 10 * 10;  // 18^2 in 2d
  explicit Children(int dimension) : side{2 * block_edge(dimension) + 2} {}
  /// The free nodes of a finer block, which begins `begin` nodes from the first of these.
  void take(const NodeBlock& from, const std::array<int, 3>& begin, int dimension) {
    const int edge = block_edge(dimension);
    for (int n = 0; n < kBlockNodes; ++n) {
      if ((from.tied >> n & 1U) != 0) continue;  // in the sums of their masters already
      int at = 0, inside = 1;
      for (int a = dimension - 1, rest = n, stride = 1; a >= 0; --a, rest /= edge, stride *= side) {
        const int i = begin[static_cast<std::size_t>(a)] + rest % edge;
        inside &= static_cast<int>(i >= 0 && i < side);
        at += i * stride;
      }
      if (inside != 0)
        volume[static_cast<std::size_t>(at)] = from.nodes[kNodeDoubles * n + moved::volume];
    }
  }
  int side;
  std::array<double, kMost> volume{};
};

constexpr std::array<double, 4> kShares{0.25, 0.75, 0.75, 0.25};

/// Of the children of one node, the first of which is at `first`, in lexicographic order.
double sum_plane(const double* first, int side) {
  double sum = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      sum += kShares[static_cast<std::size_t>(i)] * kShares[static_cast<std::size_t>(j)] *
             first[side * i + j];
  return sum;
}

double sum_space(const double* first, int side) {
  double sum = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 4; ++k)
        sum += kShares[static_cast<std::size_t>(i)] * kShares[static_cast<std::size_t>(j)] *
               kShares[static_cast<std::size_t>(k)] * first[side * (side * i + j) + k];
  return sum;
}

}  // namespace

// The children of node J are 2J - 2 .. 2J + 1 with the weights (1 3 3 1)/4.
void Ties::add_children(const Parent& parent) {
  const int dimension = grid_.geometry().dimension, edge = block_edge(dimension);
  NodeBlock& block = grid_.node_blocks()[parent.block];
  Children children{dimension};
  for (int slot = 0; slot < neighbour_count(dimension); ++slot) {
    const std::int32_t finer = parent.finer[static_cast<std::size_t>(slot)];
    if (finer < 0) continue;
    std::array<int, 3> begin{};
    for (int a = 0; a < dimension; ++a)
      begin[static_cast<std::size_t>(a)] = slot_offset(slot, a, dimension) * edge + 2;
    children.take(grid_.node_blocks()[static_cast<std::size_t>(finer)], begin, dimension);
  }
  const int side = children.side;
  for (int n = 0; n < kBlockNodes; ++n) {
    int at = 0;
    for (int a = dimension - 1, rest = n, stride = 1; a >= 0; --a, rest /= edge, stride *= side)
      at += 2 * (rest % edge) * stride;
    const double* first = children.volume.data() + at;
    block.nodes[kNodeDoubles * n + moved::volume] +=
        dimension == 3 ? sum_space(first, side) : sum_plane(first, side);
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
