// SPDX-License-Identifier: GPL-3.0-or-later
// What contact on the current grid gives back to the reference nodes.
#include <algorithm>
#include <cmath>

#include "krater/kinematics/mpm/reference_contact.hpp"

namespace krater {

namespace {

constexpr int kPasses = 8;

}  // namespace

ContactWork ReferenceContact::apply() {
  ContactWork sum;
  if (!collect()) return sum;
  for (int pass = 0; pass < kPasses; ++pass) {
    project(0);
    const ContactWork work = contact_.apply(current_, carrier_columns_, none_, true);
    if (!(work.nodes > 0)) break;
    note_impulses();
    sides_.mirror();
    hand_back(false);
    sum.change += push_nodes();
    boundary_.mirror();
    sum.friction += work.friction;
    sum.nodes = std::max(sum.nodes, work.nodes);
  }
  return sum;
}

/// Sum over the passes, and the blocks where nodes were pushed.
void ReferenceContact::note_impulses() {
  std::fill(pushed_.begin(), pushed_.end(), char{0});
  for (std::size_t b = 0; b < current_.node_blocks().size(); ++b) {
    const double* nodes = current_.node_blocks()[b].nodes;
    for (int n = 0; n < kBlockNodes; ++n) {
      const double* node = nodes + kNodeDoubles * n;
      auto& J = impulses_[b * kBlockNodes + static_cast<std::size_t>(n)];
      for (std::size_t a = 0; a < 3; ++a) {
        const double change = node[moved::change + a];
        J[a] += node[moved::mass] * change;
        if (change != 0) pushed_[b] = 1;
      }
    }
  }
  // Ghosts beyond a plane of symmetry have the motion of their images.
  for (std::size_t b = 0; b < pushed_.size(); ++b)
    if (current_.node_blocks()[b].at_boundary) pushed_[b] = 1;
}

ReferenceContact::Share ReferenceContact::share_of(const Patch& patch, int i, bool heat) const {
  const GridGeometry& g = grid_.geometry();
  const PointColumns& own = carrier_data_.columns;
  Share share;
  for_nodes(reach(patch.points, own.position, -1, i, KernelShape::quadratic_bspline),
            [&](const std::array<int, 3>& at, double w, const double(&)[3]) {
              const double* node = current_.nodes() + kNodeDoubles * node_of(patch, at);
              if (heat) {
                share.heat += w * node[moved::work];
                return;
              }
              for (int b = 0; b < g.dimension; ++b) {
                const auto k = static_cast<std::size_t>(b);
                const double x = g.min[k] + (at[k] - 1) * g.h,
                             lever = x - patch.points.at(own.position + kLanes * b, i);
                for (int a = 0; a < g.dimension; ++a)
                  share.moment[a][b] += w * node[moved::change + a] * lever;
              }
              for (int a = 0; a < g.dimension; ++a)
                share.velocity[a] += w * node[moved::change + a];
            });
  return share;
}

/// The sums of what the points bring to the reference nodes, in the order of patches and points.
void ReferenceContact::hand_back(bool heat) {
  touched_.clear();
  const int corners = corner_count(grid_.geometry().dimension);
  for (std::size_t q = 0; q < current_.patches().size(); ++q) {
    const Patch& patch = current_.patches()[q];
    if (std::none_of(patch.links.node_blocks.begin(), patch.links.node_blocks.begin() + corners,
                     [this](int b) { return pushed_[static_cast<std::size_t>(b)] != 0; }))
      continue;
    for (int i = 0; i < patch.points.count(); ++i) {
      const Share share = share_of(patch, i, heat);
      const double any = std::abs(share.velocity[0]) + std::abs(share.velocity[1]) +
                         std::abs(share.velocity[2]) + std::abs(share.heat);
      if (any > 0)
        add(carriers_[q][static_cast<std::size_t>(i)],
            patch.points.at(carrier_data_.columns.mass, i), share);
    }
  }
}

void ReferenceContact::add(const Carrier& carrier, double mass, const Share& share) {
  const int n = grid_.geometry().dimension;
  const Patch& to = grid_.patches()[static_cast<std::size_t>(carrier.patch)];
  const PointColumns& c = bodies_[static_cast<std::size_t>(to.body)].columns;
  double inverse[3][3], moment[3][3]{};  // on the reference: M F^-T
  inverse_map(to, c, carrier.point, inverse);
  for (int a = 0; a < n; ++a)
    for (int A = 0; A < n; ++A)
      for (int b = 0; b < n; ++b) moment[a][A] += share.moment[a][b] * inverse[A][b];
  for_nodes(reach(to.points, c.grid_position, c.half_width, carrier.point, shape_),
            [&](const std::array<int, 3>& at, double w, const double(&slope)[3]) {
              std::array<double, 4> value{0, 0, 0, mass * w * share.heat};
              for (int a = 0; a < n; ++a) {
                double x = w * share.velocity[a];
                for (int A = 0; A < n; ++A) x += moment[a][A] * slope[A];
                value[static_cast<std::size_t>(a)] = mass * x;
              }
              add_folded(at, to.body, value);
            });
}

/// What comes to a ghost beyond a plane that folds belongs to its image; odd components of the
/// plane's own nodes are nothing.
void ReferenceContact::add_folded(std::array<int, 3> at, int body, std::array<double, 4> value) {
  const GridGeometry& g = grid_.geometry();
  for (int axis = 0; axis < g.dimension; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    for (std::size_t side = 0; side < 2; ++side) {
      const Boundary& plane = boundary_.conditions()[a][side];
      const int line = side == 0 ? 1 : g.cells[a] + 1, ghost = side == 0 ? 0 : line + 1;
      if (!plane.folds() || (at[a] != line && at[a] != ghost)) continue;
      for (std::size_t k = 0; k < 3; ++k)
        if (k == a || plane.kind == BoundaryKind::sticky)
          value[k] = at[a] == line ? 0.0 : -value[k];
      at[a] = side == 0 ? std::max(at[a], 2 - at[a]) : std::min(at[a], 2 * line - at[a]);
    }
  }
  const double* node = grid_.find_node(at, own_field(body));
  const auto index = static_cast<std::size_t>(node - grid_.nodes()) / kNodeDoubles;
  auto& sum = given_[index];
  if (sum == std::array<double, 4>{}) touched_.push_back(static_cast<int>(index));
  for (std::size_t k = 0; k < 4; ++k) sum[k] += value[k];
}

/// v+ and dv; returns the change of kinetic energy [J].
double ReferenceContact::push_nodes() {
  double change = 0;
  for (const int index : touched_) {
    double* node = grid_.nodes() + kNodeDoubles * index;
    auto& p = given_[static_cast<std::size_t>(index)];
    const double m = node[moved::mass];
    for (std::size_t a = 0; m > 0 && a < 3; ++a) {
      const double dv = p[a] / m;
      change += p[a] * (node[moved::velocity + a] + 0.5 * dv);
      node[moved::velocity + a] += dv;
      node[moved::change + a] += dv;
    }
    p = {};
    NodeBlock& block = grid_.node_blocks()[static_cast<std::size_t>(index / kBlockNodes)];
    block.still = block.inert = false;
  }
  return change;
}

double ReferenceContact::heat() {
  if (near_.empty()) return 0;
  const auto none = [](const std::array<double, 3>& J) { return J == std::array<double, 3>{}; };
  if (std::all_of(impulses_.begin(), impulses_.end(), none)) return 0;
  project(0.5);
  double sum = 0;
  std::fill(pushed_.begin(), pushed_.end(), char{0});
  const auto blocks = current_.node_blocks();
  for (std::size_t first = 0, end = 0; first < blocks.size(); first = end) {
    while (end < blocks.size() && blocks[end].key == blocks[first].key) ++end;
    for (std::size_t n = 0; n < kBlockNodes; ++n) {
      double heat = 0, mass = 0;
      for (std::size_t b = first; b < end; ++b) {
        double* node = blocks[b].nodes + kNodeDoubles * n;
        const auto& J = impulses_[b * kBlockNodes + n];
        node[moved::work] = 0;
        if (none(J)) continue;
        for (std::size_t a = 0; a < 3; ++a) heat -= J[a] * node[moved::velocity + a];
        mass += node[moved::mass];
      }
      if (!(mass > 0)) continue;
      sum += heat;
      for (std::size_t b = first; b < end; ++b)
        if (!none(impulses_[b * kBlockNodes + n])) {
          blocks[b].nodes[kNodeDoubles * n + moved::work] = heat / mass;
          pushed_[b] = 1;
        }
    }
  }
  for (std::size_t b = 0; b < blocks.size(); ++b)
    if (blocks[b].at_boundary) pushed_[b] = 1;
  sides_.heat();  // ghosts as their images
  hand_back(true);
  warm_nodes();
  return sum;
}

void ReferenceContact::warm_nodes() {
  for (const int index : touched_) {
    double* node = grid_.nodes() + kNodeDoubles * index;
    auto& given = given_[static_cast<std::size_t>(index)];
    if (node[moved::mass] > 0) node[moved::work] += given[3] / node[moved::mass];
    given = {};
  }
}

}  // namespace krater
