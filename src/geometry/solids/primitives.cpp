// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/geometry/solids/primitives.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace krater {
namespace {

void require_positive(double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value)) {
    throw std::invalid_argument(std::string(what) + " must be positive and finite");
  }
}

void require_finite(const std::array<double, 3>& x, const char* what) {
  for (double value : x) {
    if (!std::isfinite(value)) throw std::invalid_argument(std::string(what) + " is not finite");
  }
}

double square(double x) { return x * x; }

/// Least and greatest distance of a point from the points of an interval.
double nearest(double x, double low, double high) { return std::max({low - x, x - high, 0.0}); }
double farthest(double x, double low, double high) { return std::max(x - low, high - x); }

/// A disc against a rectangle given by the distances from its centre.
Place classify_disc(double radius, double near_squared, double far_squared) {
  if (near_squared >= radius * radius) return Place::outside;
  return far_squared <= radius * radius ? Place::inside : Place::cut;
}

Place classify_section(const Section& s, const Box& cell) {
  const Rectangle& r = s.rectangle;
  if (s.kind == Section::Kind::empty || cell.max[0] <= r.x_min || cell.min[0] >= r.x_max ||
      cell.max[1] <= r.y_min || cell.min[1] >= r.y_max) {
    return Place::outside;
  }
  if (s.kind == Section::Kind::rectangle) {
    const Box box{{r.x_min, r.y_min, 0}, {r.x_max, r.y_max, 0}};
    return encloses(box, cell, 2) ? Place::inside : Place::cut;
  }
  return classify_disc(s.radius,
                       square(nearest(s.x, cell.min[0], cell.max[0])) +
                           square(nearest(s.z, cell.min[1], cell.max[1])),
                       square(farthest(s.x, cell.min[0], cell.max[0])) +
                           square(farthest(s.z, cell.min[1], cell.max[1])));
}

PlaneMoments clip_section(const Section& s, const Box& cell) {
  switch (s.kind) {
    case Section::Kind::empty:
      break;
    case Section::Kind::rectangle:
      return rectangle_moments(
          {std::max(cell.min[0], s.rectangle.x_min), std::min(cell.max[0], s.rectangle.x_max),
           std::max(cell.min[1], s.rectangle.y_min), std::min(cell.max[1], s.rectangle.y_max)});
    case Section::Kind::disc:
      return shifted(disc_moments(s.radius, {cell.min[0] - s.x, cell.max[0] - s.x,
                                             cell.min[1] - s.z, cell.max[1] - s.z}),
                     s.x, s.z);
  }
  return {};
}

Section rectangle_section(double x_min, double x_max, double z_min, double z_max) {
  return {Section::Kind::rectangle, {x_min, x_max, z_min, z_max}, 0, 0, 0};
}

Section disc_section(double x, double z, double radius) {
  return {Section::Kind::disc, {x - radius, x + radius, z - radius, z + radius}, x, z, radius};
}

}  // namespace

// --------------------------------------------------------------------------------------- Primitive

Box Primitive::extent(Frame frame) const {
  if (dimension(frame) == 3) return bounding_box();
  const Section s = section();
  if (s.kind == Section::Kind::empty) return {};
  const Rectangle& r = s.rectangle;
  return in_frame(frame, {{r.x_min, r.y_min, 0}, {r.x_max, r.y_max, 0}});
}

void Primitive::clip_column(Frame frame, std::span<const Box> cells, CellPart* parts) const {
  for (std::size_t n = 0; n < cells.size(); ++n) {
    parts[n] = {};
    if (is_empty(cells[n], dimension(frame))) continue;
    const Place place = classify(frame, cells[n]);
    if (place == Place::outside) continue;
    parts[n] = place == Place::inside ? whole_box(frame, cells[n]) : clip(frame, cells[n]);
  }
}

Place Primitive::classify(Frame frame, const Box& cell) const {
  return dimension(frame) == 3 ? classify_3d(cell) : classify_section(section(), cell);
}

