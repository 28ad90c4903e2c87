// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mesh/mesh_contact.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace krater {

namespace {

constexpr std::size_t kRecord = 8, kMass = 3, kVelocity = 4, kHeat = 7, kChange = 4;
constexpr int kPasses = 3;
constexpr double kAway = -0.5;      // N . n of what looks away
constexpr double kTakenBack = 0.1;  // share of an overlap, per step
constexpr double kNoFaster = 0.05;  // than this share of the approach, or ...
constexpr double kCreep = 5e-4;     // ... cells per step
constexpr double kNoNormal = 1e-6;  // of the longest that there could be
constexpr double kReach = 3;        // cells: bodies further apart cannot meet in a step

double dot(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
void add_to(Triple& sum, double k, const Triple& x) {
  for (std::size_t a = 0; a < 3; ++a) sum[a] += k * x[a];
}
Triple minus(const Triple& a, const Triple& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Triple place_of(const MeshNodes& nodes, std::int32_t n) {
  const double* x = nodes.records + kRecord * static_cast<std::size_t>(n);
  return {x[0], x[1], x[2]};
}

struct Bounds {
  Triple low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  void hold(const Triple& x) {
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], x[a]);
      high[a] = std::max(high[a], x[a]);
    }
  }
  bool meets(const Bounds& other, double within) const {
    for (std::size_t a = 0; a < 3; ++a)
      if (low[a] > other.high[a] + within || other.low[a] > high[a] + within) return false;
    return true;
  }
};

