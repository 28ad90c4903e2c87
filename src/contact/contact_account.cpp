// SPDX-License-Identifier: GPL-3.0-or-later
// What contact did in a step, over all its blocks.
#include "krater/contact/contact.hpp"
#include "krater/core/parallel.hpp"
#include "krater/core/ranks.hpp"

namespace krater {

/// Of the groups, whose rigid bodies have been given nothing yet.
ContactWork ContactSet::total() const {
  std::array<ReproducibleSum, 3> sums;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (!groups_[g].counted) continue;
    sums[0] += results_[g].change;
    sums[1] += results_[g].friction;
    sums[2] += results_[g].nodes;
  }
  ranks::sum(sums);
  ContactWork out;
  out.change = sums[0].value();
  out.friction = sums[1].value();
  out.nodes = sums[2].value();
  return out;
}

double ContactSet::heat() {
  heats_.resize(groups_.size());
  for_each(groups_.size(), [&](std::size_t g) { heats_[g] = groups_[g].heat.book(); });
  ReproducibleSum sum;
  for (std::size_t g = 0; g < groups_.size(); ++g)
    if (groups_[g].counted) sum += heats_[g];
  ranks::sum({&sum, 1});
  return sum.value();
}

void ContactSet::give(Impulses& impulses) const {
  std::vector<ImpulseSum> all;
  for (const Group& group : groups_)
    if (group.counted) add_impulses(all, group.given);
  impulses.add(all);
}

}  // namespace krater
