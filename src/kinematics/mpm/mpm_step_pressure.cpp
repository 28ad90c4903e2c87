// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a step that only fluids need: their pressure on the grid (mpm/grid_pressure.hpp).
// Sums over tiles, folds and means of the second node records; the sweeps over points and cells are
// kernels.
#include <algorithm>
#include <array>

#include "krater/core/parallel.hpp"
#include "krater/grid/overlaps.hpp"
#include "krater/kinematics/mpm/mpm_step.hpp"

namespace krater {

namespace {

constexpr std::size_t kBlockDoubles = static_cast<std::size_t>(kBlockNodes) * kNodeDoubles;

bool is_fluid(const BodyKernelData& body) { return body.columns.local_correction >= 0; }

// A node beyond a plane of symmetry or a sticky one.
bool is_folded_ghost(const GridGeometry& g, const BoundaryConditions& conditions,
                     const BlockKey& key, int node) {
  const std::array<int, 3> index = index_in(key, node, g.dimension);
  for (std::size_t a = 0; a < static_cast<std::size_t>(g.dimension); ++a) {
    if (index[a] > 0 && index[a] <= g.cells[a] + 1) continue;
    if (conditions[a][index[a] > 0 ? 1 : 0].folds()) return true;
  }
  return false;
}

}  // namespace

void MpmStep::relink_fluids() {
  fluid_patches_.clear();
  fluid_blocks_.clear();
  std::vector<bool> holds(grid_.node_blocks().size());
  const int dimension = grid_.geometry().dimension;
  for (std::size_t p = 0; p < grid_.patches().size(); ++p) {
    Patch& patch = grid_.patches()[p];
    if (!patch.near || !is_fluid(bodies_[static_cast<std::size_t>(patch.body)])) continue;
    patch.owns_cells = true;  // patches of one block stand side by side
    for (auto other = fluid_patches_.rbegin();
         other != fluid_patches_.rend() && grid_.patches()[*other].key == patch.key; ++other)
      if (grid_.patches()[*other].field == patch.field) patch.owns_cells = false;
    patch.pressure_tile.reserve(static_cast<std::size_t>(tile_nodes(dimension)) * kNodeDoubles +
                                kBlockNodes);
    fluid_patches_.push_back(p);
    for (int c = 0; c < corner_count(dimension); ++c)
      holds[static_cast<std::size_t>(patch.links.node_blocks[static_cast<std::size_t>(c)])] = true;
  }
  for (std::size_t n = 0; n < holds.size(); ++n)
    if (holds[n]) fluid_blocks_.push_back(n);
  if (fluid_patches_.empty()) return;
  const std::size_t size = grid_.node_blocks().size() * kBlockDoubles;
  pressure_nodes_.reserve(size);
  std::fill(pressure_nodes_.data(), pressure_nodes_.data() + size, 0.0);
}

double* MpmStep::second_record(double* node) {
  return pressure_nodes_.data() + (node - grid_.nodes());
}

void MpmStep::sweep_fluids(PressurePart part, const SweepSettings& s) {
  for_each(fluid_patches_.size(), [&](std::size_t i) {
    Patch& patch = grid_.patches()[fluid_patches_[i]];
    if (patch.here)
      kernels_.pressure(patch, grid_, bodies_[static_cast<std::size_t>(patch.body)], s, scratch(),
                        part);
  });
  if (ranks_ == nullptr) return;
  const auto size = static_cast<std::size_t>(tile_nodes(grid_.geometry().dimension)) * kNodeDoubles;
  ranks_->exchange_near(
      [&](std::size_t p, std::vector<double>& out) {
        const Patch& patch = grid_.patches()[p];
        if (is_fluid(bodies_[static_cast<std::size_t>(patch.body)]))
          out.insert(out.end(), patch.pressure_tile.data(), patch.pressure_tile.data() + size);
      },
      [&](std::size_t p, const double*& at) {
        Patch& patch = grid_.patches()[p];
        if (!is_fluid(bodies_[static_cast<std::size_t>(patch.body)])) return;
        std::copy_n(at, size, patch.pressure_tile.data());
        at += size;
      });
}

// Slots [first, last) of the second records from the tiles, in their fixed order.
void MpmStep::sum_fluid_tiles(int first, int last) {
  const Overlaps overlaps = find_overlaps(grid_.geometry().dimension);
  for_each(fluid_blocks_.size(), [&](std::size_t i) {
    const NodeBlock& block = grid_.node_blocks()[fluid_blocks_[i]];
    double* nodes = second_record(block.nodes);
    for (int n = 0; n < kBlockNodes; ++n)
      std::fill(nodes + kNodeDoubles * n + first, nodes + kNodeDoubles * n + last, 0.0);
    for (int t = block.first_tile; t < block.first_tile + block.tiles; ++t) {
      const TileRef& ref = grid_.tile_refs()[static_cast<std::size_t>(t)];
      const Patch& patch = grid_.patches()[static_cast<std::size_t>(ref.patch)];
      if (!is_fluid(bodies_[static_cast<std::size_t>(patch.body)])) continue;
      const double* tile = patch.pressure_tile.data();
      const std::array<int, kBlockNodes>& overlap = overlaps[static_cast<std::size_t>(ref.corner)];
      for (int n = 0; n < kBlockNodes; ++n)
        if (const int from = overlap[static_cast<std::size_t>(n)]; from >= 0)
          for (int k = first; k < last; ++k) nodes[kNodeDoubles * n + k] += tile[from + k];
    }
  });
}

// Beyond a plane that is not open the fluid has its mirror image.
void MpmStep::fold_fluids(std::initializer_list<int> slots) {
  boundary_.for_each_mirror([&](double* ghost, double* inner) {
    for (const int k : slots) {
      second_record(inner)[k] += second_record(ghost)[k];
      second_record(ghost)[k] = 0;
    }
  });
}
void MpmStep::mirror_fluids(std::initializer_list<int> slots) {
  boundary_.for_each_mirror([&](double* ghost, double* inner) {
    for (const int k : slots) second_record(ghost)[k] = second_record(inner)[k];
  });
}

template <class Work>
void MpmStep::for_fluid_nodes(const Work& work) {
  for_each(fluid_blocks_.size(), [&](std::size_t i) {
    const std::size_t block = fluid_blocks_[i];
    for (int n = 0; n < kBlockNodes; ++n) work(block, kNodeDoubles * n);
  });
}

// Mean pressures and shares at the nodes; these hold [m, p, f, V], nothing folded yet.
void MpmStep::collect_pressure(const SweepSettings& s) {
  const std::span<const NodeBlock> blocks = grid_.node_blocks();
  for_fluid_nodes([&](std::size_t block, int node) {
    std::size_t first = block;
    while (first > 0 && blocks[first - 1].key == blocks[block].key) --first;
    double fill = 0;
    for (std::size_t b = first; b < blocks.size() && blocks[b].key == blocks[block].key; ++b)
      fill += blocks[b].nodes[node + summed::volume];
    double* record = second_record(blocks[block].nodes) + node;
    record[kNodeFill] = record[kNodeReach] = fill;
    record[kNodeOwn] = blocks[block].nodes[node + summed::volume];
    if (is_folded_ghost(grid_.geometry(), boundary_.conditions(), blocks[block].key,
                        node / kNodeDoubles))
      record[kNodeReach] = record[kNodeOwn] = 1e30;
  });
  sweep_fluids(PressurePart::collect, s);
  sum_fluid_tiles(kNodePressure, kNodeVolume + 1);
  fold_fluids({kNodePressure, kNodeVolume, kNodeFill});
  for_fluid_nodes([&](std::size_t block, int node) {
    double* record = second_record(blocks[block].nodes) + node;
    const double V = record[kNodeVolume];
    record[kNodePressure] = V > 0 ? record[kNodePressure] / V : 0;
    record[kNodeShare] = V > 0 ? V / record[kNodeFill] : 0;
  });
  mirror_fluids({kNodePressure, kNodeShare});
}

void MpmStep::add_pressure_force(const SweepSettings& s) {
  sweep_fluids(PressurePart::force, s);
  sum_fluid_tiles(kNodeForce, kNodeForce + 3);
  for_fluid_nodes([&](std::size_t block, int node) {
    double* nodes = grid_.node_blocks()[block].nodes;
    for (int a = 0; a < 3; ++a)
      nodes[node + summed::force + a] += second_record(nodes)[node + kNodeForce + a];
  });
}

// Nodes hold the final v+, ghosts too.
void MpmStep::correct_dilatation(const SweepSettings& s) {
  sweep_fluids(PressurePart::dilatation, s);
  sum_fluid_tiles(kNodeDilatation, kNodeWorkRate + 1);
  fold_fluids({kNodeDilatation, kNodeWorkRate});
  for_fluid_nodes([&](std::size_t block, int node) {
    double* record = second_record(grid_.node_blocks()[block].nodes) + node;
    const double V = record[kNodeVolume];
    for (const int k : {kNodeDilatation, kNodeWorkRate}) record[k] = V > 0 ? record[k] / V : 0;
  });
  mirror_fluids({kNodeDilatation, kNodeWorkRate});
}

}  // namespace krater
