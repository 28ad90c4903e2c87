// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/measure/openings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "krater/measure/measure_surface.hpp"

namespace krater {

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double kFilled = 0.85;  // a line filled less, beside the outside, is the body's own side

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// The node lines along the last axis; ny = 1 in the 2D frames.
struct Lines {
  std::array<MeasuringAxis, 2> axes;
  int nx = 1, ny = 1;

  std::size_t count() const { return index(nx) * index(ny); }
  std::size_t at(int i, int j) const { return index(i) * index(ny) + index(j); }

  /// Call visit(line) for the four lines beside one.
  template <class V>
  void beside(std::size_t line, const V& visit) const {
    const int i = static_cast<int>(line) / ny, j = static_cast<int>(line) % ny;
    if (i > 0) visit(at(i - 1, j));
    if (i + 1 < nx) visit(at(i + 1, j));
    if (j > 0) visit(at(i, j - 1));
    if (j + 1 < ny) visit(at(i, j + 1));
  }
};

Lines lines_of(const VolumeFraction& fraction, const MeasureContext& context) {
  const bool space = context.frame == Frame::cartesian_3d;
  Lines lines{{fraction.axis(0), space ? fraction.axis(1) : MeasuringAxis{}}};
  lines.nx = fraction.axis(0).count;
  if (space) lines.ny = fraction.axis(1).count;
  return lines;
}

/// The lines of `open` connected with `seeds`.
std::vector<bool> flood(const Lines& lines, const std::vector<bool>& open,
                        std::vector<std::size_t> seeds) {
  std::vector<bool> reached(lines.count(), false);
  for (const std::size_t seed : seeds) reached[seed] = true;
  while (!seeds.empty()) {
    const std::size_t line = seeds.back();
    seeds.pop_back();
    lines.beside(line, [&](std::size_t next) {
      if (!open[next] || reached[next]) return;
      reached[next] = true;
      seeds.push_back(next);
    });
  }
  return reached;
}

/// The empty lines around the body: those connected with the rim of the lines, symmetry planes and
/// walls apart.
std::vector<bool> outside(const Lines& lines, const std::vector<bool>& empty) {
  std::vector<std::size_t> rim;
  const auto rim_line = [&](int i, int j) {
    if (empty[lines.at(i, j)]) rim.push_back(lines.at(i, j));
  };
  for (int j = 0; j < lines.ny; ++j) {
    if (!lines.axes[0].closed[0]) rim_line(0, j);
    if (!lines.axes[0].closed[1]) rim_line(lines.nx - 1, j);
  }
  for (int i = 0; lines.ny > 1 && i < lines.nx; ++i) {
    if (!lines.axes[1].closed[0]) rim_line(i, 0);
    if (!lines.axes[1].closed[1]) rim_line(i, lines.ny - 1);
  }
  return flood(lines, empty, rim);
}

/// Part of a triangle, area 1, where the linear function through the corners' values is positive.
double positive_part(std::array<double, 3> f) {
  std::sort(f.begin(), f.end());
  if (f[2] <= 0) return 0;
  if (f[0] >= 0) return 1;
  if (f[1] <= 0) return f[2] / (f[2] - f[1]) * (f[2] / (f[2] - f[0]));
  return 1 - f[0] / (f[0] - f[1]) * (f[0] / (f[0] - f[2]));
}

/// Equivalent diameter of the part of f > 0 whose lines are `inside`, with its mirror images.
double area_diameter(const Lines& lines, std::vector<double> f, const std::vector<bool>& inside,
                     const MeasureContext& context) {
  for (std::size_t line = 0; line < f.size(); ++line)
    if (!inside[line] && f[line] > 0) f[line] = -f[line];  // another opening
  double squares = 0;
  for (int i = 0; i + 1 < lines.nx; ++i)
    for (int j = 0; j + 1 < lines.ny; ++j) {
      const double a = f[lines.at(i, j)], b = f[lines.at(i + 1, j)], c = f[lines.at(i + 1, j + 1)],
                   d = f[lines.at(i, j + 1)];
      // Both diagonals, so that no direction is preferred.
      squares += 0.25 * (positive_part({a, b, c}) + positive_part({a, c, d}) +
                         positive_part({a, b, d}) + positive_part({b, c, d}));
    }
  double area = squares * lines.axes[0].spacing * lines.axes[1].spacing;
  for (int d = 0; d < 2; ++d)
    for (int side = 0; side < 2; ++side) {
      if (!is_symmetry(context, d, side) || !lines.axes[index(d)].closed[index(side)]) continue;
      const int across = d == 0 ? lines.ny : lines.nx;
      const int at = side == 0 ? 0 : (d == 0 ? lines.nx : lines.ny) - 1;
      bool touches = false;
      for (int n = 0; n < across; ++n)
        touches = touches || inside[d == 0 ? lines.at(at, n) : lines.at(n, at)];
      if (touches) area *= 2;
    }
  return 2 * std::sqrt(area / std::numbers::pi);
}

/// Depth of every line below the face [m]: inf where the body is perforated, -inf outside of it.
std::vector<double> depths(const VolumeFraction& fraction, const Lines& lines,
                           const MeasureContext& context, int side, double face) {
  const VolumeFraction::Surface surface = fraction.surface(dimension(context.frame) - 1, side);
  std::vector<bool> empty(lines.count());
  for (std::size_t line = 0; line < lines.count(); ++line) empty[line] = !surface.edges[line];
  const std::vector<bool> out = outside(lines, empty);
  std::vector<double> result;
  for (std::size_t line = 0; line < lines.count(); ++line) {
    const std::optional<LineEdge>& edge = surface.edges[line];
    bool at_side = out[line];
    if (edge && edge->fill < kFilled)
      lines.beside(line, [&](std::size_t n) { at_side = at_side || out[n]; });
    const double depth = edge ? (side == 1 ? face - edge->place : edge->place - face) : inf;
    result.push_back(at_side ? -inf : depth);
  }
  return result;
}

/// phi of every line at the height z, linear between nodes.
std::vector<double> fractions_at(const VolumeFraction& fraction, const Lines& lines,
                                 const MeasureContext& context, double z) {
  const bool space = context.frame == Frame::cartesian_3d;
  const MeasuringAxis& axis = fraction.axis(space ? 2 : 1);
  const double u = std::clamp((z - axis.origin) / axis.spacing, 0.0, axis.count - 1.0);
  const int below = std::min(static_cast<int>(u), axis.count - 2);
  const double share = u - below;
  std::vector<double> result;
  for (int i = 0; i < lines.nx; ++i)
    for (int j = 0; j < lines.ny; ++j) {
      const double low = space ? fraction.at(i, j, below) : fraction.at(i, below);
      const double high = space ? fraction.at(i, j, below + 1) : fraction.at(i, below + 1);
      result.push_back((1 - share) * low + share * high);
    }
  return result;
}

/// Where f vanishes between line i and the next one outwards (step +1 or -1), from i.
double crossing(const Lines& lines, const std::vector<double>& f, int i, int step) {
  const MeasuringAxis& axis = lines.axes[0];
  if (i + step < 0 || i + step >= lines.nx) return axis.node(i);
  const double here = f[index(i)], next = f[index(i + step)];
  return axis.node(i) + step * axis.spacing * here / (here - next);
}

/// 2D frames: the opening that holds line `deepest`.
double width(const Lines& lines, const std::vector<double>& f, int deepest,
             const MeasureContext& context) {
  int left = deepest, right = deepest;
  while (left > 0 && f[index(left - 1)] > 0) --left;
  while (right + 1 < lines.nx && f[index(right + 1)] > 0) ++right;
  const double low = crossing(lines, f, left, -1), high = crossing(lines, f, right, 1);
  if (context.frame == Frame::axisymmetric) return 2 * high;
  if (left == 0 && is_symmetry(context, 0, 0)) return 2 * (high - context.min[0]);
  if (right == lines.nx - 1 && is_symmetry(context, 0, 1)) return 2 * (context.max[0] - low);
  return high - low;
}

}  // namespace

