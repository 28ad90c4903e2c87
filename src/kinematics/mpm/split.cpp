// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mpm/split.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include <Eigen/LU>

#include "krater/kinematics/mpm/migrate.hpp"

namespace krater {

namespace {

constexpr double kTooLarge = 1.4;   ///< in spacings along each axis
constexpr double kMostGrown = 1.5;  ///< of the spacing, in spacings

/// A record of one point by the offsets of its columns.
double& entry(std::vector<double>& record, int offset, int k = 0) {
  return record[static_cast<std::size_t>(offset / kLanes + k)];
}

double entry(const std::vector<double>& record, int offset, int k = 0) {
  return record[static_cast<std::size_t>(offset / kLanes + k)];
}

double kinetic_of(const std::vector<double>& record, const PointColumns& c, double h, int dim) {
  double twice = 0;
  for (int a = 0; a < dim; ++a)
    twice += entry(record, c.velocity, a) * entry(record, c.velocity, a);
  for (int k = 0; c.affine >= 0 && k < dim * dim; ++k)
    twice += Support::moment * h * h * entry(record, c.affine, k) * entry(record, c.affine, k);
  return 0.5 * entry(record, c.mass) * twice;
}

/// Where the parts lie from the point's own place, in the undeformed body and now.
struct Offset {
  Triple before{}, now{};
};
using Offsets = std::vector<Offset>;

/// Columns of parts, counted across the last axis of the grid.
bool odd_column(int corner, int dim) {
  int count = 0;
  for (int a = 0; a + 1 < dim; ++a) count += corner_offset(corner, a);
  return count % 2 != 0;
}

Offsets rows(const Triple& step, int dim) {
  Offsets out(static_cast<std::size_t>(corner_count(dim)));
  for (int corner = 0; corner < corner_count(dim); ++corner)
    for (int a = 0; a < dim; ++a) {
      const auto i = static_cast<std::size_t>(a);
      out[static_cast<std::size_t>(corner)].before[i] =
          corner_offset(corner, a) != 0 ? step[i] : -step[i];
    }
  return out;
}

void stagger(Offsets& at, double by, int dim) {
  for (int corner = 0; corner < corner_count(dim); ++corner)
    at[static_cast<std::size_t>(corner)].before[static_cast<std::size_t>(dim - 1)] +=
        odd_column(corner, dim) ? by : -by;
}

/// F d_0, each component up to `most`.
void deform(Offsets& at, const std::vector<double>& record, const PointColumns& c, double most,
            int dim) {
  for (Offset& d : at) {
    d.now = d.before;
    if (c.deformation < 0) continue;
    for (int a = 0; a < dim; ++a) {
      double sum = 0;
      for (int b = 0; b < dim; ++b) {
        const int row = dim == 2 ? 2 * a : a, column = dim == 2 ? 2 * b : b;
        sum +=
            entry(record, c.deformation, 3 * row + column) * d.before[static_cast<std::size_t>(b)];
      }
      d.now[static_cast<std::size_t>(a)] = std::clamp(sum, -most, most);
    }
  }
}

/// No part beyond a side of the domain that the whole is inside of.
void keep_inside(Offsets& at, const std::vector<double>& record, const PointColumns& c,
                 const GridGeometry& g) {
  constexpr double kRoom = 0.9;
  for (int a = 0; a < g.dimension; ++a) {
    const auto k = static_cast<std::size_t>(a);
    const double x = entry(record, c.position, a);
    const double room = kRoom * std::max(0.0, std::min(x - g.min[k], g.upper(a) - x));
    double most = 0;
    for (const Offset& d : at) most = std::max(most, std::abs(d.now[k]));
    if (most > room)
      for (Offset& d : at) d.now[k] *= room / most;
  }
}

/// How a point is split.
struct Way {
  Triple step{};       ///< from it to its parts, along each axis
  double stagger = 0;  ///< of odd columns of parts, up from their rows [step]; even ones down
  bool moving = true;  ///< not at the start
};

/// The parts of one point: where they lie, and which share of it each of them is.
struct Parts {
  Offsets at;
  std::vector<double> share;
  Triple mean{};  ///< of the places

