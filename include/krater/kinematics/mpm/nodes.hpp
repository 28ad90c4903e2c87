// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/nodes.hpp
/// Work on node blocks: the sum of the tiles in their fixed order, and the momentum update (theory
/// 2, CCF (1))
///   v- = p/m,  dv = dt f/m,  v+ = v- + dv
/// Nodes lighter than 1e-15 of the lightest point get no force (f/m means nothing there) but keep
/// v = p/m, so that no momentum is lost; a threshold in kg would break other unit scales.
#include "krater/kinematics/mpm/gather.hpp"

namespace krater::inline KRATER_ISA {

/// Add the part of one tile that overlaps the block.
template <int Dim>
KRATER_FORCE_INLINE void add_tile(const double* tile, int corner, double* nodes) {
  constexpr int E = block_edge(Dim), T = tile_edge(Dim), z = Dim - 1;
  int count[3] = {1, 1, 1}, start[3] = {0, 0, 0};
  for (int a = 0; a < Dim; ++a) {
    const bool below = corner_offset(corner, a) != 0;
    count[a] = below ? T - E : E;
    start[a] = below ? E : 0;
  }
  const int rows = Dim == 3 ? count[0] : 1, j_axis = Dim - 2;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < count[j_axis]; ++j) {
      const int from_row = (Dim == 3 ? (start[0] + i) * T : 0) + start[j_axis] + j;
      const int to_row = (Dim == 3 ? i * E : 0) + j;
      const double* from = tile + kNodeDoubles * (from_row * T + start[z]);
      double* to = nodes + kNodeDoubles * to_row * E;
      for (int k = 0; k < count[z]; ++k) store(to + 8 * k, load(to + 8 * k) + load(from + 8 * k));
    }
}

template <int Dim>
void sum_block(const BlockGrid& grid, NodeBlock& block) {
  for (int i = 0; i < kBlockNodes * kNodeDoubles; i += 8) store(block.nodes + i, Pack(0.0));
  for (int t = block.first_tile; t < block.first_tile + block.tiles; ++t) {
    const TileRef& ref = grid.tile_refs()[static_cast<unsigned>(t)];
    add_tile<Dim>(grid.patches()[static_cast<unsigned>(ref.patch)].tile.data(), ref.corner,
                  block.nodes);
  }
}

/// Velocities below `flush` become exactly zero: the numerical precursor of a signal runs ahead of
/// it by the support of the shape functions in every step, at amplitudes without meaning, and would
/// wake every dormant block.
KRATER_FORCE_INLINE void update_block(NodeBlock& block, const MomentumSettings& s) {
  Pack after = 0.0, change = 0.0;
  const Pack flush = s.flush_velocity * s.flush_velocity;
  Mask moving = Pack(0.0) > Pack(0.0), loaded = moving;
  for (int first = 0; first < kBlockNodes; first += kLanes) {
    double* record = block.nodes + kNodeDoubles * first;
    Pack n[8];
    for (int i = 0; i < 8; ++i) n[i] = load(record + 8 * i);
    transpose8(n);
    const Pack m = n[0], V = n[7];
    const Mask exists = m > Pack(0.0), moves = m > Pack(s.smallest_mass);
    const Pack inverse = select(exists, 1.0 / m, Pack(0.0));
    const Pack step = select(moves, s.dt_force * inverse, Pack(0.0));
    Pack out[8];
    Pack old2 = 0.0, new2 = 0.0, dv2 = 0.0;
    for (int a = 0; a < 3; ++a) {
      const Pack minus = n[1 + a] * inverse, dv = n[4 + a] * step, plus = minus + dv;
      old2 = fma(minus, minus, old2);
      new2 = fma(plus, plus, new2);
      dv2 = fma(dv, dv, dv2);
      out[a] = plus;
      out[4 + a] = dv;
    }
    const Mask still = (old2 <= flush) & (new2 <= flush);  // false for a NaN
    for (int a = 0; a < 3; ++a) {
      out[a] = select(still, Pack(0.0), out[a]);
      out[4 + a] = select(still, Pack(0.0), out[4 + a]);
    }
    new2 = select(still, Pack(0.0), new2);
    moving = moving | !still;
    for (int c = 1; c < 7; ++c) loaded = loaded | (n[c] != Pack(0.0));
    out[3] = m;
    out[7] = V;
    after = fma(m, new2, after);
    change = max(change, select(V > Pack(kFilledNode * s.cell_volume), dv2, Pack(0.0)));
    transpose8(out);
    for (int i = 0; i < 8; ++i) store(record + 8 * i, out[i]);
  }
  block.still = none(moving);
  block.inert = block.still && none(loaded);
  block.sums = {0.5 * sum(after), hmax(sqrt(change))};
}

/// k = (v- + dv/2) . dv in place of the volume, from the final v+ (kinematics/mpm/ledger.hpp).
KRATER_FORCE_INLINE void work_of_block(NodeBlock& block, bool moments) {
  for (int first = 0; first < kBlockNodes; first += kLanes) {
    double* record = block.nodes + kNodeDoubles * first;
    Pack n[8];
    for (int i = 0; i < 8; ++i) n[i] = load(record + 8 * i);
    transpose8(n);
    Pack k = 0.0;
    for (int a = 0; a < 3; ++a) k = fma(fnma(Pack(0.5), n[4 + a], n[a]), n[4 + a], k);
    if (moments)
      for (int a = 0; a < 3; ++a) k = fma(n[a] - n[4 + a], n[a] - n[4 + a], k);
    alignas(64) double out[8];
    store(out, k);
    for (int i = 0; i < 8; ++i) record[8 * i + moved::work] = out[i];
  }
}

}  // namespace krater::inline KRATER_ISA
