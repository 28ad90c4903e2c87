// SPDX-License-Identifier: GPL-3.0-or-later
// Contact of deformable fields with rigid bodies.
#include <algorithm>
#include <cmath>

#include "krater/contact/contact.hpp"
#include "krater/contact/rigid_meeting.hpp"
#include "krater/core/parallel.hpp"
#include "krater/core/ranks.hpp"

namespace krater {

using Eigen::Vector3d;

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
  const std::array<int, 3> index = index_in(a.key, contact.node, geometry_.dimension);
  for (int axis = 0; axis < geometry_.dimension; ++axis) {
    const auto k = static_cast<unsigned>(axis);
    out.place[k] = geometry(a.key.level).place(index[k], axis);
  }
  return out;
}

void ContactSet::probe(const Strike& strike, const RigidTwist& twist, RigidShare& share) const {
  const RigidMeeting m =
      meet_rigid(strike.node, strike.normal, strike.place, strike.friction, twist);
  if (m.closing > 0) share.foretold.add(m, strike.node[moved::mass]);
}

Triple ContactSet::exchange(const Strike& strike, const RigidTwist& twist, Group& group,
                            ContactWork& sum) const {
  const RigidMeeting m =
      meet_rigid(strike.node, strike.normal, strike.place, strike.friction, twist);
  if (!(m.closing > 0)) return {};
  double* node = strike.node;
  const double mass = node[moved::mass];
  Eigen::Map<Vector3d> v{node}, dv{node + moved::change};
  const Vector3d change = m.change();
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
    const int b = body.options().body;
    ReproducibleSums<42> sums;
    for (const Group& group : groups_)
      for (const RigidShare& share : group.shares)
        if (group.counted && share.body == b) {
          sums.add(share.foretold.push.data(), 6);
          sums.add(share.foretold.stiffness.data(), 36, 6);
        }
    ranks::sum(sums.all);
    ForetoldPush all;
    sums.read(all.push.data(), 6);
    sums.read(all.stiffness.data(), 36, 6);
    all.foretell(body, twists_[static_cast<std::size_t>(b)]);
  }
}

// A free body works by the mean of its velocities before and after what it received.
void ContactSet::hand_over(RigidBodies& rigid, ContactWork& sum) {
  for (RigidBody& body : rigid.all()) {
    const RigidTwist before = body.twist();
    ReproducibleSums<7> sums;
    for (const Group& group : groups_)
      for (const RigidShare& share : group.shares)
        if (group.counted && share.body == body.options().body) {
          sums.add(share.sum.impulse.data(), 3);
          sums.add(share.sum.moment.data(), 3, 3);
          sums.all[6] += share.sum.work;
        }
    ranks::sum(sums.all);
    RigidImpulse all;
    sums.read(all.impulse.data(), 3);
    sums.read(all.moment.data(), 3, 3);
    all.work = sums.all[6].value();
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
