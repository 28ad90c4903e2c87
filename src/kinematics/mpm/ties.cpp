// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mpm/ties.hpp"

#include <algorithm>
#include <cmath>

#include "krater/core/parallel.hpp"

namespace krater {

namespace {

constexpr int kNone = -1, kImage = -2;
constexpr std::size_t kFew = 64;  ///< nodes that are not worth a second thread

}  // namespace

/// Where a block with tied nodes finds others: looked up once for all of them.
struct Ties::Places {
  Places(const BlockGrid& grid, std::size_t block)
      : own{block}, dimension{grid.geometry().dimension}, edge{block_edge(dimension)} {
    const NodeBlock& home = grid.node_blocks()[block];
    for (int a = 0; a < dimension; ++a) {
      const auto k = static_cast<std::size_t>(a);
      half[k] = home.key.i[k] % 2 != 0 ? edge / 2 : 0;
      for (const int side : {0, 1}) {
        BlockKey next = home.key;
        next.i[k] += side == 0 ? -1 : 1;
        neighbours[2 * k + static_cast<std::size_t>(side)] = grid.find_node_block(next, home.field);
      }
    }
    for (int c = 0; c < corner_count(dimension); ++c) {
      const auto key = master_block(home.key, c, dimension);
      masters[static_cast<std::size_t>(c)] = key ? grid.find_node_block(*key, home.field) : kNone;
    }
  }
  /// Of a node of the block: (n >> 1), or one more along the axes of `corner`.
  std::int32_t master(const std::array<int, 3>& local, int corner) const {
    int at = 0, block = 0;
    for (int a = 0; a < dimension; ++a) {
      const auto k = static_cast<std::size_t>(a);
      int i = half[k] + local[k] / 2 + corner_offset(corner, a);
      if (i >= edge) {
        i -= edge;
        block |= 1 << a;
      }
      at = at * edge + i;
    }
    return masters[static_cast<std::size_t>(block)] * kBlockNodes + at;
  }
  /// The next node along an axis; none: -1.
  std::int32_t beside(const std::array<int, 3>& local, int axis, int step) const {
    int at = 0, block = static_cast<int>(own);
    for (int a = 0; a < dimension; ++a) {
      int i = local[static_cast<std::size_t>(a)] + (a == axis ? step : 0);
      if (i < 0 || i >= edge) {
        block = neighbours[static_cast<std::size_t>(2 * a + (i < 0 ? 0 : 1))];
        i = (i + edge) % edge;
      }
      at = at * edge + i;
    }
    return block < 0 ? kNone : block * kBlockNodes + at;
  }