CellPart Primitive::clip(Frame frame, const Box& cell) const {
  require(frame);
  const Box box = in_frame(frame, cell);
  if (is_empty(box, dimension(frame))) return {};
  if (dimension(frame) == 3) return clip_3d(box);
  return from_section(frame, clip_section(section(), box));
}

// --------------------------------------------------------------------------------------------- box

BoxSolid::BoxSolid(const Box& box) : box_(box) {
  require_finite(box.min, "a corner of the box");
  require_finite(box.max, "a corner of the box");
  if (is_empty(box)) throw std::invalid_argument("the box is empty: max must exceed min");
}

BoxSolid BoxSolid::centred(const std::array<double, 3>& centre, const std::array<double, 3>& size) {
  Box box;
  for (std::size_t a = 0; a < 3; ++a) {
    require_positive(size[a], "the size of the box");
    box.min[a] = centre[a] - 0.5 * size[a];
    box.max[a] = centre[a] + 0.5 * size[a];
  }
  return BoxSolid(box);
}

BoxSolid BoxSolid::from_grid(Frame frame, const std::array<double, 3>& min,
                             const std::array<double, 3>& max) {
  if (dimension(frame) == 3) return BoxSolid({min, max});
  return BoxSolid({{min[0], -0.5, min[1]}, {max[0], 0.5, max[1]}});
}

bool BoxSolid::contains(double x, double y, double z) const {
  return encloses(box_, std::array<double, 3>{x, y, z});
}

void BoxSolid::require(Frame frame) const {
  if (frame == Frame::axisymmetric) {
    throw std::invalid_argument(
        "a box is not a body of revolution (in the axisymmetric frame use a cylinder)");
  }
}

Section BoxSolid::section() const {
  if (box_.min[1] > 0 || box_.max[1] < 0) return {};
  return rectangle_section(box_.min[0], box_.max[0], box_.min[2], box_.max[2]);
}

Place BoxSolid::classify_3d(const Box& cell) const {
  if (is_empty(intersection(box_, cell))) return Place::outside;
  return encloses(box_, cell) ? Place::inside : Place::cut;
}

CellPart BoxSolid::clip_3d(const Box& cell) const {
  const Box common = intersection(box_, cell);
  return is_empty(common) ? CellPart{} : whole_box(Frame::cartesian_3d, common);
}

// ---------------------------------------------------------------------------------------- cylinder

CylinderSolid::CylinderSolid(double radius, double height, const std::array<double, 3>& base,
                             int axis)
    : radius_(radius), height_(height), base_(base) {
  require_positive(radius, "the radius of the cylinder");
  require_positive(height, "the height of the cylinder");
  require_finite(base, "the base of the cylinder");
  if (axis < 0 || axis > 2)
    throw std::invalid_argument("the axis of the cylinder must be x, y or z");
  axis_ = static_cast<std::size_t>(axis);
  first_ = (axis_ + 1) % 3;
  second_ = (axis_ + 2) % 3;
}

CylinderSolid CylinderSolid::centred(double radius, double height,
                                     const std::array<double, 3>& centre, int axis) {
  std::array<double, 3> base = centre;
  if (axis >= 0 && axis <= 2) base[static_cast<std::size_t>(axis)] -= 0.5 * height;
  return {radius, height, base, axis};
}

bool CylinderSolid::contains(double x, double y, double z) const {
  const std::array<double, 3> p{x, y, z};
  const double along = p[axis_] - base_[axis_];
  return along >= 0 && along <= height_ &&
         square(p[first_] - base_[first_]) + square(p[second_] - base_[second_]) <= square(radius_);
}

Box CylinderSolid::bounding_box() const {
  Box box{base_, base_};
  box.max[axis_] += height_;
  for (std::size_t a : {first_, second_}) {
    box.min[a] -= radius_;
    box.max[a] += radius_;
  }
  return box;
}

