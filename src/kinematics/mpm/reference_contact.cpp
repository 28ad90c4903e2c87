// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mpm/reference_contact.hpp"

#include <algorithm>
#include <cmath>

#include "krater/core/parallel.hpp"
#include "krater/core/stability.hpp"
#include "krater/kinematics/mpm/columns.hpp"

namespace krater {

namespace {

constexpr int kNear = 2;  ///< blocks: a contact reads the fillings two nodes around a shared block

Layout carrier_layout(int dimension) {
  constexpr const char* kName = "contact of references";
  Layout layout{dimension};
  layout.state<field::Id>(0, kName);
  layout.state<field::Position>(0, kName);
  layout.state<field::Velocity>(0, kName);
  layout.state<field::Mass>(0, kName);
  layout.state<field::Density>(1, kName);
  layout.state<field::AffineVelocity>(0, kName);
  return layout;
}

double hat(double z) { return std::max(0.0, 1 - std::abs(z)); }
double hat_integral(double z) {
  const double u = std::clamp(z, -1.0, 1.0);
  return 0.5 + u - 0.5 * u * std::abs(u);
}

}  // namespace

ReferenceContact::ReferenceContact(const Parts& parts)
    : grid_{parts.grid},
      boundary_{parts.boundary},
      contact_{parts.contact},
      kernels_{parts.kernels},
      bodies_{parts.bodies},
      shape_{parts.shape},
      current_{parts.grid.geometry()},
      sides_{parts.grid.geometry(), parts.boundary.conditions()},
      layout_{carrier_layout(parts.grid.geometry().dimension)} {
  std::vector<FieldId> fields;
  for (int b = 0; b < static_cast<int>(bodies_.size()); ++b) fields.push_back(own_field(b));
  current_.set_fields(std::move(fields));
  carrier_data_.columns = point_columns(layout_, false);
  carrier_columns_.assign(bodies_.size(), carrier_data_.columns);
  zeros_.reserve(9 * kLanes);
}

bool ReferenceContact::earlier(const Entry& a, const Entry& b) {
  return a.key != b.key ? a.key < b.key : a.body < b.body;
}

/// Where points are now, each block and body once.
std::vector<ReferenceContact::Entry> ReferenceContact::blocks_of_points() const {
  std::vector<std::vector<Entry>> found(grid_.patches().size());
  for_each(found.size(), [&](std::size_t p) {
    const Patch& patch = grid_.patches()[p];
    const int position = bodies_[static_cast<std::size_t>(patch.body)].columns.position;
    double x[3]{};
    for (int i = 0; i < patch.points.count(); ++i) {
      for (int a = 0; a < grid_.geometry().dimension; ++a)
        x[a] = patch.points.at(position + kLanes * a, i);
      const Entry entry{block_of(grid_.geometry(), x), patch.body};
      if (found[p].empty() || !(found[p].back() == entry)) found[p].push_back(entry);
    }
  });
  std::vector<Entry> all;
  for (const auto& f : found) all.insert(all.end(), f.begin(), f.end());
  std::sort(all.begin(), all.end(), earlier);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

std::vector<ReferenceContact::Entry> ReferenceContact::near_each_other() const {
  const std::vector<Entry> all = blocks_of_points();
  const int last = grid_.geometry().dimension - 1;
  const auto l = static_cast<std::size_t>(last);
  const auto meets = [&](const Entry& e) {
    for (int row = 0; row < (last == 2 ? 25 : 5); ++row) {
      BlockKey low = e.key;
      low.i[0] += row % 5 - kNear;
      if (last == 2) low.i[1] += row / 5 - kNear;
      BlockKey high = low;
      low.i[l] -= kNear;
      high.i[l] += kNear;
      for (auto at = std::lower_bound(all.begin(), all.end(), Entry{low, 0}, earlier);
           at != all.end() && !(high < at->key); ++at)
        if (at->body != e.body) return true;
    }
    return false;
  };
  std::vector<Entry> near;
  std::copy_if(all.begin(), all.end(), std::back_inserter(near), meets);
  return near;
}

/// False where no body is near another.
bool ReferenceContact::collect() {
  std::vector<Entry> near = near_each_other();
  if (!(near == near_)) {
    near_ = std::move(near);
    current_.drop_patches();
    for (const Entry& e : near_) current_.add_patch(e.key, e.body, layout_.stride());
    current_.rebuild(false);
    sides_.relink(current_);
    contact_.relink(current_);
    carriers_.resize(near_.size());
  }
  travel_rate_ = 0;
  if (near_.empty()) return false;
  for (std::size_t q = 0; q < near_.size(); ++q) {
    current_.patches()[q].points.truncate(0);
    carriers_[q].clear();
  }
  for (int p = 0; p < static_cast<int>(grid_.patches().size()); ++p) {
    const Patch& patch = grid_.patches()[static_cast<std::size_t>(p)];
    const PointColumns& c = bodies_[static_cast<std::size_t>(patch.body)].columns;
    BlockKey known;
    int to = -1;
    double x[3]{};
    for (int i = 0; i < patch.points.count(); ++i) {
      for (int a = 0; a < grid_.geometry().dimension; ++a)
        x[a] = patch.points.at(c.position + kLanes * a, i);
      const BlockKey key = block_of(grid_.geometry(), x);
      if (i == 0 || key != known) to = current_.find_patch(key, patch.body);
      known = key;
      if (to < 0) continue;
      append(current_.patches()[static_cast<std::size_t>(to)], patch, c, i);
      carriers_[static_cast<std::size_t>(to)].push_back({p, i});
    }
  }
  int groups = 1;
  for (Patch& patch : current_.patches()) {
    patch.points.pad(carrier_data_.columns.mass);
    groups = std::max(groups, patch.points.groups());
  }
  memory_.resize(static_cast<std::size_t>(std::max(threads(), 1)));
  for (Memory& m : memory_) {
    m.cells.reserve(kCellDoubles);
    m.pressures.reserve(static_cast<std::size_t>(groups) * kLanes);
    m.halo.reserve(static_cast<std::size_t>(tile_nodes(grid_.geometry().dimension)) * kNodeDoubles);
  }
  const std::size_t blocks = current_.node_blocks().size();
  impulses_.assign(blocks * kBlockNodes, {});
  pushed_.assign(blocks, 0);
  given_.resize(grid_.node_blocks().size() * kBlockNodes);
  return true;
}

void ReferenceContact::append(Patch& to, const Patch& from, const PointColumns& c, int i) {
  const PointColumns& own = carrier_data_.columns;
  record_.assign(static_cast<std::size_t>(layout_.stride() / kLanes), 0.0);
  const auto set = [&](int place, double value) {
    record_[static_cast<std::size_t>(place / kLanes)] = value;
  };
  for (int a = 0; a < grid_.geometry().dimension; ++a) {
    set(own.position + kLanes * a, from.points.at(c.position + kLanes * a, i));
    const double speed = std::abs(from.points.at(c.velocity + kLanes * a, i));
    travel_rate_ = std::max(travel_rate_, speed * grid_.geometry().inv_h / kMostTravel);
  }
  set(own.mass, from.points.at(c.mass, i));
  set(own.density, from.points.at(c.density, i));
  to.points.append(record_.data());
}

ReferenceContact::Reach ReferenceContact::reach(const PointStore& points, int position,
                                                int half_width, int i, KernelShape shape) const {
  const GridGeometry& g = grid_.geometry();
  Reach r;
  for (int a = 0; a < g.dimension; ++a) {
    const double t = g.knots(points.at(position + kLanes * a, i), a), base = Support::base(t),
                 f = t - base + 0.5;
    r.first[static_cast<std::size_t>(a)] = static_cast<int>(base);
    const double lp = shape == KernelShape::gimp
                          ? std::min(0.5, points.at(half_width + kLanes * a, i) * g.inv_h)
                          : 0.5;
    for (int k = 0; k < 3; ++k) {
      const double z = f - k;
      if (shape == KernelShape::linear) {
        r.w[a][k] = hat(z);
        // of the two cells at a kink the one that the kernels take (grid/shape.hpp)
        const bool left = f < 1;
        r.d[a][k] = g.inv_h * (left ? (k == 0   ? -1
                                       : k == 1 ? 1
                                                : 0)
                                    : (k == 0   ? 0
                                       : k == 1 ? -1
                                                : 1));
        continue;
      }
      r.w[a][k] = 0.5 / lp * (hat_integral(z + lp) - hat_integral(z - lp));
      r.d[a][k] = 0.5 / lp * g.inv_h * (hat(z + lp) - hat(z - lp));
    }
  }
  return r;
}

/// Index in the memory of nodes; the patch scatters there.
int ReferenceContact::node_of(const Patch& patch, const std::array<int, 3>& storage) const {
  const int dimension = grid_.geometry().dimension, edge = block_edge(dimension);
  int corner = 0, local = 0;
  for (int a = 0; a < dimension; ++a) {
    const auto k = static_cast<std::size_t>(a);
    int l = storage[k] - patch.key.i[k] * edge;
    if (l >= edge) {
      l -= edge;
      corner |= 1 << a;
    }
    local = local * edge + l;
  }
  return patch.links.node_blocks[static_cast<std::size_t>(corner)] * kBlockNodes + local;
}

/// out[A][b] = dX_A/dx_b.
void ReferenceContact::inverse_map(const Patch& patch, const PointColumns& c, int i,
                                   double (&out)[3][3]) const {
  const int n = grid_.geometry().dimension;
  double f[3][3]{};
  f[2][2] = 1;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b) f[a][b] = patch.points.at(c.map + kLanes * (n * a + b), i);
  const auto minor = [&](int a, int b) {
    const int a1 = (a + 1) % 3, a2 = (a + 2) % 3, b1 = (b + 1) % 3, b2 = (b + 2) % 3;
    return f[a1][b1] * f[a2][b2] - f[a1][b2] * f[a2][b1];
  };
  const double inverse =
      1 / (f[0][0] * minor(0, 0) + f[0][1] * minor(0, 1) + f[0][2] * minor(0, 2));
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) out[b][a] = minor(a, b) * inverse;
}

