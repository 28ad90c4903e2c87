// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mesh/mesh_contact.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/mesh/carriers.hpp"

namespace krater {

namespace {

constexpr int kPasses = 3;
constexpr double kTakenBack = 0.1;  // share of an overlap, per step
constexpr double kNoFaster = 0.05;  // than this share of the approach, or ...
constexpr double kCreep = 1e-3;     // ... of the speed of sound
constexpr double kTouch = 0.05;     // cells: gap at which points touch (contact/contact_joint.cpp)

}  // namespace

MeshContact::MeshContact(Frame frame, const ContactOptions& options, const Parts& parts)
    : frame_{frame},
      dim_{dimension(frame)},
      cell_{parts.grid.geometry().h},
      geometry_{parts.grid.geometry()},
      conditions_{parts.boundary.conditions()},
      options_{options},
      parts_{parts} {
  find_faces();
}

void MeshContact::find_faces() {
  if (!faces_.empty() && shape_ == parts_.mesh.shape_changes()) return;
  shape_ = parts_.mesh.shape_changes();
  faces_.clear();
  for (int s = 0; s < parts_.mesh.set_count(); ++s) faces_.push_back(parts_.mesh.meeting_faces(s));
}

void MeshContact::push(double dt) {
  begin();
  for (int k = 0; k < kPasses; ++k) pass(dt);
  end();
}

void MeshContact::begin() {
  bodies_ = parts_.mesh.nodes();
  find_faces();
  carriers_.clear();
  meetings_.clear();
  touched_.clear();
  given_.clear();
  rigid_parts_.clear();
  friction_ = pairs_ = rigid_work_ = 0;
  find_carriers();
  if (carriers_.empty()) return;
  share_masses();
  number_nodes();
  find_meetings();
  if (meetings_.empty()) return;
  link_carriers();
  weigh();
  for (const Meeting& m : meetings_)
    if (m.rigid) rigid_part(m.side[1].of_scene);
  parts_.mesh.hold_nodes();
  list_touched();
  note_changes(-1);  // dv with contact less dv without it
}

void MeshContact::end() {
  note_changes(1);
  note_impulses();
}

void MeshContact::note_impulses() {
  for (const Meeting& m : meetings_) {
    if (m.impulse == Triple{}) continue;
    pairs_ += 1;
    const Side& other = m.side[1];
    const int by = other.record != nullptr ? other.of_scene : bodies_[other.body].body;
    add_impulse(given_, own_field(bodies_[m.side[0].body].body), {Partner::Kind::body, by},
                m.impulse);
    if (other.record == nullptr) continue;
    const int block = parts_.grid.find_node_block(
        parts_.grid.place_of_node(places_[static_cast<std::size_t>(m.node)]).first, own_field(by));
    NodeBlock& pushed = parts_.grid.node_blocks()[static_cast<std::size_t>(block)];
    pushed.still = pushed.inert = false;
  }
}

void MeshContact::list_touched() {
  std::vector<std::vector<bool>> seen;
  for (const MeshNodes& b : bodies_) seen.emplace_back(b.count, false);
  for (const Carrier& q : carriers_)
    for (std::size_t I = 0; I < q.corners && q.first_link < q.last_link; ++I) {
      const auto n = static_cast<std::size_t>(q.nodes[I]);
      if (!seen[q.body][n]) touched_.push_back({q.body, q.nodes[I], {}});
      seen[q.body][n] = true;
    }
}

void MeshContact::note_changes(double sign) {
  for (Touched& t : touched_) {
    const double* change = bodies_[t.body].changes + kChange * static_cast<std::size_t>(t.node);
    add_to(t.by_contact, sign, {change[0], change[1], change[2]});
  }
}

/// How fast the sides of a meeting may close [m/s].
double MeshContact::allowed(const Meeting& m, double closing, double dt) const {
  if (m.side[1].record != nullptr) return std::max(m.gap - kTouch * cell_, 0.0) / dt;
  const double closed = m.gap / dt;
  if (m.gap >= 0) return closed;
  return -std::min(-kTakenBack * closed,
                   std::max(kNoFaster * std::abs(closing), kCreep * parts_.sound_speed));
}

void MeshContact::exchange(Meeting& m, double dt) {
  Side &A = m.side[0], &B = m.side[1];
  A.change = B.change = {};
  if (!(A.mass > 0) || !(B.mass > 0)) return;
  if (m.rigid) return exchange_rigid(m, dt);
  Triple slip{};
  add_to(slip, 1 / A.mass, A.momentum);
  if (B.record != nullptr)
    add_to(slip, -1, {B.record[0], B.record[1], B.record[2]});
  else
    add_to(slip, -1 / B.mass, B.momentum);
  const double closing = dot(slip, m.normal), stop = closing - allowed(m, closing, dt);
  if (!(stop > 0)) return;
  const double reduced = A.mass * B.mass / (A.mass + B.mass);
  add_to(slip, -closing, m.normal);
  const double speed = length_of(slip);
  const double held = speed > 0 ? std::min(friction_between(m) * stop / speed, 1.0) : 0.0;
  Triple impulse{};
  add_to(impulse, -reduced * stop, m.normal);
  add_to(impulse, -reduced * held, slip);
  friction_ -= reduced * speed * speed * held * (1 - 0.5 * held);
  add_to(A.change, 1 / A.mass, impulse);
  if (B.record == nullptr) {
    add_to(B.change, -1 / B.mass, impulse);
  } else {
    for (std::size_t a = 0; a < 3; ++a) {
      B.record[a] -= impulse[a] / B.mass;
      B.record[moved::change + a] -= impulse[a] / B.mass;
    }
  }
  add_to(m.impulse, 1, impulse);
}

double MeshContact::friction_between(const Meeting& m) const {
  const Side& other = m.side[1];
  return options_.friction_of(bodies_[m.side[0].body].body,
                              other.record != nullptr ? other.of_scene : bodies_[other.body].body);
}

/// Momenta to the grid, exchange, and back.
void MeshContact::pass(double dt) {
  if (meetings_.empty()) return;
  for (Meeting& m : meetings_) m.side[0].momentum = m.side[1].momentum = {};
  for (const Carrier& q : carriers_) {
    if (q.first_link == q.last_link) continue;
    Triple p{};
    for (std::size_t I = 0; I < q.corners; ++I) {
      const auto n = static_cast<std::size_t>(q.nodes[I]);
      const double *v = bodies_[q.body].records + kNode * n + kVelocity,
                   *change = bodies_[q.body].changes + kChange * n;
      for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a)
        p[a] += q.share[I] * (v[a] + change[a]);
    }
    for_each_link(q, [&](const Link& link, Side& side) {
      add_to(side.momentum, link.S, reflected(p, link.flips));
    });
  }
  for (Meeting& m : meetings_)  // the image has the opposite across the plane
    for (std::size_t a = 0; a < 3; ++a)
      if (m.held[a]) m.side[0].momentum[a] = m.side[1].momentum[a] = 0;
  foretell(dt);
  for (Meeting& m : meetings_) exchange(m, dt);
  hand_over();
  for (const Carrier& q : carriers_) {
    if (q.first_link == q.last_link) continue;
    Triple dv{};
    for_each_link(q, [&](const Link& link, const Side& side) {
      add_to(dv, link.S, reflected(side.change, link.flips));
    });
    for (std::size_t I = 0; I < q.corners; ++I) {
      const auto n = static_cast<std::size_t>(q.nodes[I]);
      const double part = q.share[I] / bodies_[q.body].records[kNode * n + kMass];
      double* change = bodies_[q.body].changes + kChange * n;
      for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a) change[a] += part * dv[a];
    }
  }
}

