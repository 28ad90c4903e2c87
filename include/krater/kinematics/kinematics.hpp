// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/kinematics.hpp
/// A way to move bodies: material points over a grid (mpm/), and what else takes forces from the
/// stresses of its points and gives them strains. All of a scene take a step together:
///   dt = min force(dt)   forces of sigma_n and loads on the nodes; the step that is safe for them
///   meet(dt)             contact and sides of the domain change the nodes' velocities
///   move(dt)             v, x, L of the points, and by the stages of their material sigma_{n+1}
/// Each books its energies in the audit it was made with, and hands its points out in sets: that is
/// all that output, measures and checkpoints know of it. Virtual calls per sweep, never per point.
#include <span>

#include "krater/points/store.hpp"

namespace krater {

/// What limits the time step. By the point's id: sets are sorted anew when points migrate.
struct TimeStepLimit {
  double rate = 0;  ///< 1/dt at CFL 1 [1/s]
  int kind = 0;     ///< 0 wave speed, 1 material velocity, 2 volume change
  int body = -1;
  double id = -1;
};

class Kinematics {
 public:
  Kinematics() = default;
  Kinematics(const Kinematics&) = delete;
  Kinematics& operator=(const Kinematics&) = delete;
  virtual ~Kinematics();

  /// Returns the step that is safe, `dt` or less [s]. May be asked again, with a shorter one, before
  /// a point is touched.
  virtual double force(double dt) = 0;
  virtual void meet(double dt) = 0;
  virtual void move(double dt) = 0;
  virtual const TimeStepLimit& limit() const = 0;  ///< found by the last move

  virtual int set_count() const = 0;
  virtual PointSet set(int s) const = 0;
  /// The points of a set, to be changed from outside: what was foreseen of them is void.
  virtual PointStore& change(int s) = 0;
};

/// One step of all, `dt` or shorter; returns the step taken [s].
double take_step(std::span<Kinematics* const> all, double dt);

}  // namespace krater
