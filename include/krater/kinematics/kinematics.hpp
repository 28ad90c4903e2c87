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
/// None knows another: what is between bodies of different ones is an Encounter.
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

/// Energies that the audit holds at a time of the step, summed from one kinematics to the next.
struct Standing {
  double kinetic = 0, internal = 0;  ///< [J]
  double unfelt = 0, law_lead = 0;   ///< [J], see Audit
  double contact_pairs = 0;          ///< places where bodies pushed in this step
};

class Kinematics {
 public:
  Kinematics() = default;
  Kinematics(const Kinematics&) = delete;
  Kinematics& operator=(const Kinematics&) = delete;
  virtual ~Kinematics();

  /// Returns the step that is safe, `dt` or less [s]. May be asked again, with a shorter one,
  /// before a point is touched.
  virtual double force(double dt) = 0;
  virtual void meet(double dt) = 0;
  /// `others` have moved before, and hold this; returns the sum with its own, which the audit has.
  virtual Standing move(double dt, const Standing& others) = 0;
  virtual const TimeStepLimit& limit() const = 0;  ///< found by the last move

  virtual int set_count() const = 0;
  virtual PointSet set(int s) const = 0;
  /// The points of a set, to be changed from outside: what was foreseen of them is void.
  virtual PointStore& change(int s) = 0;
};

/// Contact of bodies that may differ in their kinematics.
class Encounter {
 public:
  Encounter() = default;
  Encounter(const Encounter&) = delete;
  Encounter& operator=(const Encounter&) = delete;
  virtual ~Encounter();
  virtual void push(double dt) = 0;  ///< velocities, after all forces and before any side
  virtual Standing book() = 0;       ///< its heat, when every velocity is final
};

/// One step of all, `dt` or shorter; returns the step taken [s]. `between`: may be null.
double take_step(std::span<Kinematics* const> all, double dt, Encounter* between = nullptr);

}  // namespace krater
