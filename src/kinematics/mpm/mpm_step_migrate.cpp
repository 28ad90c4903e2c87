// SPDX-License-Identifier: GPL-3.0-or-later
// The end of a step: points go where they belong, and cells may become others.
#include <algorithm>

#include "krater/kinematics/mpm/mpm_step.hpp"

namespace krater {

void MpmStep::migrate() {
  for (std::size_t p = 0; p < removed_.size(); ++p) {
    audit_.book_removed(removed_[p]);
    if (removed_[p].count > 0 && feels_no_energy(p)) audit_.unfelt_removed += removed_[p].internal;
  }
  if (impulses_.any()) note_put_back();
  const std::vector<int> losing = rigid_losses();
  const Delivered delivered = deliver(grid_, boundary_, bodies_, sizes_);
  book_delivered(delivered);
  bool changed = delivered.changed;
  for (const int b : losing)  // what is left moves on as it did
    rigid_.find(b)->lose(grid_, bodies_[static_cast<std::size_t>(b)].columns);
  if (method_.reference == Reference::adaptive) changed = renew_references() || changed;
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
  book_delivered(deliver(grid_, boundary_, bodies_, sizes_));
  grid_.rebuild(true);
  relink();
  lap(Phase::migrate);
}

}  // namespace krater
