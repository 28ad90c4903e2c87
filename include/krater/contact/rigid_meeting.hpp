// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file contact/rigid_meeting.hpp
/// A node that meets a rigid body, and what foretells the body's velocity after all that it meets
/// (contact/contact.hpp):
///   (1 + M^-1 K) du = M^-1 J(u),  K = sum m A^T P A,  A u = V + omega x r.
#include <Eigen/Core>

#include "krater/contact/rigid.hpp"

namespace krater {

/// The change of a node's velocity that a rigid body asks for.
struct RigidMeeting {
  Eigen::Vector3d arm, velocity;  ///< from the centre; of the body at the node
  Eigen::Vector3d normal, slip;   ///< out of the body; body - node, along the surface
  double closing = 0;             ///< speed that is to be stopped [m/s]
  double loss = 0;                ///< share of the slip that friction takes
  Eigen::Vector3d change() const { return closing * normal + loss * slip; }
};

/// Of a node at `place` with velocity v; they may close with the speed `allowed`.
RigidMeeting meet_rigid(const double* v, const Triple& normal, const Triple& place, double friction,
                        const RigidTwist& twist, double allowed = 0);

/// J and K of a body, about its centre.
struct ForetoldPush {
  Eigen::Matrix<double, 6, 1> push = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 6, 6> stiffness = Eigen::Matrix<double, 6, 6>::Zero();
  void add(const RigidMeeting& meeting, double mass);
  void add(const ForetoldPush& other) {
    push += other.push;
    stiffness += other.stiffness;
  }
  /// Adds du to the twist of a free body.
  void foretell(const RigidBody& body, RigidTwist& twist) const;
};

}  // namespace krater
