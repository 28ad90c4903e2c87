// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "geometry/solids/axis_of_revolution.hpp"
#include "geometry/solids/profile_curve.hpp"
#include "geometry/solids/real_roots.hpp"
#include "krater/geometry/solids/profile.hpp"

namespace krater {
namespace {

/// A solid that knows where a line may enter or leave it: the pieces between are judged by their
/// middles.
class SweptSolid : public Solid {
 public:
  using Solid::contains;

  explicit SweptSolid(const Profile& profile) : curve_(profile) {}

  void spans(const Line& line, Spans& out) const final {
    thread_local std::vector<double> cuts;
    cuts.clear();
    crossings(line, cuts);
    std::sort(cuts.begin(), cuts.end());
    out.clear();
    for (std::size_t n = 0; n + 1 < cuts.size(); ++n) {
      if (!(cuts[n + 1] > cuts[n])) continue;
      const Vector3 p = line.at(0.5 * (cuts[n] + cuts[n + 1]));
      if (!contains(p[0], p[1], p[2])) continue;
      if (!out.empty() && out.back().high == cuts[n]) {
        out.back().high = cuts[n + 1];
      } else {
        out.push_back({cuts[n], cuts[n + 1]});
      }
    }
  }

 protected:
  /// All parameters at which the line meets the boundary, and perhaps others.
  virtual void crossings(const Line& line, std::vector<double>& cuts) const = 0;

  ProfileCurve curve_;
};

// -------------------------------------------------------------------------------------- revolution

/// Of a rectangle revolved about z: a tube or cylinder.
std::optional<RoundForm> tube_of(const Profile& profile) {
  if (profile.size() != 4) return std::nullopt;
  Vector3 low{profile[0].u0, 0, profile[0].v0}, high = low;
  for (const ProfileEdge& e : profile) {
    if (e.arc || (e.u0 != e.u1 && e.v0 != e.v1)) return std::nullopt;
    low = {std::min(low[0], e.u0), 0, std::min(low[2], e.v0)};
    high = {std::max(high[0], e.u0), 0, std::max(high[2], e.v0)};
  }
  return RoundForm{RoundForm::Kind::tube, low[0],         high[0],
                   high[2] - low[2],      {0, 0, low[2]}, {0, 0, 1}};
}

class RevolvedSolid final : public SweptSolid {
 public:
  explicit RevolvedSolid(const Profile& profile) : SweptSolid(profile), form_{tube_of(profile)} {}

  std::optional<RoundForm> round_form() const override { return form_; }

  using Solid::contains;

  bool contains(double x, double y, double z) const override {
    return curve_.contains(std::sqrt(x * x + y * y), z);
  }

  double support(const Vector3& d) const override {
    return curve_.support(std::hypot(d[0], d[1]), d[2]);
  }

  bool revolved_about(const Line& axis) const override {
    return same_line(axis, along_axis({0, 0, 0}, 2), curve_.support(1, 0));
  }

  /// dV = 2 pi r dA; int x^2 dV = pi int r^3 dA.
  std::optional<VolumeMoments> moments() const override {
    const double turn = 2 * std::numbers::pi * (curve_.moment(0, 0) < 0 ? -1 : 1);
    VolumeMoments m;
    m.volume = turn * curve_.moment(1, 0);
    m.first[2] = turn * curve_.moment(1, 1);
    m.second[2] = turn * curve_.moment(1, 2);
    m.second[0] = m.second[1] = 0.5 * turn * curve_.moment(3, 0);
    return m;
  }

 protected:
  void crossings(const Line& line, std::vector<double>& cuts) const override {
    const Vector3& o = line.origin;
    const Vector3& d = line.direction;
    const double dd = d[0] * d[0] + d[1] * d[1];
    if (dd == 0) {
      curve_.crossings_along_v(std::sqrt(o[0] * o[0] + o[1] * o[1]), cuts);
      for (double& t : cuts) t = (t - o[2]) / d[2];
      return;
    }
    for (const ProfileCurve::Piece& piece : curve_.pieces()) {
      if (piece.edge.arc) {
        torus_crossings(line, piece.edge, cuts);
      } else {
        cone_crossings(line, piece.edge, cuts);
      }
    }
  }

 private:
  /// dv r = dv u0 + du (z - v0), squared.
  static void cone_crossings(const Line& line, const ProfileEdge& e, std::vector<double>& cuts) {
    const Vector3& o = line.origin;
    const Vector3& d = line.direction;
    const double du = e.u1 - e.u0, dv = e.v1 - e.v0;
    if (dv == 0) {
      if (d[2] != 0) cuts.push_back((e.v0 - o[2]) / d[2]);
      return;
    }
    const double g0 = dv * e.u0 + du * (o[2] - e.v0), g1 = du * d[2];
    const double a = dv * dv * (d[0] * d[0] + d[1] * d[1]) - g1 * g1;
    const double b = dv * dv * (o[0] * d[0] + o[1] * d[1]) - g0 * g1;  // half the linear term
    const double c = dv * dv * (o[0] * o[0] + o[1] * o[1]) - g0 * g0;
    const double discriminant = b * b - a * c;
    if (discriminant < 0) return;
    const double q = -(b + (b < 0 ? -1 : 1) * std::sqrt(discriminant));
    if (a != 0 && std::isfinite(q / a)) cuts.push_back(q / a);
    if (q != 0 && std::isfinite(c / q)) cuts.push_back(c / q);
  }

