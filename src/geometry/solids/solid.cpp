// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/geometry/solids/solid.hpp"

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <stdexcept>

namespace krater {
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

bool Solid::contains(double x, double y, double z) const {
  Spans found;
  spans(along_axis({x, y, z}, 2), found);
  for (const Span& s : found) {
    if (s.low <= z && z <= s.high) return true;
  }
  return false;
}

Box Solid::bounding_box() const {
  Box box;
  for (std::size_t a = 0; a < 3; ++a) {
    Vector3 d{};
    d[a] = 1;
    box.max[a] = support(d);
    d[a] = -1;
    box.min[a] = -support(d);
  }
  return box;
}

double Solid::support(const Vector3& d) const {
  const Box box = bounding_box();
  double sum = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    if (d[a] != 0) sum += d[a] * (d[a] > 0 ? box.max[a] : box.min[a]);
  }
  return sum;
}

void Solid::require(Frame frame) const {
  if (frame == Frame::axisymmetric && !revolved_about(along_axis({0, 0, 0}, 2))) {
    throw std::invalid_argument(
        "in the axisymmetric frame a body must be one of revolution about the axis r = 0");
  }
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

double Solid::smallest_thickness(Frame frame, const Box& domain) const {
  const Box box = intersection(extent(frame), domain, dimension(frame));
  double least = box.length(0);
  for (int a = 1; a < dimension(frame); ++a) least = std::min(least, box.length(a));
  return std::max(least, 0.0);
}

}  // namespace krater
