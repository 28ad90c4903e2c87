// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/geometry/solids/profile.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "geometry/solids/profile_curve.hpp"

namespace krater {

ProfileEdge ProfileEdge::straight(double u0, double v0, double u1, double v1) {
  ProfileEdge e;
  e.u0 = u0;
  e.v0 = v0;
  e.u1 = u1;
  e.v1 = v1;
  return e;
}

ProfileEdge ProfileEdge::circular(double u_centre, double v_centre, double radius, double start,
                                  double sweep) {
  ProfileEdge e;
  e.arc = true;
  e.u_centre = u_centre;
  e.v_centre = v_centre;
  e.radius = radius;
  e.start = start;
  e.sweep = sweep;
  e.u0 = u_centre + radius * std::cos(start);
  e.v0 = v_centre + radius * std::sin(start);
  e.u1 = u_centre + radius * std::cos(start + sweep);
  e.v1 = v_centre + radius * std::sin(start + sweep);
  return e;
}

namespace {

double turn(const std::array<double, 2>& a, const std::array<double, 2>& b,
            const std::array<double, 2>& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool on_edge(const std::array<double, 2>& a, const std::array<double, 2>& b,
             const std::array<double, 2>& p) {
  return std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) &&
         std::min(a[1], b[1]) <= p[1] && p[1] <= std::max(a[1], b[1]);
}

/// Closed edges with a point in common.
bool meet(const std::array<double, 2>& a, const std::array<double, 2>& b,
          const std::array<double, 2>& c, const std::array<double, 2>& d) {
  const double abc = turn(a, b, c), abd = turn(a, b, d), cda = turn(c, d, a), cdb = turn(c, d, b);
  if (((abc > 0 && abd < 0) || (abc < 0 && abd > 0)) &&
      ((cda > 0 && cdb < 0) || (cda < 0 && cdb > 0))) {
    return true;
  }
  return (abc == 0 && on_edge(a, b, c)) || (abd == 0 && on_edge(a, b, d)) ||
         (cda == 0 && on_edge(c, d, a)) || (cdb == 0 && on_edge(c, d, b));
}

std::string corner_name(std::size_t n) { return "corner " + std::to_string(n + 1); }

}  // namespace

Profile polygon_profile(const std::vector<std::array<double, 2>>& corners) {
  const std::size_t n = corners.size();
  if (n < 3) throw std::invalid_argument("a polygon needs three corners or more");
  double area = 0, size = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const auto& a = corners[i];
    const auto& b = corners[(i + 1) % n];
    if (!std::isfinite(a[0]) || !std::isfinite(a[1])) {
      throw std::invalid_argument(corner_name(i) + " of the polygon is not finite");
    }
    if (a == b) {
      throw std::invalid_argument(corner_name((i + 1) % n) +
                                  " of the polygon repeats the one before it (the last corner is "
                                  "joined to the first by itself)");
    }
    area += 0.5 * (a[0] * b[1] - b[0] * a[1]);
    size = std::max({size, std::abs(a[0] - corners[0][0]), std::abs(a[1] - corners[0][1])});
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j + 1 == n) continue;
      if (meet(corners[i], corners[i + 1], corners[j], corners[(j + 1) % n])) {
        throw std::invalid_argument("the polygon's edges after " + corner_name(i) + " and " +
                                    corner_name(j) + " cross or touch");
      }
    }
  }
  if (!(std::abs(area) > 1e-12 * size * size)) {
    throw std::invalid_argument("the polygon has no area");
  }
  Profile profile;
  for (std::size_t i = 0; i < n; ++i) {
    const auto& a = corners[i];
    const auto& b = corners[(i + 1) % n];
    profile.push_back(ProfileEdge::straight(a[0], a[1], b[0], b[1]));
  }
  return profile;
}

// ------------------------------------------------------------------------------------ ProfileCurve

ProfileCurve::ProfileCurve(const Profile& profile) {
  double size = 0;
  for (const ProfileEdge& e : profile) {
    size = std::max({size, std::abs(e.u0), std::abs(e.v0), e.arc ? e.radius : 0});
    add(e);
  }
  for (std::size_t n = 0; n < profile.size(); ++n) {
    const ProfileEdge& next = profile[(n + 1) % profile.size()];
    const double gap = std::hypot(profile[n].u1 - next.u0, profile[n].v1 - next.v0);
    if (!(gap <= 1e-9 * size)) throw std::invalid_argument("the profile is not closed");
  }
  // To the last bit: a gap of round-off would be a slit all through the body.
  for (std::size_t n = 0; n < pieces_.size(); ++n) {
    const ProfileEdge& next = pieces_[(n + 1) % pieces_.size()].edge;
    pieces_[n].edge.u1 = next.u0;
    pieces_[n].edge.v1 = next.v0;
  }
}