double crater_depth(const BodyPoints& body, const MeasureContext& context, int side, double face) {
  const VolumeFraction fraction = volume_fraction(body, context, true);
  const std::vector<double> depth =
      depths(fraction, lines_of(fraction, context), context, side, face);
  const double deepest = *std::max_element(depth.begin(), depth.end());
  return std::isfinite(deepest) ? deepest : std::numeric_limits<double>::quiet_NaN();
}

double crater_diameter(const BodyPoints& body, const MeasureContext& context, int side, double face,
                       double level) {
  const VolumeFraction fraction = volume_fraction(body, context, true);
  const Lines lines = lines_of(fraction, context);
  const std::vector<double> depth = depths(fraction, lines, context, side, face);
  const auto deepest = std::max_element(depth.begin(), depth.end());
  if (!(*deepest > level)) return 0;
  std::vector<double> f =
      fractions_at(fraction, lines, context, side == 1 ? face - level : face + level);
  // Near the face no line is full: half of what the fullest holds there.
  const double half = *std::max_element(f.begin(), f.end()) / 2;
  std::vector<bool> open;
  for (std::size_t line = 0; line < f.size(); ++line) {
    f[line] = half - f[line];
    open.push_back(f[line] > 0 && depth[line] > -inf);
  }
  const auto seed = static_cast<std::size_t>(deepest - depth.begin());
  if (!open[seed]) return 0;
  if (lines.ny == 1) return width(lines, f, static_cast<int>(seed), context);
  return area_diameter(lines, f, flood(lines, open, {seed}), context);
}

double hole_diameter(const BodyPoints& body, const MeasureContext& context) {
  if (context.frame == Frame::axisymmetric)
    return 2 * std::max(0.0, outermost(body, context, 0, 0));
  const VolumeFraction fraction = volume_fraction(body, context, true);
  const Lines lines = lines_of(fraction, context);
  std::vector<double> f;
  std::vector<bool> open;
  for (int i = 0; i < lines.nx; ++i)
    for (int j = 0; j < lines.ny; ++j) {
      double fullest = 0;
      for (int k = 0; k < fraction.axis(2).count; ++k)
        fullest = std::max(fullest, fraction.at(i, j, k));
      f.push_back(0.5 - fullest);
      open.push_back(fullest < 0.5);
    }
  const std::vector<bool> out = outside(lines, open);
  std::vector<bool> seen = out;
  double largest = 0;
  for (std::size_t line = 0; line < lines.count(); ++line) {
    if (!open[line] || seen[line]) continue;
    const std::vector<bool> hole = flood(lines, open, {line});
    for (std::size_t n = 0; n < lines.count(); ++n)
      if (hole[n]) seen[n] = true;
    largest = std::max(largest, area_diameter(lines, f, hole, context));
  }
  return largest;
}

}  // namespace krater
