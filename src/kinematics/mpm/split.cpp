// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mpm/split.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "krater/kinematics/mpm/migrate.hpp"

namespace krater {

namespace {

constexpr double kTooLarge = 1.4;   ///< in spacings along each axis
constexpr double kMostGrown = 1.5;  ///< of the spacing, in spacings

/// A record of one point by the offsets of its columns.
double& entry(std::vector<double>& record, int offset, int k = 0) {
  return record[static_cast<std::size_t>(offset / kLanes + k)];
}

double kinetic_of(const std::vector<double>& record, const PointColumns& c, double h, int dim) {
  const auto get = [&](int offset, int k) {
    return record[static_cast<std::size_t>(offset / kLanes + k)];
  };
  double twice = 0;
  for (int a = 0; a < dim; ++a) twice += get(c.velocity, a) * get(c.velocity, a);
  for (int k = 0; c.affine >= 0 && k < dim * dim; ++k)
    twice += Support::moment * h * h * get(c.affine, k) * get(c.affine, k);
  return 0.5 * get(c.mass, 0) * twice;
}

/// Where the parts lie from the point's own place, in the undeformed body and now.
struct Offset {
  Triple before{}, now{};
};
std::vector<Offset> offsets(std::vector<double>& record, const PointColumns& c, const Triple& step,
                            double most, int dim) {
  std::vector<Offset> out(static_cast<std::size_t>(corner_count(dim)));
  for (int corner = 0; corner < corner_count(dim); ++corner) {
    Offset& d = out[static_cast<std::size_t>(corner)];
    for (int a = 0; a < dim; ++a) {
      const auto i = static_cast<std::size_t>(a);
      d.before[i] = corner_offset(corner, a) != 0 ? step[i] : -step[i];
    }
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
  return out;
}

/// No part beyond a side of the domain that the whole is inside of.
void keep_inside(std::vector<Offset>& at, std::vector<double>& record, const PointColumns& c,
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

/// 2^dim points in the place of one, `step` from it along each axis.
void split(const GridGeometry& g, const PointColumns& c, PointSize& size, const Triple& step,
           const Arrival& whole, std::vector<Arrival>& out) {
  const int dim = g.dimension, parts = corner_count(dim);
  std::vector<double> record = whole.record;
  std::vector<Offset> at = offsets(record, c, step, g.h, dim);
  keep_inside(at, record, c, g);
  const double r = entry(record, c.position);
  std::vector<double> share(at.size(), 1.0 / parts);
  if (size.hoop) {
    double sum = 0;
    for (std::size_t k = 0; k < at.size(); ++k) sum += share[k] = std::max(0.0, r + at[k].now[0]);
    for (double& w : share) w /= sum;
  }
  Triple mean{};
  for (std::size_t k = 0; k < at.size(); ++k)
    for (std::size_t a = 0; a < 3; ++a) mean[a] += share[k] * at[k].now[a];
  for (std::size_t k = 0; k < at.size(); ++k) {
    if (!(share[k] > 0)) continue;
    Arrival part = whole;
    for (int a = 0; a < dim; ++a) {
      const auto i = static_cast<std::size_t>(a);
      entry(part.record, c.position, a) += at[k].now[i];
      if (c.reference >= 0) entry(part.record, c.reference, a) += at[k].before[i];
      for (int b = 0; c.affine >= 0 && b < dim; ++b) {
        const auto j = static_cast<std::size_t>(b);
        entry(part.record, c.velocity, a) +=
            entry(record, c.affine, dim * a + b) * (at[k].now[j] - mean[j]);
      }
    }
    entry(part.record, c.mass) *= share[k];
    if (k > 0) entry(part.record, 0) = size.next_id++;
    out.push_back(std::move(part));
  }
}

}  // namespace

double PointSize::mass(const GridGeometry& geometry, double r) const {
  double m = density * (hoop ? 2 * std::numbers::pi * r : 1);
  for (int a = 0; a < geometry.dimension; ++a)
    m *= geometry.h / per_direction[static_cast<std::size_t>(a)];
  return m;
}

double arrive(const Levels& levels, const PointColumns& c, PointSize& size, int from, Arrival point,
              std::vector<Arrival>& out, const Triple* half_width) {
  const int dim = levels.geometry().dimension, level = point.key.level;
  const double before = kinetic_of(point.record, c, levels.geometry(from).h, dim);
  const double m = entry(point.record, c.mass), r = entry(point.record, c.position);
  std::vector<Arrival> parts{std::move(point)}, next;
  int splits = 0;
  // Of its spacing over that of a point of its level, by its volume; F tells what became of that.
  const double rho = c.deformation >= 0 ? size.density : entry(parts.front().record, c.density);
  const double there = m / rho, usual = size.mass(levels.geometry(from), r) / size.density;
  const double grown = std::clamp(std::pow(there / usual, 1.0 / dim), 0.5, kMostGrown);
  for (int l = from + 1; l <= level; ++l) {
    if (!(m * std::pow(corner_count(dim), -splits) >
          std::pow(kTooLarge, dim) * size.mass(levels.geometry(l), r)))
      continue;
    ++splits;
    next.clear();
    Triple step{};
    for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a)
      step[a] = half_width != nullptr ? std::ldexp((*half_width)[a], -splits)
                                      : 0.5 * grown * levels.geometry(l).h / size.per_direction[a];
    for (const Arrival& whole : parts) split(levels.geometry(l), c, size, step, whole, next);
    parts.swap(next);
  }
  double after = 0;
  for (Arrival& part : parts) {
    double x[3] = {};
    for (int a = 0; a < dim; ++a) x[a] = entry(part.record, c.position, a);
    part.key = levels.block_at(x);
    after += kinetic_of(part.record, c, levels.geometry(part.key.level).h, dim);
  }
  const double heat = half_width == nullptr && c.energy >= 0 ? before - after : 0;
  for (Arrival& part : parts) {
    if (c.energy >= 0)  // rigid bodies have none
      entry(part.record, heat < 0 && c.carried >= 0 ? c.carried : c.energy) += heat / m;
    out.push_back(std::move(part));
  }
  return heat;
}

}  // namespace krater
