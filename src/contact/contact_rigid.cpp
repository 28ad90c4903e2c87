// SPDX-License-Identifier: GPL-3.0-or-later
// Contact of deformable fields with rigid bodies.
#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "krater/contact/contact.hpp"
#include "krater/core/parallel.hpp"

namespace krater {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// How a node meets a rigid body: the change of its velocity that the body asks for.
struct Meeting {
  Vector3d arm, velocity;  ///< from the centre; of the body at the node
  Vector3d normal, slip;   ///< body - node, along the surface
  double closing = 0, loss = 0;
};

Meeting meet(const double* node, const std::array<double, 3>& normal,
             const std::array<double, 3>& place, double friction, const RigidTwist& twist) {
  Meeting out;
  const Eigen::Map<const Vector3d> v{node};
  const Vector3d x{place[0], place[1], place[2]};
  out.normal = {normal[0], normal[1], normal[2]};
  out.arm = x - twist.centre;
  out.velocity = twist.at(x);
  const Vector3d apart = out.velocity - v;
  out.closing = apart.dot(out.normal);
  out.slip = apart - out.closing * out.normal;
  const double slip = out.slip.norm();
  out.loss = slip > 0 ? std::min(friction * out.closing / slip, 1.0) : 0.0;
  return out;
}

}  // namespace

ContactSet::RigidShare& ContactSet::share_of(Group& group, int body) {
  for (RigidShare& share : group.shares)
    if (share.body == body) return share;
  group.shares.emplace_back().body = body;
  return group.shares.back();
}

ContactSet::Strike ContactSet::strike_of(const BlockGrid& grid, const Group& group,
                                         const Contact& contact, bool a_is_rigid) const {
  const NodeBlock& a = grid.node_blocks()[group.first + static_cast<std::size_t>(contact.a)];
  const NodeBlock& b = grid.node_blocks()[group.first + static_cast<std::size_t>(contact.b)];
  const NodeBlock &body = a_is_rigid ? a : b, &other = a_is_rigid ? b : a;
  Strike out{other.nodes + kNodeDoubles * contact.node,
             body_of(body.field),
             contact.normal,
             {},
             options_.friction_of(body_of(a.field), body_of(b.field))};
  if (!a_is_rigid)
    for (double& n : out.normal) n = -n;
  for (int axis = geometry_.dimension - 1, rest = contact.node; axis >= 0; --axis, rest /= edge_) {
    const auto k = static_cast<unsigned>(axis);
    out.place[k] = geometry_.min[k] + geometry_.h * (a.key.i[k] * edge_ + rest % edge_ - 1);
  }
  return out;
}

void ContactSet::probe(const Strike& strike, const RigidTwist& twist, RigidShare& share) const {
  const Meeting m = meet(strike.node, strike.normal, strike.place, strike.friction, twist);
  if (!(m.closing > 0)) return;
  const double mass = strike.node[moved::mass];
  const Vector3d impulse = -mass * (m.closing * m.normal + m.loss * m.slip);
  share.push.head<3>() += impulse;
  share.push.tail<3>() += m.arm.cross(impulse);
  Eigen::Matrix<double, 3, 6> A = Eigen::Matrix<double, 3, 6>::Identity();
  A.rightCols<3>() << 0, m.arm[2], -m.arm[1], -m.arm[2], 0, m.arm[0], m.arm[1], -m.arm[0], 0;
  const bool sticks = m.loss >= 1;
  const Matrix3d P = sticks ? Matrix3d::Identity() : Matrix3d{m.normal * m.normal.transpose()};
  share.stiffness += mass * A.transpose() * P * A;
}

