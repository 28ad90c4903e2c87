// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/simulation/refinement.hpp"

#include <algorithm>
#include <array>

namespace krater {

namespace {

/// All blocks of the levels below `level` that reach into an extent within the domain and are
/// touched.
void mark(const GridGeometry& coarsest, const Box& extent, int level,
          const std::function<bool(const Box&)>& touched, BlockSet& out) {
  GridGeometry g = coarsest;
  for (int l = 0; l < level; ++l, g = finer(g)) {
    Triple low{}, high{};
    for (int a = 0; a < g.dimension; ++a) {
      const auto k = static_cast<std::size_t>(a);
      low[k] = std::max(extent.min[k], g.min[k]);
      high[k] = std::min(extent.max[k], g.upper(a));
      if (low[k] > high[k]) return;
    }
    const BlockKey first = block_of(g, low.data()), last = block_of(g, high.data());
    BlockKey key = first;
    for (key.i[0] = first.i[0]; key.i[0] <= last.i[0]; ++key.i[0])
      for (key.i[1] = first.i[1]; key.i[1] <= last.i[1]; ++key.i[1])
        for (key.i[2] = first.i[2]; key.i[2] <= last.i[2]; ++key.i[2])
          if (touched(box_of(g, key))) out.insert(key);
  }
}

/// More than their sides in common, in parts of the block's edge.
bool overlap(const Box& block, const Box& box, int dimension) {
  constexpr double kRoundOff = 1e-9;
  for (int a = 0; a < dimension; ++a) {
    const auto k = static_cast<std::size_t>(a);
    const double slack = kRoundOff * block.length(a);
    if (block.max[k] <= box.min[k] + slack || block.min[k] >= box.max[k] - slack) return false;
  }
  return true;
}

}  // namespace

Box box_of(const GridGeometry& g, const BlockKey& key) {
  const int edge = block_edge(g.dimension);
  Box box{};
  for (int a = 0; a < g.dimension; ++a) {
    const auto k = static_cast<std::size_t>(a);
    box.min[k] = g.min[k] + (key.i[k] * edge - g.origin) * g.h;
    box.max[k] = box.min[k] + edge * g.h;
  }
  return box;
}

BlockSet refined_regions(const Scene& scene, const GridGeometry& coarsest) {
  BlockSet out;
  for (const RefineOptions& rule : scene.grid.refine) {
    if (!rule.region && !rule.box) continue;
    const Box extent = rule.box ? *rule.box : rule.region->extent(scene.frame);
    mark(
        coarsest, extent, rule.level,
        [&](const Box& block) {
          return overlap(block, extent, coarsest.dimension) &&
                 (rule.box || rule.region->classify(scene.frame, block) != Place::outside);
        },
        out);
  }
  return out;
}

void refine_around(const RefineOptions& rule, const BlockGrid& grid, BlockSet& refined) {
  for (const Patch& patch : grid.patches()) {
    if (patch.body != rule.follow || patch.points.empty()) continue;
    Box box = box_of(grid.geometry(patch.key.level), patch.key);
    for (int a = 0; a < grid.geometry().dimension; ++a) {
      const auto k = static_cast<std::size_t>(a);
      box.min[k] -= rule.margin;
      box.max[k] += rule.margin;
    }
    mark(
        grid.geometry(), box, rule.level,
        [&](const Box& block) { return overlap(block, box, grid.geometry().dimension); }, refined);
  }
}

}  // namespace krater
