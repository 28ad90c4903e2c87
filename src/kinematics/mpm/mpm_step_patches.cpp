// SPDX-License-Identifier: GPL-3.0-or-later
// Which patches a step passes over because nothing moves there, and which are scattered for the
// next step ahead of it.
#include <algorithm>
#include <chrono>
#include <cstring>

#include "krater/core/parallel.hpp"
#include "krater/kinematics/mpm/mpm_step.hpp"

namespace krater {

namespace {

std::uint64_t hash_of(const double* data, std::size_t count) {
  std::uint64_t hash = 1469598103934665603U;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t bits;
    std::memcpy(&bits, data + i, sizeof(bits));
    hash = (hash ^ bits) * 1099511628211U;
  }
  return hash;
}

}  // namespace

// Dormant blocks. A patch whose nodes are all at rest is gathered once more; if that changed no bit
// of its points, it would change none in any later step either, and is passed over, its tile with
// it, until a node around it moves. The hash is paid only in that one gather.
bool MpmStep::may_sleep(GatherPart part) const {
  return method_.dormant_blocks && part == GatherPart::all && !loaded_ && !boundary_.drives() &&
         fluid_patches_.empty();
}

bool MpmStep::asleep(const NodeBlock& block) const {
  if (!block.inert || block.completed || waits(block) || !fluid_patches_.empty()) return false;
  for (int t = block.first_tile; t < block.first_tile + block.tiles; ++t) {
    const int p = grid_.tile_refs()[static_cast<std::size_t>(t)].patch;
    const Tile& tile = grid_.patches()[static_cast<std::size_t>(p)].tile;
    if (tile.state != Tile::State::asleep) return false;
  }
  return true;
}

// Points may leave the patch or change places in it. Their ids lie at the head of every record
// (mpm/columns.cpp declares them first).
void MpmStep::name_limit(Patch& patch) const {
  if (!(patch.result.max_rate > 0)) return;
  patch.result.limiting_point = static_cast<int>(patch.points.at(0, patch.result.limiting_point));
}

void MpmStep::gather(std::size_t p, GatherPart part, const SweepSettings& s,
                     const SweepScratch& w) {
  Patch& patch = grid_.patches()[p];
  const BodyKernelData& body = bodies_[static_cast<unsigned>(patch.body)];
  if (patch.points.empty()) {  // made ahead, or left behind: its tile is zero, and stays so
    patch.result = {};
    patch.tile.state = Tile::State::asleep;
    removed_[p] = {};
    return;
  }
  const int corners = corner_count(grid_.geometry().dimension);
  const bool still =
      s.may_sleep &&
      std::all_of(patch.links.node_blocks.begin(), patch.links.node_blocks.begin() + corners,
                  [this](int n) { return grid_.node_blocks()[static_cast<std::size_t>(n)].still; });
  patch.result.ledger = {};
  patch.tile.state = still && patch.settled ? Tile::State::asleep : Tile::State::stale;
  if (patch.tile.state == Tile::State::asleep) {
    removed_[p] = {};
    patch.result.heat_given = patch.result.heat_taken = patch.result.carriers = 0;
    patch.result.cut_impulse = {};
    return;
  }
  const std::size_t size = patch.points.size();
  const std::uint64_t before = still ? hash_of(patch.points.data(), size) : 0;
  if (part != GatherPart::velocity_move) patch.result.max_rate = patch.result.stretch = 0;
  kernels_.gather(patch, grid_, body, s, w, part);
  if (part != GatherPart::velocity_move) name_limit(patch);
  patch.settled = still && hash_of(patch.points.data(), size) == before;
}

/// A patch moves; what leaves it is in its outbox, and where nothing does, it is scattered again.
void MpmStep::gather_and_collect(std::size_t p, GatherPart part, const SweepSettings& s,
                                 const AfterGather& then) {
  const SweepScratch w = scratch();
  Patch& patch = grid_.patches()[p];
  gather(p, part, s, w);
  if (!then.moves || patch.tile.state == Tile::State::asleep ||
      patch.result.fault.kind != FaultKind::none)
    return;
  const int before = patch.points.count();
  removed_[p] = collect_leavers(patch, grid_.levels(), boundary_,
                                bodies_[static_cast<unsigned>(patch.body)].columns, w.leavers);
  const bool steady = patch.steady;
  patch.steady = patch.points.count() == before;
  if (then.scatters && steady && patch.steady) scatter_ahead(patch, s, w);
  if (!then.scatters || !look_) return;
  patch.points.pad(bodies_[static_cast<unsigned>(patch.body)].columns.mass);
  look_(p);
}

/// Some patch of this rank could not be scattered.
bool MpmStep::faults_here() const {
  return std::any_of(grid_.patches().begin(), grid_.patches().end(), [](const Patch& p) {
    return p.here && p.result.fault.kind != FaultKind::none;
  });
}

// Points are read from memory once a step: the next scatter follows the gather of a patch while its
// points are in the cache. It takes no dt, and where points come or leave after all, or are changed
// from outside, it is done again; so the bits are the same, ahead or not. Not where most would be
// done twice: a patch whose points changed in the last step is left to the next sweep.
bool MpmStep::may_scatter_ahead(GatherPart part) const {
  return part == GatherPart::all && method_.update == Update::usl &&
         method_.reference == Reference::current && !loaded_;
}

void MpmStep::scatter_ahead(Patch& patch, const SweepSettings& s, const SweepScratch& w) {
  const auto start = std::chrono::steady_clock::now();
  kernels_.scatter(patch, bodies_[static_cast<unsigned>(patch.body)], s, w);
  memory_[static_cast<unsigned>(thread_index())].scatter_seconds +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (patch.result.fault.kind == FaultKind::none) patch.tile.state = Tile::State::ahead;
  patch.result.fault = {};  // a broken point is found again, in the step that it breaks
}

}  // namespace krater