  std::size_t own;
  int dimension, edge;
  std::array<int, 3> half{};        ///< where the block begins in that of its masters
  std::array<int, 6> neighbours{};  ///< blocks along each axis, lower and upper
  std::array<int, 8> masters{};     ///< blocks by corner
};

void Ties::relink() {
  const int dimension = grid_.geometry().dimension;
  for (unsigned odd = 0; odd < 8; ++odd)
    for (int corner = 0; corner < corner_count(dimension); ++corner) {
      double& w = weights_[odd][static_cast<std::size_t>(corner)] = 1;
      for (int a = 0; a < dimension; ++a)
        w *= ((odd >> a & 1U) != 0) == (corner_offset(corner, a) != 0) ? 0.75 : 0.25;
    }
  tied_.clear();
  tied_blocks_.clear();
  const int levels = grid_.levels().count();
  tied_ranges_.assign(static_cast<std::size_t>(levels), {});
  master_ranges_.assign(static_cast<std::size_t>(levels), {});
  for (NodeBlock& block : grid_.node_blocks()) block.at_tie = block.tied != 0;
  for (std::size_t b = 0; b < grid_.node_blocks().size(); ++b) {
    const NodeBlock& block = grid_.node_blocks()[b];
    if (block.tied == 0) continue;
    tied_blocks_.push_back(b);
    Range& range = tied_ranges_[static_cast<std::size_t>(block.key.level)];
    if (range.end == 0) range.first = tied_.size();
    const Places places{grid_, b};
    for (int n = 0; n < kBlockNodes; ++n)
      if ((block.tied >> n & 1U) != 0) add_tied(block, n, places);
    range.end = tied_.size();
  }
  link_masters();
  if (whole_volume_) link_parents();
}

void Ties::add_tied(const NodeBlock& block, int node, const Places& places) {
  const GridGeometry& g = grid_.geometry(block.key.level);
  const int edge = block_edge(g.dimension);
  Tied& tied = tied_.emplace_back();
  const std::array<int, 3> local = index_in({}, node, g.dimension);
  for (int a = 0; a < g.dimension; ++a)  // blocks have an even number of nodes along each axis
    if (local[static_cast<std::size_t>(a)] % 2 != 0) tied.odd |= 1U << a;
  tied.node = static_cast<std::int32_t>(places.own * kBlockNodes + static_cast<std::size_t>(node));
  if (whole_volume_) tied.whole = whole_volume_(g, index_in(block.key, node, g.dimension));
  tied.masters.fill(kNone);
  for (int c = 0; c < corner_count(g.dimension); ++c)
    tied.masters[static_cast<std::size_t>(c)] = places.master(local, c);
  tied.beside.fill(kNone);
  for (int a = 0; a < g.dimension; ++a)
    for (const int side : {0, 1}) {
      const auto k = static_cast<std::size_t>(a);
      const int i = block.key.i[k] * edge + local[k], step = side == 0 ? -1 : 1;
      const double plane = side == 0 ? g.lower_storage() : g.upper_storage(a);
      const bool crosses = (i - plane) * (i + step - plane) < 0 && step * (plane - i) > 0;
      const Boundary& condition = boundary_.conditions()[k][static_cast<std::size_t>(side)];
      std::int32_t& at = tied.beside[static_cast<std::size_t>(2 * a + side)];
      at = crosses && condition.folds() ? kImage : places.beside(local, a, step);
      if (at >= 0)  // slopes read its raw sums
        grid_.node_blocks()[static_cast<std::size_t>(at / kBlockNodes)].at_tie = true;
    }
}

void Ties::link_masters() {
  masters_.clear();
  shares_.clear();
  master_blocks_.clear();
  master_at_.assign(any() ? grid_.node_blocks().size() * kBlockNodes : 0, 0);
  if (!any()) return;
  const int corners = corner_count(grid_.geometry().dimension);
  for (const Tied& tied : tied_)
    for (int c = 0; c < corners; ++c)
      ++master_at_[static_cast<std::size_t>(tied.masters[static_cast<std::size_t>(c)])];
  std::int32_t first = 0;
  for (std::size_t n = 0; n < master_at_.size(); ++n) {
    const std::int32_t count = master_at_[n];
    master_at_[n] = kNone;
    if (count == 0) continue;
    NodeBlock& block = grid_.node_blocks()[n / kBlockNodes];
    if (master_blocks_.empty() || master_blocks_.back() != n / kBlockNodes)
      master_blocks_.push_back(n / kBlockNodes);
    block.at_tie = true;
    Range& range = master_ranges_[static_cast<std::size_t>(block.key.level)];
    if (range.end == 0) range.first = masters_.size();
    master_at_[n] = static_cast<std::int32_t>(masters_.size());
    Master& master = masters_.emplace_back();
    master.node = static_cast<std::int32_t>(n);
    master.level = block.key.level;
    master.first = first;
    if (whole_volume_)
      master.whole = whole_volume_(
          grid_.geometry(block.key.level),
          index_in(block.key, static_cast<int>(n % kBlockNodes), grid_.geometry().dimension));
    first += count;
    range.end = masters_.size();
  }
  shares_.resize(static_cast<std::size_t>(first));
  for (std::size_t t = 0; t < tied_.size(); ++t)
    for (int c = 0; c < corners; ++c) {
      const auto n = static_cast<std::size_t>(tied_[t].masters[static_cast<std::size_t>(c)]);
      Master& master = masters_[static_cast<std::size_t>(master_at_[n])];
      shares_[static_cast<std::size_t>(master.first + master.count++)] = {
          static_cast<std::int32_t>(t), c};
    }
}

void Ties::find_slope(Tied& tied, double h) {
  std::copy_n(record(tied.node), kNodeDoubles, tied.sums.begin());
  tied.slope = {};
  const double m = tied.sums[summed::mass];
  if (!(m > 0)) return;
  const int dimension = grid_.geometry().dimension;
  for (int a = 0; a < dimension; ++a) {
    double mass = 0;
    Triple sum{};
    for (const int side : {0, 1}) {
      const std::int32_t at = tied.beside[static_cast<std::size_t>(2 * a + side)];
      if (at == kNone) continue;
      const double* next = record(at == kImage ? tied.node : at);
      const double m_next = next[summed::mass];
      if (!(m_next > 0)) continue;
      mass += m_next;
      const Boundary& plane =
          boundary_.conditions()[static_cast<std::size_t>(a)][static_cast<std::size_t>(side)];
      for (int c = 0; c < dimension; ++c) {
        const bool flips = at == kImage && (c == a || plane.kind == BoundaryKind::sticky);
        const double v = tied.sums[static_cast<std::size_t>(summed::momentum + c)] / m,
                     v_next = (flips ? -1 : 1) * next[summed::momentum + c] / m_next;
        sum[static_cast<std::size_t>(c)] += m_next * (side == 0 ? v - v_next : v_next - v);
      }
    }
    if (!(mass > 0)) continue;
    for (int c = 0; c < dimension; ++c)
      tied.slope[static_cast<std::size_t>(3 * c + a)] =
          sum[static_cast<std::size_t>(c)] / (h * mass);
  }
}

/// Of all tied nodes that follow from this one, in their order; `h`: their cell.
void Ties::pull(Master& master, double h) {
  const int dimension = grid_.geometry().dimension;
  double* to = record(master.node);
  master.own = to[summed::mass];
  master.own_volume = to[summed::volume];
  master.from_slopes = {};
  for (std::int32_t k = master.first; k < master.first + master.count; ++k) {
    const auto [t, corner] = shares_[static_cast<std::size_t>(k)];
    const Tied& tied = tied_[static_cast<std::size_t>(t)];
    const double m = tied.sums[summed::mass];
    if (!(m > 0)) continue;
    const double w = weight(tied, corner);
    Triple apart{};  // x_J - x_n
    for (int a = 0; a < dimension; ++a) {
      const bool odd = (tied.odd >> a & 1U) != 0, upper = corner_offset(corner, a) != 0;
      apart[static_cast<std::size_t>(a)] = h * (upper ? (odd ? 0.5 : 1.5) : (odd ? -1.5 : -0.5));
    }
    for (int i = 0; i < kNodeDoubles; ++i) to[i] += w * tied.sums[static_cast<std::size_t>(i)];
    for (int c = 0; c < dimension; ++c) {
      double v = 0;
      for (int a = 0; a < dimension; ++a)
        v += tied.slope[static_cast<std::size_t>(3 * c + a)] * apart[static_cast<std::size_t>(a)];
      to[summed::momentum + c] += w * m * v;
      master.from_slopes[static_cast<std::size_t>(c)] += w * m * v;
    }
  }
}

void Ties::restrict(int level) {
  const Range tied = tied_of(level), masters = masters_of(level - 1);
  const double h = grid_.geometry(level).h;
  for_each(
      tied.end - tied.first, [&](std::size_t i) { find_slope(tied_[tied.first + i], h); }, kFew);
  for_each(
      masters.end - masters.first, [&](std::size_t i) { pull(masters_[masters.first + i], h); },
      kFew);
  for (std::size_t t = tied.first; t < tied.end; ++t)
    std::fill_n(record(tied_[t].node), kNodeDoubles, 0.0);
}

void Ties::shorten(double share) {
  for (Master& m : masters_)
    for (double& dv : m.lumped) dv *= share;
}

void Ties::prolong(int level) {
  const Range range = tied_of(level);
  const int corners = corner_count(grid_.geometry().dimension);
  for_each(
      range.end - range.first,
      [&](std::size_t i) {
        const Tied& tied = tied_[range.first + i];
        double* to = record(tied.node);
        std::array<double, kNodeDoubles> sum{};
        double seen = 0;
        for (int c = 0; c < corners; ++c) {
          const std::int32_t n = tied.masters[static_cast<std::size_t>(c)];
          const double* from = record(n);
          const double w = weight(tied, c);
          for (std::size_t k = 0; k < 7; ++k) sum[k] += w * from[k];
          seen +=
              w * masters_[static_cast<std::size_t>(master_at_[static_cast<std::size_t>(n)])].own;
        }
        // what a uniform grid of this level would hold there
        sum[moved::mass] = tied.sums[summed::mass] + seen / corners;
        std::copy_n(sum.begin(), 7, to);
      },
      kFew);
  for (const std::size_t b : tied_blocks_) {
    NodeBlock& block = grid_.node_blocks()[b];
    if (block.key.level != level || !block.still) continue;
    for (int n = 0; n < kBlockNodes && block.still; ++n) {
      const double* r = block.nodes + kNodeDoubles * n;
      for (int a = 0; a < 3; ++a) block.still = block.still && r[a] == 0 && r[4 + a] == 0;
    }
    block.inert = block.inert && block.still;
  }
}

void Ties::finish_work(bool moments) {
  if (!any()) return;
  for (const Master& master : masters_) {
    double* r = record(master.node);
    const NodeBlock& block =
        grid_.node_blocks()[static_cast<std::size_t>(master.node / kBlockNodes)];
    const double m = r[moved::mass];
    if (keeps_volumes(block) || !(m > 0)) continue;
    for (int a = 0; a < 3; ++a) {
      const auto k = static_cast<std::size_t>(a);
      const double dv = r[moved::change + a], minus = r[moved::velocity + a] - dv;
      r[moved::work] += master.lumped[k] * (minus + 0.5 * dv);
      if (moments) r[moved::work] -= minus * master.from_slopes[k] / m;
    }
  }
  boundary_.mirror_work();  // what ghosts follow from, and what follows from them
  const int corners = corner_count(grid_.geometry().dimension);
  for (const Tied& tied : tied_) {
    double sum = 0;
    for (int c = 0; c < corners; ++c) {
      const std::int32_t n = tied.masters[static_cast<std::size_t>(c)];
      if (!keeps_volumes(grid_.node_blocks()[static_cast<std::size_t>(n / kBlockNodes)]))
        sum += weight(tied, c) * record(n)[moved::work];
    }
    if (!keeps_volumes(grid_.node_blocks()[static_cast<std::size_t>(tied.node / kBlockNodes)]))
      record(tied.node)[moved::work] = sum;
  }
  boundary_.mirror_work();
}

}  // namespace krater
