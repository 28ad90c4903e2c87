// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/geometry/solid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace krater {
namespace {

/// Levels of halving: at least, so that a corner or a hole between the samples is not missed, and
/// at most.
constexpr int least_depth = 2;
constexpr int greatest_depth_2d = 7;
constexpr int greatest_depth_3d = 5;
/// `part` cuts its box into this many intervals an axis before it subdivides.
constexpr int part_intervals_2d = 64;
constexpr int part_intervals_3d = 16;

/// Child `index` of a box halved along its first `dimensions` axes.
Box child(const Box& box, int dimensions, int index) {
  Box half = box;
  for (int a = 0; a < dimensions; ++a) {
    const auto k = static_cast<std::size_t>(a);
    ((index >> a) & 1 ? half.min[k] : half.max[k]) = box.middle(a);
  }
  return half;
}

/// Corners and centre: how many of how many are in the solid.
Place sampled(const Solid& solid, Frame frame, const Box& box) {
  const int corners = 1 << dimension(frame);
  const std::array<double, 3> centre{box.middle(0), box.middle(1), box.middle(2)};
  int in = solid.contains(frame, centre) ? 1 : 0;
  for (int c = 0; c < corners; ++c) {
    std::array<double, 3> x{};
    for (std::size_t a = 0; a < 3; ++a) x[a] = ((c >> a) & 1) ? box.max[a] : box.min[a];
    in += solid.contains(frame, x) ? 1 : 0;
  }
  return in == 0 ? Place::outside : (in == corners + 1 ? Place::inside : Place::cut);
}

CellPart subdivided(const Solid& solid, Frame frame, const Box& box, int depth) {
  const Place place = solid.classify(frame, box);
  if (place == Place::outside) return {};
  if (place == Place::inside) return whole_box(frame, box);
  const int dimensions = dimension(frame);
  if (depth >= least_depth) {
    const Place guess = sampled(solid, frame, box);
    if (guess == Place::outside) return {};
    if (guess == Place::inside) return whole_box(frame, box);
  }
  const bool leaf = depth == (dimensions == 3 ? greatest_depth_3d : greatest_depth_2d);
  CellPart sum;
  for (int c = 0; c < (1 << dimensions); ++c) {
    const Box half = child(box, dimensions, c);
    if (!leaf) {
      sum += subdivided(solid, frame, half, depth + 1);
    } else if (solid.contains(frame, {half.middle(0), half.middle(1), half.middle(2)})) {
      sum += whole_box(frame, half);
    }
  }
  return sum;
}

}  // namespace

CellPart& CellPart::operator+=(const CellPart& other) {
  const double total = measure + other.measure;
  if (other.measure > 0) {
    const double share = other.measure / total;
    for (std::size_t a = 0; a < 3; ++a) centroid[a] += share * (other.centroid[a] - centroid[a]);
  }
  measure = total;
  section += other.section;
  return *this;
}

CellPart whole_box(Frame frame, const Box& box) {
  CellPart part;
  part.centroid = {box.middle(0), box.middle(1), 0};
  part.section = box.length(0) * box.length(1);
  part.measure = part.section;
  if (frame == Frame::cartesian_3d) {
    part.centroid[2] = box.middle(2);
    part.section *= box.length(2);
    part.measure = part.section;
  } else if (frame == Frame::axisymmetric) {
    const double r = part.centroid[0];
    part.measure = 2 * std::numbers::pi * r * part.section;
    part.centroid[0] = r + box.length(0) * box.length(0) / (12 * r);
  }
  return part;
}

CellPart from_section(Frame frame, const PlaneMoments& m) {
  const bool axisymmetric = frame == Frame::axisymmetric;
  const double weight = axisymmetric ? m.x : m.area;
  if (!(weight > 0)) return {};
  const double x = axisymmetric ? m.xx : m.x;
  const double y = axisymmetric ? m.xy : m.y;
  const double measure = axisymmetric ? 2 * std::numbers::pi * weight : weight;
  return {measure, {x / weight, y / weight, 0}, m.area};
}

Box in_frame(Frame frame, Box box) {
  if (frame == Frame::axisymmetric) {
    box.min[0] = std::max(box.min[0], 0.0);
    box.max[0] = std::max(box.max[0], 0.0);
  }
  return box;
}

Box Solid::extent(Frame frame) const {
  const Box b = bounding_box();
  if (frame == Frame::cartesian_3d) return b;
  return in_frame(frame, {{b.min[0], b.min[2], 0}, {b.max[0], b.max[2], 0}});
}

Place Solid::classify(Frame frame, const Box& cell) const {
  const int dimensions = dimension(frame);
  return is_empty(intersection(in_frame(frame, cell), extent(frame), dimensions), dimensions)
             ? Place::outside
             : Place::cut;
}

CellPart Solid::clip(Frame frame, const Box& cell) const {
  const Box box = in_frame(frame, cell);
  if (is_empty(box, dimension(frame))) return {};
  return subdivided(*this, frame, box, 0);
}

CellPart Solid::part(Frame frame, const Box& domain) const {
  const int dimensions = dimension(frame);
  const Box box = intersection(in_frame(frame, extent(frame)), domain, dimensions);
  if (is_empty(box, dimensions)) return {};
  const int n = dimensions == 3 ? part_intervals_3d : part_intervals_2d;
  const auto bound = [&](int a, int i) {
    return box.min[static_cast<std::size_t>(a)] + box.length(a) * i / n;
  };
  CellPart sum;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      Box cell{{bound(0, i), bound(1, j), 0}, {bound(0, i + 1), bound(1, j + 1), 0}};
      for (int k = 0; k < (dimensions == 3 ? n : 1); ++k) {
        cell.min[2] = bound(2, k);
        cell.max[2] = bound(2, k + 1);
        sum += clip(frame, cell);
      }
    }
  }
  return sum;
}

double Solid::smallest_thickness(Frame frame, const Box& domain) const {
  const Box box = intersection(extent(frame), domain, dimension(frame));
  double least = box.length(0);
  for (int a = 1; a < dimension(frame); ++a) least = std::min(least, box.length(a));
  return std::max(least, 0.0);
}

}  // namespace krater
