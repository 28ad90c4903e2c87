// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file grid/levels.hpp
/// Which part of space has which cells. A block that is *refined* is replaced by the 2^dim blocks
/// of the next level that lie in it; a point belongs to the first block around it that is not. R_l
/// is the union of all blocks of level l and finer.
///
/// Grading: around a refined block of level l all 3^dim blocks of level l lie in R_l. Then no node
/// that is tied to nodes of the level above is one that ties others.
///
/// A node of level l >= 1 is *tied* when a cell of its support does not lie in R_l: with the nodes
/// n of level l it is the function S_n less what coarser functions hold of it, and follows from its
/// masters J of level l - 1 by the two-scale relation of quadratic B-splines, per axis
///   S_J^(l-1) = 1/4 S_(2J-2) + 3/4 S_(2J-1) + 3/4 S_(2J) + 1/4 S_(2J+1),
/// so node n has the masters n>>1 and (n>>1) + 1 with weights 3/4, 1/4 (n even) or 1/4, 3/4 (odd).
/// This is the truncated hierarchical basis of Giannelli, Juettler, Speleers (2012, Computer Aided
/// Geometric Design 29, 485), reached without a point ever seeing nodes of two levels. Beyond the
/// planes of the domain the map is its mirror image, so that half a model has the map of the whole.
#include <array>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "krater/grid/geometry.hpp"

namespace krater {

struct BlockKeyHash {
  std::size_t operator()(const BlockKey& key) const { return hash_of(key, 0); }
};
using BlockSet = std::unordered_set<BlockKey, BlockKeyHash>;

inline constexpr int kMostLevels = 6;  ///< of refinement

class Levels {
 public:
  explicit Levels(const GridGeometry& coarsest) : geometries_{coarsest} {}

  /// These blocks are refined, and all that grading and their own place ask for. True: it is
  /// another map than before.
  bool set(BlockSet refined);
  /// Of the map, in their order.
  std::vector<BlockKey> refined() const;
  bool single() const { return refined_.empty(); }
  int count() const { return static_cast<int>(geometries_.size()); }
  const GridGeometry& geometry(int level = 0) const {
    return geometries_[static_cast<std::size_t>(level)];
  }
  /// The block whose points see what lies at a position.
  BlockKey block_at(const double* position) const;
  bool is_refined(const BlockKey& key) const { return refined_.contains(key); }
  /// The space of the block lies in R_l, l its level.
  bool holds(const BlockKey& key) const;
  /// The tied nodes of a block of nodes, a bit each.
  std::uint64_t tied_nodes(const BlockKey& key) const;

 private:
  bool holds_cell(const std::array<int, 3>& cell, int level) const;

  std::vector<GridGeometry> geometries_;
  BlockSet refined_;
  mutable std::unordered_map<BlockKey, std::uint64_t, BlockKeyHash> known_;  ///< tied_nodes
};

/// The block of the level above that a block lies in.
BlockKey parent_of(const BlockKey& key, int dimension);

}  // namespace krater
