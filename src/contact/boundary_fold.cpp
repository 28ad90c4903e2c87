// SPDX-License-Identifier: GPL-3.0-or-later
// Planes that fold.
#include <algorithm>

#include "contact/boundary_slots.hpp"
#include "krater/contact/boundary.hpp"

namespace krater {

void BoundarySet::fold() {
  for (Plane& plane : planes_) {
    if (!plane.condition->folds()) continue;
    for (Column& c : plane.columns) fold_column(plane, c);
  }
}

void BoundarySet::fold_column(Plane& plane, Column& c) const {
  c.folded.ghost_mass = c.ghost[kMass];
  for (int a = 0; a < 3; ++a) {
    const auto k = static_cast<unsigned>(a);
    const bool odd = plane.odd(a);
    const double sign = odd ? -1.0 : 1.0;
    double &p = c.inner[kMomentum + a], &p_0 = c.plane[kMomentum + a],
           &p_g = c.ghost[kMomentum + a];
    if (odd) {
      c.folded.ghost_momentum[k] = p_g;
      c.folded.ghost_force[k] = c.ghost[kForce + a];
      c.folded.plane_momentum[k] = p_0;
      c.folded.plane_force[k] = c.plane[kForce + a];
    }
    p += sign * p_g;
    c.inner[kForce + a] += sign * c.ghost[kForce + a];
    if (odd) p_0 = c.plane[kForce + a] = 0;
  }
  c.inner[kMass] += c.ghost[kMass];
  c.inner[kVolume] += c.ghost[kVolume];
  std::fill(c.ghost, c.ghost + kNodeDoubles, 0.0);
}

BoundaryWork BoundarySet::folded(double dt, double alpha) const {
  BoundaryWork sum;
  for (const Plane& plane : planes_) {
    if (!plane.condition->folds()) continue;
    for (const Column& c : plane.columns) {
      if (!c.moves_points) continue;
      const Folded& f = c.folded;
      for (int a = 0; a < 3; ++a) {
        if (!plane.odd(a)) continue;
        const auto k = static_cast<unsigned>(a);
        const double change = c.inner[kChange + a], minus = c.inner[kVelocity + a] - change;
        sum.impulse[k] -=
            2 * (f.ghost_mass * change + dt * f.ghost_force[k]) + dt * f.plane_force[k] +
            (1 - alpha) * (2 * (f.ghost_momentum[k] + f.ghost_mass * minus) + f.plane_momentum[k]);
      }
    }
  }
  return sum;
}

void BoundarySet::mirror() const {
  for (const Plane& plane : planes_) {
    if (!plane.condition->folds()) continue;
    for (const Column& c : plane.columns) {
      for (int a = 0; a < 3; ++a) {
        const double sign = plane.odd(a) ? -1.0 : 1.0;
        c.ghost[kVelocity + a] = sign * c.inner[kVelocity + a];
        c.ghost[kChange + a] = sign * c.inner[kChange + a];
      }
      c.ghost[kNodeMass] = c.inner[kNodeMass];
      c.ghost[kVolume] = c.inner[kVolume];
    }
  }
}

}  // namespace krater
