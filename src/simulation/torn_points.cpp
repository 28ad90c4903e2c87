// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/simulation/torn_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "krater/kinematics/mpm/domain.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater {

namespace {

/// A point and how far it is stretched.
struct Stretched {
  Triple place{}, longest{};  ///< the longest axis of its domain [m]
  Triple reach{};             ///< 2R - h along the grid axes [m]
  double share = 0;           ///< the greatest of one over the other
};

class BodyLook {
 public:
  BodyLook(const Simulation& sim, int body)
      : sim_{sim},
        body_{*sim.bodies()[static_cast<std::size_t>(body)]},
        dimension_{dimension(sim.scene().frame)},
        hoop_{sim.scene().frame == Frame::axisymmetric},
        x_{body_.slot(field::Position::info)},
        domain_{body_.slot(field::Domain::info)},
        width_{body_.slot(field::HalfWidth::info)},
        failed_{body_.slot(field::Failed::info)} {}

  Stretched at(int set, int i) const {
    Stretched out;
    const auto value = [&](int slot) { return sim_.value(set, i, slot); };
    for (int a = 0; a < dimension_; ++a) out.place[index(a)] = value(x_ + a);
    if (failed_ >= 0 && value(failed_) != 0) return out;
    out.longest =
        longest_half(domain_tensor(dimension_, [&](int k) { return value(domain_ + k); }));
    const double h = sim_.geometry_of(set).h;
    for (int b = 0; b < dimension_; ++b) {
      out.longest[index(b)] *= 2;
      out.reach[index(b)] = reach(h, set, i, b);
      out.share = std::max(out.share, std::abs(out.longest[index(b)]) / out.reach[index(b)]);
    }
    return out;
  }

  /// The plane of a side that mirrors brings the point's own image within reach.
  bool meets_image(const Stretched& p, double side) const {
    for (int b = 0; b < dimension_; ++b) {
      const double along = side * p.longest[index(b)];
      const auto& sides = sim_.scene().grid.boundary[index(b)];
      const GridGeometry& g = sim_.geometry();
      const double low = p.place[index(b)] - g.min[index(b)], high = g.upper(b) - p.place[index(b)];
      const bool axis = hoop_ && b == 0;
      if (along < 0 && (sides[0].folds() || axis) && 2 * low < p.reach[index(b)]) return true;
      if (along > 0 && sides[1].folds() && 2 * high < p.reach[index(b)]) return true;
    }
    return false;
  }

 private:
  static std::size_t index(int a) { return static_cast<std::size_t>(a); }

  double reach(double h, int set, int i, int axis) const {
    switch (sim_.scene().method.shape) {
      case Shape::linear:
        return h;
      case Shape::gimp:
        return h + 2 * std::min(sim_.value(set, i, width_ + axis), 0.5 * h);
      case Shape::quadratic_bspline:
        break;
    }
    return 2 * h;
  }

  const Simulation& sim_;
  const Body& body_;
  int dimension_;
  bool hoop_;
  int x_, domain_, width_, failed_;
};

/// Points of a body by cells, to be found by place.
class Places {
 public:
  Places(std::vector<Triple> points, double cell, int dimension)
      : points_{std::move(points)}, cell_{cell}, dimension_{dimension} {
    for (std::size_t i = 0; i < points_.size(); ++i) cells_.push_back({cell_of(points_[i]), i});
    std::sort(cells_.begin(), cells_.end());
  }

  /// Some point q of them with `takes(q - p)`, in the cell of p and those around.
  template <class Takes>
  bool any_near(const Triple& p, const Takes& takes) const {
    const Cell home = cell_of(p);
    Cell cell = home;
    const int depth = dimension_ == 3 ? 1 : 0;
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        for (int k = -depth; k <= depth; ++k) {
          cell = {home[0] + i, home[1] + j, home[2] + k};
          auto at =
              std::lower_bound(cells_.begin(), cells_.end(), std::pair<Cell, std::size_t>{cell, 0});
          for (; at != cells_.end() && at->first == cell; ++at) {
            Triple d{};
            for (std::size_t a = 0; a < 3; ++a) d[a] = points_[at->second][a] - p[a];
            if (takes(d)) return true;
          }
        }
    return false;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell_of(const Triple& p) const {
    Cell out{};
    for (std::size_t a = 0; a < 3; ++a)
      out[a] = static_cast<std::int64_t>(std::floor(p[a] / cell_));
    return out;
  }

  std::vector<Triple> points_;
  double cell_;
  int dimension_;
  std::vector<std::pair<Cell, std::size_t>> cells_;
};

bool watched(const Simulation& sim, int body) {
  return sim.scene().method.numerical_fracture != NumericalFracture::ignore &&
         may_tear(*sim.bodies()[static_cast<std::size_t>(body)]);
}

bool is_torn(const BodyLook& look, const Places& places, const Stretched& p, int dimension) {
  double square = 0;
  for (const double d : p.longest) square += d * d;
  const double length = std::sqrt(square);
  const double beyond =
      0.25 * length * std::min(length, *std::max_element(p.reach.begin(), p.reach.end()));
  for (const double side : {-1.0, 1.0}) {
    const auto takes = [&](const Triple& d) {
      double along = 0;
      for (int b = 0; b < dimension; ++b) {
        const auto k = static_cast<std::size_t>(b);
        if (std::abs(d[k]) >= p.reach[k]) return false;
        along += side * d[k] * p.longest[k];
      }
      return along > beyond;
    };
    if (!look.meets_image(p, side) && !places.any_near(p.place, takes)) return true;
  }
  return false;
}

}  // namespace

bool may_tear(const Body& body) {
  return body.options().material_points() && !body.options().rigid() &&
         (body.material().strength || body.material().model);
}

FractureOfPoints fracture_of(const Simulation& sim, int body) {
  const std::vector<std::pair<int, int>> ids = sim.points_by_id(body);
  FractureOfPoints out{std::vector<double>(ids.size()), std::vector<bool>(ids.size())};
  if (!watched(sim, body)) return out;
  const BodyLook look{sim, body};
  std::vector<Stretched> points;
  std::vector<Triple> places;
  bool any = false;
  for (const auto& [set, i] : ids) {
    points.push_back(look.at(set, i));
    places.push_back(points.back().place);
    out.stretch[points.size() - 1] = points.back().share;
    any = any || points.back().share > 1;
  }
  if (!any) return out;
  const int dim = dimension(sim.scene().frame);
  const Places near{std::move(places), 2 * sim.geometry().h, dim};  // no reach is wider
  for (std::size_t k = 0; k < points.size(); ++k)
    out.torn[k] = points[k].share > 1 && is_torn(look, near, points[k], dim);
  return out;
}

TornPoints look_for_torn_points(const Simulation& sim) {
  TornPoints out;
  for (std::size_t b = 0; b < sim.bodies().size(); ++b) {
    const int body = static_cast<int>(b);
    out.torn_by_body.push_back(0);
    if (!watched(sim, body)) continue;
    const FractureOfPoints all = fracture_of(sim, body);
    const int mass = sim.bodies()[b]->slot(field::Mass::info);
    const std::vector<std::pair<int, int>> ids = sim.points_by_id(body);
    for (std::size_t k = 0; k < ids.size(); ++k) {
      out.greatest_stretch = std::max(out.greatest_stretch, all.stretch[k]);
      if (all.stretch[k] > 1) ++out.stretched;
      if (!all.torn[k]) continue;
      ++out.torn_by_body.back();
      ++out.torn;
      out.torn_mass += sim.value(ids[k].first, ids[k].second, mass);
    }
  }
  return out;
}

}  // namespace krater
