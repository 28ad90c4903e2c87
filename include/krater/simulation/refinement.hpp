// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file simulation/refinement.hpp
/// Where a scene wants finer cells (grid.refine), as the blocks that must be refined for it: of
/// every rule the blocks it touches, up to its level; the map itself is then graded
/// (grid/levels.hpp). Rules of a region hold for good. Those that follow a body or look at a field
/// are asked again every few steps; the grid carries no state from step to step, so a new map moves
/// and splits points and does nothing else.
#include <functional>
#include <vector>

#include "krater/geometry/solids/box.hpp"
#include "krater/grid/blocks.hpp"
#include "krater/scene/scene.hpp"

namespace krater {

/// The space that the cells of a block fill, along the grid axes [m].
Box box_of(const GridGeometry& geometry, const BlockKey& key);

/// Blocks that rules of regions refine.
BlockSet refined_regions(const Scene& scene, const GridGeometry& coarsest);

/// Blocks within a rule's margin of the patches of the body it follows.
void refine_around(const RefineOptions& rule, const BlockGrid& grid, BlockSet& refined);

}  // namespace krater
