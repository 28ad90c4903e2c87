// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of elements that meet rigid bodies of points: as contact/contact_rigid.cpp, a pass at a
// time.
#include <algorithm>

#include "kinematics/mesh/carriers.hpp"

namespace krater {

using Eigen::Vector3d;

/// Velocities that the meetings of a pass will find: those after the push.
void MeshContact::foretell(double dt) {
  for (RigidPart& part : rigid_parts_) {
    const RigidBody& body = *parts_.rigid.find(part.body);
    part.twist = body.twist();
    part.sum = {};
    part.pushes.clear();
    if (!body.options().free) continue;
    ForetoldPush foretold;
    for (const Meeting& m : meetings_)
      if (m.rigid && m.side[1].of_scene == part.body && m.side[0].mass > 0) {
        const RigidMeeting met = meet(m, part, dt);
        if (met.closing > 0) foretold.add(met, m.side[0].mass);
      }
    foretold.foretell(body, part.twist);
  }
}

RigidMeeting MeshContact::meet(const Meeting& m, const RigidPart& part, double dt) const {
  Triple velocity{}, outwards{};
  add_to(velocity, 1 / m.side[0].mass, m.side[0].momentum);
  add_to(outwards, -1, m.normal);
  return meet_rigid(velocity.data(), outwards,
                    place_of_node(places_[static_cast<std::size_t>(m.node)]), friction_between(m),
                    part.twist, allowed(m, 0, dt));
}

MeshContact::RigidPart& MeshContact::rigid_part(int body) {
  const auto at = std::find_if(rigid_parts_.begin(), rigid_parts_.end(),
                               [body](const RigidPart& p) { return p.body == body; });
  if (at != rigid_parts_.end()) return *at;
  rigid_parts_.push_back({body, {}, {}, {}});
  return rigid_parts_.back();
}

void MeshContact::exchange_rigid(Meeting& m, double dt) {
  RigidPart& part = rigid_part(m.side[1].of_scene);
  const RigidMeeting met = meet(m, part, dt);
  if (!(met.closing > 0)) return;
  Side& A = m.side[0];
  const Vector3d change = met.change(), impulse = A.mass * change;
  const Vector3d place = part.twist.centre + met.arm;
  for (std::size_t a = 0; a < 3; ++a) {
    A.change[a] = change[static_cast<int>(a)];
    m.impulse[a] += impulse[static_cast<int>(a)];
  }
  friction_ -= A.mass * met.slip.squaredNorm() * met.loss * (1 - 0.5 * met.loss);
  part.sum.add({-impulse, -met.arm.cross(impulse), impulse.dot(met.velocity)});
  part.pushes.push_back({place, impulse});
}

/// A free body works by the mean of its velocities before and after what it received.
void MeshContact::hand_over() {
  for (RigidPart& part : rigid_parts_) {
    RigidBody& body = *parts_.rigid.find(part.body);
    const RigidTwist before = body.twist();
    body.take(part.sum);
    if (!body.options().free) parts_.audit.external_work += part.sum.work;
    const RigidTwist after = body.twist();
    for (const auto& [place, impulse] : part.pushes)
      rigid_work_ += 0.5 * impulse.dot(before.at(place) + after.at(place));
    const Vector3d others = body.mass() * (after.velocity - before.velocity) - part.sum.impulse;
    std::array<double, 3>& book =
        body.options().free ? parts_.audit.wall_impulse : parts_.audit.external_impulse;
    for (int a = 0; a < 3; ++a) book[static_cast<std::size_t>(a)] += others[a];
  }
}

}  // namespace krater
