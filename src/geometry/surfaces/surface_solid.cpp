// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "krater/geometry/surfaces/surface.hpp"

namespace krater {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Facet = std::array<std::uint32_t, 3>;

/// A point seen along an axis.
struct Foot {
  double u, v;
};

Foot foot(const Vector3& x, std::size_t axis) { return {x[(axis + 1) % 3], x[(axis + 2) % 3]}; }

/// Side of the line a -> b on which p lies once it is moved by (e, e^2), e -> 0: never 0 but for a
/// == b.
int side(const Foot& a, const Foot& b, const Foot& p) {
  const auto exact = CGAL::orientation(Kernel::Point_2(a.u, a.v), Kernel::Point_2(b.u, b.v),
                                       Kernel::Point_2(p.u, p.v));
  if (exact != CGAL::COLLINEAR) return exact == CGAL::LEFT_TURN ? 1 : -1;
  if (a.v != b.v) return a.v > b.v ? 1 : -1;
  if (a.u != b.u) return b.u > a.u ? 1 : -1;
  return 0;
}

/// Facets by the squares of a plane lattice that their projections touch.
class Bins {
 public:
  Bins(const Triangles& t, std::size_t axis, const Box& box) {
    const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
    low_ = {box.min[a], box.min[b]};
    const double du = std::max(box.max[a] - box.min[a], 1e-300);
    const double dv = std::max(box.max[b] - box.min[b], 1e-300);
    const double edge = std::sqrt(du * dv / static_cast<double>(t.facets.size()));
    nu_ = count(du, edge);
    nv_ = count(dv, edge);
    scale_ = {static_cast<double>(nu_) / du, static_cast<double>(nv_) / dv};
    start_.assign(nu_ * nv_ + 1, 0);
    // Twice over the facets: to count, to store.
    for (const Facet& f : t.facets) {
      visit(t, f, axis, [this](std::size_t bin) { ++start_[bin + 1]; });
    }
    for (std::size_t n = 1; n < start_.size(); ++n) start_[n] += start_[n - 1];
    facets_.resize(start_.back());
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    for (std::size_t n = 0; n < t.facets.size(); ++n) {
      visit(t, t.facets[n], axis,
            [&](std::size_t bin) { facets_[next[bin]++] = static_cast<std::uint32_t>(n); });
    }
  }

  /// Facets that may lie over a foot.
  std::pair<const std::uint32_t*, const std::uint32_t*> over(const Foot& p) const {
    const double u = (p.u - low_[0]) * scale_[0], v = (p.v - low_[1]) * scale_[1];
    if (!(u >= -0.5) || !(v >= -0.5) || u > static_cast<double>(nu_) + 0.5 ||
        v > static_cast<double>(nv_) + 0.5) {
      return {nullptr, nullptr};
    }
    const std::size_t bin = index(u, nu_) * nv_ + index(v, nv_);
    return {facets_.data() + start_[bin], facets_.data() + start_[bin + 1]};
  }

 private:
  static std::size_t count(double length, double edge) {
    return static_cast<std::size_t>(std::clamp(std::ceil(length / edge), 1.0, 8192.0));
  }
  static std::size_t index(double x, std::size_t n) {
    return std::min(static_cast<std::size_t>(std::max(x, 0.0)), n - 1);
  }

  template <class Visit>
  void visit(const Triangles& t, const Facet& f, std::size_t axis, Visit&& visitor) const {
    Foot lo{1e300, 1e300}, hi{-1e300, -1e300};
    for (const std::uint32_t corner : f) {
      const Foot p = foot(t.vertices[corner], axis);
      lo = {std::min(lo.u, p.u), std::min(lo.v, p.v)};
      hi = {std::max(hi.u, p.u), std::max(hi.v, p.v)};
    }
    const std::size_t u1 = index((hi.u - low_[0]) * scale_[0], nu_);
    const std::size_t v1 = index((hi.v - low_[1]) * scale_[1], nv_);
    for (std::size_t u = index((lo.u - low_[0]) * scale_[0], nu_); u <= u1; ++u) {
      for (std::size_t v = index((lo.v - low_[1]) * scale_[1], nv_); v <= v1; ++v) {
        visitor(u * nv_ + v);
      }
    }
  }

  std::size_t nu_ = 1, nv_ = 1;
  std::array<double, 2> low_{}, scale_{};
  std::vector<std::uint32_t> start_, facets_;
};

class SurfaceSolid final : public Solid {
 public:
  explicit SurfaceSolid(Triangles triangles) : t_(std::move(triangles)) {
    constexpr double inf = std::numeric_limits<double>::infinity();
    box_ = {{inf, inf, inf}, {-inf, -inf, -inf}};
    for (const Vector3& x : t_.vertices) {
      for (std::size_t a = 0; a < 3; ++a) {
        box_.min[a] = std::min(box_.min[a], x[a]);
        box_.max[a] = std::max(box_.max[a], x[a]);
      }
    }
  }

  using Solid::contains;

