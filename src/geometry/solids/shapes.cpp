// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/geometry/solids/shapes.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "krater/geometry/solids/primitives.hpp"

namespace krater {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

void require_positive(double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value)) {
    throw std::invalid_argument(std::string(what) + " must be positive and finite");
  }
}

class SlabSolid final : public Solid {
 public:
  SlabSolid(int axis, double low, double high)
      : axis_(static_cast<std::size_t>(axis)), low_(low), high_(high) {}

  using Solid::contains;

  void spans(const Line& line, Spans& out) const override {
    out.clear();
    const double x = line.origin[axis_], d = line.direction[axis_];
    if (d == 0) {
      if (x >= low_ && x <= high_) out.push_back({-inf, inf});
      return;
    }
    const double a = (low_ - x) / d, b = (high_ - x) / d;
    out.push_back({std::min(a, b), std::max(a, b)});
  }

  bool contains(double x, double y, double z) const override {
    const Vector3 p{x, y, z};
    return p[axis_] >= low_ && p[axis_] <= high_;
  }

  Box bounding_box() const override {
    Box box{{-inf, -inf, -inf}, {inf, inf, inf}};
    box.min[axis_] = low_;
    box.max[axis_] = high_;
    return box;
  }

  double support(const Vector3& d) const override {
    double across = 0;
    for (std::size_t a = 0; a < 3; ++a) across += a == axis_ ? 0 : std::abs(d[a]);
    if (across > 1e-14 * std::abs(d[axis_])) return inf;
    return d[axis_] * (d[axis_] > 0 ? high_ : low_);
  }

  bool revolved_about(const Line& axis) const override {
    const Vector3& d = axis.direction;
    double across = 0;
    for (std::size_t a = 0; a < 3; ++a) across += a == axis_ ? 0 : std::abs(d[a]);
    return across <= 1e-12 * std::abs(d[axis_]);
  }

 private:
  std::size_t axis_;
  double low_, high_;
};

}  // namespace

Affine placing(const Vector3& base, int axis, bool negative) {
  if (axis < 0 || axis > 2) throw std::invalid_argument("an axis is x, y or z");
  Affine map;
  const double quarter = std::numbers::pi / 2;
  if (axis == 0) map = Affine::rotate({0, 1, 0}, quarter);
  if (axis == 1) map = Affine::rotate({1, 0, 0}, -quarter);
  if (negative) map = map * Affine::rotate({1, 0, 0}, 2 * quarter);
  map.shift = base;
  return map;
}

std::shared_ptr<const Solid> make_tube(double inner_radius, double outer_radius, double height) {
  require_positive(inner_radius, "the inner radius of the tube");
  require_positive(outer_radius, "the outer radius of the tube");
  require_positive(height, "the height of the tube");
  if (!(outer_radius > inner_radius)) {
    throw std::invalid_argument("the outer radius of the tube must exceed the inner one");
  }
  return make_revolution(polygon_profile(
      {{inner_radius, 0}, {outer_radius, 0}, {outer_radius, height}, {inner_radius, height}}));
}

std::shared_ptr<const Solid> make_cone(double base_radius, double top_radius, double height) {
  require_positive(height, "the height of the cone");
  if (!(base_radius >= 0) || !(top_radius >= 0) || !(base_radius + top_radius > 0) ||
      !std::isfinite(base_radius + top_radius)) {
    throw std::invalid_argument("the radii of a cone are not negative, and not both zero");
  }
  std::vector<std::array<double, 2>> corners{{0, 0}};
  if (base_radius > 0) corners.push_back({base_radius, 0});
  if (top_radius > 0) corners.push_back({top_radius, height});
  corners.push_back({0, height});
  return make_revolution(polygon_profile(corners));
}

std::shared_ptr<const Solid> make_torus(double major_radius, double minor_radius) {
  require_positive(major_radius, "the major radius of the torus");
  require_positive(minor_radius, "the minor radius of the torus");
  if (!(major_radius > minor_radius)) {
    throw std::invalid_argument("the major radius of the torus must exceed the minor one");
  }
  return make_revolution(
      {ProfileEdge::circular(major_radius, 0, minor_radius, 0, 2 * std::numbers::pi)});
}

std::shared_ptr<const Solid> make_ellipsoid(const Vector3& semi_axes) {
  for (const double a : semi_axes) require_positive(a, "a semi-axis of the ellipsoid");
  return transformed(std::make_shared<SphereSolid>(1.0, Vector3{}), Affine::scale(semi_axes));
}

std::shared_ptr<const Solid> make_ogive(double radius, double length, double crh) {
  require_positive(radius, "the radius of the ogive-nosed body");
  require_positive(length, "the length of the ogive-nosed body");
  if (!(crh >= 0.5) || !std::isfinite(crh)) {
    throw std::invalid_argument("crh, the nose's radius over the diameter, must be 0.5 or more");
  }
  const double nose = radius * std::sqrt(4 * crh - 1);
  const double shank = length - nose;
  if (shank < -1e-12 * length) {
    throw std::invalid_argument("the nose alone is " + std::to_string(nose) +
                                " m long (radius sqrt(4 crh - 1)), more than the length given");
  }
  const double arc = 2 * crh * radius, centre = radius - arc, start = std::max(shank, 0.0);
  const double sweep = std::atan2(nose, arc - radius);
  Profile profile{ProfileEdge::straight(0, 0, radius, 0)};
  if (start > 0) profile.push_back(ProfileEdge::straight(radius, 0, radius, start));
  ProfileEdge tip = ProfileEdge::circular(centre, start, arc, 0, sweep);
  tip.u0 = radius;
  tip.u1 = 0;
  tip.v1 = length;
  profile.push_back(tip);
  profile.push_back(ProfileEdge::straight(0, length, 0, 0));
  return make_revolution(std::move(profile));
}

std::shared_ptr<const Solid> make_slab(int axis, double low, double high) {
  if (axis < 0 || axis > 2) throw std::invalid_argument("an axis is x, y or z");
  if (!(high > low)) throw std::invalid_argument("the slab is empty: max must exceed min");
  if (low == -inf && high == inf) {
    throw std::invalid_argument("a slab needs min, max or both");
  }
  return std::make_shared<SlabSolid>(axis, low, high);
}

}  // namespace krater
