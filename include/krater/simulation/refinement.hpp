// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file simulation/refinement.hpp
/// Where a scene wants finer cells (grid.refine), as the blocks that must be refined for it: of
/// every rule the blocks it touches, up to its level; the map itself is then graded
/// (grid/levels.hpp). Rules of a region hold for good. The others are asked again every
/// `kRegridSteps` steps:
///   follow a body: all blocks within the margin of the blocks that hold its points;
///   where a field is large: blocks around those that hold a point above the threshold, and those
///   of the finest cells until no point there was above a quarter of it for three times.
/// The grid carries no state from step to step, so a new map moves and splits points and does
/// nothing else.
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "krater/distribute/distribution.hpp"
#include "krater/geometry/solids/box.hpp"
#include "krater/grid/blocks.hpp"
#include "krater/scene/scene.hpp"
#include "krater/simulation/body.hpp"

namespace krater {

inline constexpr int kRegridSteps = 8;

/// The space that the cells of a block fill, along the grid axes [m].
Box box_of(const GridGeometry& geometry, const BlockKey& key);

class Refinement {
 public:
  using Bodies = std::vector<std::unique_ptr<Body>>;
  /// Throws InputError where no body carries the field that a rule looks at, and where a region
  /// holds more blocks than can be listed.
  Refinement(const Scene& scene, const GridGeometry& coarsest, const Bodies& bodies);

  /// Some rule does not hold for good.
  bool moves() const { return moves_; }
  /// Before there are points: `blocks` of the coarsest level hold those of each body.
  BlockSet at_start(const std::vector<BlockSet>& blocks) const;
  /// Now.
  BlockSet find(const BlockGrid& grid, const Distribution* ranks);

  /// What the rules remember, for a checkpoint.
  std::vector<std::int64_t> state() const;
  void restore(const std::vector<std::int64_t>& state);

 private:
  /// Blocks that a rule of a field has refined last, and how many times it did not ask for them.
  using Held = std::map<BlockKey, int>;
  void look(std::size_t rule, const BlockGrid& grid, const Distribution* ranks);
  double largest(const Patch& patch, std::size_t rule) const;

  const std::vector<RefineOptions>& rules_;
  GridGeometry coarsest_;
  BlockSet regions_;
  bool moves_ = false;
  std::vector<std::vector<int>> offsets_;  ///< [rule][body]: of its field; -1: not carried
  std::vector<Held> held_;                 ///< by rule
};

}  // namespace krater
