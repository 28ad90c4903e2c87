// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/geometry/lighting.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace krater {

namespace {

using Spot = Lighting::Spot;

constexpr double kNever = std::numeric_limits<double>::infinity();

double distance(const Spot& a, const Spot& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}
Spot along(const Spot& a, const Spot& direction, double s) {
  return {a[0] + s * direction[0], a[1] + s * direction[1], a[2] + s * direction[2]};
}

}  // namespace

Spot Detonator::nearest(const Spot& x) const {
  const Spot from_a = along(x, a, -1.0);
  switch (kind) {
    case Kind::point:
      break;
    case Kind::line: {
      const Spot line = along(b, a, -1.0);
      const double length2 = dot(line, line);
      return along(a, line, length2 > 0 ? std::clamp(dot(from_a, line) / length2, 0.0, 1.0) : 0.0);
    }
    case Kind::plane:
      return along(x, b, -dot(from_a, b));
  }
  return a;
}

Lighting::Lighting(Frame frame, const Box& domain, double spacing,
                   std::vector<Explosive> explosives, std::vector<Detonator> detonators)
    : frame_{frame},
      dimension_{dimension(frame)},
      spacing_{spacing},
      explosives_{std::move(explosives)},
      detonators_{std::move(detonators)} {
  mark_explosives(domain);
  light_sources();
  spread();
}

Spot Lighting::place(int n) const {
  const std::array<int, 3> i = index(n);
  Spot x{};
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension_); ++a)
    x[a] = origin_[a] + i[a] * spacing_;
  return x;
}
std::array<int, 3> Lighting::index(int n) const {
  return {n / (count_[1] * count_[2]), n / count_[2] % count_[1], n % count_[2]};
}
int Lighting::node_at(const std::array<int, 3>& i) const {
  for (std::size_t a = 0; a < 3; ++a)
    if (i[a] < 0 || i[a] >= count_[a]) return -1;
  return (i[0] * count_[1] + i[1]) * count_[2] + i[2];
}

template <class Visit>
void Lighting::around(const std::array<int, 3>& c, int reach, const Visit& visit) const {
  const int last = dimension_ == 3 ? reach : 0;
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j)
      for (int k = -last; k <= last; ++k) {
        const int n = node_at({c[0] + i, c[1] + j, c[2] + k});
        if (n >= 0 && owner_[static_cast<std::size_t>(n)] >= 0) visit(n);
      }
}

/// Nodes in the middle of cells of the spacing, over the boxes of the explosives.
void Lighting::mark_explosives(const Box& domain) {
  Box all{{kNever, kNever, kNever}, {-kNever, -kNever, -kNever}};
  for (const Explosive& e : explosives_) {
    const Box box = intersection(e.solid->extent(frame_), domain, dimension_);
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension_); ++a) {
      all.min[a] = std::min(all.min[a], box.min[a]);
      all.max[a] = std::max(all.max[a], box.max[a]);
    }
  }
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension_); ++a) {
    count_[a] = std::max(1, static_cast<int>(std::ceil((all.max[a] - all.min[a]) / spacing_)));
    origin_[a] = 0.5 * (all.min[a] + all.max[a] - (count_[a] - 1) * spacing_);
  }
  owner_.assign(static_cast<std::size_t>(count_[0] * count_[1] * count_[2]), -1);
  const auto last = static_cast<std::size_t>(dimension_ - 1);
  Spans spans;
  for (int n = 0; n < static_cast<int>(owner_.size()); n += count_[last])
    for (std::size_t e = 0; e < explosives_.size(); ++e) {
      explosives_[e].solid->spans(
          along_axis(to_space(frame_, place(n)), tensor_axis(frame_, dimension_ - 1)), spans);
      for (int k = 0; k < count_[last]; ++k) {
        const double z = origin_[last] + k * spacing_;
        if (std::any_of(spans.begin(), spans.end(),
                        [z](const Span& s) { return s.low <= z && z <= s.high; }))
          owner_[static_cast<std::size_t>(n + k)] = static_cast<std::int8_t>(e);
      }
    }
  nodes_.assign(owner_.size(), {.time = kNever});
}

void Lighting::light_sources() {
  const double reach = spacing_ * std::sqrt(static_cast<double>(dimension_));
  for (std::size_t s = 0; s < detonators_.size(); ++s) {
    bool lights = false;
    for (int n = 0; n < static_cast<int>(nodes_.size()); ++n) {
      const auto i = static_cast<std::size_t>(n);
      if (owner_[i] < 0) continue;
      const Spot x = place(n), from = detonators_[s].nearest(x);
      if (distance(x, from) > reach) continue;
      lights = true;
      const double t = detonators_[s].time +
                       distance(x, from) / explosives_[static_cast<std::size_t>(owner_[i])].speed;
      if (t >= nodes_[i].time) continue;
      nodes_[i] = {t, from, detonators_[s].time, static_cast<int>(s), true, false};
      queue_.emplace_back(t, n);
    }
    if (!lights) idle_.push_back(static_cast<int>(s));
  }
  std::make_heap(queue_.begin(), queue_.end(), std::greater<>{});
}

