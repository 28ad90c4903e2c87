// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/contact/boundary.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace krater {

double BoundarySet::position(int axis, int side, double later) const {
  const auto a = static_cast<unsigned>(axis);
  const Boundary& condition = conditions_[a][static_cast<unsigned>(side)];
  const double at = side == 0 ? geometry_.min[a] : geometry_.upper(axis);
  return condition.travels(axis) ? at + condition.velocity[a] * (time_ + later) : at;
}

double BoundarySet::last_knots(int axis, int side, int level) const {
  const auto a = static_cast<unsigned>(axis);
  double at = side == 0 ? 1.0 + clearance(axis) - 0.5 : geometry_.cells[a] + 0.5;
  if (conditions_[a][static_cast<unsigned>(side)].travels(axis))
    at = geometry_.knots(position(axis, side, step_), axis);
  return std::ldexp(at, level);  // exact, as the knots of all points are
}

double BoundarySet::clearance(int axis) const {
  return conditions_[static_cast<unsigned>(axis)][0].kind == BoundaryKind::symmetry ? kClearance
                                                                                    : 0;
}

bool BoundarySet::beyond(int axis, int side, double x) const {
  const auto a = static_cast<unsigned>(axis);
  if (side != 0) return geometry_.knots(x, axis) > last_knots(axis, 1);
  if (conditions_[a][0].travels(axis)) return x < position(axis, 0, step_);
  return x < geometry_.min[a] + clearance(axis) * geometry_.h;
}

void BoundarySet::place(Plane& plane) const {
  plane.on_knot = plane.geometry.planes_on_knots() && !plane.condition->travels(plane.axis);
  if (plane.on_knot) {
    const double s =
        plane.side == 0 ? plane.geometry.lower_storage() : plane.geometry.upper_storage(plane.axis);
    plane.line = static_cast<int>(s + 0.5 * plane.inward);
    return;
  }
  const double s = plane.geometry.storage(position(plane.axis, plane.side), plane.axis);
  plane.line = static_cast<int>(std::lround(s));
  plane.beyond = plane.inward * (s - plane.line);
}

bool BoundarySet::set_time(double time) {
  time_ = time;
  bool moved = false;
  for (Plane& plane : planes_) {
    if (!plane.condition->travels(plane.axis)) continue;
    const int before = plane.line;
    place(plane);
    moved = moved || plane.line != before;
  }
  return moved;
}

void BoundarySet::relink(BlockGrid& grid) {
  planes_.clear();
  for (int axis = 0; axis < geometry_.dimension; ++axis)
    for (int side = 0; side < 2; ++side) {
      const Boundary& condition =
          conditions_[static_cast<unsigned>(axis)][static_cast<unsigned>(side)];
      if (!condition.closed()) continue;
      for (int level = 0; level < grid.levels().count(); ++level) {
        Plane& plane = planes_.emplace_back();
        plane.axis = axis;
        plane.side = side;
        plane.inward = side == 0 ? 1.0 : -1.0;
        plane.condition = &condition;
        plane.geometry = grid.geometry(level);
        place(plane);
        add_columns(grid, plane);
        if (condition.pushes()) link_columns(plane);
      }
    }
  list_held_nodes(grid);
}

void BoundarySet::add_columns(BlockGrid& grid, Plane& plane) const {
  const int dimension = geometry_.dimension, edge = block_edge(dimension);
  for (NodeBlock& block : grid.node_blocks()) {
    if (block.key.level != plane.geometry.level) continue;
    const int start = block.key.i[static_cast<unsigned>(plane.axis)] * edge;
    for (int i = plane.line - 1; i <= plane.line + 1; ++i)  // a node of a column in this block
      if (i >= start && i < start + edge) block.at_boundary = true;
    if (plane.line < start || plane.line >= start + edge) continue;
    const auto field = static_cast<std::size_t>(block.field);
    const bool rigid = field < rigid_.size() && rigid_[field];
    if (plane.condition->pushes() && rigid) continue;
    for (int n = 0; n < kBlockNodes; ++n) {
      const std::array<int, 3> index = index_in(block.key, n, dimension);
      if (index[static_cast<unsigned>(plane.axis)] == plane.line)
        add_column(grid, plane, block, index);
    }
  }
}

