// SPDX-License-Identifier: GPL-3.0-or-later
// Planes that fold.
#include <algorithm>

#include "contact/boundary_sums.hpp"

#include "krater/contact/boundary.hpp"

namespace krater {

// Both sides of an axis give first and clear then: where they are one cell apart, the inner node of
// one plane lies on the other.
void BoundarySet::fold(int level) {
  const auto for_columns = [&](int axis, const auto& work) {
    for (Plane& plane : planes_) {
      if (plane.axis != axis || plane.geometry.level != level || !plane.condition->folds())
        continue;
      for (Column& c : plane.columns) work(plane, c);
    }
  };
  for (int axis = 0; axis < geometry_.dimension; ++axis) {
    for_columns(axis, [](const Plane& plane, Column& c) { fold_ghost(plane, c); });
    for_columns(axis, [](const Plane& plane, Column& c) { clear_plane(plane, c); });
  }
}

void BoundarySet::fold_ghost(const Plane& plane, Column& c) {
  c.folded.ghost_mass = c.ghost[summed::mass];
  for (int a = 0; a < 3; ++a) {
    const auto k = static_cast<unsigned>(a);
    const bool odd = plane.odd(a);
    const double sign = odd ? -1.0 : 1.0;
    double &p = c.inner[summed::momentum + a], &p_g = c.ghost[summed::momentum + a];
    if (odd) {
      c.folded.ghost_momentum[k] = p_g;
      c.folded.ghost_force[k] = c.ghost[summed::force + a];
    }
    p += sign * p_g;
    c.inner[summed::force + a] += sign * c.ghost[summed::force + a];
  }
  c.inner[summed::mass] += c.ghost[summed::mass];
  c.inner[moved::volume] += c.ghost[moved::volume];
  std::fill(c.ghost, c.ghost + kNodeDoubles, 0.0);
}

void BoundarySet::clear_plane(const Plane& plane, Column& c) {
  for (int a = 0; a < 3 && c.plane != nullptr; ++a) {
    if (!plane.odd(a)) continue;
    double &p_0 = c.plane[summed::momentum + a], &f_0 = c.plane[summed::force + a];
    c.folded.plane_momentum[static_cast<unsigned>(a)] = p_0;
    c.folded.plane_force[static_cast<unsigned>(a)] = f_0;
    p_0 = f_0 = 0;
  }
}

BoundaryWork BoundarySet::folded(double dt, double alpha) const {
  Sums sums;
  for (const Plane& plane : planes_) {
    if (!plane.condition->folds()) continue;
    for (const Column& c : plane.columns) {
      if (!c.moves_points || !c.counted) continue;
      const Folded& f = c.folded;
      for (int a = 0; a < 3; ++a) {
        if (!plane.odd(a)) continue;
        const auto k = static_cast<unsigned>(a);
        const double change = c.inner[moved::change + a],
                     minus = c.inner[moved::velocity + a] - change;
        sums.all[3 + k] -=
            2 * (f.ghost_mass * change + dt * f.ghost_force[k]) + dt * f.plane_force[k] +
            (1 - alpha) * (2 * (f.ghost_momentum[k] + f.ghost_mass * minus) + f.plane_momentum[k]);
      }
    }
  }
  return together(sums);
}

void BoundarySet::mirror(int level) const {
  for (const Plane& plane : planes_) {
    if (plane.geometry.level != level || !plane.condition->folds()) continue;
    for (const Column& c : plane.columns) {
      for (int a = 0; a < 3; ++a) {
        const double sign = plane.odd(a) ? -1.0 : 1.0;
        c.ghost[moved::velocity + a] = sign * c.inner[moved::velocity + a];
        c.ghost[moved::change + a] = sign * c.inner[moved::change + a];
      }
      c.ghost[moved::mass] = c.inner[moved::mass];
      c.ghost[moved::volume] = c.inner[moved::volume];
    }
  }
}

}  // namespace krater