  /// (|p|^2 + r_c^2 - R^2)^2 = 4 r_c^2 (x^2 + y^2), p from the torus's centre, the parameter from
  /// the line's nearest point to it and in units of its reach.
  static void torus_crossings(const Line& line, const ProfileEdge& e, std::vector<double>& cuts) {
    const Vector3& d = line.direction;
    const double dd = dot(d, d);
    Vector3 o = line.origin;
    o[2] -= e.v_centre;
    const double nearest = -dot(o, d) / dd;
    o = plus(o, nearest, d);
    const double reach = (std::abs(e.u_centre) + e.radius) * (1 + 1e-9);
    if (dot(o, o) > reach * reach) return;
    const double unit = reach / std::sqrt(dd);
    const double k = dot(o, o) + e.u_centre * e.u_centre - e.radius * e.radius;
    const double f = 4 * e.u_centre * e.u_centre, q = reach * reach;
    const double a = (d[0] * d[0] + d[1] * d[1]) * unit * unit;
    const double b = (o[0] * d[0] + o[1] * d[1]) * unit;
    if (f == 0) {  // a sphere: the quartic would be a square, without sign changes
      if (k > 0) return;
      const double t = std::sqrt(-k / dd);
      cuts.insert(cuts.end(), {nearest - t, nearest + t});
      return;
    }
    const Quartic c{k * k - f * (o[0] * o[0] + o[1] * o[1]), -2 * f * b, 2 * q * k - f * a, 0,
                    q * q};
    const Roots roots = real_roots(c, 4);
    for (std::size_t n = 0; n < roots.count; ++n) cuts.push_back(nearest + unit * roots.x[n]);
  }

  std::optional<RoundForm> form_;
};

// --------------------------------------------------------------------------------------- extrusion

class ExtrudedSolid final : public SweptSolid {
 public:
  ExtrudedSolid(const Profile& profile, double height) : SweptSolid(profile), height_(height) {}

  using Solid::contains;

  bool contains(double x, double y, double z) const override {
    return z >= 0 && z <= height_ && curve_.contains(x, y);
  }

  double support(const Vector3& d) const override {
    return curve_.support(d[0], d[1]) + std::max(0.0, height_ * d[2]);
  }

  std::optional<VolumeMoments> moments() const override {
    const double h = curve_.moment(0, 0) < 0 ? -height_ : height_;
    VolumeMoments m;
    m.volume = h * curve_.moment(0, 0);
    m.first = {h * curve_.moment(1, 0), h * curve_.moment(0, 1), 0.5 * height_ * m.volume};
    m.second = {h * curve_.moment(2, 0),          h * curve_.moment(0, 2),
                height_ * height_ / 3 * m.volume, 0.5 * height_ * m.first[1],
                0.5 * height_ * m.first[0],       h * curve_.moment(1, 1)};
    return m;
  }

 protected:
  void crossings(const Line& line, std::vector<double>& cuts) const override {
    const Vector3& o = line.origin;
    const Vector3& d = line.direction;
    if (d[2] != 0) {
      cuts.push_back(-o[2] / d[2]);
      cuts.push_back((height_ - o[2]) / d[2]);
    }
    if (d[0] == 0 && d[1] == 0) return;
    for (const ProfileCurve::Piece& piece : curve_.pieces()) {
      const ProfileEdge& e = piece.edge;
      const double du = e.u1 - e.u0, dv = e.v1 - e.v0;
      const double slope = dv * d[0] - du * d[1];
      if (slope == 0) continue;
      cuts.push_back((du * (o[1] - e.v0) - dv * (o[0] - e.u0)) / slope);
    }
  }

 private:
  double height_;
};

}  // namespace

std::shared_ptr<const Solid> make_revolution(Profile profile) {
  double widest = 0;
  for (const ProfileEdge& e : profile) widest = std::max({widest, e.u0, e.u1});
  if (!(widest > 0)) throw std::invalid_argument("the revolved profile lies on the axis");
  for (const ProfileEdge& e : profile) {
    if (std::min(e.u0, e.u1) < 0) {
      throw std::invalid_argument("the revolved profile has corners at r < 0");
    }
  }
  return std::make_shared<RevolvedSolid>(profile);
}

std::shared_ptr<const Solid> make_extrusion(Profile profile, double height) {
  if (!(height > 0) || !std::isfinite(height)) {
    throw std::invalid_argument("the length of an extrusion must be positive and finite");
  }
  for (const ProfileEdge& e : profile) {
    if (e.arc) throw std::invalid_argument("an extruded profile has straight edges only");
  }
  return std::make_shared<ExtrudedSolid>(profile, height);
}

}  // namespace krater
