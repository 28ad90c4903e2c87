// SPDX-License-Identifier: GPL-3.0-or-later
// The consistent mass of tied nodes.
#include <algorithm>
#include <cmath>

#include "krater/core/parallel.hpp"
#include "krater/kinematics/mpm/ties.hpp"

namespace krater {

namespace {

constexpr int kSweeps = 2;
constexpr std::size_t kFew = 64;  ///< nodes that are not worth a second thread

}  // namespace

void Ties::sharpen(const std::vector<MomentumSettings>& by_level) {
  for (Master& master : masters_) {
    const double* r = record(master.node);
    for (std::size_t a = 0; a < 3; ++a) master.lumped[a] = r[moved::change + a];
  }
  for (std::size_t level = 0; level + 1 < master_ranges_.size(); ++level) {
    const Range masters = master_ranges_[level];
    if (masters.first == masters.end || by_level[level].dt_force == 0) continue;
    for (int k = 0; k < kSweeps; ++k)
      sweep(masters, by_level[level].smallest_mass, static_cast<int>(level));
    apply_changes(masters, by_level[level]);
  }
  for (Master& master : masters_) {  // of dv: what sharpening took
    const double* r = record(master.node);
    for (std::size_t a = 0; a < 3; ++a) master.lumped[a] -= r[moved::change + a];
  }
  for (const std::size_t b : master_blocks_)
    sum_block(grid_.node_blocks()[b],
              by_level[static_cast<std::size_t>(grid_.node_blocks()[b].key.level)]);
}

void Ties::sweep(Range masters, double smallest_mass, int level) {
  boundary_.for_each_fold(level, [](double* ghost, double* plane, double* inner, unsigned odd) {
    static_cast<void>(plane);
    for (int a = 0; a < 3; ++a)
      ghost[moved::change + a] =
          (odd >> a & 1U) != 0 ? -inner[moved::change + a] : inner[moved::change + a];
  });
  const Range tied = tied_of(level + 1);
  const int corners = corner_count(grid_.geometry().dimension);
  for_each(
      tied.end - tied.first,
      [&](std::size_t i) {
        Tied& t = tied_[tied.first + i];
        t.change = {};
        for (int c = 0; c < corners; ++c)
          for (std::size_t a = 0; a < 3; ++a)
            t.change[a] +=
                weight(t, c) * record(t.masters[static_cast<std::size_t>(c)])[moved::change + a];
      },
      kFew);
  for_each(
      masters.end - masters.first,
      [&](std::size_t i) {
        Master& master = masters_[masters.first + i];
        const double* r = record(master.node);
        master.residual = {};
        for (std::int32_t k = master.first; k < master.first + master.count; ++k) {
          const auto [t, corner] = shares_[static_cast<std::size_t>(k)];
          const Tied& from = tied_[static_cast<std::size_t>(t)];
          const double share = weight(from, corner) * from.sums[summed::mass];
          if (share == 0) continue;
          for (std::size_t a = 0; a < 3; ++a)
            master.residual[a] += share * (r[moved::change + a] - from.change[a]);
        }
      },
      kFew);
  fold_residuals(level);
  for (std::size_t i = masters.first; i < masters.end; ++i) {
    Master& master = masters_[i];
    double* r = record(master.node);
    const double m = r[moved::mass];
    if (!(m > smallest_mass)) continue;
    for (std::size_t a = 0; a < 3; ++a)
      r[moved::change + a] = master.lumped[a] + master.residual[a] / m;
  }
}

void Ties::fold_residuals(int level) {
  const auto find = [this](const double* node) -> Master* {
    if (node == nullptr) return nullptr;
    const std::int32_t i =
        master_at_[static_cast<std::size_t>(node - grid_.nodes()) / kNodeDoubles];
    return i < 0 ? nullptr : &masters_[static_cast<std::size_t>(i)];
  };
  boundary_.for_each_fold(level, [&](double* ghost, double* plane, double* inner, unsigned odd) {
    Master *g = find(ghost), *p = find(plane), *i = find(inner);
    for (std::size_t a = 0; a < 3; ++a) {
      const bool flips = (odd >> a & 1U) != 0;
      if (g != nullptr && i != nullptr) i->residual[a] += (flips ? -1 : 1) * g->residual[a];
      if (g != nullptr) g->residual[a] = 0;
      if (p != nullptr && flips) p->residual[a] = 0;
    }
  });
}

/// v+ follows dv, which holds the new one.
void Ties::apply_changes(Range masters, const MomentumSettings& s) {
  const double flush = s.flush_velocity * s.flush_velocity;
  for (std::size_t i = masters.first; i < masters.end; ++i) {
    const Master& master = masters_[i];
    double* r = record(master.node);
    if (!(r[moved::mass] > 0)) continue;
    double before = 0, after = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double minus = r[moved::velocity + a] - master.lumped[a];
      r[moved::velocity + a] = minus + r[moved::change + a];
      before += minus * minus;
      after += r[moved::velocity + a] * r[moved::velocity + a];
    }
    if (before > flush || after > flush) continue;
    for (std::size_t a = 0; a < 3; ++a) r[moved::velocity + a] = r[moved::change + a] = 0;
  }
}

/// As the momentum update sums them (kinematics/mpm/nodes.hpp).
void Ties::sum_block(NodeBlock& block, const MomentumSettings& s) {
  double kinetic = 0, change = 0;
  bool still = true;
  for (int n = 0; n < kBlockNodes; ++n) {
    const double* r = block.nodes + kNodeDoubles * n;
    double v2 = 0, dv2 = 0;
    for (int a = 0; a < 3; ++a) {
      v2 += r[moved::velocity + a] * r[moved::velocity + a];
      dv2 += r[moved::change + a] * r[moved::change + a];
    }
    kinetic += 0.5 * r[moved::mass] * v2;
    if (r[moved::volume] > kFilledNode * s.cell_volume) change = std::max(change, dv2);
    still = still && v2 == 0 && dv2 == 0;
  }
  block.sums = {kinetic, std::sqrt(change)};
  block.still = still;
  block.inert = block.inert && still;
}

}  // namespace krater
