// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "krater/contact/rigid.hpp"
#include "krater/core/errors.hpp"
#include "krater/core/ranks.hpp"

namespace krater {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Departure of a given velocity field from a rigid one, as a share of its speed.
constexpr double kNotRigid = 1e-6;

Triple triple(const Vector3d& v) { return {v[0], v[1], v[2]}; }
Vector3d vector(const Triple& v) { return {v[0], v[1], v[2]}; }

Matrix3d cross_matrix(const Vector3d& w) {
  Matrix3d out;
  out << 0, -w[2], w[1], w[2], 0, -w[0], -w[1], w[0], 0;
  return out;
}

/// visit(mass, position at the start) for every point of this rank.
template <class Visit>
void for_points(const BlockGrid& grid, const RigidOptions& options, const PointColumns& c,
                const Visit& visit) {
  for (const Patch& patch : grid.patches()) {
    if (patch.body != options.body) continue;
    for (int i = 0; i < patch.points.count(); ++i) {
      Vector3d X = Vector3d::Zero();
      for (int a = 0; a < grid.geometry().dimension; ++a)
        X[a] = patch.points.at(options.reference + kLanes * a, i);
      visit(patch.points.at(c.mass, i), X);
    }
  }
}

}  // namespace

double RigidBody::kinetic() const {
  return 0.5 * (mass_ * twist_.velocity.squaredNorm() + twist_.spin.dot(angular_momentum_));
}

Matrix3d RigidBody::inertia() const {
  const Matrix3d axes = rotation_ * axes_;
  return axes * principal_.asDiagonal() * axes.transpose();
}

Vector3d RigidBody::spin_of(const Vector3d& L) const {
  Vector3d out = Vector3d::Zero();
  if (turning_axes() == 3) {
    const Matrix3d axes = rotation_ * axes_;
    const Vector3d own = axes.transpose() * L;
    for (int a = 0; a < 3; ++a) out[a] = principal_[a] > 0 ? own[a] / principal_[a] : 0;
    return axes * out;
  }
  const Matrix3d I = inertia();
  for (int a = 0; a < 3; ++a)
    if (options_.turns[static_cast<unsigned>(a)] && I(a, a) > 0) out[a] = L[a] / I(a, a);
  return out;
}

Eigen::Matrix<double, 6, 6> RigidBody::mobility() const {
  Eigen::Matrix<double, 6, 6> out = Eigen::Matrix<double, 6, 6>::Zero();
  if (!options_.free) return out;
  for (int a = 0; a < 3; ++a) {
    if (options_.translates[static_cast<unsigned>(a)]) out(a, a) = mass_ > 0 ? 1 / mass_ : 0;
    if (!options_.turns[static_cast<unsigned>(a)]) continue;
    out.block<3, 1>(3, 3 + a) = spin_of(Vector3d::Unit(a));
  }
  return out;
}

void RigidBody::measure(const BlockGrid& grid, const PointColumns& columns) {
  ReproducibleSums<4> moments;
  for_points(grid, options_, columns, [&](double m, const Vector3d& X) {
    const Vector3d first = m * X;
    moments.all[3] += m;
    moments.add(first.data(), 3);
  });
  ranks::sum(moments.all);
  mass_ = moments.all[3].value();
  principal_.setZero();
  if (!(mass_ > 0)) return;
  moments.read(start_centre_.data(), 3);
  start_centre_ /= mass_;
  ReproducibleSums<9> turning;
  double size = grid.geometry().h;
  for_points(grid, options_, columns, [&](double m, const Vector3d& X) {
    const Vector3d r = X - start_centre_;
    const Matrix3d I = m * (r.squaredNorm() * Matrix3d::Identity() - r * r.transpose());
    turning.add(I.data());
    size = std::max(size, r.norm());
  });
  ranks::sum(turning.all);
  size_ = ranks::max(size);
  Matrix3d I;
  turning.read(I.data());
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver{I};
  principal_ = solver.eigenvalues().cwiseMax(0.0);
  axes_ = solver.eigenvectors();
}

/// The field at the centre and about it, by differences over the size of the body: exact for a
/// rigid field.
RigidTwist RigidBody::evaluate(double time) const {
  RigidTwist out{twist_.centre, Vector3d::Zero(), Vector3d::Zero()};
  if (!options_.velocity) return out;
  const auto field = [&](const Vector3d& x) {
    return vector(options_.velocity(triple(x), triple(start_position(x)), time));
  };
  out.velocity = field(out.centre);
  Matrix3d gradient = Matrix3d::Zero();
  double bent = 0;
  const bool turns = turning_axes() > 0;
  for (int a = 0; a < 3; ++a) {
    const Vector3d step = size_ * Vector3d::Unit(a), high = field(out.centre + step),
                   low = field(out.centre - step);
    gradient.col(a) = (high - low) / (2 * size_);
    bent = std::max(bent, (0.5 * (high + low) - out.velocity).norm());
  }
  if (turns)
    out.spin = 0.5 * Vector3d{gradient(2, 1) - gradient(1, 2), gradient(0, 2) - gradient(2, 0),
                              gradient(1, 0) - gradient(0, 1)};
  for (int a = 0; a < 3; ++a) {
    const auto k = static_cast<unsigned>(a);
    if (!options_.translates[k]) bent = std::max(bent, std::abs(out.velocity[a]));
    if (!options_.turns[k]) bent = std::max(bent, size_ * std::abs(out.spin[a]));
  }
  const Matrix3d rest = gradient - cross_matrix(out.spin);
  const double scale = out.velocity.norm() + size_ * out.spin.norm();
  if (std::max(bent, size_ * rest.norm()) > kNotRigid * std::max(scale, size_ * gradient.norm()))
    throw InputError(fmt::format(
        "{}: its velocity at time {:.6g} s is not one that a rigid body can have here: give a "
        "velocity that is the same everywhere, or that of a rotation, such as [-w*z, w*x]; bodies "
        "cut by the axis or by planes of symmetry move along them",
        options_.where, time));
  return out;
}

