// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/geometry/seeds/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>

#include "geometry/seeds/lattice_filler.hpp"
#include "geometry/seeds/light_points.hpp"

namespace krater {
namespace {

/// splitmix64 (Steele, Lea, Flood 2014): a number of [-1, 1) from a counter, the same on every
/// machine.
double symmetric_random(std::uint64_t counter) {
  std::uint64_t z = counter + 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  z ^= z >> 31;
  return std::ldexp(static_cast<double>(z >> 11), -52) - 1;
}

/// Points that would leave the body or the domain stay where they are.
void shake(std::vector<SeedPoint>& points, const Solid& solid, Frame frame,
           const LatticeOptions& options, const Box& domain) {
  std::array<double, 3> amplitude{};
  for (std::size_t a = 0; a < 3; ++a) {
    amplitude[a] = options.spacing[a] > 0
                       ? options.jitter * options.spacing[a]
                       : options.jitter * options.cell / options.points_per_direction[a];
  }
  const auto dimensions = static_cast<std::size_t>(dimension(frame));
  for (std::size_t n = 0; n < points.size(); ++n) {
    std::array<double, 3> x = points[n].x;
    for (std::size_t a = 0; a < dimensions; ++a) {
      x[a] += amplitude[a] * symmetric_random(options.seed * 0x2545f4914f6cdd1dULL + 3 * n + a);
    }
    // Far nearer to the axis V/r would be that of another ring.
    const bool on_axis_side = frame != Frame::axisymmetric || x[0] > 0.5 * points[n].x[0];
    if (on_axis_side && encloses(domain, x, dimension(frame)) && solid.contains(frame, x)) {
      points[n].x = x;
    }
  }
}

/// Neumaier's compensated sum: the report's figure is free of its own round-off.
double total_measure(const std::vector<SeedPoint>& points) {
  double sum = 0, lost = 0;
  for (const SeedPoint& point : points) {
    const double next = sum + point.measure;
    lost += std::abs(sum) >= point.measure ? (sum - next) + point.measure
                                           : (point.measure - next) + sum;
    sum = next;
  }
  return sum + lost;
}

}  // namespace

VolumeMoments moments_of(const std::vector<SeedPoint>& points, Frame frame) {
  VolumeMoments sum;
  for (const SeedPoint& p : points) {
    if (frame != Frame::axisymmetric) {
      add_point(sum, p.measure, to_space(frame, p.x));
      continue;
    }
    add_point(sum, p.measure, {0, 0, p.x[1]});
    sum.second[0] += 0.5 * p.measure * p.x[0] * p.x[0];
  }
  if (frame == Frame::axisymmetric) sum.second[1] = sum.second[0];
  if (frame == Frame::plane_strain) sum.second[1] = sum.volume / 12;
  return sum;
}

std::vector<SeedPoint> fill(const Solid& solid, Frame frame, const LatticeOptions& options,
                            const Box& domain, FillReport* report) {
  solid.require(frame);
  if (!(options.cell > 0) || !std::isfinite(options.cell)) {
    throw std::invalid_argument("the grid's cell must be positive and finite");
  }
  for (int a = 0; a < dimension(frame); ++a) {
    if (options.points_per_direction[static_cast<std::size_t>(a)] < 1) {
      throw std::invalid_argument("points_per_direction must be at least 1");
    }
  }
  if (!(options.jitter >= 0)) throw std::invalid_argument("jitter must not be negative");
  FillReport local;
  FillReport& out = report ? *report : local;
  out = {};
  Filler filler(solid, frame, options, domain);
  std::vector<SeedPoint> points = filler.run(out);
  if (out.slivers_kept > 0) {  // all other points are half full or more
    std::vector<double> full;
    for (const SeedPoint& p : points) full.push_back(fullness(p, frame, options));
    const std::size_t given = give_light_points(points, std::move(full), solid, frame,
                                                light_reach * widest_spacing(options, frame));
    out.slivers_merged += given;
    out.slivers_kept -= std::min(given, out.slivers_kept);
  }
  if (options.jitter > 0) shake(points, solid, frame, options, filler.region());
  out.count = points.size();
  if (report) {
    out.measure_exact = solid.measure(frame, domain);
    out.measure_points = total_measure(points);
    out.smallest_thickness_in_cells = solid.smallest_thickness(frame, domain) / options.cell;
  }
  return points;
}

}  // namespace krater
