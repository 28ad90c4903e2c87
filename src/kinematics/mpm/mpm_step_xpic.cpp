// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a step that only xpic needs.
#include <algorithm>

#include "krater/kinematics/mpm/mpm_step.hpp"

namespace krater {

// Adds the impulse of walls [N s]: they act on each term S+ S dv(l), which enters with a minus
// sign.
void MpmStep::filter_velocity(std::array<double, 3>& impulse) {
  // v(1) = v+, dv(1) = v+; dv(l+1) = dv(l) - S+ S dv(l); v(m) = sum dv(l): Hammerquist & Nairn
  // (2017), FMPM form.
  const std::size_t block_doubles = kBlockNodes * kNodeDoubles;
  const std::size_t total = grid_.node_blocks().size() * block_doubles;
  double* sum = filtered_.data();
  double* increment = sum + total;
  if (total == 0) return;
  double* nodes = grid_.nodes();  // node memory is contiguous over blocks
  std::copy(nodes, nodes + total, sum);
  for (int order = 1; order < method_.xpic_order; ++order) {
    std::copy(nodes, nodes + total, increment);
    grid_to_particles(GatherPart::keep_only, 0);
    particles_to_grid(plain_, velocity_from_kept_, 0);
    double unused = 0;
    momentum(unused, 0);
    const BoundaryWork term = boundary_.constrain();
    impulses_.add(boundary_.given(), -1);
    boundary_.mirror();
    const BoundaryWork folds = boundary_.folded(0, 0);
    for (std::size_t a = 0; a < 3; ++a) impulse[a] -= term.impulse[a] + folds.impulse[a];
    lap(Phase::boundary);
    for (std::size_t i = 0; i < total; i += kNodeDoubles)
      for (std::size_t a = i; a < i + 3; ++a) {
        nodes[a] = increment[a] - nodes[a];
        sum[a] += nodes[a];
      }
  }
  std::copy(sum, sum + total, nodes);
  write_filtered_work();
}

// The nodes as the forces left them, before anything else.
void MpmStep::note_forces() {
  const std::size_t total = grid_.node_blocks().size() * kBlockNodes * kNodeDoubles;
  filtered_.reserve(3 * total);
  std::copy(grid_.nodes(), grid_.nodes() + total, filtered_.data() + 2 * total);
}

// The filter is one more change of v+, after the forces f and walls at rest: dv = v(m) - v-, and
// what it takes from motion is in k = vbar . (dt f/m) (mpm/ledger.hpp) by the vbar of v(m).
void MpmStep::write_filtered_work() {
  const std::size_t total = grid_.node_blocks().size() * kBlockNodes * kNodeDoubles;
  double* nodes = grid_.nodes();
  for (std::size_t i = 0; i < total; i += kNodeDoubles) {
    const double* forced = filtered_.data() + 2 * total + i;
    double k = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double minus = forced[a] - forced[4 + a], change = nodes[i + a] - minus;
      k += (minus + 0.5 * change) * forced[4 + a] + minus * minus;
      nodes[i + 4 + a] = change;
    }
    nodes[i + moved::work] = k;
  }
  for (NodeBlock& block : grid_.node_blocks()) block.still = false;
  boundary_.mirror();
  heat_ = {};
}

}  // namespace krater
