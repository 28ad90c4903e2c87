// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/contact/rigid_meeting.hpp"

#include <algorithm>

#include <Eigen/LU>

namespace krater {

using Eigen::Matrix3d;
using Eigen::Vector3d;

RigidMeeting meet_rigid(const double* v, const Triple& normal, const Triple& place, double friction,
                        const RigidTwist& twist, double allowed) {
  RigidMeeting out;
  const Eigen::Map<const Vector3d> velocity{v};
  const Vector3d x{place[0], place[1], place[2]};
  out.normal = {normal[0], normal[1], normal[2]};
  out.arm = x - twist.centre;
  out.velocity = twist.at(x);
  const Vector3d apart = out.velocity - velocity;
  const double closing = apart.dot(out.normal);
  out.closing = closing - allowed;
  out.slip = apart - closing * out.normal;
  const double slip = out.slip.norm();
  out.loss = slip > 0 ? std::min(friction * out.closing / slip, 1.0) : 0.0;
  return out;
}

void ForetoldPush::add(const RigidMeeting& m, double mass) {
  const Vector3d impulse = -mass * m.change();
  push.head<3>() += impulse;
  push.tail<3>() += m.arm.cross(impulse);
  Eigen::Matrix<double, 3, 6> A = Eigen::Matrix<double, 3, 6>::Identity();
  A.rightCols<3>() << 0, m.arm[2], -m.arm[1], -m.arm[2], 0, m.arm[0], m.arm[1], -m.arm[0], 0;
  const bool sticks = m.loss >= 1;
  const Matrix3d P = sticks ? Matrix3d::Identity() : Matrix3d{m.normal * m.normal.transpose()};
  stiffness += mass * A.transpose() * P * A;
}

void ForetoldPush::foretell(const RigidBody& body, RigidTwist& twist) const {
  const Eigen::Matrix<double, 6, 6> mobility = body.mobility();
  const Eigen::Matrix<double, 6, 6> system =
      Eigen::Matrix<double, 6, 6>::Identity() + mobility * stiffness;
  const Eigen::Matrix<double, 6, 1> change = system.partialPivLu().solve(mobility * push);
  twist.velocity += change.head<3>();
  twist.spin += change.tail<3>();
}

}  // namespace krater
