// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/grid/blocks.hpp"

#include <algorithm>

#include "krater/grid/neighbourhood.hpp"

namespace krater {

namespace {

using Offset = std::array<std::int32_t, 3>;

/// Offsets of all neighbours: a change of the topology asks for 27 of them per patch.
constexpr std::array<Offset, 27> neighbour_offsets(int dimension) {
  std::array<Offset, 27> out{};
  for (int slot = 0; slot < neighbour_count(dimension); ++slot)
    for (int a = 0; a < dimension; ++a)
      out[static_cast<std::size_t>(slot)][static_cast<std::size_t>(a)] =
          slot_offset(slot, a, dimension);
  return out;
}
constexpr std::array<Offset, 27> plane_offsets = neighbour_offsets(2),
                                 space_offsets = neighbour_offsets(3);

}  // namespace

BlockKey shifted(const BlockKey& key, int slot, int dimension) {
  const Offset& offset =
      (dimension == 3 ? space_offsets : plane_offsets)[static_cast<std::size_t>(slot)];
  return {{key.i[0] + offset[0], key.i[1] + offset[1], key.i[2] + offset[2]}, key.level};
}

namespace {

BlockKey at_corner(const BlockKey& key, int corner, int sign, int dimension) {
  BlockKey k = key;
  for (int a = 0; a < dimension; ++a)
    k.i[static_cast<std::size_t>(a)] += sign * corner_offset(corner, a);
  return k;
}

int tag(FieldId field) { return static_cast<int>(field); }

bool before(const Patch& a, const Patch& b) {
  return a.key != b.key ? a.key < b.key : a.body < b.body;
}

}  // namespace

std::optional<BlockKey> master_block(const BlockKey& key, int corner, int dimension) {
  BlockKey out = parent_of(key, dimension);
  for (int a = 0; a < dimension; ++a) {
    const auto k = static_cast<std::size_t>(a);
    if (corner_offset(corner, a) == 0) continue;
    if (key.i[k] % 2 == 0) return {};
    out.i[k] += 1;
  }
  return out;
}

int BlockGrid::find_patch(const BlockKey& key, int body) const {
  return patch_index_.find(key, body);
}

int BlockGrid::find_node_block(const BlockKey& key, FieldId field) const {
  return node_index_.find(key, tag(field));
}

std::pair<BlockKey, int> BlockGrid::place_of_node(const std::array<int, 3>& storage_index,
                                                  int level) const {
  const int dimension = geometry().dimension, edge = block_edge(dimension);
  BlockKey key;
  key.level = level;
  int local = 0;
  for (int a = 0; a < dimension; ++a) {
    const int i = storage_index[static_cast<std::size_t>(a)];
    const int block = floor_div(i, edge);
    key.i[static_cast<std::size_t>(a)] = block;
    local = local * edge + (i - block * edge);
  }
  return {key, local};
}

double* BlockGrid::find_node(const std::array<int, 3>& storage_index, FieldId field,
                             int level) const {
  const auto [key, local] = place_of_node(storage_index, level);
  const int n = find_node_block(key, field);
  return n < 0 ? nullptr : node_blocks_[static_cast<std::size_t>(n)].nodes + kNodeDoubles * local;
}

Patch& BlockGrid::add_patch(const BlockKey& key, int body, int stride) {
  Patch& patch = patches_.emplace_back();
  patch.key = key;
  patch.body = body;
  patch.points = PointStore{stride};
  if (owner_) {
    patch.rank = owner_(key);
    patch.here = patch.near = patch.rank == own_;
  }
  return patch;
}

void BlockGrid::drop_patches(int body) {
  std::erase_if(patches_, [body](const Patch& p) { return body < 0 || p.body == body; });
}

void BlockGrid::rebuild(bool drop_empty) {
  if (drop_empty) std::erase_if(patches_, [](const Patch& p) { return p.count() == 0; });
  if (!std::is_sorted(patches_.begin(), patches_.end(), before))
    std::sort(patches_.begin(), patches_.end(), before);
  for (Patch& p : patches_)
    p.field = static_cast<std::size_t>(p.body) < field_of_body_.size()
                  ? field_of_body_[static_cast<std::size_t>(p.body)]
                  : FieldId{};
  if (owner_) find_near();
  make_node_blocks();
  link_patches();
}

/// Which patches this rank has, and which lie around these.
void BlockGrid::find_near() {
  std::vector<BlockKey> own;
  for (Patch& patch : patches_) {
    patch.here = patch.rank == own_;
    if (patch.here) own.push_back(patch.key);
  }
  const Neighbourhood around{own, width_, geometry().dimension};
  for (Patch& patch : patches_) patch.near = patch.here || around.holds(patch.key);
}

/// Blocks about those of masters where cells are finer: contact looks at their volumes.
template <class Add>
void BlockGrid::add_shadows(const Add& add) {
  const int dimension = geometry().dimension;
  const std::size_t there = node_blocks_.size();
  const auto under_finer = [&](const BlockKey& key) {
    if (key.level + 1 >= levels_.count()) return false;
    for (int c = 0; c < corner_count(dimension); ++c)
      if (levels_.is_refined(at_corner(key, c, -1, dimension))) return true;
    return false;
  };
  for (std::size_t n = 0; n < there; ++n) {
    const NodeBlock block = node_blocks_[n];
    if (!under_finer(block.key)) continue;
    for (int s = 0; s < neighbour_count(dimension); ++s)
      if (const BlockKey key = shifted(block.key, s, dimension); under_finer(key))
        add(key, block.field);
  }
}

void BlockGrid::make_node_blocks() {
  const int dimension = geometry().dimension, corners = corner_count(dimension);
  node_index_.clear(std::max(node_blocks_.size(), patches_.size()));  // about as many as before
  node_blocks_.clear();
  const auto add = [this](const BlockKey& key, FieldId field) {
    if (node_index_.find(key, tag(field)) >= 0) return false;
    node_index_.insert(key, tag(field), static_cast<int>(node_blocks_.size()));
    NodeBlock& block = node_blocks_.emplace_back();
    block.key = key;
    block.field = field;
    return true;
  };
  for (const Patch& patch : patches_)
    for (int c = 0; c < corners && patch.near; ++c)
      add(at_corner(patch.key, c, 1, dimension), patch.field);
  if (!levels_.single()) {
    // what points see, and where it follows from nodes of the level above, these
    const std::size_t seen = node_blocks_.size();
    for (std::size_t n = 0; n < seen; ++n) {
      node_blocks_[n].tied = levels_.tied_nodes(node_blocks_[n].key);
      if (node_blocks_[n].tied == 0) continue;
      const NodeBlock block = node_blocks_[n];
      for (int c = 0; c < corners; ++c)
        if (const auto key = master_block(block.key, c, dimension)) add(*key, block.field);
    }
    if (shadows_) add_shadows(add);
  }
  std::sort(node_blocks_.begin(), node_blocks_.end(), [](const NodeBlock& a, const NodeBlock& b) {
    return a.key != b.key ? a.key < b.key : a.field < b.field;
  });
  constexpr std::size_t per_block = kBlockNodes * kNodeDoubles;
  node_memory_.reserve(node_blocks_.size() * per_block);
  node_index_.clear(node_blocks_.size());
  for (std::size_t n = 0; n < node_blocks_.size(); ++n) {
    node_blocks_[n].nodes = node_memory_.data() + n * per_block;
    node_index_.insert(node_blocks_[n].key, tag(node_blocks_[n].field), static_cast<int>(n));
  }
}

// The tiles of a node block stand in the order of their patches_; that order fixes its sums.
void BlockGrid::link_patches() {
  const int dimension = geometry().dimension, corners = corner_count(dimension);
  patch_index_.clear(patches_.size());
  for (std::size_t p = 0; p < patches_.size(); ++p)
    patch_index_.insert(patches_[p].key, patches_[p].body, static_cast<int>(p));
  for (Patch& patch : patches_) {
    if (patch.near)
      patch.tile.nodes.reserve(static_cast<std::size_t>(tile_nodes(dimension)) * kNodeDoubles);
    if (patch.here) patch.beta.reserve(kBlockNodes);
    for (int c = 0; c < corners && patch.near; ++c) {
      const int n = find_node_block(at_corner(patch.key, c, 1, dimension), patch.field);
      patch.links.node_blocks[static_cast<std::size_t>(c)] = n;
      ++node_blocks_[static_cast<std::size_t>(n)].tiles;
    }
    for (int s = 0; s < neighbour_count(dimension); ++s)
      patch.links.neighbours[static_cast<std::size_t>(s)] =
          find_patch(shifted(patch.key, s, dimension), patch.body);
  }
  int first = 0;
  for (NodeBlock& block : node_blocks_) {
    block.first_tile = first;
    first += block.tiles;
    block.tiles = 0;
  }
  tile_refs_.resize(static_cast<std::size_t>(first));
  for (std::size_t p = 0; p < patches_.size(); ++p)
    for (int c = 0; c < corners && patches_[p].near; ++c) {
      NodeBlock& block = node_blocks_[static_cast<std::size_t>(
          patches_[p].links.node_blocks[static_cast<std::size_t>(c)])];
      if (block.tiles == 0) block.counted = patches_[p].here;
      block.whole = block.whole && patches_[p].here;
      tile_refs_[static_cast<std::size_t>(block.first_tile + block.tiles++)] = {static_cast<int>(p),
                                                                                c};
    }
  if (owner_) count_masters();
}

/// What no tile reaches follows from tied nodes alone, and is counted where the first block of
/// these is.
void BlockGrid::count_masters() {
  std::vector<bool> known(node_blocks_.size());
  for (const NodeBlock& block : node_blocks_)
    for (int c = 0; c < corner_count(geometry().dimension) && block.tied != 0; ++c) {
      const auto key = master_block(block.key, c, geometry().dimension);
      const int m = key ? find_node_block(*key, block.field) : -1;
      if (m < 0 || known[static_cast<std::size_t>(m)]) continue;
      known[static_cast<std::size_t>(m)] = true;
      NodeBlock& master = node_blocks_[static_cast<std::size_t>(m)];
      if (master.tiles == 0) master.counted = block.counted;
    }
}

}  // namespace krater
