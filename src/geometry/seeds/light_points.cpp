// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/seeds/light_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <unordered_map>

#include "geometry/seeds/lattice_cells.hpp"

namespace krater {
namespace {

/// Of the fullness of the body's typical point.
constexpr double light_share = 0.25;
/// Lighter than this it is a trace of the lines that sampled its cell, as along a needle's axis: it
/// finds a taker anywhere in the body.
constexpr double trace_share = 0.01;
/// Masses and distances as near as this are equal: mirror images differ by round-off.
constexpr double equal = 1e-6;

/// Area (2D) or volume (3D) of a point, whatever its r.
double content(const SeedPoint& p, Frame frame) {
  return frame == Frame::axisymmetric ? p.measure / (2 * std::numbers::pi * p.x[0]) : p.measure;
}

double square_of_distance(const SeedPoint& a, const SeedPoint& b) {
  const Vector3 d = minus(a.x, b.x);
  return dot(d, d);
}

/// Half of the body's measure lies in points at least so full.
double typical_fullness(const std::vector<SeedPoint>& points, const std::vector<double>& full) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return full[a] < full[b]; });
  double all = 0, sum = 0;
  for (const SeedPoint& p : points) all += p.measure;
  for (const std::size_t n : order) {
    sum += points[n].measure;
    if (sum >= 0.5 * all) return std::min(full[n], 1.0);
  }
  return 1;
}

/// Bins about the light points only: a body of 1e7 points has a few of them.
class Neighbourhood {
 public:
  Neighbourhood(const std::vector<SeedPoint>& points, const std::vector<std::size_t>& light,
                double reach)
      : reach_{reach} {
    for (const std::size_t n : light) {
      for_bins(points[n], [&](std::uint64_t key) { bins_.try_emplace(key); });
    }
    for (std::size_t n = 0; n < points.size(); ++n) {
      const auto at = bins_.find(key(bin(points[n])));
      if (at != bins_.end()) at->second.push_back(n);
    }
  }

  template <class Visit>
  void for_near(const SeedPoint& p, Visit&& visit) const {
    for_bins(p, [&](std::uint64_t key) {
      const auto at = bins_.find(key);
      if (at == bins_.end()) return;
      for (const std::size_t n : at->second) visit(n);
    });
  }

 private:
  using Bin = std::array<std::int64_t, 3>;
  Bin bin(const SeedPoint& p) const {
    Bin b{};
    for (std::size_t a = 0; a < 3; ++a) {
      b[a] = static_cast<std::int64_t>(std::floor(p.x[a] / reach_));
    }
    return b;
  }
  /// Bins that share a key cost time, nothing else: distances decide.
  static std::uint64_t key(const Bin& b) {
    std::uint64_t k = 0;
    for (const std::int64_t i : b) k = (k << 21) ^ (static_cast<std::uint64_t>(i) & 0x1fffff);
    return k;
  }
  template <class Visit>
  void for_bins(const SeedPoint& p, Visit&& visit) const {
    const Bin b = bin(p);
    for (std::int64_t i = b[0] - 1; i <= b[0] + 1; ++i) {
      for (std::int64_t j = b[1] - 1; j <= b[1] + 1; ++j) {
        for (std::int64_t k = b[2] - 1; k <= b[2] + 1; ++k) visit(key({i, j, k}));
      }
    }
  }

  double reach_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> bins_;
};

struct Gift {
  std::size_t from, to;
  double share;
};

class Giver {
 public:
  Giver(std::vector<SeedPoint>& points, std::vector<double>& full, const Solid& solid, Frame frame,
        double reach)
      : points_{points}, full_{full}, solid_{solid}, frame_{frame}, reach_{reach} {}

  std::size_t run() {
    typical_ = typical_fullness(points_, full_);
    const double limit = light_share * typical_;
    std::vector<std::size_t> light;
    for (std::size_t n = 0; n < points_.size(); ++n) {
      if (full_[n] < limit) light.push_back(n);
    }
    if (light.empty()) return 0;
    const std::vector<double> before = full_;
    std::stable_sort(light.begin(), light.end(),
                     [&](std::size_t a, std::size_t b) { return before[a] < before[b]; });
    const Neighbourhood near(points_, light, reach_);
    gone_.assign(points_.size(), false);
    for (std::size_t n = 0; n < light.size();) {
      std::vector<Gift> gifts;  // of points equally light: decided before any is made
      for (const double same = before[light[n]] * (1 + equal);
           n < light.size() && before[light[n]] <= same; ++n) {
        if (full_[light[n]] < limit) choose(light[n], near, gifts);  // it may have taken by now
      }
      for (const Gift& gift : gifts) gone_[gift.from] = true;
      for (const Gift& gift : gifts) give(gift);
    }
    return remove_gone();
  }

