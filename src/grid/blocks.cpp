// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/grid/blocks.hpp"

#include <algorithm>
#include <cmath>

namespace krater {

BlockKey shifted(const BlockKey& key, int slot, int dimension) {
  BlockKey k = key;
  for (int a = 0; a < dimension; ++a)
    k.i[static_cast<std::size_t>(a)] += slot_offset(slot, a, dimension);
  return k;
}

namespace {

BlockKey at_corner(const BlockKey& key, int corner, int sign, int dimension) {
  BlockKey k = key;
  for (int a = 0; a < dimension; ++a)
    k.i[static_cast<std::size_t>(a)] += sign * corner_offset(corner, a);
  return k;
}

bool before(const Patch& a, const Patch& b) {
  return a.key != b.key ? a.key < b.key : a.body < b.body;
}

}  // namespace

BlockKey block_of(const GridGeometry& geometry, const double* position) {
  BlockKey key;
  for (int a = 0; a < geometry.dimension; ++a) {
    const int base = static_cast<int>(std::floor(geometry.storage(position[a], a) - 0.5));
    const int edge = block_edge(geometry.dimension);
    key.i[static_cast<std::size_t>(a)] = base >= 0 ? base / edge : -((edge - 1 - base) / edge);
  }
  return key;
}

int BlockGrid::find_patch(const BlockKey& key, int body) const {
  const auto at = std::lower_bound(
      patches.begin(), patches.end(), key,
      [body](const Patch& p, const BlockKey& k) { return p.key != k ? p.key < k : p.body < body; });
  return at != patches.end() && at->key == key && at->body == body
             ? static_cast<int>(at - patches.begin())
             : -1;
}

int BlockGrid::find_node_block(const BlockKey& key, int field) const {
  const auto at = std::lower_bound(node_blocks.begin(), node_blocks.end(), key,
                                   [field](const NodeBlock& n, const BlockKey& k) {
                                     return n.key != k ? n.key < k : n.field < field;
                                   });
  return at != node_blocks.end() && at->key == key && at->field == field
             ? static_cast<int>(at - node_blocks.begin())
             : -1;
}

double* BlockGrid::find_node(const std::array<int, 3>& storage_index, int field) const {
  const int edge = block_edge(geometry_.dimension);
  BlockKey key;
  int local = 0;
  for (int a = 0; a < geometry_.dimension; ++a) {
    const int i = storage_index[static_cast<std::size_t>(a)];
    const int block = i >= 0 ? i / edge : -((edge - 1 - i) / edge);
    key.i[static_cast<std::size_t>(a)] = block;
    local = local * edge + (i - block * edge);
  }
  const int n = find_node_block(key, field);
  return n < 0 ? nullptr : node_blocks[static_cast<std::size_t>(n)].nodes + kNodeDoubles * local;
}

void BlockGrid::rebuild(bool drop_empty) {
  if (drop_empty) std::erase_if(patches, [](const Patch& p) { return p.count == 0; });
  if (!std::is_sorted(patches.begin(), patches.end(), before))
    std::sort(patches.begin(), patches.end(), before);
  for (Patch& p : patches)
    p.field = static_cast<std::size_t>(p.body) < field_of_body_.size()
                  ? field_of_body_[static_cast<std::size_t>(p.body)]
                  : 0;
  make_node_blocks();
  link_patches();
}

void BlockGrid::make_node_blocks() {
  const int dimension = geometry_.dimension, corners = corner_count(dimension);
  struct Overlap {
    BlockKey key;
    int field;
    TileRef tile;
  };
  std::vector<Overlap> overlaps;
  overlaps.reserve(patches.size() * static_cast<std::size_t>(corners));
  for (std::size_t p = 0; p < patches.size(); ++p)
    for (int c = 0; c < corners; ++c)
      overlaps.push_back(
          {at_corner(patches[p].key, c, 1, dimension), patches[p].field, {static_cast<int>(p), c}});
  std::stable_sort(overlaps.begin(), overlaps.end(), [](const Overlap& a, const Overlap& b) {
    return a.key != b.key ? a.key < b.key : a.field < b.field;
  });

  node_blocks.clear();
  tile_refs.clear();
  for (const Overlap& o : overlaps) {
    if (node_blocks.empty() || node_blocks.back().key != o.key ||
        node_blocks.back().field != o.field) {
      node_blocks.emplace_back();
      node_blocks.back().key = o.key;
      node_blocks.back().field = o.field;
      node_blocks.back().first_tile = static_cast<int>(tile_refs.size());
    }
    tile_refs.push_back(o.tile);
    ++node_blocks.back().tiles;
  }
  constexpr std::size_t per_block = kBlockNodes * kNodeDoubles;
  node_memory_.reserve(node_blocks.size() * per_block);
  for (std::size_t n = 0; n < node_blocks.size(); ++n)
    node_blocks[n].nodes = node_memory_.data() + n * per_block;
}

void BlockGrid::link_patches() {
  const int dimension = geometry_.dimension;
  for (Patch& patch : patches) {
    patch.tile.reserve(static_cast<std::size_t>(tile_nodes(dimension)) * kNodeDoubles);
    patch.beta.reserve(kBlockNodes);
    for (int c = 0; c < corner_count(dimension); ++c)
      patch.node_blocks[static_cast<std::size_t>(c)] =
          find_node_block(at_corner(patch.key, c, 1, dimension), patch.field);
    for (int s = 0; s < neighbour_count(dimension); ++s)
      patch.neighbours[static_cast<std::size_t>(s)] =
          find_patch(shifted(patch.key, s, dimension), patch.body);
  }
}

}  // namespace krater
