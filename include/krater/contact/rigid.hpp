// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file contact/rigid.hpp
/// Rigid bodies: v = V + omega x (x - c), x = c + R (X - C); momentum and spin by
///   M dV/dt = F,  dL/dt = T,  omega = R I^-1 R^T L  (I from the points at the start),
/// or prescribed. Their points are scattered as all others, so that contact finds filling and
/// normals, but nothing is gathered: positions follow from the start, shapes never change. Where
/// they push, their nodes count as of infinite mass (contact/contact.hpp).
///
/// Free rotation: Dullweber, Leimkuhler & McLachlan (1997): turns about the principal axes in turn,
/// L fixed in space. Second order, L exact, energy without drift; exact about a principal axis.
/// Prescribed motion is taken at the middle of the step.
///
/// Vectors are along the grid axes (0, 1, 2); in 2D frames the third is empty and plane strain
/// turns about it. Symmetry planes that cut a body, and the axis, forbid what they must.
#include <array>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "krater/contact/boundary.hpp"
#include "krater/points/columns.hpp"

namespace krater {

/// Velocity [m/s] at x (at the start: X) and time t, along the grid axes.
using VelocityFunction = std::function<Triple(const Triple& x, const Triple& X, double t)>;

struct RigidOptions {
  std::string name, where;
  int body = -1;
  bool free = false;          ///< moved by what it meets; else by `velocity` for ever
  VelocityFunction velocity;  ///< of a free body: at the start; must be rigid; empty: at rest
  int reference = -1;         ///< offset of the points' positions at the start
  std::array<bool, 3> translates{}, turns{};  ///< along and about the grid axes
};

/// Velocity field of a rigid body.
struct RigidTwist {
  Eigen::Vector3d centre, velocity, spin;
  Eigen::Vector3d at(const Eigen::Vector3d& x) const { return velocity + spin.cross(x - centre); }
};

/// Impulse [N s] and its moment about the centre on a body; its work [J] if it is driven.
struct RigidImpulse {
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
  double work = 0;
  void add(const RigidImpulse& o) {
    impulse += o.impulse;
    moment += o.moment;
    work += o.work;
  }
};

class RigidBody {
 public:
  explicit RigidBody(RigidOptions options) : options_{std::move(options)} {}

  const RigidOptions& options() const { return options_; }
  double mass() const { return mass_; }
  const RigidTwist& twist() const { return twist_; }
  double kinetic() const;                                        ///< [J]
  const Eigen::Vector3d& received() const { return received_; }  ///< impulse of contact [N s]
  /// Inverse of (M, I): change of (V, omega) by an impulse and a moment, as far as it is free.
  Eigen::Matrix<double, 6, 6> mobility() const;

  /// Mass, centre and inertia from the points as they are at the start, velocities at `time`.
  /// Throws InputError when the velocity given is not that of a rigid body.
  void place(const BlockGrid& grid, const PointColumns& columns, double time);
  /// The same after points have left: the rest keeps its motion.
  void lose(const BlockGrid& grid, const PointColumns& columns);
  /// From the state at the start of the step to the velocities of the step; `acceleration` acts on
  /// a free body as force and moment. Repeatable.
  void begin(double time, double dt);
  void set_load(const Eigen::Vector3d& force, const Eigen::Vector3d& moment);
  /// Contact has pushed; returns the change of kinetic energy [J].
  double take(const RigidImpulse& sum);
  void rewind();           ///< to the start of the step
  void finish(double dt);  ///< move
  bool moves() const { return moves_; }
  Eigen::Vector3d position(const Eigen::Vector3d& start) const {
    return twist_.centre + rotation_ * (start - start_centre_);
  }
  Eigen::Vector3d start_position(const Eigen::Vector3d& now) const {
    return start_centre_ + rotation_.transpose() * (now - twist_.centre);
  }

  std::vector<double> state() const;
  void set_state(const double* values);
  static constexpr std::size_t kStateSize = 38;

 private:
  void measure(const BlockGrid& grid, const PointColumns& columns);
  void settle();
  void kick(const Eigen::Vector3d& impulse, const Eigen::Vector3d& moment);
  RigidTwist evaluate(double time) const;
  Eigen::Matrix3d inertia() const;  ///< about the centre, now
  Eigen::Vector3d spin_of(const Eigen::Vector3d& angular_momentum) const;
  int turning_axes() const { return options_.turns[0] + options_.turns[1] + options_.turns[2]; }

  RigidOptions options_;
  double mass_ = 0, size_ = 0;
  Eigen::Vector3d start_centre_ = Eigen::Vector3d::Zero(), principal_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();  ///< principal axes at the start
  Eigen::Quaterniond turn_ = Eigen::Quaterniond::Identity();
  Eigen::Matrix3d rotation_ = Eigen::Matrix3d::Identity();  ///< of turn_
  Eigen::Vector3d angular_momentum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d received_ = Eigen::Vector3d::Zero();
  RigidTwist twist_{};
  RigidTwist start_{};  ///< at the start of the step ...
  Eigen::Vector3d start_angular_momentum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero(), moment_ = Eigen::Vector3d::Zero();
  bool moves_ = false;
};

/// All rigid bodies of a scene.
class RigidBodies {
 public:
  void add(RigidOptions options);
  bool any() const { return !bodies_.empty(); }
  /// nullptr: deformable
  RigidBody* find(int body);
  const RigidBody* find(int body) const;
  std::vector<RigidBody>& all() { return bodies_; }
  const std::vector<RigidBody>& all() const { return bodies_; }
  void set_time(double t) { time_ = t; }

  /// The points' velocities, at the start.
  void write_velocities(BlockGrid& grid, const std::vector<PointColumns>& columns) const;
  double kinetic() const;
  Triple momentum() const;  ///< [kg m/s]
  /// Velocities of the step; returns the work of loads and drives [J].
  double begin(double dt);
  void rewind();
  void finish(double dt);
  /// Positions and velocities of the points of one patch from the body's motion; sums, time-step
  /// limit, leavers. In parallel over patches, after finish().
  void move(Patch& patch, const Levels& levels, const BoundarySet& boundary,
            const PointColumns& columns, unsigned char* leavers) const;
  /// Throws NumericalError when a body has run into a closed side.
  void throw_collisions(const BlockGrid& grid) const;

 private:
  std::vector<RigidBody> bodies_;
  std::vector<int> of_body_;  ///< index in bodies_, -1
  double time_ = 0;
};

}  // namespace krater
