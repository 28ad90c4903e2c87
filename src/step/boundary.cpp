// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/step/boundary.hpp"

#include <algorithm>
#include <cmath>

namespace krater {

namespace {

// Fill a column may lack and still count as touching: quadrature noise of a few points per cell is
// several per cent, a gap of g cells costs 1.5 g; 0.25 closes gaps below 0.15 cells.
constexpr double kFillTolerance = 0.25;

// Distance from the wall, in cells, at which a node of a fixed reference counts as touching.
constexpr double kGapTolerance = 0.02;

constexpr int kMass = 0, kMomentum = 1, kForce = 4, kVolume = 7;  // after the scatter
constexpr int kVelocity = 0, kNodeMass = 3, kChange = 4;          // after the momentum update

double kinetic(const double* node) {
  return 0.5 * node[kNodeMass] * (node[0] * node[0] + node[1] * node[1] + node[2] * node[2]);
}

/// Forces work over the mean of v- and the final v+: a plane changes the final v+, and so the
/// forces' work.
void set_velocity(double* node, int axis, double value, double raw_mass, BoundaryWork& sum) {
  const double change = value - node[kVelocity + axis];
  sum.force_correction += 0.5 * raw_mass * node[kChange + axis] * change;
  node[kVelocity + axis] = value;
  node[kChange + axis] += change;
  sum.impulse[static_cast<unsigned>(axis)] += raw_mass * change;
}

}  // namespace

void BoundarySet::relink(BlockGrid& grid) {
  planes_.clear();
  for (int axis = 0; axis < geometry_.dimension; ++axis)
    for (int side = 0; side < 2; ++side) {
      const Boundary& condition =
          conditions_[static_cast<unsigned>(axis)][static_cast<unsigned>(side)];
      if (condition.kind == BoundaryKind::open) continue;
      planes_.push_back({axis, side == 0 ? 1.0 : -1.0, &condition, {}});
      add_columns(grid, planes_.back(), side);
    }
}

void BoundarySet::add_columns(BlockGrid& grid, Plane& plane, int side) const {
  const int dimension = geometry_.dimension, edge = block_edge(dimension);
  const int plane_index = side == 0 ? 1 : geometry_.cells[static_cast<unsigned>(plane.axis)] + 1;
  const int inward = side == 0 ? 1 : -1;
  for (NodeBlock& block : grid.node_blocks) {
    const int start = block.key.i[static_cast<unsigned>(plane.axis)] * edge;
    for (int i = plane_index - 1; i <= plane_index + 1;
         ++i)  // ghost, plane or inner node in this block
      if (i >= start && i < start + edge) block.at_boundary = true;
    if (plane_index < start || plane_index >= start + edge) continue;
    const auto field = static_cast<std::size_t>(block.field);
    const bool acts = plane.condition->kind == BoundaryKind::wall ||
                      plane.condition->kind == BoundaryKind::velocity;
    if (acts && field < rigid_.size() && rigid_[field]) continue;
    for (int n = 0; n < kBlockNodes; ++n) {
      std::array<int, 3> index{};
      for (int a = dimension - 1, rest = n; a >= 0; --a, rest /= edge)
        index[static_cast<unsigned>(a)] =
            block.key.i[static_cast<unsigned>(a)] * edge + rest % edge;
      if (index[static_cast<unsigned>(plane.axis)] != plane_index) continue;
      std::array<int, 3> ghost = index, inner = index;
      ghost[static_cast<unsigned>(plane.axis)] -= inward;
      inner[static_cast<unsigned>(plane.axis)] += inward;
      const auto node = [&](const std::array<int, 3>& at) {
        return grid.find_node(at, block.field);
      };
      const Column column{node(ghost), node(index), node(inner), 0};
      if (column.ghost == nullptr || column.inner == nullptr) continue;
      plane.columns.push_back(column);
      block.at_wall = block.at_wall || plane.condition->kind == BoundaryKind::wall;
    }
  }
}

void BoundarySet::note_gaps() {
  for (Plane& plane : planes_) {
    if (plane.condition->kind != BoundaryKind::wall) continue;
    const double at = plane.inward > 0 ? geometry_.min[static_cast<unsigned>(plane.axis)]
                                       : geometry_.upper(plane.axis);
    for (Column& c : plane.columns)
      c.gap = c.plane[kMass] > 0
                  ? plane.inward * (c.plane[kMomentum + plane.axis] / c.plane[kMass] - at)
                  : 0;
  }
}

bool BoundarySet::drives() const {
  return std::any_of(planes_.begin(), planes_.end(),
                     [](const Plane& p) { return p.condition->kind == BoundaryKind::velocity; });
}

void BoundarySet::fold() const {
  for (const Plane& plane : planes_) {
    const bool sticky = plane.condition->kind == BoundaryKind::sticky;
    if (plane.condition->kind != BoundaryKind::symmetry && !sticky) continue;
    for (const Column& c : plane.columns) {
      c.inner[kMass] += c.ghost[kMass];
      c.inner[kVolume] += c.ghost[kVolume];
      for (int a = 0; a < 3; ++a) {
        const bool odd = sticky || a == plane.axis;
        const double sign = odd ? -1.0 : 1.0;
        c.inner[kMomentum + a] += sign * c.ghost[kMomentum + a];
        c.inner[kForce + a] += sign * c.ghost[kForce + a];
        if (odd) c.plane[kMomentum + a] = c.plane[kForce + a] = 0;
      }
      std::fill(c.ghost, c.ghost + kNodeDoubles, 0.0);
    }
  }
}

BoundaryWork BoundarySet::constrain() const {
  BoundaryWork sum;
  for (const Plane& plane : planes_) {
    if (plane.condition->kind == BoundaryKind::wall)
      for (const Column& c : plane.columns) constrain_wall(plane, c, sum);
    if (plane.condition->kind == BoundaryKind::velocity)
      for (const Column& c : plane.columns) constrain_velocity(plane, c, sum);
  }
  return sum;
}

void BoundarySet::constrain_wall(const Plane& plane, const Column& c, BoundaryWork& sum) const {
  const int n = plane.axis;
  const double m_g = c.ghost[kNodeMass], m_0 = c.plane[kNodeMass], m_1 = c.inner[kNodeMass];
  if (m_0 <= 0) return;
  const double push = -plane.inward * (2 * m_g * c.ghost[n] + m_0 * c.plane[n]);
  const bool touches =
      fixed_reference_
          ? c.gap <= kGapTolerance * geometry_.h
          : 2 * c.plane[kVolume] > (1 - kFillTolerance) * (c.inner[kVolume] + c.ghost[kVolume]);
  if (push <= 0 || !touches) return;
  ++sum.columns_in_contact;
  sum.work -= kinetic(c.ghost) + kinetic(c.plane) + kinetic(c.inner);

  const double together = m_1 + m_g;
  std::array<double, 3> joint{};  // velocity of the folded inner node
  for (int a = 0; a < 3; ++a)
    joint[static_cast<unsigned>(a)] =
        (m_1 * c.inner[a] + (a == n ? -1.0 : 1.0) * m_g * c.ghost[a]) / together;
  const double mu = plane.condition->friction;
  const auto slowed = [mu, n](const double* v, double normal_impulse, double mass, int a) {
    double slip = 0;
    for (int b = 0; b < 3; ++b)
      if (b != n) slip += v[b] * v[b];
    slip = std::sqrt(slip);
    const double loss =
        mass > 0 && slip > 0 ? std::min(1.0, mu * normal_impulse / (mass * slip)) : 0.0;
    return v[a] * (1 - loss);
  };
  const double J_0 = std::max(0.0, -plane.inward * m_0 * c.plane[n]);
  const double J_1 = std::max(0.0, -plane.inward * 2 * m_g * c.ghost[n]);
  const std::array<double, 3> before{c.plane[0], c.plane[1], c.plane[2]};
  for (int a = 0; a < 3; ++a) {
    const double plane_v = a == n ? 0.0 : slowed(before.data(), J_0, m_0, a);
    const double inner_v =
        a == n ? joint[static_cast<unsigned>(a)] : slowed(joint.data(), J_1, together, a);
    set_velocity(c.plane, a, plane_v, m_0, sum);
    set_velocity(c.inner, a, inner_v, m_1, sum);
    set_velocity(c.ghost, a, a == n ? -inner_v : inner_v, m_g, sum);
  }
  c.inner[kNodeMass] = c.ghost[kNodeMass] = together;
  c.inner[kVolume] = c.ghost[kVolume] = c.inner[kVolume] + c.ghost[kVolume];
  sum.work += kinetic(c.plane) + kinetic(c.inner);
}

void BoundarySet::constrain_velocity(const Plane& plane, const Column& c, BoundaryWork& sum) const {
  ++sum.columns_in_contact;
  for (double* node : {c.ghost, c.plane}) {
    sum.work -= kinetic(node);
    for (int a = 0; a < 3; ++a)
      set_velocity(node, a, plane.condition->velocity[static_cast<unsigned>(a)], node[kNodeMass],
                   sum);
    sum.work += kinetic(node);
  }
}

void BoundarySet::mirror() const {
  for (const Plane& plane : planes_) {
    const bool sticky = plane.condition->kind == BoundaryKind::sticky;
    if (plane.condition->kind != BoundaryKind::symmetry && !sticky) continue;
    for (const Column& c : plane.columns) {
      for (int a = 0; a < 3; ++a) {
        const double sign = sticky || a == plane.axis ? -1.0 : 1.0;
        c.ghost[kVelocity + a] = sign * c.inner[kVelocity + a];
        c.ghost[kChange + a] = sign * c.inner[kChange + a];
      }
      c.ghost[kNodeMass] = c.inner[kNodeMass];
      c.ghost[kVolume] = c.inner[kVolume];
    }
  }
}

}  // namespace krater
