// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mpm/node_loads.hpp"

#include <algorithm>
#include <cmath>

#include "krater/core/parallel.hpp"
#include "krater/core/ranks.hpp"

namespace krater {

namespace {

// In the records of areas the momenta are the marked masses of the body's loads, the forces the
// area vector.
constexpr int kShares = summed::momentum, kArea = summed::force;
constexpr double kDriven = 0.5;  // share from which a node is moved

}  // namespace

NodeLoads::NodeLoads(const LoadOptions& options, BlockGrid& grid,
                     const std::vector<BodyKernelData>& bodies, std::vector<LoadColumns> columns,
                     std::vector<bool> rigid)
    : options_{options},
      grid_{grid},
      columns_{std::move(columns)},
      rigid_{std::move(rigid)},
      areas_{bodies},
      of_body_(bodies.size()),
      overlaps_{find_overlaps(grid.geometry().dimension)},
      now_(options.faces.size()) {
  for (std::size_t k = 0; k < options_.faces.size(); ++k)
    for (const int b : options_.faces[k].bodies)
      of_body_[static_cast<std::size_t>(b)].push_back(static_cast<int>(k));
  for (std::size_t b = 0; b < areas_.size(); ++b) {
    PointColumns& c = areas_[b].columns;
    c.velocity = columns_[b].share;
    c.pressure = columns_[b].unit;
    c.stress = c.viscous = c.body_acceleration = c.affine = -1;
  }
}

bool NodeLoads::marked(const Patch& patch) const {
  const auto b = static_cast<std::size_t>(patch.body);
  for (std::size_t k = 0; k < of_body_[b].size(); ++k)
    for (int i = 0; i < patch.points.count(); ++i)
      if (patch.points.at(columns_[b].share + kLanes * static_cast<int>(k), i) > 0) return true;
  return false;
}

void NodeLoads::collect(const Kernels& kernels, std::vector<SweepSettings> by_level,
                        const std::function<SweepScratch()>& scratch, const Distribution* ranks) {
  for (std::size_t k = 0; k < now_.size(); ++k)
    for (std::size_t a = 0; a < 3; ++a)
      now_[k][a] = options_.faces[k].value[a] ? options_.faces[k].value[a](time_) : 0;
  const auto patches = grid_.patches();
  tiles_.resize(patches.size());
  loaded_.assign(patches.size(), 0);
  if (options_.faces.empty()) return;
  std::vector<char> marks(patches.size());
  for_each(patches.size(), [&](std::size_t p) { marks[p] = marked(patches[p]) ? 1 : 0; });
  if (ranks != nullptr) ranks->share(grid_, marks);
  for (SweepSettings& s : by_level) s.average_cells = false;  // beta is that of the stress
  const auto size = static_cast<std::size_t>(tile_nodes(grid_.geometry().dimension)) * kNodeDoubles;
  for_each(patches.size(), [&](std::size_t p) {
    Patch& patch = patches[p];
    const auto& beside = patch.links.neighbours;
    const auto count = neighbour_count(grid_.geometry().dimension);
    const bool near = std::any_of(beside.begin(), beside.begin() + count, [&](int n) {
      return n >= 0 && marks[static_cast<std::size_t>(n)] != 0;
    });
    if (!patch.near || (!near && marks[p] == 0)) return;
    loaded_[p] = 1;
    tiles_[p].reserve(size);
    if (!patch.here) return;
    patch.result.fault = {};
    kernels.scatter(patch, areas_[static_cast<std::size_t>(patch.body)],
                    by_level[static_cast<std::size_t>(patch.key.level)], scratch());
    std::copy(patch.tile.data(), patch.tile.data() + size, tiles_[p].data());
  });
  if (ranks == nullptr) return;
  ranks->exchange_near(
      [&](std::size_t p, std::vector<double>& out) {
        if (loaded_[p] != 0) out.insert(out.end(), tiles_[p].data(), tiles_[p].data() + size);
      },
      [&](std::size_t p, const double*& at) {
        if (loaded_[p] == 0) return;
        std::copy_n(at, size, tiles_[p].data());
        at += size;
      });
}

/// Records of the areas of one body at the nodes of a block; false: none.
bool NodeLoads::sum_areas(const NodeBlock& block, int body,
                          std::array<Record, kBlockNodes>& out) const {
  bool found = false;
  for (int t = block.first_tile; t < block.first_tile + block.tiles; ++t) {
    const TileRef& ref = grid_.tile_refs()[static_cast<std::size_t>(t)];
    const auto p = static_cast<std::size_t>(ref.patch);
    if (loaded_[p] == 0 || grid_.patches()[p].body != body) continue;
    if (!found) out.fill({});
    found = true;
    const double* tile = tiles_[p].data();
    const auto& overlap = overlaps_[static_cast<std::size_t>(ref.corner)];
    for (std::size_t n = 0; n < out.size(); ++n)
      for (std::size_t k = 0; k < kNodeDoubles && overlap[n] >= 0; ++k)
        out[n][k] += tile[overlap[n] + static_cast<int>(k)];
  }
  return found;
}

void NodeLoads::load_node(const Record& area, int body, double* force) const {
  const std::vector<int>& loads = of_body_[static_cast<std::size_t>(body)];
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const auto k = static_cast<std::size_t>(loads[i]);
    const FaceLoad& load = options_.faces[k];
    const double share = area[kShares + i] / area[summed::mass];
    if (!(share > 0) || load.kind == FaceLoad::Kind::velocity) continue;
    const bool presses = load.kind == FaceLoad::Kind::pressure;
    if (load.axis < 0) {
      for (std::size_t a = 0; a < 3; ++a) force[a] -= now_[k][0] * share * area[kArea + a];
      continue;
    }
    const auto n = static_cast<std::size_t>(load.axis);
    const double outward = load.side == 0 ? -1 : 1,
                 facing = share * std::max(0.0, outward * area[kArea + n]);
    if (presses) force[n] -= outward * now_[k][0] * facing;
    for (std::size_t a = 0; !presses && a < 3; ++a) force[a] += now_[k][a] * facing;
  }
}

