// SPDX-License-Identifier: GPL-3.0-or-later
// Lattices of a body's own: zones of more points, and lattices fitted to the body.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "geometry/seeds/light_points.hpp"
#include "krater/geometry/seeds/lattice.hpp"

namespace krater {
namespace {

struct Piece {
  Box box;
  std::array<int, 3> points;
};

/// The zone and its belts of fewer points, outermost first, on grid nodes.
std::vector<Piece> belts(const RefinedZone& zone, const LatticeOptions& options, int dimensions) {
  if (zone.falloff < 1) throw std::invalid_argument("the belts of a zone are a cell wide or more");
  int most = 0;
  for (int a = 0; a < dimensions; ++a) {
    const auto k = static_cast<std::size_t>(a);
    if (zone.points_per_direction[k] < 1) {
      throw std::invalid_argument("points_per_direction must be at least 1");
    }
    most = std::max(most, zone.points_per_direction[k] - options.points_per_direction[k]);
  }
  std::vector<Piece> list;
  for (int less = std::max(most - 1, 0); less >= 0; --less) {
    Piece belt{zone.box, zone.points_per_direction};
    for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions); ++k) {
      const double o = options.origin[k], h = options.cell, round_off = 1e-6;
      const double low = std::floor((zone.box.min[k] - o) / h + round_off) - less * zone.falloff;
      const double high = std::ceil((zone.box.max[k] - o) / h - round_off) + less * zone.falloff;
      belt.box.min[k] = o + h * low;
      belt.box.max[k] = o + h * high;
      belt.points[k] = std::max(belt.points[k] - less, options.points_per_direction[k]);
    }
    list.push_back(belt);
  }
  return list;
}

/// What of the pieces lies in the belt gets its points where they are more; the rest of each piece
/// is cut into at most two boxes an axis.
std::vector<Piece> refined(const std::vector<Piece>& pieces, const Piece& belt, int dimensions) {
  std::vector<Piece> out;
  for (Piece piece : pieces) {
    if (is_empty(intersection(piece.box, belt.box, dimensions), dimensions)) {
      out.push_back(piece);
      continue;
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions); ++k) {
      if (belt.box.min[k] > piece.box.min[k]) {
        Piece rest = piece;
        rest.box.max[k] = piece.box.min[k] = belt.box.min[k];
        out.push_back(rest);
      }
      if (belt.box.max[k] < piece.box.max[k]) {
        Piece rest = piece;
        rest.box.min[k] = piece.box.max[k] = belt.box.max[k];
        out.push_back(rest);
      }
      piece.points[k] = std::max(piece.points[k], belt.points[k]);
    }
    out.push_back(piece);
  }
  return out;
}

void add(FillReport& sum, const FillReport& piece) {
  sum.measure_points += piece.measure_points;
  sum.count += piece.count;
  sum.slivers_merged += piece.slivers_merged;
  sum.slivers_kept += piece.slivers_kept;
}

std::vector<SeedPoint> fill_zones(const Solid& solid, Frame frame, const LatticeOptions& options,
                                  const std::vector<RefinedZone>& zones, const Box& domain,
                                  FillReport& report) {
  const int dimensions = dimension(frame);
  std::vector<Piece> pieces{{domain, options.points_per_direction}};
  for (const RefinedZone& zone : zones) {
    for (const Piece& belt : belts(zone, options, dimensions)) {
      pieces = refined(pieces, belt, dimensions);
    }
  }
  std::vector<SeedPoint> points;
  std::vector<double> full;
  double widest = 0;
  for (const Piece& piece : pieces) {
    LatticeOptions local = options;
    local.points_per_direction = piece.points;
    FillReport part;
    for (const SeedPoint& p : fill(solid, frame, local, piece.box, &part)) {
      points.push_back(p);
      full.push_back(fullness(p, frame, local));
    }
    widest = std::max(widest, widest_spacing(local, frame));
    add(report, part);
  }
  // Slivers do not cross the sides of a piece; one that had nowhere to go became a light point.
  give_light_points(points, std::move(full), solid, frame, light_reach * widest);
  report.count = points.size();
  report.measure_exact = solid.measure(frame, domain);
  report.smallest_thickness_in_cells = solid.smallest_thickness(frame, domain) / options.cell;
  return points;
}

/// Spacings that divide the edges of the solid's bounding box, the box's corner as origin.
LatticeOptions fitted(const Box& extent, const LatticeOptions& options, double scale,
                      int dimensions) {
  LatticeOptions local = options;
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions); ++k) {
    const double length = extent.max[k] - extent.min[k];
    if (!std::isfinite(length)) {
      throw std::invalid_argument("a lattice cannot be fitted to a body without end");
    }
    const double s = options.cell / (scale * options.points_per_direction[k]);
    local.spacing[k] = length / std::max(1.0, std::round(length / s));
    local.origin[k] = extent.min[k];
  }
  local.cell = options.cell / scale;
  return local;
}

/// Points of the solid before it was turned, taken along.
std::vector<SeedPoint> fill_turned(const Solid& solid, const Affine& map,
                                   const LatticeOptions& options, FillReport& report) {
  double scale = 1;
  map.is_similarity(&scale);
  const Frame frame = Frame::cartesian_3d;
  const Box extent = solid.extent(frame);
  std::vector<SeedPoint> points =
      fill(solid, frame, fitted(extent, options, scale, 3), extent, &report);
  const double volume = scale * scale * scale;
  for (SeedPoint& p : points) {
    p.x = map.apply(p.x);
    p.measure *= volume;
    // Edges do not lie along the axes any more: a cube of the same volume stands for them.
    p.half_width.fill(0.5 * std::cbrt(p.measure));
  }
  report.measure_exact *= volume;
  report.measure_points *= volume;
  return points;
}

}  // namespace

std::vector<SeedPoint> fill_body(const Solid& solid, Frame frame, const LatticeOptions& options,
                                 const std::vector<RefinedZone>& zones, const Box& domain,
                                 FillReport* report) {
  FillReport local;
  FillReport& out = report ? *report : local;
  out = {};
  if (!options.fit_to_body) {
    if (zones.empty()) return fill(solid, frame, options, domain, report);
    solid.require(frame);
    return fill_zones(solid, frame, options, zones, domain, out);
  }
  if (!zones.empty()) {
    throw std::invalid_argument("a lattice fitted to the body has no zones of more points");
  }
  solid.require(frame);
  Affine map;
  const Solid* before = frame == Frame::cartesian_3d ? solid.unmapped(map) : nullptr;
  const bool turned = before != nullptr && map.linear != Affine{}.linear;
  if (!turned) {
    const int dimensions = dimension(frame);
    return fill(solid, frame, fitted(solid.extent(frame), options, 1, dimensions), domain, report);
  }
  if (!encloses(domain, solid.extent(frame))) {
    throw std::invalid_argument(
        "a lattice along the axes of a turned body needs all of the body inside the grid's box");
  }
  return fill_turned(*before, map, options, out);
}

}  // namespace krater
