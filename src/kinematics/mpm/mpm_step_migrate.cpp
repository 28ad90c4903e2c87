// SPDX-License-Identifier: GPL-3.0-or-later
// The end of a step: points go where they belong, and cells may become others.
#include <algorithm>

#include "krater/core/parallel.hpp"
#include "krater/kinematics/mpm/mpm_step.hpp"
#include "krater/kinematics/mpm/stretch.hpp"

namespace krater {

namespace {

constexpr double kStepsAhead = 8;  ///< for which blocks are made beforehand

}  // namespace

void MpmStep::migrate() {
  for (std::size_t p = 0; p < removed_.size(); ++p) {
    audit_.book_removed(removed_[p]);
    if (removed_[p].count > 0 && feels_no_energy(p)) audit_.unfelt_removed += removed_[p].internal;
  }
  if (impulses_.any()) note_put_back();
  const std::vector<int> losing = rigid_losses();
  const Delivered delivered =
      deliver(grid_, boundary_, bodies_, sizes_, kStepsAhead * last_step_, ranks_);
  book_delivered(delivered);
  bool changed = delivered.changed;
  for (const int b : losing)  // what is left moves on as it did
    rigid_.find(b)->lose(grid_, bodies_[static_cast<std::size_t>(b)].columns);
  if (method_.reference == Reference::adaptive) changed = renew_references() || changed;
  if (ranks_ != nullptr) changed = ranks_->rebalance(grid_) || changed;
  if (changed)
    relink();
  else
    provide_memory();  // patches may have grown
  lap(Phase::migrate);
}

void MpmStep::book_delivered(const Delivered& delivered) {
  audit_.book_level(delivered.heat, delivered.unfelt);
  audit_.split_points += delivered.made;
  limit_.rate = std::max(limit_.rate, delivered.finer_rate);
}

void MpmStep::regrid(BlockSet refined) {
  if (!grid_.set_levels(std::move(refined))) return;
  for (Patch& patch : grid_.patches())
    if (!grid_.levels().holds(patch.key) || grid_.levels().is_refined(patch.key))
      send_away(patch, grid_.levels(), bodies_[static_cast<std::size_t>(patch.body)].columns);
  book_delivered(deliver(grid_, boundary_, bodies_, sizes_, 0, ranks_));
  grid_.rebuild(true);
  relink();
  lap(Phase::migrate);
}

void MpmStep::merge() {
  std::vector<Merged> merged(grid_.patches().size());
  const int corners = corner_count(grid_.geometry().dimension);
  for_each(merged.size(), [&](std::size_t p) {
    Patch& patch = grid_.patches()[p];
    if (!patch.here) return;
    const auto body = static_cast<std::size_t>(patch.body);
    for (int c = 0; c < corners; ++c)
      if (grid_
              .node_blocks()[static_cast<std::size_t>(
                  patch.links.node_blocks[static_cast<std::size_t>(c)])]
              .at_tie)
        return;
    merged[p] = merge_points(patch, grid_.geometry(patch.key.level), bodies_[body], sizes_[body],
                             merge_plans_[body]);
  });
  if (ranks_ != nullptr) {
    ranks_->share(grid_, merged);
    ranks_->share_counts(grid_);
  }
  for (const Merged& m : merged) {
    audit_.book_level(m.heat, m.unfelt);
    audit_.merged_points += m.points;
  }
  lap(Phase::migrate);
}

void MpmStep::split_stretched() {
  std::vector<std::vector<int>> found(grid_.patches().size());
  for_each(found.size(), [&](std::size_t p) {
    const Patch& patch = grid_.patches()[p];
    const auto body = static_cast<std::size_t>(patch.body);
    if (patch.here && sizes_[body].halves)
      found[p] = stretched_points(patch, grid_.geometry(patch.key.level), bodies_[body].columns,
                                  sizes_[body]);
  });
  struct Halved {
    double points, heat;
    std::uint32_t used;  ///< of the outbox
  };
  std::vector<Halved> halved;
  for (const std::vector<int>& points : found)
    halved.push_back({static_cast<double>(points.size()), 0, 0});
  if (ranks_ != nullptr) ranks_->share(grid_, halved);
  for (std::size_t p = 0; p < found.size(); ++p) {  // numbers go on in the order of patches
    Patch& patch = grid_.patches()[p];
    const auto body = static_cast<std::size_t>(patch.body);
    PointSize size = sizes_[body];
    sizes_[body].next_id += halved[p].points;
    if (found[p].empty()) continue;
    halved[p].heat =
        split_stretched_points(patch, grid_.levels(), bodies_[body].columns, size, found[p]);
    halved[p].used = patch.outbox.used;
  }
  if (ranks_ != nullptr) ranks_->share(grid_, halved);
  double all = 0;
  for (std::size_t p = 0; p < found.size(); ++p) {
    if (!(halved[p].points > 0)) continue;
    audit_.book_level(halved[p].heat, feels_no_energy(p) ? halved[p].heat : 0);
    grid_.patches()[p].outbox.used = halved[p].used;
    all += halved[p].points;
  }
  if (!(all > 0)) return;
  audit_.split_points += all;
  if (ranks_ != nullptr) ranks_->share_counts(grid_);
  const Delivered delivered = deliver(grid_, boundary_, bodies_, sizes_, 0, ranks_);
  book_delivered(delivered);
  if (delivered.changed)
    relink();
  else
    provide_memory();
  lap(Phase::migrate);
}

}  // namespace krater
