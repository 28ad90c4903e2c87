// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/mesh_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace krater {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Where the edges cross z0 on axis `last`: both ends of those that lie in the plane.
std::vector<Triple> crossings(const BodyPoints& body, std::size_t last, double z0) {
  std::vector<Triple> out;
  for (const auto& [a, b] : body.edges) {
    const double below = a[last] - z0, above = b[last] - z0;
    if (below * above > 0) continue;
    if (below == above) {
      out.insert(out.end(), {a, b});
      continue;
    }
    const double share = below / (below - above);
    Triple x{};
    for (std::size_t k = 0; k < 3; ++k) x[k] = a[k] + share * (b[k] - a[k]);
    out.push_back(x);
  }
  return out;
}

}  // namespace

std::array<double, 2> mesh_ends(const BodyPoints& body, int axis) {
  std::array<double, 2> ends{kInfinite, -kInfinite};
  for (const auto& edge : body.edges)
    for (const Triple& x : edge) {
      const double at = x[static_cast<std::size_t>(axis)];
      // Written so that a NaN stays.
      ends = {at >= ends[0] ? ends[0] : at, at <= ends[1] ? ends[1] : at};
    }
  return ends;
}

double mesh_diameter(const BodyPoints& body, Frame frame,
                     const std::array<std::optional<double>, 2>& middle, double z0) {
  const auto across = static_cast<std::size_t>(dimension(frame) - 1);
  const std::vector<Triple> section = crossings(body, across, z0);
  if (section.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::array<double, 2> centre{};
  for (std::size_t a = 0; a < across; ++a) {
    double low = kInfinite, high = -kInfinite;
    for (const Triple& x : section) {
      low = std::min(low, x[a]);
      high = std::max(high, x[a]);
    }
    centre[a] = middle[a] ? *middle[a] : 0.5 * (low + high);
  }
  double furthest = 0;
  for (const Triple& x : section)
    furthest = std::max(furthest, across == 1 ? std::abs(x[0] - centre[0])
                                              : std::hypot(x[0] - centre[0], x[1] - centre[1]));
  return 2 * furthest;
}

std::vector<double> mesh_heights(const BodyPoints& body, int axis, double low, double high) {
  std::vector<double> out{low, high};
  for (const auto& edge : body.edges)
    for (const Triple& x : edge) {
      const double at = x[static_cast<std::size_t>(axis)];
      if (at > low && at < high) out.push_back(at);
    }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace krater