  void spans(const Line& line, Spans& out) const override {
    out.clear();
    const std::size_t axis = axis_of(line);
    struct Crossing {
      double t;
      int step;  ///< +1 into the solid
    };
    thread_local std::vector<Crossing> crossings;
    crossings.clear();
    for_facets_over(foot(line.origin, axis), axis, [&](const Facet& f, int turn) {
      const double at = height(f, foot(line.origin, axis), axis);
      crossings.push_back({(at - line.origin[axis]) / line.direction[axis],
                           line.direction[axis] > 0 ? -turn : turn});
    });
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
      return a.t != b.t ? a.t < b.t : a.step > b.step;
    });
    int winding = 0;
    double low = 0;
    for (const Crossing& c : crossings) {
      const int before = winding;
      winding += c.step;
      if (before <= 0 && winding > 0) low = c.t;
      if (before > 0 && winding <= 0 && c.t > low) out.push_back({low, c.t});
    }
  }

  /// The winding number from the facets above the point; on a facet: in.
  bool contains(double x, double y, double z) const override {
    const Vector3 p{x, y, z};
    int winding = 0;
    bool on_facet = false;
    for_facets_over(foot(p, 2), 2, [&](const Facet& f, int turn) {
      const auto point = [](const Vector3& q) { return Kernel::Point_3(q[0], q[1], q[2]); };
      const auto s = CGAL::orientation(point(t_.vertices[f[0]]), point(t_.vertices[f[1]]),
                                       point(t_.vertices[f[2]]), point(p));
      if (s == CGAL::COPLANAR) on_facet = true;
      if (s == (turn > 0 ? CGAL::NEGATIVE : CGAL::POSITIVE)) winding += turn;
    });
    return on_facet || winding > 0;
  }

  Box bounding_box() const override { return box_; }

  double support(const Vector3& d) const override {
    double best = -std::numeric_limits<double>::infinity();
    for (const Vector3& x : t_.vertices) best = std::max(best, dot(d, x));
    return best;
  }

  std::optional<VolumeMoments> moments() const override {
    const Vector3 c{box_.middle(0), box_.middle(1), box_.middle(2)};
    VolumeMoments sum;
    for (const Facet& f : t_.facets) {
      sum += tetrahedron_moments(minus(t_.vertices[f[0]], c), minus(t_.vertices[f[1]], c),
                                 minus(t_.vertices[f[2]], c));
    }
    return sum.mapped(Affine::move(c));
  }

  void require(Frame frame) const override {
    if (frame == Frame::axisymmetric) {
      throw std::invalid_argument(
          "a surface of triangles is not a body of revolution (in the axisymmetric frame use "
          "revolution)");
    }
  }

  /// Lines stay along the axes: the vertices are moved instead.
  std::shared_ptr<const Solid> mapped(const Affine& map) const override {
    Triangles image = t_;
    for (Vector3& x : image.vertices) x = map.apply(x);
    if (map.determinant() < 0) {
      for (Facet& f : image.facets) std::swap(f[1], f[2]);
    }
    return std::make_shared<SurfaceSolid>(std::move(image));
  }

 private:
  static std::size_t axis_of(const Line& line) {
    std::size_t axis = 3;
    for (std::size_t a = 0; a < 3; ++a) {
      if (line.direction[a] != 0) axis = axis == 3 ? a : 4;
    }
    if (axis > 2) throw std::logic_error("a surface knows lines along the axes only");
    return axis;
  }

  /// Calls found(facet, turn) for every facet that the line over the foot meets; turn is +1 where
  /// the facet's projection is anticlockwise, its normal along the axis.
  template <class Found>
  void for_facets_over(const Foot& p, std::size_t axis, Found&& found) const {
    std::call_once(once_[axis], [&] { bins_[axis] = std::make_unique<Bins>(t_, axis, box_); });
    const auto [begin, end] = bins_[axis]->over(p);
    for (const std::uint32_t* n = begin; n != end; ++n) {
      const Facet& f = t_.facets[*n];
      const Foot a = foot(t_.vertices[f[0]], axis), b = foot(t_.vertices[f[1]], axis),
                 c = foot(t_.vertices[f[2]], axis);
      if (p.u < std::min({a.u, b.u, c.u}) || p.u > std::max({a.u, b.u, c.u}) ||
          p.v < std::min({a.v, b.v, c.v}) || p.v > std::max({a.v, b.v, c.v})) {
        continue;
      }
      const int turn = side(a, b, p);
      if (turn == 0 || side(b, c, p) != turn || side(c, a, p) != turn) continue;
      found(f, turn);
    }
  }

  double height(const Facet& f, const Foot& p, std::size_t axis) const {
    const auto area = [](const Foot& a, const Foot& b, const Foot& c) {
      return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
    };
    const Vector3 &x = t_.vertices[f[0]], &y = t_.vertices[f[1]], &z = t_.vertices[f[2]];
    const Foot a = foot(x, axis), b = foot(y, axis), c = foot(z, axis);
    const double wa = area(p, b, c), wb = area(p, c, a), wc = area(p, a, b);
    const double sum = wa + wb + wc;
    const double h = sum != 0 ? (wa * x[axis] + wb * y[axis] + wc * z[axis]) / sum
                              : (x[axis] + y[axis] + z[axis]) / 3;
    return std::clamp(h, std::min({x[axis], y[axis], z[axis]}),
                      std::max({x[axis], y[axis], z[axis]}));
  }

  Triangles t_;
  Box box_;
  mutable std::array<std::once_flag, 3> once_;
  mutable std::array<std::unique_ptr<Bins>, 3> bins_;
};

}  // namespace

std::shared_ptr<const Solid> make_surface_solid(Triangles triangles) {
  if (triangles.facets.empty()) throw std::invalid_argument("the surface has no facets");
  return std::make_shared<SurfaceSolid>(std::move(triangles));
}

}  // namespace krater
