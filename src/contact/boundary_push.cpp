// SPDX-License-Identifier: GPL-3.0-or-later
// Planes that push.
#include <algorithm>
#include <cmath>

#include "contact/boundary_sums.hpp"
#include "krater/contact/boundary.hpp"

namespace krater {

namespace {

// Fill a column may lack and still count as touching: quadrature noise of a few points per cell is
// several per cent, a gap of g cells costs 1.5 g; 0.25 closes gaps below 0.15 cells.
constexpr double kFillTolerance = 0.25;
// The same where the plane is a knot: 1/6 closes gaps below 0.16 cells.
constexpr double kPairTolerance = 1.0 / 6;

// Distance from the wall, in cells, at which a node of a fixed reference counts as touching.
constexpr double kGapTolerance = 0.02;

double cube(double x) { return x * x * x; }

/// Part of the nodes' volume that lies inside a plane `beyond` cells before the plane's node.
struct Fill {
  double plane, rest;  ///< rest: ghost and inner node
};
Fill whole_fill(double beyond) {
  return {0.5 - 0.75 * beyond + cube(beyond) / 3,
          1 - (cube(0.5 + beyond) - cube(0.5 - beyond)) / 6};
}

void set_velocity(double* node, int axis, double value) {
  node[moved::change + axis] += value - node[moved::velocity + axis];
  node[moved::velocity + axis] = value;
}

/// Coulomb: tangential velocities slow down by mu J_n, at most to those of the plane.
void slow_down(double* node, int normal, const Triple& plane, double impulse_over_mass) {
  std::array<double, 3> slip{};
  double square = 0;
  for (int a = 0; a < 3; ++a) {
    const auto k = static_cast<unsigned>(a);
    if (a != normal) slip[k] = node[a] - plane[k];
    square += slip[k] * slip[k];
  }
  const double speed = std::sqrt(square);
  const double loss = speed > 0 ? std::min(1.0, impulse_over_mass / speed) : 0.0;
  for (int a = 0; a < 3; ++a)
    if (a != normal) set_velocity(node, a, node[a] - loss * slip[static_cast<unsigned>(a)]);
}

}  // namespace

// Booked node by node with the masses of the points, after all planes: columns of two planes that
// meet in a corner share nodes, and joined masses.
BoundaryWork BoundarySet::constrain() {
  Sums sums;
  heat_.clear();
  given_.clear();
  for (Held& h : held_) {
    std::copy_n(h.node, kNodeDoubles, h.before.begin());
    std::copy_n(h.node, 3, h.last.begin());
  }
  for (Plane& plane : planes_)
    if (plane.condition->pushes()) note_fills(plane);
  for (const Plane& plane : planes_)
    if (plane.condition->pushes())
      for (const Column& c : plane.columns)
        if (hold(plane, c)) {
          keep_folded(c);
          note_push(plane, c, sums);
        }
  for (const Held& h : held_) {
    if (!h.counted) continue;
    const double m = h.before[moved::mass];
    for (unsigned a = 0; a < 3; ++a) {
      const double old = h.before[moved::velocity + a], now = h.node[moved::velocity + a],
                   change = now - old;
      if (change == 0) continue;
      sums.all[3 + a] += m * change;
      sums.all[0] += 0.5 * m * (now * now - old * old);
    }
  }
  return together(sums);
}

BoundaryWork BoundarySet::together(Sums& sums) {
  ranks::sum(sums.all);
  BoundaryWork out;
  out.change = sums.all[0].value();
  out.work = sums.all[1].value();
  out.columns_in_contact = static_cast<int>(sums.all[2].value());
  for (std::size_t a = 0; a < 3; ++a) out.impulse[a] = sums.all[3 + a].value();
  return out;
}

/// Volumes at the plane's nodes and beside them, (1 2 1) along each axis of the plane. Material
/// that has spread along the plane is a lattice of wide columns: single columns of nodes held 0.7
/// and 1.4 of their due, and where they were let go the points beside were pressed through.
void BoundarySet::note_fills(Plane& plane) {
  for (Column& c : plane.columns)
    c.fill = c.plane != nullptr ? std::array{c.plane[moved::volume],
                                             c.inner[moved::volume] + c.ghost[moved::volume]}
                                : std::array{c.inner[moved::volume] + c.ghost[moved::volume],
                                             c.next != nullptr ? c.next[moved::volume] : 0.0};
  std::vector<std::array<double, 2>> raw(plane.columns.size());
  for (std::size_t axis = 0; axis < 4; axis += 2) {
    for (std::size_t i = 0; i < raw.size(); ++i) raw[i] = plane.columns[i].fill;
    for (std::size_t i = 0; i < raw.size(); ++i) {
      Column& c = plane.columns[i];
      for (std::size_t part = 0; part < 2; ++part) {
        c.fill[part] = 2 * raw[i][part];
        for (std::size_t side = axis; side < axis + 2; ++side)
          if (c.columns_beside[side] >= 0)
            c.fill[part] += raw[static_cast<std::size_t>(c.columns_beside[side])][part];
      }
    }
  }
}

// What a side that folds holds at rest, no other side moves: the forces there were folded away, and
// their work with it.
void BoundarySet::keep_folded(const Column& c) {
  for (const std::size_t i : c.held_nodes()) {
    const Held& h = held_[i];
    for (int a = 0; a < 3; ++a)
      if ((h.folded >> a & 1U) != 0) set_velocity(h.node, a, h.before[static_cast<unsigned>(a)]);
  }
}

// A side works by its own velocity on what it pushes.
void BoundarySet::note_push(const Plane& plane, const Column& c, Sums& sums) {
  double work = 0;
  Triple impulse{};
  for (const std::size_t i : c.held_nodes()) {
    Held& h = held_[i];
    const double m = h.before[moved::mass];
    std::array<double, 3> change{};
    for (unsigned a = 0; a < 3; ++a) {
      change[a] = h.node[moved::velocity + a] - h.last[a];
      h.last[a] = h.node[moved::velocity + a];
      work += m * change[a] * plane.condition->velocity[a];
      impulse[a] += m * change[a];
    }
    heat_.add(h.node, m, change);
  }
  heat_.close(work, c.counted);
  if (c.counted) sums.all[1] += work;
  if (c.counted) sums.all[2] += 1;
  if (notes_ && c.counted)
    add_impulse(given_, c.field, Partner::side(plane.axis, plane.side), impulse);
}

double BoundarySet::heat() {
  ReproducibleSum sum = heat_.book();
  ranks::sum({&sum, 1});
  mirror_work();
  return sum.value();
}

void BoundarySet::mirror_work() const {
  for (const Plane& plane : planes_)
    if (plane.condition->folds())
      for (const Column& c : plane.columns) c.ghost[moved::work] = c.inner[moved::work];
}

bool BoundarySet::touches(const Plane& plane, const Column& c) const {
  if (fixed_reference_) return c.gap <= kGapTolerance * geometry_.h;
  if (plane.on_knot) return c.fill[0] > (1 - kPairTolerance) * c.fill[1];
  const Fill whole = whole_fill(plane.beyond);
  return c.fill[0] * whole.rest > (1 - kFillTolerance) * whole.plane * c.fill[1];
}

/// False where the column moves on freely.
bool BoundarySet::hold(const Plane& plane, const Column& c) const {
  const int n = plane.axis;
  const Boundary& condition = *plane.condition;
  double none[kNodeDoubles] = {};  // where the plane is a knot
  double* const at_plane = plane.on_knot ? none : c.plane;
  const double m_g = c.ghost[moved::mass], m_0 = at_plane[moved::mass], m_1 = c.inner[moved::mass];
  if (m_0 <= 0 && !plane.on_knot) return false;
  const double c_g = plane.on_knot ? -1 : -(1 + plane.beyond) / (1 - plane.beyond),
               c_0 = plane.on_knot ? 0 : -plane.beyond / (1 - plane.beyond);
  const double mass = m_1 + c_g * c_g * m_g + c_0 * c_0 * m_0;
  const auto joint = [&](int a) {  // of the inner node, relative to the plane
    const double w = condition.velocity[static_cast<unsigned>(a)];
    return mass > 0 ? (m_1 * (c.inner[a] - w) + c_g * (m_g * (c.ghost[a] - w)) +
                       c_0 * (m_0 * (at_plane[a] - w))) /
                          mass
                    : 0;
  };
  const double w = condition.velocity[static_cast<unsigned>(n)], u = joint(n);
  const double push_plane = plane.inward * m_0 * (w + c_0 * u - at_plane[n]),
               push_rest =
                   plane.inward * (m_1 * (w + u - c.inner[n]) + m_g * (w + c_g * u - c.ghost[n]));
  const double push = push_plane + push_rest;
  if (!(push > 0) || !touches(plane, c)) return false;

  const double together = m_1 + m_g;
  for (int a = 0; a < 3; ++a) {
    if (a != n && !std::isinf(condition.friction)) {  // even: the folded node's
      if (!(together > 0)) continue;
      const double even = (m_1 * c.inner[a] + m_g * c.ghost[a]) / together;
      set_velocity(c.inner, a, even);
      set_velocity(c.ghost, a, even);
      continue;
    }
    const double v = condition.velocity[static_cast<unsigned>(a)], relative = joint(a);
    set_velocity(c.ghost, a, v + c_g * relative);
    set_velocity(at_plane, a, v + c_0 * relative);
    set_velocity(c.inner, a, v + relative);
  }
  if (condition.friction > 0 && !std::isinf(condition.friction)) {
    const double both = std::max(0.0, push_plane) + std::max(0.0, push_rest);
    const double share = condition.friction * push / both;
    if (m_0 > 0)
      slow_down(at_plane, n, condition.velocity, share * std::max(0.0, push_plane) / m_0);
    if (together > 0) {
      slow_down(c.inner, n, condition.velocity, share * std::max(0.0, push_rest) / together);
      slow_down(c.ghost, n, condition.velocity, share * std::max(0.0, push_rest) / together);
    }
  }
  c.inner[moved::mass] = c.ghost[moved::mass] = together;
  c.inner[moved::volume] = c.ghost[moved::volume] = c.inner[moved::volume] + c.ghost[moved::volume];
  return true;
}

}  // namespace krater