/// The reference nodes' v+ less a share of dv, on the current grid: [v, m, 0, V] of its nodes.
void ReferenceContact::project(double share_of_change) {
  const int n = grid_.geometry().dimension;
  const PointColumns& own = carrier_data_.columns;
  SweepSettings settings;
  settings.geometry = &grid_.geometry();
  for_each(current_.patches().size(), [&](std::size_t q) {
    Patch& patch = current_.patches()[q];
    for (int i = 0; i < patch.points.count(); ++i) {
      const Carrier carrier = carriers_[q][static_cast<std::size_t>(i)];
      const Patch& from = grid_.patches()[static_cast<std::size_t>(carrier.patch)];
      const PointColumns& c = bodies_[static_cast<std::size_t>(from.body)].columns;
      double v[3]{}, G[3][3]{}, inverse[3][3];
      for_nodes(reach(from.points, c.grid_position, c.half_width, carrier.point, shape_),
                [&](const std::array<int, 3>& at, double w, const double(&slope)[3]) {
                  const double* node = grid_.nodes() + kNodeDoubles * node_of(from, at);
                  for (int a = 0; a < n; ++a) {
                    const double u =
                        node[moved::velocity + a] - share_of_change * node[moved::change + a];
                    v[a] += w * u;
                    for (int b = 0; b < n; ++b) G[a][b] += u * slope[b];
                  }
                });
      inverse_map(from, c, carrier.point, inverse);
      for (int a = 0; a < n; ++a) {
        patch.points.at(own.velocity + kLanes * a, i) = v[a];
        for (int b = 0; b < n; ++b) {
          double L = 0;
          for (int k = 0; k < n; ++k) L += G[a][k] * inverse[k][b];
          patch.points.at(own.affine + kLanes * (n * a + b), i) = L;
        }
      }
    }
    patch.points.pad(own.mass);
    Memory& m = memory_[static_cast<std::size_t>(thread_index())];
    kernels_.scatter(patch, carrier_data_, settings,
                     {m.halo.data(), nullptr, nullptr, nullptr, m.cells.data(), m.pressures.data(),
                      nullptr, zeros_.data()});
  });
  for_each(current_.node_blocks().size(),
           [&](std::size_t b) { kernels_.sum_tiles(current_, current_.node_blocks()[b]); });
  sides_.fold();
  MomentumSettings nodes;
  nodes.cell_volume = std::pow(grid_.geometry().h, n);
  for_each(current_.node_blocks().size(),
           [&](std::size_t b) { kernels_.momentum(current_.node_blocks()[b], nodes); });
}

}  // namespace krater