void BoundarySet::add_column(BlockGrid& grid, Plane& plane, NodeBlock& block,
                             const std::array<int, 3>& index) const {
  const int inward = plane.side == 0 ? 1 : -1;
  const auto node = [&](int axis, int step) {
    std::array<int, 3> at = index;
    at[static_cast<unsigned>(axis)] += step;
    return grid.find_node(at, block.field, block.key.level);
  };
  double* const ghost = node(plane.axis, -inward);
  double* const own = node(plane.axis, 0);
  double* const after = node(plane.axis, inward);
  Column column{};
  column.ghost = ghost;
  column.plane = plane.on_knot ? nullptr : own;
  column.inner = plane.on_knot ? own : after;
  column.next = plane.on_knot ? after : nullptr;
  column.field = block.field;
  column.counted = block.counted;
  const auto field = static_cast<std::size_t>(block.field);
  column.moves_points = field >= rigid_.size() || !rigid_[field];
  if (column.ghost == nullptr || column.inner == nullptr) return;
  for (int a = 0, side = 0; a < geometry_.dimension; ++a)
    for (const int step : {-1, 1}) {
      if (a == plane.axis) continue;
      column.beside[static_cast<unsigned>(side++)] = node(a, step);
    }
  plane.columns.push_back(column);
  block.at_wall = block.at_wall || plane.condition->kind == BoundaryKind::wall;
}

void BoundarySet::link_columns(Plane& plane) {
  std::unordered_map<const double*, int> at;
  for (const Column& c : plane.columns) at[c.anchor()] = static_cast<int>(at.size());
  for (Column& c : plane.columns)
    for (std::size_t k = 0; k < c.beside.size(); ++k) {
      const auto found = at.find(c.beside[k]);
      c.columns_beside[k] = found == at.end() ? -1 : found->second;
    }
}

void BoundarySet::list_held_nodes(const BlockGrid& grid) {
  std::vector<double*> nodes;
  for (const Plane& plane : planes_)
    if (plane.condition->pushes())
      for (const Column& c : plane.columns)
        nodes.insert(nodes.end(), {c.ghost, c.anchor(), c.inner});
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  held_.clear();
  for (double* node : nodes) {
    const auto block =
        static_cast<std::size_t>((node - grid.nodes()) / (kBlockNodes * kNodeDoubles));
    held_.push_back({node, {}, {}, 0, grid.node_blocks()[block].counted});
  }
  const auto place = [&nodes](double* node) {
    return static_cast<std::size_t>(std::lower_bound(nodes.begin(), nodes.end(), node) -
                                    nodes.begin());
  };
  for (Plane& plane : planes_)
    if (plane.condition->pushes())
      for (Column& c : plane.columns) {
        c.held = {place(c.ghost), place(c.anchor()),
                  place(c.inner)};  // anchor: the inner one on a knot
        c.held_count = c.plane != nullptr ? 3 : 2;
      }
  for (const Plane& plane : planes_)
    if (plane.condition->folds())
      for (const Column& c : plane.columns) {
        if (c.plane == nullptr) continue;
        const std::size_t i = place(c.plane);
        if (i == nodes.size() || nodes[i] != c.plane) continue;
        for (int a = 0; a < 3; ++a)
          if (plane.odd(a)) held_[i].folded |= 1U << a;
      }
}

void BoundarySet::note_gaps() {
  for (Plane& plane : planes_) {
    if (plane.condition->kind != BoundaryKind::wall) continue;
    const double at = position(plane.axis, plane.side);
    for (Column& c : plane.columns)
      c.gap =
          c.plane[summed::mass] > 0
              ? plane.inward * (c.plane[summed::momentum + plane.axis] / c.plane[summed::mass] - at)
              : 0;
  }
}

bool BoundarySet::drives() const {
  return std::any_of(planes_.begin(), planes_.end(),
                     [](const Plane& p) { return p.condition->drives(); });
}

}  // namespace krater