void Lighting::spread() {
  const auto later = std::greater<>{};
  while (!queue_.empty()) {
    std::pop_heap(queue_.begin(), queue_.end(), later);
    const auto [t, n] = queue_.back();
    queue_.pop_back();
    Node& node = nodes_[static_cast<std::size_t>(n)];
    if (node.closed || t > node.time) continue;
    if (!node.seen && !confirm(n)) continue;
    node.closed = true;
    around(index(n), 1, [&, n = n](int m) { offer(n, m); });
  }
}

Lighting::Start Lighting::start_of(const Node& node, const Spot& x) const {
  if (node.source < 0) return {node.from, node.from_time};
  return {detonators_[static_cast<std::size_t>(node.source)].nearest(x), node.from_time};
}

/// A path from a closed node to a neighbour, straight from where the node's own began; whether it
/// is in sight is asked when its turn comes.
void Lighting::offer(int from, int to) {
  const Node& node = nodes_[static_cast<std::size_t>(from)];
  Node& next = nodes_[static_cast<std::size_t>(to)];
  if (next.closed) return;
  const auto mine = owner_[static_cast<std::size_t>(from)],
             its = owner_[static_cast<std::size_t>(to)];
  const Spot x = place(to);
  const double speed = explosives_[static_cast<std::size_t>(its)].speed;
  Node path{.time = kNever};
  if (mine == its) {
    const Start start = start_of(node, x);
    path = {start.time + distance(start.from, x) / speed, start.from, start.time, node.source};
  } else {
    const double own = explosives_[static_cast<std::size_t>(mine)].speed;
    const Spot at = place(from);
    const double t = node.time + 0.5 * distance(at, x) * (1 / own + 1 / speed);
    path = {t, x, t, -1, true, false};  // its straight part begins here
  }
  if (path.time >= next.time) return;
  next = path;
  queue_.emplace_back(next.time, to);
  std::push_heap(queue_.begin(), queue_.end(), std::greater<>{});
}

bool Lighting::confirm(int n) {
  Node& node = nodes_[static_cast<std::size_t>(n)];
  const int mine = owner_[static_cast<std::size_t>(n)];
  const Spot x = place(n);
  if (sees(mine, node.from, x)) return node.seen = true;
  const double speed = explosives_[static_cast<std::size_t>(mine)].speed;
  Node best{.time = kNever};
  around(index(n), 1, [&](int m) {
    const Node& other = nodes_[static_cast<std::size_t>(m)];
    if (!other.closed || owner_[static_cast<std::size_t>(m)] != mine) return;
    const Spot at = place(m);
    const double step = other.time + distance(at, x) / speed;
    if (step < best.time) best = {step, at, other.time, -1, true, false};
    const Start start = start_of(other, x);
    const double straight = start.time + distance(start.from, x) / speed;
    if (straight < best.time && sees(mine, start.from, x))
      best = {straight, start.from, start.time, other.source, true, false};
  });
  node = best;
  if (best.time == kNever) return false;
  queue_.emplace_back(best.time, n);
  std::push_heap(queue_.begin(), queue_.end(), std::greater<>{});
  return false;
}

/// A node of the explosive is among the corners of the lattice's cell about x.
bool Lighting::near_explosive(int explosive, const Spot& x) const {
  std::array<int, 3> low{};
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension_); ++a)
    low[a] = static_cast<int>(std::floor((x[a] - origin_[a]) / spacing_));
  for (int corner = 0; corner < (1 << dimension_); ++corner) {
    std::array<int, 3> i = low;
    for (int a = 0; a < dimension_; ++a) i[static_cast<std::size_t>(a)] += corner >> a & 1;
    const int n = node_at(i);
    if (n >= 0 && owner_[static_cast<std::size_t>(n)] == explosive) return true;
  }
  return false;
}

bool Lighting::sees(int explosive, const Spot& a, const Spot& b) const {
  const double length = distance(a, b);
  const int samples = static_cast<int>(2 * length / spacing_);
  const Spot way = along(b, a, -1.0);
  for (int i = 1; i <= samples; ++i)
    if (!near_explosive(explosive, along(a, way, static_cast<double>(i) / (samples + 1))))
      return false;
  return true;
}

double Lighting::at(int explosive, const Spot& x) const {
  std::array<int, 3> centre{};
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension_); ++a)
    centre[a] = static_cast<int>(std::lround((x[a] - origin_[a]) / spacing_));
  const double speed = explosives_[static_cast<std::size_t>(explosive)].speed;
  double best = kNever;
  for (int reach = 1; reach <= 2 && best == kNever; ++reach)
    around(centre, reach, [&](int n) {
      const Node& node = nodes_[static_cast<std::size_t>(n)];
      if (!node.closed || owner_[static_cast<std::size_t>(n)] != explosive) return;
      best = std::min(best, node.time + distance(place(n), x) / speed);
      const Start start = start_of(node, x);
      const double straight = start.time + distance(start.from, x) / speed;
      if (straight < best && sees(explosive, start.from, x)) best = straight;
    });
  return best;
}

}  // namespace krater
