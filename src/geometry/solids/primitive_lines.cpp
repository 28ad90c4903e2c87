// SPDX-License-Identifier: GPL-3.0-or-later
// Box, cylinder and sphere: their spans on lines, moments and axes. All three are convex: one span.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "geometry/solids/axis_of_revolution.hpp"
#include "krater/geometry/solids/primitives.hpp"

namespace krater {
namespace {

constexpr Span nowhere{1, -1};
constexpr Span whole{-std::numeric_limits<double>::infinity(),
                     std::numeric_limits<double>::infinity()};

Span common(const Span& a, const Span& b) {
  return {std::max(a.low, b.low), std::min(a.high, b.high)};
}

void give(const Span& span, Spans& out) {
  out.clear();
  if (span.high > span.low) out.push_back(span);
}

/// low <= x + t d <= high.
Span between(double low, double high, double x, double d) {
  if (d == 0) return x >= low && x <= high ? whole : nowhere;
  const double a = (low - x) / d, b = (high - x) / d;
  return {std::min(a, b), std::max(a, b)};
}

/// |x + t d|^2 <= R^2 over some of the axes: dd t^2 + 2 xd t + xx <= R^2.
Span within(double dd, double xd, double xx, double radius) {
  if (dd == 0) return xx <= radius * radius ? whole : nowhere;
  const double middle = -xd / dd;
  const double nearest = std::max(0.0, xx - xd * xd / dd);  // squared distance of the line
  if (nearest >= radius * radius) return nowhere;
  const double half = std::sqrt((radius * radius - nearest) / dd);
  return {middle - half, middle + half};
}

}  // namespace

void BoxSolid::spans(const Line& line, Spans& out) const {
  Span span = whole;
  for (std::size_t a = 0; a < 3; ++a) {
    span = common(span, between(box_.min[a], box_.max[a], line.origin[a], line.direction[a]));
  }
  give(span, out);
}

std::optional<VolumeMoments> BoxSolid::moments() const {
  const Vector3 c{box_.middle(0), box_.middle(1), box_.middle(2)};
  VolumeMoments m;
  const double v = box_.length(0) * box_.length(1) * box_.length(2);
  add_point(m, v, c);
  for (std::size_t a = 0; a < 3; ++a) {
    const double d = box_.length(static_cast<int>(a));
    m.second[a] += v * d * d / 12;
  }
  return m;
}

void CylinderSolid::spans(const Line& line, Spans& out) const {
  double dd = 0, xd = 0, xx = 0;
  for (const std::size_t a : {first_, second_}) {
    const double x = line.origin[a] - base_[a], d = line.direction[a];
    dd += d * d;
    xd += x * d;
    xx += x * x;
  }
  give(common(within(dd, xd, xx, radius_), between(base_[axis_], base_[axis_] + height_,
                                                   line.origin[axis_], line.direction[axis_])),
       out);
}

bool CylinderSolid::revolved_about(const Line& axis) const {
  Vector3 own{};
  own[axis_] = 1;
  return same_line(axis, {base_, own}, radius_ + height_);
}

double CylinderSolid::support(const Vector3& d) const {
  return dot(d, base_) + std::max(0.0, height_ * d[axis_]) +
         radius_ * std::hypot(d[first_], d[second_]);
}

std::optional<VolumeMoments> CylinderSolid::moments() const {
  const double v = std::numbers::pi * radius_ * radius_ * height_;
  Vector3 c = base_;
  c[axis_] += 0.5 * height_;
  VolumeMoments m;
  add_point(m, v, c);
  m.second[axis_] += v * height_ * height_ / 12;
  m.second[first_] += v * radius_ * radius_ / 4;
  m.second[second_] += v * radius_ * radius_ / 4;
  return m;
}

void SphereSolid::spans(const Line& line, Spans& out) const {
  const Vector3 x = minus(line.origin, centre_);
  give(within(dot(line.direction, line.direction), dot(x, line.direction), dot(x, x), radius_),
       out);
}

bool SphereSolid::revolved_about(const Line& axis) const {
  return same_line(axis, {centre_, axis.direction}, radius_);
}

double SphereSolid::support(const Vector3& d) const {
  return dot(d, centre_) + radius_ * std::sqrt(dot(d, d));
}

std::optional<VolumeMoments> SphereSolid::moments() const {
  const double v = 4 * std::numbers::pi / 3 * radius_ * radius_ * radius_;
  VolumeMoments m;
  add_point(m, v, centre_);
  for (std::size_t a = 0; a < 3; ++a) m.second[a] += v * radius_ * radius_ / 5;
  return m;
}

}  // namespace krater
