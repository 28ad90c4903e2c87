// SPDX-License-Identifier: GPL-3.0-or-later
// The nodes' part of a step: sums of tiles, momentum, and a step that is short enough for it.
#include <algorithm>
#include <cmath>

#include "krater/core/parallel.hpp"
#include "krater/core/ranks.hpp"
#include "krater/core/reproducible_sum.hpp"
#include "krater/kinematics/mpm/mpm_step.hpp"

namespace krater {

namespace {

// A step is halved when the change of velocity alone would move material by more than this share of
// a cell.
constexpr double kMaxShare = 0.3;

}  // namespace

std::vector<MomentumSettings> MpmStep::momentum_settings(double dt_force) const {
  std::vector<MomentumSettings> out;
  for (int level = 0; level < grid_.levels().count(); ++level) {
    MomentumSettings s = node_settings_;
    s.dt_force = dt_force;
    s.cell_volume = std::pow(grid_.geometry(level).h, grid_.geometry().dimension);
    out.push_back(s);
  }
  return out;
}

double MpmStep::momentum(double& dt, double force_share) {
  const std::vector<MomentumSettings> s = momentum_settings(force_share * dt);
  const bool fluids = !fluid_patches_.empty(), loads = loads_.any() && force_share > 0;
  const auto update = [&](std::size_t n) {
    NodeBlock& block = grid_.node_blocks()[n];
    kernels_.momentum(block, s[static_cast<std::size_t>(block.key.level)]);
  };
  const auto sum = [&](bool whole) {
    for_each(
        grid_.node_blocks().size(),
        [&](std::size_t n) {
          NodeBlock& block = grid_.node_blocks()[n];
          if (block.whole != whole || asleep(block)) return;
          kernels_.sum_tiles(grid_, block);
          if (!waits(block) && !fluids && !loads) update(n);
        },
        few_blocks());
  };
  sum(true);
  if (ranks_ != nullptr) {
    ranks_->receive_tiles(grid_);
    sum(false);
  }
  if (fluids) {
    if (force_share > 0 || method_.update == Update::usf) collect_pressure(settings(dt));
    if (force_share > 0) add_pressure_force(settings(dt));
  }
  if (loads) loads_.add_forces(dt, node_settings_.smallest_mass);
  if (fluids || loads)
    for_each(
        grid_.node_blocks().size(),
        [&](std::size_t n) {
          if (!waits(grid_.node_blocks()[n])) update(n);
        },
        few_blocks());
  lap(Phase::nodes);
  for (int level = grid_.levels().count() - 1; level >= 0; --level) {
    boundary_.fold(level);
    if (level > 0) ties_.restrict(level);
  }
  for_each(
      waiting_blocks_.size(), [&](std::size_t i) { update(waiting_blocks_[i]); }, few_blocks());
  ties_.sharpen(s);
  ReproducibleSum kinetic = node_kinetic();
  std::array<double, 2> greatest{greatest_change(), faults_here() ? 1.0 : 0.0};
  ranks::reduce({&kinetic, 1}, greatest);
  if (ranks_ != nullptr && greatest[1] > 0) {  // all must hear where
    ranks_->share_results(grid_, removed_);
    throw_faults();
  }
  const double share = safe_share(greatest[0], force_share * dt);
  if (share < 1) {
    shorten(dt, share);
    kinetic = node_kinetic();
    ranks::sum({&kinetic, 1});
  }
  lap(Phase::boundary);
  return rigid_.kinetic() + kinetic.value();
}

/// Of deformable matter, as far as this rank counts it.
ReproducibleSum MpmStep::node_kinetic() const {
  ReproducibleSum kinetic;
  for (const NodeBlock& block : grid_.node_blocks()) {
    if (!block.counted || (rigid_.any() && rigid_.find(body_of(block.field)))) continue;
    kinetic += block.sums.kinetic;
  }
  return kinetic;
}

/// Of a node's velocity in the step, in cells of the coarsest level.
double MpmStep::greatest_change() const {
  double most = 0;
  for (const NodeBlock& block : grid_.node_blocks())
    if (block.counted) most = std::max(most, std::ldexp(block.sums.max_change, block.key.level));
  return most;
}

/// Share of a step that the change of velocity alone may move material through its cells; halved
/// until it does.
double MpmStep::safe_share(double most, double dt_force) const {
  double share = 1;
  while (share * most * share * dt_force > kMaxShare * grid_.geometry().h) share *= 0.5;
  return share;
}

void MpmStep::shorten(double& dt, double share) {
  ties_.shorten(share);
  dt *= share;
  audit_.retries += 1;
  for (NodeBlock& block : grid_.node_blocks()) {
    block.sums.kinetic = 0;
    for (double* node = block.nodes; node < block.nodes + kBlockNodes * kNodeDoubles;
         node += kNodeDoubles) {
      double speed2 = 0;
      for (int a = 0; a < 3; ++a) {
        node[a] -= (1 - share) * node[4 + a];
        node[4 + a] *= share;
        speed2 += node[a] * node[a];
      }
      block.sums.kinetic += 0.5 * node[3] * speed2;
    }
  }
}

}  // namespace krater