void NodeLoads::damp(NodeBlock& block, double dt, double smallest_mass, double* force) const {
  const double half = 0.5 * options_.damping * dt;
  for (int n = 0; n < kBlockNodes; ++n)
    for (int a = 0; a < 3 && block.nodes[kNodeDoubles * n + summed::mass] > smallest_mass; ++a) {
      double& f = block.nodes[kNodeDoubles * n + summed::force + a];
      const double p = block.nodes[kNodeDoubles * n + summed::momentum + a];
      const double damping = -(options_.damping * p + half * f) / (1 + half);
      force[kForces * n + 3 + a] = damping;
      f += damping;
    }
}

void NodeLoads::add_forces(double dt, double smallest_mass) {
  const std::size_t blocks = grid_.node_blocks().size();
  forces_.reserve(blocks * static_cast<std::size_t>(kBlockNodes) * kForces);
  for_each(blocks, [&](std::size_t b) {
    NodeBlock& block = grid_.node_blocks()[b];
    double* force = force_of(b);
    std::fill(force, force + static_cast<std::size_t>(kBlockNodes) * kForces, 0.0);
    std::array<Record, kBlockNodes> areas;
    for (std::size_t body = 0; body < of_body_.size(); ++body) {
      if (of_body_[body].empty() || !sum_areas(block, static_cast<int>(body), areas)) continue;
      for (int n = 0; n < kBlockNodes; ++n) {
        double* node = block.nodes + kNodeDoubles * n;
        const Record& area = areas[static_cast<std::size_t>(n)];
        if (!(node[summed::mass] > smallest_mass) || !(area[summed::mass] > 0)) continue;
        double* f = force + kForces * n;
        const std::array<double, 3> before{f[0], f[1], f[2]};
        load_node(area, static_cast<int>(body), f);
        for (std::size_t a = 0; a < 3; ++a) node[summed::force + a] += f[a] - before[a];
      }
    }
    const auto field = static_cast<std::size_t>(block.field);
    const bool rigid = field < rigid_.size() && rigid_[field];
    if (options_.damping > 0 && !rigid) damp(block, dt, smallest_mass, force);
  });
}

void NodeLoads::drive(double dt) {
  const bool any = std::any_of(options_.faces.begin(), options_.faces.end(), [](const FaceLoad& f) {
    return f.kind == FaceLoad::Kind::velocity;
  });
  if (!any) return;
  for_each(grid_.node_blocks().size(), [&](std::size_t b) {
    NodeBlock& block = grid_.node_blocks()[b];
    std::array<Record, kBlockNodes> areas;
    for (std::size_t body = 0; body < of_body_.size(); ++body) {
      if (of_body_[body].empty() || !sum_areas(block, static_cast<int>(body), areas)) continue;
      for (std::size_t i = 0; i < of_body_[body].size(); ++i) {
        const auto k = static_cast<std::size_t>(of_body_[body][i]);
        const FaceLoad& load = options_.faces[k];
        for (std::size_t n = 0; load.kind == FaceLoad::Kind::velocity && n < kBlockNodes; ++n) {
          double* node = block.nodes + kNodeDoubles * n;
          if (!(areas[n][kShares + i] > kDriven * areas[n][summed::mass])) continue;
          for (std::size_t a = 0; a < 3; ++a) {
            if (!load.value[a]) continue;
            const double change = now_[k][a] - node[moved::velocity + a];
            node[moved::velocity + a] += change;
            node[moved::change + a] += change;
            force_of(b)[kForces * n + a] += node[moved::mass] * change / dt;
          }
        }
      }
    }
  });
}

LoadWork NodeLoads::work(double dt) const {
  std::vector<LoadWork> parts(grid_.node_blocks().size());
  for_each(parts.size(), [&](std::size_t b) {
    const NodeBlock& block = grid_.node_blocks()[b];
    const double* force = forces_.data() + b * static_cast<std::size_t>(kBlockNodes) * kForces;
    for (int n = 0; n < kBlockNodes; ++n)
      for (int a = 0; a < 3; ++a) {
        const double* node = block.nodes + kNodeDoubles * n;
        const double mean = node[moved::velocity + a] - 0.5 * node[moved::change + a];
        parts[b].faces += force[kForces * n + a] * mean;
        parts[b].damping += force[kForces * n + 3 + a] * mean;
        parts[b].face_impulse[static_cast<unsigned>(a)] += force[kForces * n + a];
        parts[b].damping_impulse[static_cast<unsigned>(a)] += force[kForces * n + 3 + a];
      }
  });
  ReproducibleSums<8> sums;
  for (std::size_t b = 0; b < parts.size(); ++b) {
    if (!grid_.node_blocks()[b].counted) continue;
    sums.all[0] += dt * parts[b].faces;
    sums.all[1] += dt * parts[b].damping;
    for (std::size_t a = 0; a < 3; ++a) {
      sums.all[2 + a] += dt * parts[b].face_impulse[a];
      sums.all[5 + a] += dt * parts[b].damping_impulse[a];
    }
  }
  ranks::sum(sums.all);
  LoadWork sum;
  sum.faces = sums.all[0].value();
  sum.damping = sums.all[1].value();
  sums.read(sum.face_impulse.data(), 3, 2);
  sums.read(sum.damping_impulse.data(), 3, 5);
  return sum;
}

}  // namespace krater