EncounterLoss MeshContact::loss() const {
  EncounterLoss out{rigid_work_, 0};
  for (const Touched& t : touched_) {
    const auto n = static_cast<std::size_t>(t.node);
    const double *record = bodies_[t.body].records + kNode * n,
                 *change = bodies_[t.body].changes + kChange * n;
    double work = 0;
    for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a)
      work += t.by_contact[a] * (record[kVelocity + a] + 0.5 * change[a]);
    out.taken -= record[kMass] * work;
    out.pushed += record[kMass] * dot(t.by_contact, t.by_contact);
  }
  for (const Meeting& m : meetings_) {
    const Side& side = m.side[1];
    if (!accounts_for(m)) continue;
    double work = 0;
    for (std::size_t a = 0; a < 3; ++a)
      work -= m.impulse[a] * (side.record[a] - 0.5 * side.record[moved::change + a]);
    out.taken -= work;
    out.pushed += dot(m.impulse, m.impulse) / side.mass;
  }
  return out;
}

/// What contact took from motion becomes heat of the nodes that were pushed, by m_I |dv_I|^2.
Standing MeshContact::warm(const EncounterLoss& all) {
  if (!(all.pushed > 0)) return {};
  double in_points = 0;
  for (const Touched& t : touched_)
    bodies_[t.body].records[kNode * static_cast<std::size_t>(t.node) + kHeat] +=
        all.share() * dot(t.by_contact, t.by_contact);
  for (const Meeting& m : meetings_) {
    if (!accounts_for(m)) continue;
    const double heat = all.share() * dot(m.impulse, m.impulse) / m.side[1].mass;
    m.side[1].record[moved::work] += heat / m.side[1].mass;
    in_points += heat;
  }
  if (in_points != 0) parts_.boundary.mirror_work();
  parts_.audit.transfer_loss -= in_points;  // MPM's own account takes it for that
  parts_.audit.friction_work += friction_;
  parts_.impulses.add(given_);
  Standing out{};
  out.contact_pairs = pairs_;
  return out;
}

Standing MeshContact::book() {
  const EncounterLoss all = loss();
  if (all.pushed > 0) parts_.audit.contact_heat += all.taken;
  return warm(all);
}

std::vector<BodyBox> MeshContact::boxes() const {
  std::vector<BodyBox> out;
  for (const MeshNodes& b : parts_.mesh.nodes()) {
    BodyBox of{b.body, {}};
    for (std::size_t n = 0; n < b.count; ++n) {
      const double* x = b.records + kNode * n;
      if (x[kMass] > 0) of.box.hold({x[0], x[1], x[2]});
    }
    out.push_back(of);
  }
  return out;
}

}  // namespace krater