  void weigh(double r, bool hoop) {
    share.assign(at.size(), 1.0 / static_cast<double>(at.size()));
    if (hoop) {
      double sum = 0;
      for (std::size_t k = 0; k < at.size(); ++k) sum += share[k] = std::max(0.0, r + at[k].now[0]);
      for (double& w : share) w /= sum;
    }
    mean = {};
    for (std::size_t k = 0; k < at.size(); ++k)
      for (std::size_t a = 0; a < 3; ++a) mean[a] += share[k] * at[k].now[a];
  }
  double apart(std::size_t k, int axis) const {
    const auto a = static_cast<std::size_t>(axis);
    return at[k].now[a] - mean[a];
  }
};

Parts parts_of(const GridGeometry& g, const PointColumns& c, const PointSize& size, const Way& way,
               const std::vector<double>& record) {
  Parts out;
  out.at = rows(way.step, g.dimension);
  const auto last = static_cast<std::size_t>(g.dimension - 1);
  stagger(out.at, way.stagger * way.step[last], g.dimension);
  deform(out.at, record, c, g.h, g.dimension);
  keep_inside(out.at, record, c, g);
  out.weigh(entry(record, c.position), size.hoop);
  if (way.stagger == 0) return out;
  for (Offset& d : out.at) d.now[last] -= out.mean[last];  // about an axis odd columns are heavier
  out.mean[last] = 0;
  return out;
}

/// sum w [d_a (L d)_b - d_b (L d)_a], of the motion about the centre and per mass.
double turning(const Parts& parts, const std::vector<double>& record, const PointColumns& c,
               int dim, int a, int b) {
  double sum = 0;
  for (std::size_t k = 0; k < parts.at.size(); ++k)
    for (int j = 0; j < dim; ++j)
      sum += parts.share[k] * parts.apart(k, j) *
             (parts.apart(k, a) * entry(record, c.affine, dim * b + j) -
              parts.apart(k, b) * entry(record, c.affine, dim * a + j));
  return sum;
}

/// To the skew part of L: what the motion of the parts about their centre adds to the angular
/// momentum, beyond that of `plain` ones.
void keep_turning(const GridGeometry& g, const PointColumns& c, const Parts* plain,
                  const Parts& parts, const std::vector<double>& record, std::vector<double>& to) {
  const int dim = g.dimension;
  for (int a = 0; a < dim; ++a)
    for (int b = a + 1; b < dim; ++b) {
      const double before = plain != nullptr ? turning(*plain, record, c, dim, a, b) : 0,
                   change = before - turning(parts, record, c, dim, a, b);
      const double skew = change / (2 * Support::moment * g.h * g.h);
      entry(to, c.affine, dim * b + a) += skew;
      entry(to, c.affine, dim * a + b) -= skew;
    }
}

/// Points in the place of one; all else of them is `as_all`.
void make_parts(const PointColumns& c, PointSize& size, const Parts& parts, int dim,
                const std::vector<double>& as_all, const Arrival& whole,
                std::vector<Arrival>& out) {
  const std::vector<double>& record = whole.record;
  for (std::size_t k = 0; k < parts.at.size(); ++k) {
    if (!(parts.share[k] > 0)) continue;
    Arrival part = whole;
    part.record = as_all;
    for (int a = 0; a < dim; ++a) {
      const auto i = static_cast<std::size_t>(a);
      entry(part.record, c.position, a) += parts.at[k].now[i];
      if (c.reference >= 0) entry(part.record, c.reference, a) += parts.at[k].before[i];
      for (int b = 0; c.affine >= 0 && b < dim; ++b)
        entry(part.record, c.velocity, a) +=
            entry(record, c.affine, dim * a + b) * parts.apart(k, b);
    }
    entry(part.record, c.mass) *= parts.share[k];
    if (k > 0) entry(part.record, 0) = size.next_id++;
    out.push_back(std::move(part));
  }
}

/// 2^dim points in the place of one.
void split(const GridGeometry& g, const PointColumns& c, PointSize& size, const Way& way,
           const Arrival& whole, std::vector<Arrival>& out) {
  const std::vector<double>& record = whole.record;
  const Parts parts = parts_of(g, c, size, way, record);
  std::vector<double> as_all = record;
  if (way.stagger != 0 && way.moving && c.affine >= 0 && !size.hoop) {
    const Parts plain = parts_of(g, c, size, {way.step}, record);
    keep_turning(g, c, &plain, parts, record, as_all);
  }
  for (int k = 0; c.domain >= 0 && k < 6; ++k) entry(as_all, c.domain, k) *= 0.25;
  make_parts(c, size, parts, g.dimension, as_all, whole, out);
}

/// What the motion lost, to all parts alike.
void share_heat(double heat, double m, const PointColumns& c, std::span<Arrival> parts) {
  for (Arrival& part : parts)
    if (c.energy >= 0)  // rigid bodies have none
      entry(part.record, heat < 0 && c.carried >= 0 ? c.carried : c.energy) += heat / m;
}

/// d_0 = F^-1 d
void undeform(Offsets& at, const std::vector<double>& record, const PointColumns& c, int dim) {
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  for (int a = 0; c.deformation >= 0 && a < dim; ++a)
    for (int b = 0; b < dim; ++b)
      F(a, b) = entry(record, c.deformation, dim == 2 ? 6 * a + 2 * b : 3 * a + b);
  const Eigen::Matrix3d inverse = F.inverse();
  for (Offset& d : at)
    for (int a = 0; a < 3; ++a) {
      double sum = 0;
      for (int b = 0; b < 3; ++b) sum += inverse(a, b) * d.now[static_cast<std::size_t>(b)];
      d.before[static_cast<std::size_t>(a)] = sum;
    }
}

/// M of a half: without 3 q q^T, q the way from the point to it. So is the width of gimp's domain.
void halve_domain(std::vector<double>& record, const PointColumns& c, const Triple& half, int dim) {
  for (int a = 0; a < dim; ++a)
    for (int b = a; b < dim; ++b)
      entry(record, c.domain, domain_component(dim, a, b)) -=
          0.75 * half[static_cast<std::size_t>(a)] * half[static_cast<std::size_t>(b)];
  for (int a = 0; c.half_width >= 0 && a < dim; ++a)
    entry(record, c.half_width, a) =
        std::sqrt(std::max(0.0, entry(record, c.domain, domain_component(dim, a, a))));
}

}  // namespace

double PointSize::mass(const GridGeometry& geometry, double r) const {
  double m = density * (hoop ? 2 * std::numbers::pi * r : 1);
  for (int a = 0; a < geometry.dimension; ++a)
    m *= geometry.h / per_direction[static_cast<std::size_t>(a)];
  return m;
}

namespace {

bool too_large(const GridGeometry& geometry, const PointSize& size, double m, double r) {
  return m > std::pow(kTooLarge, geometry.dimension) * size.mass(geometry, r);
}

}  // namespace

bool will_split(const Levels& levels, const PointColumns& c, const PointSize& size, int from,
                const Arrival& point) {
  return point.key.level > from &&
         too_large(levels.geometry(point.key.level), size, entry(point.record, c.mass),
                   entry(point.record, c.position));
}

namespace {

BlockKey block_around(const Levels& levels, const PointColumns& c, const Arrival& point) {
  double x[3] = {};
  for (int a = 0; a < levels.geometry().dimension; ++a) x[a] = entry(point.record, c.position, a);
  return levels.block_at(x);
}

/// Of its spacing over that of a point of its level, by its volume; F tells what became of that.
double grown(const GridGeometry& g, const PointColumns& c, const PointSize& size,
             const Arrival& point) {
  const double rho = c.deformation >= 0 ? size.density : entry(point.record, c.density);
  const double there = entry(point.record, c.mass) / rho,
               usual = size.mass(g, entry(point.record, c.position)) / size.density;
  return std::clamp(std::pow(there / usual, 1.0 / g.dimension), 0.5, kMostGrown);
}

/// Every part until it has the size of the cells where it lies, and no further.
std::vector<Arrival> split_to_size(const Levels& levels, const PointColumns& c, PointSize& size,
                                   int from, Arrival point, const Triple* half_width) {
  const double growth = grown(levels.geometry(from), c, size, point);
  std::vector<Arrival> parts{std::move(point)}, next;
  int splits = 0;
  for (int l = from + 1; l < levels.count(); ++l) {
    const GridGeometry& g = levels.geometry(l);
    bool any = false;
    next.clear();
    for (Arrival& whole : parts) {
      const int there = block_around(levels, c, whole).level;
      if (there < l ||
          !too_large(g, size, entry(whole.record, c.mass), entry(whole.record, c.position))) {
        next.push_back(std::move(whole));
        continue;
      }
      Way way{{}, size.stagger && whole.inside ? 0.5 : 0, half_width == nullptr};
      for (std::size_t a = 0; a < static_cast<std::size_t>(g.dimension); ++a)
        way.step[a] = half_width != nullptr ? std::ldexp((*half_width)[a], -splits - 1)
                                            : 0.5 * growth * g.h / size.per_direction[a];
      split(g, c, size, way, whole, next);
      any = true;
    }
    splits += any ? 1 : 0;
    parts.swap(next);
  }
  return parts;
}

}  // namespace

double arrive(const Levels& levels, const PointColumns& c, PointSize& size, int from, Arrival point,
              std::vector<Arrival>& out, const Triple* half_width) {
  const int dim = levels.geometry().dimension;
  const double before = kinetic_of(point.record, c, levels.geometry(from).h, dim),
               m = entry(point.record, c.mass);
  std::vector<Arrival> parts = split_to_size(levels, c, size, from, std::move(point), half_width);
  double after = 0;
  for (Arrival& part : parts) {
    part.key = block_around(levels, c, part);
    after += kinetic_of(part.record, c, levels.geometry(part.key.level).h, dim);
  }
  const double heat = half_width == nullptr && c.energy >= 0 ? before - after : 0;
  share_heat(heat, m, c, parts);
  for (Arrival& part : parts) out.push_back(std::move(part));
  return heat;
}

double halve(const GridGeometry& g, const PointColumns& c, PointSize& size, const Arrival& whole,
             const Triple& half, std::vector<Arrival>& out) {
  const int dim = g.dimension;
  const std::vector<double>& record = whole.record;
  Parts parts;
  parts.at.resize(2);
  for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) {
    parts.at[0].now[a] = -0.5 * half[a];
    parts.at[1].now[a] = 0.5 * half[a];
  }
  keep_inside(parts.at, record, c, g);
  undeform(parts.at, record, c, dim);
  parts.weigh(entry(record, c.position), size.hoop);
  std::vector<double> as_all = record;
  if (c.affine >= 0 && !size.hoop) keep_turning(g, c, nullptr, parts, record, as_all);
  halve_domain(as_all, c, half, dim);
  const std::size_t first = out.size();
  make_parts(c, size, parts, dim, as_all, whole, out);
  const std::span<Arrival> halves{out.begin() + static_cast<std::ptrdiff_t>(first), out.end()};
  double heat = kinetic_of(record, c, g.h, dim);
  for (const Arrival& part : halves) heat -= kinetic_of(part.record, c, g.h, dim);
  share_heat(heat, entry(record, c.mass), c, halves);
  return heat;
}

}  // namespace krater
