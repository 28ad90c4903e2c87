// SPDX-License-Identifier: GPL-3.0-or-later
// Where bodies meet: normals, and gaps.
#include <algorithm>
#include <cmath>

#include "kinematics/mesh/carriers.hpp"
#include "krater/contact/joint_profile.hpp"

namespace krater {

namespace {

constexpr double kNoNormal = 1e-9;  // of the longest that there could be
constexpr double kFlat = 1e-3;      // a mesh face that is flat within this needs no other normal
constexpr double kInside = -1;      // gap of points that do not end at a face [cells]

/// k^8, for a face decides and not a corner.
double eighth(double k) { return std::pow(k, 8); }
/// The flatter of mesh and points decides.
double fortieth(double k) { return std::pow(k, 40); }

/// (F(a + 1) - F(a - 1))/2 of a flat face that reaches a beyond the node, F = int S [1/cell].
double slope_of_face(double reach) {
  const double a = std::clamp(reach, -0.5, 0.5);
  return 0.5 - (std::pow(0.5 - a, 3) + std::pow(0.5 + a, 3)) / 12;
}

std::size_t main_axis(const Triple& n) {
  std::size_t axis = 0;
  for (std::size_t a = 1; a < 3; ++a)
    if (std::abs(n[a]) > std::abs(n[axis])) axis = a;
  return axis;
}

}  // namespace

void MeshContact::find_meetings() {
  const std::size_t bodies = faces_.size();
  present_.assign(places_.size() * bodies, {});
  for (const Carrier& q : carriers_)
    for (std::size_t n = 0; n < reached(); ++n) {
      Presence& p = present_[static_cast<std::size_t>(q.at[n].node) * bodies + q.body];
      const double S = weight_at(q, dim_, n);
      add_to(p.area, S, reflected(q.area, q.at[n].flips));
      p.whole += S * length_of(q.area);
      p.here = true;
    }
  const auto looks = [](const Presence& p) {
    const double length = length_of(p.area);
    Triple out{};
    if (length > 0 && p.whole > 0) add_to(out, eighth(length / p.whole) / length, p.area);
    return out;
  };
  first_meeting_.assign(places_.size() + 1, 0);
  for (std::size_t node = 0; node < places_.size(); ++node) {
    const auto number = static_cast<std::int32_t>(node);
    first_meeting_[node] = static_cast<std::int32_t>(meetings_.size());
    for (std::size_t a = 0; a < bodies; ++a) {
      const Presence& A = present_[node * bodies + a];
      if (!A.here) continue;
      for (std::size_t b = a + 1; b < bodies; ++b) {
        const Presence& B = present_[node * bodies + b];
        Meeting m{};
        m.node = number;
        m.side[0].body = a;
        m.side[1].body = b;
        m.normal = minus(looks(A), looks(B));
        if (B.here && find_normal(m)) meetings_.push_back(m);
      }
      if (!of_points_.empty()) meet_points(number, a, A);
    }
  }
  first_meeting_[places_.size()] = static_cast<std::int32_t>(meetings_.size());
}

/// Of length 1, without a part across a plane of symmetry that the node lies on. A node on a side
/// that sticks is held, and what lies beyond is an image of points: neither can be pushed.
bool MeshContact::find_normal(Meeting& m) const {
  Triple& n = m.normal;
  const Index& index = places_[static_cast<std::size_t>(m.node)];
  for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a)
    for (std::size_t side = 0; side < 2; ++side) {
      const int plane = side == 0 ? 1 : geometry_.cells[a] + 1;
      const BoundaryKind kind = conditions_[a][side].kind;
      const bool beyond = side == 0 ? index[a] < plane : index[a] > plane;
      if (kind == BoundaryKind::sticky && (beyond || index[a] == plane)) return false;
      if (kind != BoundaryKind::symmetry || index[a] != plane) continue;
      n[a] = 0;
      m.held[a] = true;
    }
  const double length = length_of(n);
  if (!(length > kNoNormal)) return false;
  for (double& component : n) component /= length;
  return true;
}

/// Meetings of a body of elements with those of points that have mass at the node.
void MeshContact::meet_points(std::int32_t node, std::size_t body, const Presence& presence) {
  const double length = length_of(presence.area),
               flatness = presence.whole > 0 ? length / presence.whole : 0;
  const Index& index = places_[static_cast<std::size_t>(node)];
  for (const int other : of_points_) {
    double* record = parts_.grid.find_node(index, own_field(other));
    if (record == nullptr || !(record[moved::mass] > 0)) continue;
    Meeting m{};
    m.node = node;
    m.side[0].body = body;
    m.side[1].of_scene = other;
    m.side[1].record = record;
    m.side[1].mass = record[moved::mass];
    m.side[1].weight = 1;
    m.rigid = parts_.rigid.find(other) != nullptr;
    if (length > 0) add_to(m.normal, fortieth(flatness) / length, presence.area);
    if (flatness < 1 - kFlat) {
      Triple inwards{};
      const double flat = flatness_of_points(index, other, inwards);
      add_to(m.normal, fortieth(flat), inwards);
    }
    if (find_normal(m)) meetings_.push_back(m);
  }
}

/// Central differences of phi_A, smoothed across [1/cell].
Triple MeshContact::gradient_of_points(const Index& index, int body) const {
  Triple out{};
  const int depth = dim_ == 3 ? 1 : 0;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -depth; k <= depth; ++k) {
        const std::array<int, 3> d{i, j, k};
        const double phi = parts_.fillings.filling(
            parts_.grid, {index[0] + i, index[1] + j, index[2] + k}, own_field(body));
        const double all = (2 - i * i) * (2 - j * j) * (dim_ == 3 ? 2 - k * k : 1);
        for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a)
          out[a] += d[a] * all * phi / (dim_ == 3 ? 32 : 8);
      }
  return out;
}