/// Bilinear functions of a face's corners, or linear ones of an edge's, at a point of [0, 1]^2.
std::array<double, 4> functions_at(std::size_t corners, double s, double t) {
  if (corners == 2) return {1 - s, s, 0, 0};
  return {(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
}

}  // namespace

void MeshContact::push(const std::vector<MeshNodes>& bodies, double dt) {
  carriers_.clear();
  meetings_.clear();
  touched_.clear();
  given_.clear();
  friction_ = pairs_ = 0;
  find_carriers(bodies);
  if (carriers_.empty()) return;
  share_masses(bodies);
  number_nodes();
  find_meetings();
  if (meetings_.empty()) return;
  weigh();
  list_touched(bodies);
  note_changes(bodies, -1);  // dv with contact less dv without it
  for (int k = 0; k < kPasses; ++k) pass(bodies, dt);
  note_changes(bodies, 1);
  for (const Meeting& m : meetings_) {
    if (m.impulse == Triple{}) continue;
    pairs_ += 1;
    add_impulse(given_, own_field(bodies[m.side[0].body].body),
                {Partner::Kind::body, bodies[m.side[1].body].body}, m.impulse);
  }
}

/// Samples of the faces that another body may touch.
void MeshContact::find_carriers(const std::vector<MeshNodes>& bodies) {
  std::vector<Bounds> bounds(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (const auto& face : faces_[b])
      for (const std::int32_t n : face)
        if (n >= 0) bounds[b].hold(place_of(bodies[b], n));
  const double within = kReach * cell_;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const bool alone = [&] {
      for (std::size_t o = 0; o < bodies.size(); ++o)
        if (o != b && bounds[b].meets(bounds[o], within)) return false;
      return true;
    }();
    if (alone) continue;
    for (const auto& face : faces_[b]) {
      Bounds of_face;
      for (const std::int32_t n : face)
        if (n >= 0) of_face.hold(place_of(bodies[b], n));
      for (std::size_t o = 0; o < bodies.size(); ++o)
        if (o != b && of_face.meets(bounds[o], within)) {
          sample(bodies[b], b, face);
          break;
        }
    }
  }
}

/// Carriers of one face, no further apart than a cell.
void MeshContact::sample(const MeshNodes& nodes, std::size_t body, const Face& face) {
  const std::size_t corners = face[2] < 0 ? 2 : 4;
  std::array<Triple, 4> x{};
  for (std::size_t I = 0; I < corners; ++I) x[I] = place_of(nodes, face[I]);
  const auto count = [&](const Triple& along, const Triple& beside) {
    const double length = std::sqrt(std::max(dot(along, along), dot(beside, beside)));
    return std::clamp(static_cast<int>(std::ceil(length / cell_)), 1, 64);
  };
  const int ns = count(minus(x[1], x[0]), corners == 2 ? Triple{} : minus(x[2], x[3]));
  const int nt = corners == 2 ? 1 : count(minus(x[3], x[0]), minus(x[2], x[1]));
  for (int i = 0; i < ns; ++i)
    for (int j = 0; j < nt; ++j) {
      const double s = (i + 0.5) / ns, t = (j + 0.5) / nt;
      Carrier q{};
      q.body = body;
      q.nodes = face;
      q.corners = corners;
      q.share = functions_at(corners, s, t);
      Triple by_s{}, by_t{};
      for (std::size_t I = 0; I < corners; ++I) add_to(q.x, q.share[I], x[I]);
      if (corners == 2) {  // outwards is to the right of an edge
        const Triple along = minus(x[1], x[0]);
        const double round = frame_ == Frame::axisymmetric ? 2 * std::numbers::pi * q.x[0] : 1.0;
        q.area = {round * along[1] / ns, -round * along[0] / ns, 0};
      } else {
        add_to(by_s, 1 - t, minus(x[1], x[0]));
        add_to(by_s, t, minus(x[2], x[3]));
        add_to(by_t, 1 - s, minus(x[3], x[0]));
        add_to(by_t, s, minus(x[2], x[1]));
        add_to(q.area, 1.0 / (ns * nt), cross(by_s, by_t));
      }
      for (int a = 0; a < dim_; ++a) {
        const auto k = static_cast<std::size_t>(a);
        const double u = q.x[k] / cell_, base = std::floor(u - 0.5), f = u - base;
        q.base[k] = static_cast<std::int64_t>(base);
        q.weight[k] = {0.5 * (1.5 - f) * (1.5 - f), 0.75 - (f - 1) * (f - 1),
                       0.5 * (f - 0.5) * (f - 0.5)};
      }
      carriers_.push_back(q);
    }
}

/// N_I -> m_qI.
void MeshContact::share_masses(const std::vector<MeshNodes>& bodies) {
  std::vector<std::vector<double>> whole;
  for (const MeshNodes& b : bodies) whole.emplace_back(b.count, 0.0);
  for (const Carrier& q : carriers_)
    for (std::size_t I = 0; I < q.corners; ++I)
      whole[q.body][static_cast<std::size_t>(q.nodes[I])] +=
          q.share[I] * std::sqrt(dot(q.area, q.area));
  for (Carrier& q : carriers_)
    for (std::size_t I = 0; I < q.corners; ++I) {
      const auto n = static_cast<std::size_t>(q.nodes[I]);
      const double all = whole[q.body][n];
      const double part = all > 0 ? q.share[I] * std::sqrt(dot(q.area, q.area)) / all : 0.0;
      q.share[I] = bodies[q.body].records[kRecord * n + kMass] * part;
    }
}

/// The nodes of the grid that carriers reach, in order of their places.
void MeshContact::number_nodes() {
  using Key = std::array<std::int64_t, 3>;
  std::vector<Key> keys;
  const auto visit_keys = [&](const Carrier& q, const auto& visit) {
    for (std::size_t i = 0; i < kSupport; ++i)
      for (std::size_t j = 0; j < kSupport; ++j)
        for (std::size_t k = 0; k < (dim_ == 3 ? kSupport : 1); ++k)
          visit(Key{q.base[0] + static_cast<std::int64_t>(i),
                    q.base[1] + static_cast<std::int64_t>(j),
                    q.base[2] + static_cast<std::int64_t>(k)});
  };
  for (const Carrier& q : carriers_) visit_keys(q, [&](const Key& key) { keys.push_back(key); });
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  grid_nodes_ = keys.size();
  for (Carrier& q : carriers_) {
    std::size_t n = 0;
    visit_keys(q, [&](const Key& key) {
      q.at[n++] =
          static_cast<std::int32_t>(std::lower_bound(keys.begin(), keys.end(), key) - keys.begin());
    });
  }
}

namespace {

/// S of a carrier at the nodes it reaches, in their order.
template <class Carrier>
double weight_at(const Carrier& q, int dim, std::size_t n) {
  if (dim == 2) return q.weight[0][n / 3] * q.weight[1][n % 3];
  return q.weight[0][n / 9] * q.weight[1][n / 3 % 3] * q.weight[2][n % 3];
}

}  // namespace

void MeshContact::find_meetings() {
  const std::size_t bodies = faces_.size();
  present_.assign(grid_nodes_ * bodies, {});
  for (const Carrier& q : carriers_)
    for (std::size_t n = 0; n < reached(); ++n) {
      Presence& p = present_[static_cast<std::size_t>(q.at[n]) * bodies + q.body];
      const double S = weight_at(q, dim_, n);
      add_to(p.area, S, q.area);
      p.whole += S * std::sqrt(dot(q.area, q.area));
      p.here = true;
    }
  const auto looks = [](const Presence& p) {  // k^8 N/|N|
    const double length = std::sqrt(dot(p.area, p.area));
    Triple out{};
    if (length > 0 && p.whole > 0) add_to(out, std::pow(length / p.whole, 8) / length, p.area);
    return out;
  };
  first_meeting_.assign(grid_nodes_ + 1, 0);
  for (std::size_t node = 0; node < grid_nodes_; ++node) {
    first_meeting_[node] = static_cast<std::int32_t>(meetings_.size());
    for (std::size_t a = 0; a < bodies; ++a)
      for (std::size_t b = a + 1; b < bodies; ++b) {
        const Presence &A = present_[node * bodies + a], &B = present_[node * bodies + b];
        if (!A.here || !B.here) continue;
        Triple n = minus(looks(A), looks(B));
        const double length = std::sqrt(dot(n, n));
        if (!(length > kNoNormal)) continue;
        for (double& component : n) component /= length;
        Meeting m{};
        m.node = static_cast<std::int32_t>(node);
        m.side[0].body = a;
        m.side[1].body = b;
        m.normal = n;
        meetings_.push_back(m);
      }
  }
  first_meeting_[grid_nodes_] = static_cast<std::int32_t>(meetings_.size());
}

template <class Visit>
void MeshContact::for_each_meeting(const Carrier& q, const Visit& visit) {
  const double away = kAway * std::sqrt(dot(q.area, q.area));
  for (std::size_t n = 0; n < reached(); ++n) {
    const auto node = static_cast<std::size_t>(q.at[n]);
    for (std::int32_t k = first_meeting_[node]; k < first_meeting_[node + 1]; ++k) {
      Meeting& m = meetings_[static_cast<std::size_t>(k)];
      for (std::size_t s = 0; s < 2; ++s) {
        if (m.side[s].body != q.body) continue;
        const double across = (s == 0 ? 1 : -1) * dot(q.area, m.normal);
        if (across >= away) visit(m, m.side[s], weight_at(q, dim_, n), across);
      }
    }
  }
}

/// Masses and places of the sides, and their gaps.
void MeshContact::weigh() {
  for (const Carrier& q : carriers_) {
    double mass = 0;
    for (std::size_t I = 0; I < q.corners; ++I) mass += q.share[I];
    const double squared = dot(q.area, q.area);
    for_each_meeting(q, [&](Meeting&, Side& side, double S, double across) {
      side.mass += S * mass;
      const double look = across > 0 && squared > 0 ? across * across / squared : 0;
      side.weight += S * mass * look;
      add_to(side.place, S * mass * look, q.x);
    });
  }
  for (Meeting& m : meetings_) {
    m.gap = 0;
    for (std::size_t s = 0; s < 2; ++s) {
      if (!(m.side[s].weight > 0))
        m.side[s].mass = 0;  // nothing of it looks across
      else
        m.gap += (s == 0 ? -1 : 1) * dot(m.side[s].place, m.normal) / m.side[s].weight;
    }
  }
}

void MeshContact::list_touched(const std::vector<MeshNodes>& bodies) {
  std::vector<std::vector<bool>> seen;
  for (const MeshNodes& b : bodies) seen.emplace_back(b.count, false);
  for (const Carrier& q : carriers_)
    for (std::size_t I = 0; I < q.corners; ++I) {
      const auto n = static_cast<std::size_t>(q.nodes[I]);
      if (!seen[q.body][n]) touched_.push_back({q.body, q.nodes[I], {}});
      seen[q.body][n] = true;
    }
}

void MeshContact::note_changes(const std::vector<MeshNodes>& bodies, double sign) {
  for (Touched& t : touched_) {
    const double* change = bodies[t.body].changes + kChange * static_cast<std::size_t>(t.node);
    add_to(t.by_contact, sign, {change[0], change[1], change[2]});
  }
}

void MeshContact::exchange(Meeting& m, double mu, double dt) {
  Side &A = m.side[0], &B = m.side[1];
  A.change = B.change = {};
  if (!(A.mass > 0) || !(B.mass > 0)) return;
  Triple slip{};
  add_to(slip, 1 / A.mass, A.momentum);
  add_to(slip, -1 / B.mass, B.momentum);
  const double closing = dot(slip, m.normal);
  double allowed = m.gap / dt;
  if (m.gap < 0)
    allowed = -std::min(-kTakenBack * allowed,
                        std::max(kNoFaster * std::abs(closing), kCreep * cell_ / dt));
  if (!(closing > allowed)) return;
  const double reduced = A.mass * B.mass / (A.mass + B.mass), stop = closing - allowed;
  add_to(slip, -closing, m.normal);
  const double speed = std::sqrt(dot(slip, slip));
  const double held = speed > 0 ? std::min(mu * stop / speed, 1.0) : 0.0;
  Triple impulse{};
  add_to(impulse, -reduced * stop, m.normal);
  add_to(impulse, -reduced * held, slip);
  friction_ -= reduced * speed * speed * held * (1 - 0.5 * held);
  add_to(A.change, 1 / A.mass, impulse);
  add_to(B.change, -1 / B.mass, impulse);
  add_to(m.impulse, 1, impulse);
}

double MeshContact::friction_between(const std::vector<MeshNodes>& bodies, const Meeting& m) const {
  return options_.friction_of(bodies[m.side[0].body].body, bodies[m.side[1].body].body);
}

/// Momenta to the grid, exchange, and back.
void MeshContact::pass(const std::vector<MeshNodes>& bodies, double dt) {
  for (Meeting& m : meetings_) m.side[0].momentum = m.side[1].momentum = {};
  for (const Carrier& q : carriers_) {
    Triple p{};
    for (std::size_t I = 0; I < q.corners; ++I) {
      const auto n = static_cast<std::size_t>(q.nodes[I]);
      const double *v = bodies[q.body].records + kRecord * n + kVelocity,
                   *change = bodies[q.body].changes + kChange * n;
      for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a)
        p[a] += q.share[I] * (v[a] + change[a]);
    }
    for_each_meeting(q,
                     [&](Meeting&, Side& side, double S, double) { add_to(side.momentum, S, p); });
  }
  for (Meeting& m : meetings_) exchange(m, friction_between(bodies, m), dt);
  for (const Carrier& q : carriers_) {
    Triple dv{};
    for_each_meeting(
        q, [&](Meeting&, const Side& side, double S, double) { add_to(dv, S, side.change); });
    for (std::size_t I = 0; I < q.corners; ++I) {
      const auto n = static_cast<std::size_t>(q.nodes[I]);
      const double part = q.share[I] / bodies[q.body].records[kRecord * n + kMass];
      double* change = bodies[q.body].changes + kChange * n;
      for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a) change[a] += part * dv[a];
    }
  }
}

MeshContactWork MeshContact::book(const std::vector<MeshNodes>& bodies) {
  double taken = 0, pushed = 0;
  std::vector<double> squares;
  for (const Touched& t : touched_) {
    const auto n = static_cast<std::size_t>(t.node);
    const double *record = bodies[t.body].records + kRecord * n,
                 *change = bodies[t.body].changes + kChange * n;
    double work = 0, square = 0;
    for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a) {
      const double dv = t.by_contact[a];
      work += dv * (record[kVelocity + a] + 0.5 * change[a]);
      square += dv * dv;
    }
    taken -= record[kMass] * work;
    pushed += record[kMass] * square;
    squares.push_back(square);
  }
  if (pushed > 0)
    for (std::size_t k = 0; k < touched_.size(); ++k) {
      const auto n = static_cast<std::size_t>(touched_[k].node);
      bodies[touched_[k].body].records[kRecord * n + kHeat] += taken / pushed * squares[k];
    }
  return {pushed > 0 ? taken : 0.0, friction_, pairs_};
}

}  // namespace krater
