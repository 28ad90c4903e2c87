// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/simulation/refinement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "krater/core/errors.hpp"

namespace krater {

namespace {

constexpr double kLetGo = 0.25;  ///< of the threshold
constexpr int kPatience = 3;     ///< times that a block is not asked for

/// call(key) for all blocks of a level that reach into a box within the domain.
template <class Call>
void for_each_block(const GridGeometry& g, const Box& box, const Call& call) {
  constexpr double kRoundOff = 1e-9;  // of a block's edge: sides in common are no reach
  const double slack = kRoundOff * block_edge(g.dimension) * g.h;
  Triple low{}, high{};
  for (int a = 0; a < g.dimension; ++a) {
    const auto k = static_cast<std::size_t>(a);
    low[k] = std::max(box.min[k], g.min[k]) + slack;
    high[k] = std::min(box.max[k], g.upper(a)) - slack;
    if (low[k] > high[k]) return;
  }
  const BlockKey first = block_of(g, low.data()), last = block_of(g, high.data());
  BlockKey key = first;
  for (key.i[0] = first.i[0]; key.i[0] <= last.i[0]; ++key.i[0])
    for (key.i[1] = first.i[1]; key.i[1] <= last.i[1]; ++key.i[1])
      for (key.i[2] = first.i[2]; key.i[2] <= last.i[2]; ++key.i[2]) call(key);
}

/// A map of more blocks than that fits no memory, and to list them takes minutes.
void require_blocks(const GridGeometry& coarsest, const RefineOptions& rule, const Box& extent) {
  constexpr double kMost = 1e7;
  double blocks = 1;  // of the finest that are refined
  const double edge = block_edge(coarsest.dimension) * std::ldexp(coarsest.h, 1 - rule.level);
  for (int a = 0; a < coarsest.dimension; ++a) {
    const auto k = static_cast<std::size_t>(a);
    const double length =
        std::min(extent.max[k], coarsest.upper(a)) - std::max(extent.min[k], coarsest.min[k]);
    blocks *= std::max(1.0, length / edge);
  }
  if (blocks > kMost)
    throw InputError(fmt::format(
        "{}: a region of {:.3g} million blocks of cells, and 10 million are allowed; use a lower "
        "level, a smaller region, or follow: BODY, which refines only around it",
        rule.where, 1e-6 * blocks));
}

/// All blocks of the levels below `level` that reach into a box.
void mark(const GridGeometry& coarsest, const Box& box, int level, BlockSet& out) {
  GridGeometry g = coarsest;
  for (int l = 0; l < level; ++l, g = finer(g))
    for_each_block(g, box, [&out](const BlockKey& key) { out.insert(key); });
}

void mark_region(const Scene& scene, const GridGeometry& coarsest, const RefineOptions& rule,
                 BlockSet& out) {
  if (rule.box) return mark(coarsest, *rule.box, rule.level, out);
  const Box extent = rule.region->extent(scene.frame);
  GridGeometry g = coarsest;
  for (int l = 0; l < rule.level; ++l, g = finer(g))
    for_each_block(g, extent, [&](const BlockKey& key) {
      if (rule.region->classify(scene.frame, box_of(g, key)) != Place::outside) out.insert(key);
    });
}

Box widened(Box box, double by, int dimension) {
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
    box.min[a] -= by;
    box.max[a] += by;
  }
  return box;
}

GridGeometry level_of(const GridGeometry& coarsest, int level) {
  GridGeometry g = coarsest;
  for (int l = 0; l < level; ++l) g = finer(g);
  return g;
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

Refinement::Refinement(const Scene& scene, const GridGeometry& coarsest, const Bodies& bodies)
    : rules_{scene.grid.refine}, coarsest_{coarsest}, held_(scene.grid.refine.size()) {
  for (const RefineOptions& rule : rules_) {
    if (rule.box || rule.region) {
      require_blocks(coarsest, rule, rule.box ? *rule.box : rule.region->extent(scene.frame));
      mark_region(scene, coarsest, rule, regions_);
    } else {
      moves_ = true;
    }
    std::vector<int>& offsets = offsets_.emplace_back();
    if (rule.field.empty()) continue;
    bool any = false;
    for (const auto& body : bodies) {
      const Column* c = body->layout().find(rule.field.c_str());
      const bool scalar = c != nullptr && c->components == 1;
      offsets.push_back(scalar ? c->offset : -1);
      any = any || scalar;
    }
    if (!any)
      throw InputError(rule.where + ": no body has a scalar '" + rule.field +
                       "' (see the columns that krater check lists for each body)");
  }
}

BlockSet Refinement::at_start(const std::vector<BlockSet>& blocks) const {
  BlockSet out = regions_;
  for (const RefineOptions& rule : rules_)
    if (rule.follow >= 0)
      for (const BlockKey& key : blocks[static_cast<std::size_t>(rule.follow)])
        mark(coarsest_, widened(box_of(coarsest_, key), rule.margin, coarsest_.dimension),
             rule.level, out);
  return out;
}

BlockSet Refinement::find(const BlockGrid& grid, const Distribution* ranks) {
  BlockSet out = regions_;
  for (std::size_t r = 0; r < rules_.size(); ++r) {
    const RefineOptions& rule = rules_[r];
    if (rule.follow >= 0)
      for (const Patch& patch : grid.patches())
        if (patch.body == rule.follow && patch.count() > 0)
          mark(coarsest_,
               widened(box_of(grid.geometry(patch.key.level), patch.key), rule.margin,
                       coarsest_.dimension),
               rule.level, out);
    if (rule.field.empty()) continue;
    look(r, grid, ranks);
    for (const auto& [key, times] : held_[r])
      for (BlockKey k = key; out.insert(k).second && k.level > 0;)
        k = parent_of(k, coarsest_.dimension);
  }
  return out;
}

double Refinement::largest(const Patch& patch, std::size_t rule) const {
  const int offset = offsets_[rule][static_cast<std::size_t>(patch.body)];
  double most = -std::numeric_limits<double>::infinity();
  for (int i = 0; offset >= 0 && i < patch.points.count(); ++i)
    most = std::max(most, patch.points.at(offset, i));
  return most;
}

void Refinement::look(std::size_t r, const BlockGrid& grid, const Distribution* ranks) {
  const RefineOptions& rule = rules_[r];
  Held& held = held_[r];
  for (auto& [key, times] : held) ++times;
  const GridGeometry above = level_of(coarsest_, rule.level - 1);
  const double margin = 0.5 * block_edge(above.dimension) * above.h;  // a block of the finest
  std::vector<double> most;
  for (const Patch& patch : grid.patches()) most.push_back(largest(patch, r));
  if (ranks != nullptr) ranks->share(grid, most);
  for (std::size_t p = 0; p < most.size(); ++p) {
    const Patch& patch = grid.patches()[p];
    const bool fine = patch.key.level >= rule.level;
    if (!(most[p] > (fine ? kLetGo : 1) * rule.above)) continue;
    const Box box = box_of(grid.geometry(patch.key.level), patch.key);
    for_each_block(above, fine ? box : widened(box, margin, above.dimension),
                   [&held](const BlockKey& key) { held[key] = 0; });
  }
  std::erase_if(held, [](const auto& entry) { return entry.second >= kPatience; });
}

std::vector<std::int64_t> Refinement::state() const {
  std::vector<std::int64_t> out;
  for (std::size_t r = 0; r < held_.size(); ++r)
    for (const auto& [key, times] : held_[r]) {
      out.push_back(static_cast<std::int64_t>(r));
      out.insert(out.end(), key.i.begin(), key.i.end());
      out.insert(out.end(), {key.level, times});
    }
  return out;
}

void Refinement::restore(const std::vector<std::int64_t>& state) {
  for (Held& held : held_) held.clear();
  for (std::size_t i = 0; i + 5 < state.size(); i += 6) {
    BlockKey key;
    for (std::size_t a = 0; a < 3; ++a) key.i[a] = static_cast<std::int32_t>(state[i + 1 + a]);
    key.level = static_cast<std::int32_t>(state[i + 4]);
    if (static_cast<std::size_t>(state[i]) < held_.size())
      held_[static_cast<std::size_t>(state[i])][key] = static_cast<int>(state[i + 5]);
  }
}

}  // namespace krater