void CylinderSolid::require(Frame frame) const {
  if (frame != Frame::axisymmetric) return;
  if (axis_ != 2) {
    throw std::invalid_argument("in the axisymmetric frame a cylinder's axis must be z");
  }
  if (base_[0] != 0 || base_[1] != 0) {
    throw std::invalid_argument(
        "in the axisymmetric frame a cylinder must be centred on the axis r = 0");
  }
}

Section CylinderSolid::section() const {
  const double end = base_[axis_] + height_;
  if (axis_ == 1) {
    if (base_[1] > 0 || end < 0) return {};
    return disc_section(base_[0], base_[2], radius_);
  }
  if (std::abs(base_[1]) >= radius_) return {};
  const double half = std::sqrt((radius_ - base_[1]) * (radius_ + base_[1]));
  if (axis_ == 2) return rectangle_section(base_[0] - half, base_[0] + half, base_[2], end);
  return rectangle_section(base_[0], end, base_[2] - half, base_[2] + half);
}

Place CylinderSolid::classify_3d(const Box& cell) const {
  const double end = base_[axis_] + height_;
  if (cell.max[axis_] <= base_[axis_] || cell.min[axis_] >= end) return Place::outside;
  double near_squared = 0, far_squared = 0;
  for (std::size_t a : {first_, second_}) {
    near_squared += square(nearest(base_[a], cell.min[a], cell.max[a]));
    far_squared += square(farthest(base_[a], cell.min[a], cell.max[a]));
  }
  const Place disc = classify_disc(radius_, near_squared, far_squared);
  if (disc == Place::outside) return disc;
  const bool within = cell.min[axis_] >= base_[axis_] && cell.max[axis_] <= end;
  return within ? disc : Place::cut;
}

CellPart CylinderSolid::clip_3d(const Box& cell) const {
  const double low = std::max(cell.min[axis_], base_[axis_]);
  const double high = std::min(cell.max[axis_], base_[axis_] + height_);
  const double length = high - low;
  if (!(length > 0)) return {};
  const PlaneMoments m = disc_moments(
      radius_, {cell.min[first_] - base_[first_], cell.max[first_] - base_[first_],
                cell.min[second_] - base_[second_], cell.max[second_] - base_[second_]});
  if (!(m.area > 0)) return {};
  CellPart part;
  part.measure = m.area * length;
  part.section = part.measure;
  part.centroid[axis_] = 0.5 * (low + high);
  part.centroid[first_] = base_[first_] + m.x / m.area;
  part.centroid[second_] = base_[second_] + m.y / m.area;
  return part;
}

// ------------------------------------------------------------------------------------------ sphere

SphereSolid::SphereSolid(double radius, const std::array<double, 3>& centre)
    : radius_(radius), centre_(centre) {
  require_positive(radius, "the radius of the sphere");
  require_finite(centre, "the centre of the sphere");
}

bool SphereSolid::contains(double x, double y, double z) const {
  return square(x - centre_[0]) + square(y - centre_[1]) + square(z - centre_[2]) <=
         square(radius_);
}

Box SphereSolid::bounding_box() const {
  Box box{centre_, centre_};
  for (double& x : box.min) x -= radius_;
  for (double& x : box.max) x += radius_;
  return box;
}

void SphereSolid::require(Frame frame) const {
  if (frame == Frame::axisymmetric && (centre_[0] != 0 || centre_[1] != 0)) {
    throw std::invalid_argument(
        "in the axisymmetric frame a sphere must be centred on the axis r = 0");
  }
}

Section SphereSolid::section() const {
  if (std::abs(centre_[1]) >= radius_) return {};
  return disc_section(centre_[0], centre_[2],
                      std::sqrt((radius_ - centre_[1]) * (radius_ + centre_[1])));
}

Place SphereSolid::classify_3d(const Box& cell) const {
  double near_squared = 0, far_squared = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    near_squared += square(nearest(centre_[a], cell.min[a], cell.max[a]));
    far_squared += square(farthest(centre_[a], cell.min[a], cell.max[a]));
  }
  return classify_disc(radius_, near_squared, far_squared);
}

}  // namespace krater