/// Filling of points at the node and two to each side along an axis.
std::array<double, 5> MeshContact::fillings_along(std::size_t axis, Index at, int body) const {
  std::array<double, 5> phi{};
  at[axis] -= 2;
  for (double& value : phi) {
    value = parts_.fillings.filling(parts_.grid, at, own_field(body));
    at[axis] += 1;
  }
  return phi;
}

/// k_A at the node next to their face, and the direction of grad phi_A there.
double MeshContact::flatness_of_points(Index index, int body, Triple& inwards) const {
  inwards = gradient_of_points(index, body);
  const std::size_t axis = main_axis(inwards);
  const std::array<double, 5> phi = fillings_along(axis, index, body);
  std::size_t joint = 2;
  for (const std::size_t at : {std::size_t{1}, std::size_t{3}})
    if (std::abs(phi[at] - 0.5) < std::abs(phi[joint] - 0.5)) joint = at;
  if (joint != 2) {
    index[axis] += static_cast<int>(joint) - 2;
    inwards = gradient_of_points(index, body);
  }
  const std::size_t inner = inwards[axis] > 0 ? joint + 1 : joint - 1;
  const JointProfile profile{phi[inner], phi[joint], phi[2 * joint - inner]};
  const double length = length_of(inwards);
  if (!profile.ends() || !(length > 0)) return 0;
  for (double& component : inwards) component /= length;
  return std::min(length / slope_of_face(profile.reach()), 1.0);
}

Triple MeshContact::place_of_node(const Index& index) const {
  Triple x{};
  for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a)
    x[a] = geometry_.min[a] + (index[a] - 1) * geometry_.h;
  return x;
}

/// What looks away from a meeting is no part of it.
void MeshContact::link_carriers() {
  constexpr double kAway = -0.5;  // N . n
  links_.clear();
  for (Carrier& q : carriers_) {
    q.first_link = links_.size();
    const double away = kAway * length_of(q.area);
    for (std::size_t n = 0; n < reached(); ++n) {
      const auto node = static_cast<std::size_t>(q.at[n].node);
      for (std::int32_t k = first_meeting_[node]; k < first_meeting_[node + 1]; ++k) {
        const Meeting& m = meetings_[static_cast<std::size_t>(k)];
        for (std::uint8_t s = 0; s < 2; ++s) {
          if (m.side[s].body != q.body) continue;
          const double across = (s == 0 ? 1 : -1) * dot(reflected(q.area, q.at[n].flips), m.normal);
          if (across >= away)
            links_.push_back(
                {static_cast<std::uint32_t>(k), s, q.at[n].flips, weight_at(q, dim_, n), across});
        }
      }
    }
    q.last_link = links_.size();
  }
}

/// Masses and places of the sides, and their gaps.
void MeshContact::weigh() {
  for (const Carrier& q : carriers_) {
    double mass = 0;
    for (std::size_t I = 0; I < q.corners; ++I) mass += q.share[I];
    const double squared = dot(q.area, q.area);
    for_each_link(q, [&](const Link& link, Side& side) {
      side.mass += link.S * mass;
      const double across = link.across, look = q.corners == 1 ? 1
                                                : across > 0   ? across * across / squared
                                                               : 0;
      side.weight += link.S * mass * look;
      Triple x = q.x;
      for (std::size_t a = 0; link.flips >> a != 0; ++a)
        if ((link.flips >> a & 1U) != 0) {
          const bool low = x[a] < 0.5 * (geometry_.min[a] + geometry_.upper(static_cast<int>(a)));
          x[a] = 2 * (low ? geometry_.min[a] : geometry_.upper(static_cast<int>(a))) - x[a];
        }
      add_to(side.place, link.S * mass * look, x);
    });
  }
  for (Meeting& m : meetings_) {
    m.gap = 0;
    for (std::size_t s = 0; s < 2; ++s) {
      if (m.side[s].record != nullptr) continue;
      if (!(m.side[s].weight > 0)) {
        m.side[s].mass = 0;  // nothing of it looks across
        continue;
      }
      for (double& x : m.side[s].place) x /= m.side[s].weight;
      m.gap += (s == 0 ? -1 : 1) * dot(m.side[s].place, m.normal);
    }
    if (m.side[1].record != nullptr && m.side[0].mass > 0)
      m.gap = reach_of_points(m, m.side[0].place);
  }
}

/// The gap between a face of elements and the points beyond it [m].
double MeshContact::reach_of_points(const Meeting& m, const Triple& face) const {
  const std::size_t axis = main_axis(m.normal);
  const int inwards = m.normal[axis] > 0 ? 1 : -1;
  const Index& node = places_[static_cast<std::size_t>(m.node)];
  const std::array<double, 5> phi = fillings_along(axis, node, m.side[1].of_scene);
  // Of the node and its neighbours the one that both fill best.
  Triple x = place_of_node(node);
  const double behind = dot(minus(face, x), m.normal) / cell_;  // of the mesh's face [cells]
  int joint = 0;
  double best = -1;
  for (const int d : {0, -1, 1}) {
    const double mesh = std::clamp(0.5 + behind - d * m.normal[axis], 0.0, 1.0);
    const double both = std::min(mesh, phi[static_cast<std::size_t>(2 + d)]);
    if (both > best) {
      best = both;
      joint = d;
    }
  }
  const auto at_joint = [&](int d) { return phi[static_cast<std::size_t>(2 + joint + d)]; };
  const JointProfile profile{at_joint(inwards), at_joint(0), at_joint(-inwards)};
  if (!profile.ends()) return kInside * cell_;
  x[axis] += (joint - inwards * profile.reach()) * cell_;
  return dot(minus(x, face), m.normal);
}

}  // namespace krater