 private:
  void choose(std::size_t from, const Neighbourhood& near, std::vector<Gift>& gifts) const {
    const SeedPoint& p = points_[from];
    if (give_to_nearest(from, reach_, gifts, [&](auto visit) { near.for_near(p, visit); })) return;
    if (full_[from] >= trace_share * typical_) return;
    give_to_nearest(from, std::numeric_limits<double>::infinity(), gifts, [&](auto visit) {
      for (std::size_t n = 0; n < points_.size(); ++n) visit(n);
    });
  }

  /// Of the heavier points that `for_each` visits, within `reach`; equally near ones share.
  template <class ForEach>
  bool give_to_nearest(std::size_t from, double reach, std::vector<Gift>& gifts,
                       const ForEach& for_each) const {
    const SeedPoint& p = points_[from];
    const auto takes = [&](std::size_t n) {
      return !gone_[n] && points_[n].measure > p.measure * (1 + equal);
    };
    double least = reach * reach;
    for_each([&](std::size_t n) {
      if (takes(n)) least = std::min(least, square_of_distance(points_[n], p));
    });
    const std::size_t first = gifts.size();
    for_each([&](std::size_t n) {
      const double d = square_of_distance(points_[n], p);
      if (takes(n) && d < reach * reach && d <= least * (1 + equal)) gifts.push_back({from, n, 0});
    });
    for (std::size_t g = first; g < gifts.size(); ++g) {
      gifts[g].share = 1.0 / static_cast<double>(gifts.size() - first);
    }
    return gifts.size() > first;
  }

  void give(const Gift& gift) {
    const SeedPoint& from = points_[gift.from];
    SeedPoint& to = points_[gift.to];
    const double had = content(to, frame_), added = gift.share * content(from, frame_);
    SeedPoint taker = to;
    taker.measure = to.measure + gift.share * from.measure;
    const Vector3 way = minus(from.x, to.x);
    taker.x = plus(to.x, gift.share * from.measure / taker.measure, way);
    if (frame_ == Frame::axisymmetric) {
      taker.x[0] = taker.measure / (2 * std::numbers::pi * (had + added));
    }
    std::size_t along = 0;
    for (std::size_t a = 1; a < 3; ++a) {
      if (std::abs(way[a]) > std::abs(way[along])) along = a;
    }
    taker.half_width[along] *= 1 + added / had;
    if (!solid_.contains(frame_, taker.x)) taker.x = to.x;
    full_[gift.to] *= taker.measure / to.measure;
    to = taker;
  }

  std::size_t remove_gone() {
    std::size_t kept = 0;
    for (std::size_t n = 0; n < points_.size(); ++n) {
      if (!gone_[n]) points_[kept++] = points_[n];
    }
    const std::size_t given = points_.size() - kept;
    points_.resize(kept);
    return given;
  }

  std::vector<SeedPoint>& points_;
  std::vector<double>& full_;
  const Solid& solid_;
  Frame frame_;
  double reach_, typical_ = 1;
  std::vector<bool> gone_;
};

}  // namespace

double widest_spacing(const LatticeOptions& options, Frame frame) {
  const std::array<double, 3> s = lattice_spacing(options);
  return *std::max_element(s.begin(), s.begin() + dimension(frame));
}

double fullness(const SeedPoint& point, Frame frame, const LatticeOptions& options) {
  const std::array<double, 3> s = lattice_spacing(options);
  if (frame == Frame::cartesian_3d) return point.measure / (s[0] * s[1] * s[2]);
  const double r = std::max(point.x[0], 0.5 * s[0]);
  const double depth = frame == Frame::axisymmetric ? 2 * std::numbers::pi * r : 1.0;
  return point.measure / (depth * s[0] * s[1]);
}

std::size_t give_light_points(std::vector<SeedPoint>& points, std::vector<double> full,
                              const Solid& solid, Frame frame, double reach) {
  return Giver(points, full, solid, frame, reach).run();
}

}  // namespace krater