Triple ContactSet::exchange(const Strike& strike, const RigidTwist& twist, Group& group,
                            ContactWork& sum) const {
  const Meeting m = meet(strike.node, strike.normal, strike.place, strike.friction, twist);
  if (!(m.closing > 0)) return {};
  double* node = strike.node;
  const double mass = node[moved::mass];
  Eigen::Map<Vector3d> v{node}, dv{node + moved::change};
  const Vector3d change = m.closing * m.normal + m.loss * m.slip;
  sum.change -= 0.5 * mass * v.squaredNorm();
  v += change;
  dv += change;
  sum.change += 0.5 * mass * v.squaredNorm();
  sum.friction -= mass * m.slip.squaredNorm() * m.loss * (1 - 0.5 * m.loss);
  sum.nodes += 1;
  const Vector3d reaction = -mass * change;
  share_of(group, strike.body)
      .sum.add({reaction, m.arm.cross(reaction), -reaction.dot(m.velocity)});
  group.rigid_pushes.push_back({group.heat.count(), strike.body,
                                Vector3d{strike.place[0], strike.place[1], strike.place[2]},
                                -reaction});
  return {-reaction[0], -reaction[1], -reaction[2]};
}

/// Velocities that the nodes will meet: those of driven bodies, and those that free ones will have
/// after the push.
void ContactSet::foretell(const BlockGrid& grid, RigidBodies& rigid) {
  bool any_free = false;
  for (const RigidBody& body : rigid.all()) {
    const auto b = static_cast<std::size_t>(body.options().body);
    if (twists_.size() <= b) twists_.resize(b + 1);
    twists_[b] = body.twist();
    any_free = any_free || body.options().free;
  }
  if (!any_free) return;
  for_each(groups_.size(), [&](std::size_t g) {
    Group& group = groups_[g];
    for (const Contact& c : group.contacts) {
      const auto body_in = [&](int f) {
        return body_of(grid.node_blocks()[group.first + static_cast<std::size_t>(f)].field);
      };
      const int a = body_in(c.a), b = body_in(c.b);
      const RigidBody* body = rigid.find(a) ? rigid.find(a) : rigid.find(b);
      if (!body || !body->options().free) continue;
      const Strike strike = strike_of(grid, group, c, rigid.find(a) != nullptr);
      probe(strike, twists_[static_cast<std::size_t>(strike.body)], share_of(group, strike.body));
    }
  });
  for (const RigidBody& body : rigid.all()) {
    if (!body.options().free) continue;
    RigidShare all;
    all.body = body.options().body;
    for (Group& group : groups_)
      for (const RigidShare& share : group.shares)
        if (share.body == all.body) {
          all.push += share.push;
          all.stiffness += share.stiffness;
        }
    const Eigen::Matrix<double, 6, 6> mobility = body.mobility();
    const Eigen::Matrix<double, 6, 6> system =
        Eigen::Matrix<double, 6, 6>::Identity() + mobility * all.stiffness;
    const Eigen::Matrix<double, 6, 1> change = system.partialPivLu().solve(mobility * all.push);
    RigidTwist& twist = twists_[static_cast<std::size_t>(all.body)];
    twist.velocity += change.head<3>();
    twist.spin += change.tail<3>();
  }
}

// A free body works by the mean of its velocities before and after what it received.
void ContactSet::hand_over(RigidBodies& rigid, ContactWork& sum) {
  for (RigidBody& body : rigid.all()) {
    const RigidTwist before = body.twist();
    RigidImpulse all;
    for (const Group& group : groups_)
      for (const RigidShare& share : group.shares)
        if (share.body == body.options().body) all.add(share.sum);
    sum.change += body.take(all);
    if (!body.options().free) sum.driven += all.work;
    const RigidTwist after = body.twist();
    const Vector3d others = body.mass() * (after.velocity - before.velocity) - all.impulse;
    Triple& book = body.options().free ? sum.held_impulse : sum.driven_impulse;
    for (int a = 0; a < 3; ++a) book[static_cast<unsigned>(a)] += others[a];
    for (Group& group : groups_)
      for (const RigidPush& push : group.rigid_pushes)
        if (push.body == body.options().body)
          group.heat.add_work(push.loss,
                              0.5 * push.impulse.dot(before.at(push.place) + after.at(push.place)));
  }
}

}  // namespace krater
