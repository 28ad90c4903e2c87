// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/geometry/seeds/section.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace krater {
namespace {

struct Point {
  double x, y;
};

/// Half the chord at distance x from the centre; the product avoids the cancellation of R^2 - x^2.
double half_chord(double radius, double x) {
  return std::sqrt(std::max(0.0, (radius - x) * (radius + x)));
}

/// A triangle, its area signed by its sense of rotation (so that trapezoids may degenerate).
PlaneMoments triangle_moments(Point a, Point b, Point c) {
  const double area = 0.5 * ((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y));
  const double sx = a.x + b.x + c.x;
  const double sy = a.y + b.y + c.y;
  const double sxx = a.x * a.x + b.x * b.x + c.x * c.x;
  const double sxy = a.x * a.y + b.x * b.y + c.x * c.y;
  return {area, area * sx / 3, area * sy / 3, area / 12 * (sx * sx + sxx),
          area / 12 * (sx * sy + sxy)};
}

/// Between the chord and the arc from `a` to `b`, both on the circle about the origin, at most a
/// quarter turn apart.
PlaneMoments segment_moments(double radius, Point a, Point b) {
  const double sine = std::min(1.0, std::hypot(b.x - a.x, b.y - a.y) / (2 * radius));
  const double cosine = std::sqrt((1 - sine) * (1 + sine));
  const double t0 = sine / (1 + cosine);
  const double u0 = radius * cosine;
  double area = 0, u = 0, uu = 0, ww = 0;  // u along the bisector of the arc, w across it
  for (std::size_t k = 0; k < HalfGauss16::node.size(); ++k) {
    const double t = t0 * HalfGauss16::node[k];
    const double e = 1 + t * t;
    const double w = 2 * radius * t / e;
    const double height = 2 * radius * (t0 - t) * (t0 + t) / (e * (1 + t0 * t0));
    const double dw = 2 * t0 * HalfGauss16::weight[k] * 2 * radius * (1 - t * t) / (e * e);
    area += dw * height;
    u += dw * height * (u0 + height / 2);
    uu += dw * height * (u0 * u0 + u0 * height + height * height / 3);
    ww += dw * height * w * w;
  }
  const double norm = std::hypot(a.x + b.x, a.y + b.y);
  const double ux = (a.x + b.x) / norm;
  const double uy = (a.y + b.y) / norm;
  return {area, u * ux, u * uy, uu * ux * ux + ww * uy * uy, (uu - ww) * ux * uy};
}

PlaneMoments mirrored_in_y(const PlaneMoments& m) { return {m.area, m.x, -m.y, m.xx, -m.xy}; }

/// The part of the disc between x = a and x = b, bounded above and below by arc or side throughout.
PlaneMoments strip_moments(double radius, const Rectangle& box, double a, double b) {
  const double middle = half_chord(radius, 0.5 * (a + b));
  const bool top_is_arc = middle < box.y_max;
  const bool bottom_is_arc = -middle > box.y_min;
  if (std::min(middle, box.y_max) <= std::max(-middle, box.y_min)) return {};
  // On an arc the ends are the circle's own, never the side's: chord and segment then fit exactly,
  // whatever the round-off of the abscissae (near the circle's poles it is the square root of the
  // machine's precision in y).
  const Point arc_a{a, half_chord(radius, a)};
  const Point arc_b{b, half_chord(radius, b)};
  const Point top_a{a, top_is_arc ? arc_a.y : box.y_max};
  const Point top_b{b, top_is_arc ? arc_b.y : box.y_max};
  const Point bottom_a{a, bottom_is_arc ? -arc_a.y : box.y_min};
  const Point bottom_b{b, bottom_is_arc ? -arc_b.y : box.y_min};
  PlaneMoments sum = triangle_moments(bottom_a, bottom_b, top_b);
  sum += triangle_moments(bottom_a, top_b, top_a);
  if (top_is_arc || bottom_is_arc) {
    const PlaneMoments segment = segment_moments(radius, arc_a, arc_b);
    if (top_is_arc) sum += segment;
    if (bottom_is_arc) sum += mirrored_in_y(segment);
  }
  return sum;
}

}  // namespace

PlaneMoments& PlaneMoments::operator+=(const PlaneMoments& other) {
  area += other.area;
  x += other.x;
  y += other.y;
  xx += other.xx;
  xy += other.xy;
  return *this;
}

PlaneMoments shifted(const PlaneMoments& m, double dx, double dy) {
  return {m.area, m.x + dx * m.area, m.y + dy * m.area, m.xx + dx * (2 * m.x + dx * m.area),
          m.xy + dx * m.y + dy * m.x + dx * dy * m.area};
}

PlaneMoments rectangle_moments(const Rectangle& r) {
  const double dx = r.x_max - r.x_min;
  const double dy = r.y_max - r.y_min;
  if (!(dx > 0) || !(dy > 0)) return {};
  const double cx = 0.5 * (r.x_min + r.x_max);
  const double cy = 0.5 * (r.y_min + r.y_max);
  const double area = dx * dy;
  return {area, area * cx, area * cy, area * (cx * cx + dx * dx / 12), area * cx * cy};
}

PlaneMoments disc_moments(double radius, const Rectangle& rectangle) {
  const Rectangle box{std::max(rectangle.x_min, -radius), std::min(rectangle.x_max, radius),
                      std::max(rectangle.y_min, -radius), std::min(rectangle.y_max, radius)};
  if (!(box.x_max > box.x_min) || !(box.y_max > box.y_min)) return {};
  const double low = half_chord(radius, box.y_min);
  const double high = half_chord(radius, box.y_max);
  // x = 0 as a cut keeps every arc within a quarter turn.
  std::array<double, 7> cut{box.x_min, box.x_max, 0.0, low, -low, high, -high};
  for (double& x : cut) x = std::clamp(x, box.x_min, box.x_max);
  std::sort(cut.begin(), cut.end());
  PlaneMoments sum;
  for (std::size_t k = 0; k + 1 < cut.size(); ++k) {
    if (cut[k + 1] > cut[k]) sum += strip_moments(radius, box, cut[k], cut[k + 1]);
  }
  return sum;
}

}  // namespace krater
