// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a step that only a fixed reference configuration needs.
#include <algorithm>

#include "krater/core/parallel.hpp"
#include "krater/kinematics/mpm/mpm_step.hpp"

namespace krater {

// Where the material of the nodes at walls is: x_I = sum S m (x_p + F_p (X_I - X_p)) / m_I, exact
// for a linear map. Only on a fixed reference; elsewhere a node is where it is.
void MpmStep::measure_gaps() {
  const int corners = corner_count(grid_.geometry().dimension);
  const SweepSettings s = settings(0);
  const auto at_wall = [this](int n) {
    return grid_.node_blocks()[static_cast<std::size_t>(n)].at_wall;
  };
  for_each(grid_.patches().size(), [&](std::size_t p) {
    Patch& patch = grid_.patches()[p];
    if (!patch.here) return;
    if (std::none_of(patch.links.node_blocks.begin(), patch.links.node_blocks.begin() + corners,
                     at_wall))
      return;
    plain_.scatter(patch, position_as_velocity_[static_cast<unsigned>(patch.body)], s, scratch());
    patch.tile.state = Tile::State::stale;
  });
  if (ranks_ != nullptr) {
    ranks_->send_tiles(grid_);
    ranks_->receive_tiles(grid_);
  }
  for (const std::size_t n : waiting_blocks_)
    if (grid_.node_blocks()[n].at_wall) kernels_.sum_tiles(grid_, grid_.node_blocks()[n]);
  boundary_.note_gaps();
  lap(Phase::boundary);
}

// Returns true when the topology changed.
bool MpmStep::renew_references() {
  bool renewed = false;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (largest_strain(grid_, static_cast<int>(b)) <= method_.refresh_strain) continue;
    double heat = 0;
    const Removed r =
        renew_reference(grid_, static_cast<int>(b), boundary_, bodies_[b].columns, ranks_, heat);
    audit_.kinetic -= heat;
    audit_.internal += heat;
    (heat > 0 ? audit_.transfer_loss : audit_.transfer_gain) += heat;
    audit_.book_removed(r);
    if (bodies_[b].heat_floor == nullptr) audit_.unfelt_removed += r.internal;
    audit_.new_references += 1;
    renewed = true;
  }
  return renewed;
}

}  // namespace krater