void RigidBody::place(const BlockGrid& grid, const PointColumns& columns, double time) {
  measure(grid, columns);
  twist_.centre = start_centre_;
  twist_ = evaluate(time);
  settle();
}

/// The state of the body is that of twist_.
void RigidBody::settle() {
  angular_momentum_ = inertia() * twist_.spin;
  for (int a = 0; a < 3; ++a)  // planes hold the rest
    if (!options_.turns[static_cast<unsigned>(a)]) angular_momentum_[a] = 0;
  start_ = twist_;
  start_angular_momentum_ = angular_momentum_;
}

void RigidBody::lose(const BlockGrid& grid, const PointColumns& columns) {
  const Vector3d old = start_centre_;
  measure(grid, columns);
  const Vector3d centre = twist_.centre + rotation_ * (start_centre_ - old);
  twist_.velocity = twist_.at(centre);
  twist_.centre = centre;
  settle();
}

void RigidBody::set_load(const Vector3d& force, const Vector3d& moment) {
  force_ = force;
  moment_ = moment;
}

void RigidBody::rewind() {
  twist_ = start_;
  angular_momentum_ = start_angular_momentum_;
}

void RigidBody::begin(double time, double dt) {
  rewind();
  if (!options_.free) {
    if (options_.velocity) {
      const RigidTwist now = evaluate(time);
      twist_.centre += 0.5 * dt * now.velocity;  // fields of x: where the body will be
      RigidTwist middle = evaluate(time + 0.5 * dt);
      middle.centre = start_.centre;
      twist_ = middle;
    }
    angular_momentum_ = inertia() * twist_.spin;
    return;
  }
  kick(dt * force_, dt * moment_);
}

double RigidBody::take(const RigidImpulse& sum) {
  received_ += sum.impulse;
  if (!options_.free) return 0;
  const double before = kinetic();
  kick(sum.impulse, sum.moment);
  return kinetic() - before;
}

void RigidBody::kick(const Vector3d& impulse, const Vector3d& moment) {
  if (!(mass_ > 0)) return;  // all of it has left the domain
  for (int a = 0; a < 3; ++a) {
    const auto k = static_cast<unsigned>(a);
    if (options_.translates[k]) twist_.velocity[a] += impulse[a] / mass_;
    if (options_.turns[k]) angular_momentum_[a] += moment[a];
  }
  twist_.spin = spin_of(angular_momentum_);
}

void RigidBody::finish(double dt) {
  const bool spins = twist_.spin.squaredNorm() > 0;
  // A body that has just come to rest still has to tell its points.
  moves_ = spins || start_.spin.squaredNorm() > 0 || twist_.velocity.squaredNorm() > 0 ||
           start_.velocity.squaredNorm() > 0;
  twist_.centre += dt * twist_.velocity;
  if (spins && options_.free && turning_axes() == 3) {
    const auto about = [&](int a, double share) {
      const double own = (rotation_ * axes_.col(a)).dot(angular_momentum_);
      if (!(principal_[a] > 0)) return;
      turn_ =
          (turn_ * Eigen::AngleAxisd(share * dt * own / principal_[a], axes_.col(a))).normalized();
      rotation_ = turn_.toRotationMatrix();
    };
    about(0, 0.5);
    about(1, 0.5);
    about(2, 1.0);
    about(1, 0.5);
    about(0, 0.5);
    twist_.spin = spin_of(angular_momentum_);
  } else if (spins) {
    const double rate = twist_.spin.norm();
    turn_ = (Eigen::AngleAxisd(rate * dt, twist_.spin / rate) * turn_).normalized();
    rotation_ = turn_.toRotationMatrix();
    if (!options_.free) angular_momentum_ = inertia() * twist_.spin;
  }
  start_ = twist_;
  start_angular_momentum_ = angular_momentum_;
}

std::vector<double> RigidBody::state() const {
  std::vector<double> out{mass_,     size_,     turn_.w(),          turn_.x(),
                          turn_.y(), turn_.z(), moves_ ? 1.0 : 0.0, 0.0};
  for (const Vector3d& v : {start_centre_, principal_, angular_momentum_, received_, twist_.centre,
                            twist_.velocity, twist_.spin})
    out.insert(out.end(), v.data(), v.data() + 3);
  out.insert(out.end(), axes_.data(), axes_.data() + 9);
  return out;
}

void RigidBody::set_state(const double* s) {
  mass_ = s[0];
  size_ = s[1];
  moves_ = s[6] > 0;
  turn_ = Eigen::Quaterniond{s[2], s[3], s[4], s[5]};
  rotation_ = turn_.toRotationMatrix();
  s += 8;
  for (Vector3d* v : {&start_centre_, &principal_, &angular_momentum_, &received_, &twist_.centre,
                      &twist_.velocity, &twist_.spin}) {
    *v = Eigen::Map<const Vector3d>(s);
    s += 3;
  }
  axes_ = Eigen::Map<const Matrix3d>(s);
  start_ = twist_;
  start_angular_momentum_ = angular_momentum_;
}

}  // namespace krater