/// Arcs in pieces that are monotonic in u and v; pieces share their ends.
void ProfileCurve::add(const ProfileEdge& e) {
  if (!e.arc) {
    pieces_.push_back({e, 0, 0});
    return;
  }
  const double quarter = std::numbers::pi / 2;
  const double low = std::min(e.start, e.start + e.sweep);
  const double high = std::max(e.start, e.start + e.sweep);
  std::vector<double> cut{low};
  for (double k = std::floor(low / quarter) + 1; k * quarter < high - 1e-12; k += 1) {
    if (k * quarter > low + 1e-12) cut.push_back(k * quarter);
  }
  cut.push_back(high);
  if (e.sweep < 0) std::reverse(cut.begin(), cut.end());
  double u = e.u0, v = e.v0;
  for (std::size_t n = 0; n + 1 < cut.size(); ++n) {
    ProfileEdge piece =
        ProfileEdge::circular(e.u_centre, e.v_centre, e.radius, cut[n], cut[n + 1] - cut[n]);
    piece.u0 = u;
    piece.v0 = v;
    if (n + 2 == cut.size()) {
      piece.u1 = e.u1;
      piece.v1 = e.v1;
    }
    u = piece.u1;
    v = piece.v1;
    const double middle = 0.5 * (cut[n] + cut[n + 1]);
    pieces_.push_back(
        {piece, std::cos(middle) < 0 ? -1.0 : 1.0, std::sin(middle) < 0 ? -1.0 : 1.0});
  }
}

bool ProfileCurve::contains(double u, double v) const {
  bool in = false;
  for (const Piece& p : pieces_) {
    const ProfileEdge& e = p.edge;
    if ((e.v0 > v) == (e.v1 > v)) continue;
    double at = 0;
    if (e.arc) {
      const double dv = v - e.v_centre;
      at = e.u_centre + p.u_side * std::sqrt(std::max(0.0, (e.radius - dv) * (e.radius + dv)));
    } else {
      at = e.u0 + (v - e.v0) * ((e.u1 - e.u0) / (e.v1 - e.v0));
    }
    if (at > u) in = !in;
  }
  return in;
}

void ProfileCurve::crossings_along_v(double u, std::vector<double>& out) const {
  for (const Piece& p : pieces_) {
    const ProfileEdge& e = p.edge;
    if (e.u0 == e.u1 || u < std::min(e.u0, e.u1) || u > std::max(e.u0, e.u1)) continue;
    if (e.arc) {
      const double du = u - e.u_centre;
      out.push_back(e.v_centre +
                    p.v_side * std::sqrt(std::max(0.0, (e.radius - du) * (e.radius + du))));
    } else {
      out.push_back(e.v0 + (u - e.u0) * ((e.v1 - e.v0) / (e.u1 - e.u0)));
    }
  }
}

double ProfileCurve::support(double du, double dv) const {
  double best = -std::numeric_limits<double>::infinity();
  for (const Piece& p : pieces_) {
    const ProfileEdge& e = p.edge;
    best = std::max({best, du * e.u0 + dv * e.v0, du * e.u1 + dv * e.v1});
    if (!e.arc || du * p.u_side < 0 || dv * p.v_side < 0) continue;
    // The direction lies in the piece's quarter; in the piece itself?
    const double turn_to = std::atan2(dv, du) - e.start;
    const double within = std::remainder(turn_to - 0.5 * e.sweep, 2 * std::numbers::pi);
    if (std::abs(within) > 0.5 * std::abs(e.sweep)) continue;
    best = std::max(best, du * e.u_centre + dv * e.v_centre + e.radius * std::hypot(du, dv));
  }
  return best;
}

double ProfileCurve::moment(int a, int b) const {
  double sum = 0;
  for (const Piece& p : pieces_) {
    const ProfileEdge& e = p.edge;
    for (std::size_t k = 0; k < HalfGauss16::node.size(); ++k) {
      for (const double side : {-1.0, 1.0}) {
        const double s = 0.5 * (1 + side * HalfGauss16::node[k]);
        double u = e.u0 + s * (e.u1 - e.u0), v = e.v0 + s * (e.v1 - e.v0), dv = e.v1 - e.v0;
        if (e.arc) {
          const double angle = e.start + s * e.sweep;
          u = e.u_centre + e.radius * std::cos(angle);
          v = e.v_centre + e.radius * std::sin(angle);
          dv = e.radius * std::cos(angle) * e.sweep;
        }
        sum += 0.5 * HalfGauss16::weight[k] * dv * std::pow(u, a + 1) / (a + 1) * std::pow(v, b);
      }
    }
  }
  return sum;
}

}  // namespace krater
