// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a box in a ball: int A(z) dz, where A(z) is the exact disc n rectangle of the slice
// (section.hpp).
//
// A(z) is smooth but where the slice's circle comes to touch a side of the rectangle (there it
// behaves as a power 3/2) or reaches a corner; these heights are known and split the integral. On
// each interval z = a + (b - a) s^2 (3 - 2 s) makes half-integer powers at both ends integer ones,
// and Gauss-Legendre quadrature then converges geometrically; intervals are halved until two levels
// agree, for another singularity may lie just beyond an end.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "krater/geometry/solids/primitives.hpp"

namespace krater {
namespace {

/// Difference of two levels, as a share of the box's content; the finer one is ten times better at
/// worst.
constexpr double tolerance = 1e-13;
constexpr int greatest_depth = 14;

struct Moments {
  double volume = 0, x = 0, y = 0, z = 0;

  void add(double weight, const PlaneMoments& slice, double at) {
    volume += weight * slice.area;
    x += weight * slice.x;
    y += weight * slice.y;
    z += weight * slice.area * at;
  }
  Moments& operator+=(const Moments& other) {
    volume += other.volume;
    x += other.x;
    y += other.y;
    z += other.z;
    return *this;
  }
};

/// One interval [low, high] of z between break heights; coordinates from the ball's centre.
struct Layer {
  double radius;
  Rectangle rectangle;
  double low, high;
  double allowed;  ///< difference of two levels, m^3

  Moments gauss(double s_low, double s_high) const {
    Moments sum;
    const double half = 0.5 * (s_high - s_low);
    for (std::size_t k = 0; k < HalfGauss16::node.size(); ++k) {
      for (const double side : {-1.0, 1.0}) {
        const double s = 0.5 * (s_low + s_high) + side * half * HalfGauss16::node[k];
        const double z = low + (high - low) * s * s * (3 - 2 * s);
        const double dz = (high - low) * 6 * s * (1 - s) * half * HalfGauss16::weight[k];
        const double slice_radius = std::sqrt(std::max(0.0, (radius - z) * (radius + z)));
        sum.add(dz, disc_moments(slice_radius, rectangle), z);
      }
    }
    return sum;
  }

  Moments refined(double s_low, double s_high, const Moments& coarse, int depth) const {
    const double middle = 0.5 * (s_low + s_high);
    Moments left = gauss(s_low, middle);
    Moments right = gauss(middle, s_high);
    if (std::abs(left.volume + right.volume - coarse.volume) > allowed && depth < greatest_depth) {
      left = refined(s_low, middle, left, depth + 1);
      right = refined(middle, s_high, right, depth + 1);
    }
    left += right;
    return left;
  }
};

/// Heights at which the slice's outline meets a new side or corner of the rectangle, and the ends,
/// in order.
template <std::size_t N>
void add_height(std::array<double, N>& heights, std::size_t& count, double squared) {
  if (!(squared > 0)) return;
  heights[count++] = std::sqrt(squared);
  heights[count++] = -std::sqrt(squared);
}

}  // namespace

CellPart SphereSolid::clip_3d(const Box& cell) const {
  const Place place = classify_3d(cell);
  if (place == Place::outside) return {};
  if (place == Place::inside) return whole_box(Frame::cartesian_3d, cell);
  Box box = intersection(cell, bounding_box());
  if (is_empty(box)) return {};
  for (std::size_t a = 0; a < 3; ++a) {
    box.min[a] -= centre_[a];
    box.max[a] -= centre_[a];
  }
  const Rectangle side{box.min[0], box.max[0], box.min[1], box.max[1]};
  std::array<double, 18> heights{box.min[2], box.max[2]};
  std::size_t count = 2;
  const double r = radius_;
  for (const double x : {side.x_min, side.x_max}) add_height(heights, count, (r - x) * (r + x));
  for (const double y : {side.y_min, side.y_max}) add_height(heights, count, (r - y) * (r + y));
  for (const double x : {side.x_min, side.x_max}) {
    for (const double y : {side.y_min, side.y_max}) {
      add_height(heights, count, (r - x) * (r + x) - y * y);
    }
  }
  for (std::size_t k = 0; k < count; ++k) {
    heights[k] = std::clamp(heights[k], box.min[2], box.max[2]);
  }
  std::sort(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(count));
  const double allowed = tolerance * box.length(0) * box.length(1) * box.length(2);
  Moments sum;
  for (std::size_t k = 0; k + 1 < count; ++k) {
    if (!(heights[k + 1] > heights[k])) continue;
    const Layer layer{r, side, heights[k], heights[k + 1], allowed};
    sum += layer.refined(0, 1, layer.gauss(0, 1), 0);
  }
  if (!(sum.volume > 0)) return {};
  const double v = sum.volume;
  return {v, {centre_[0] + sum.x / v, centre_[1] + sum.y / v, centre_[2] + sum.z / v}, v};
}

}  // namespace krater
