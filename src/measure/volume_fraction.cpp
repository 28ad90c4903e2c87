// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/measure/volume_fraction.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace krater {

namespace {

constexpr int kClear = 2;   // nodes inside the 1/2 node from which phi is full: support 3/2 + 1/2
constexpr int kInside = 5;  // nodes over which f is averaged
constexpr double kRising =
    1.02;  // phi still rises inwards: a leaning surface spreads phi over more nodes
constexpr double kFilled =
    0.85;  // a line filled less is at the body's side: points there were cut and merged
constexpr double kTouching =
    0.9;  // phi / full on a plane that the body touches: a gap below 0.07 a
constexpr double kSteepest =
    2;  // lean of a surface that is believed: a thin sheet along a wall is no flare

// Mean distance from a wall, in spacings, seen by the folded kernel of the node on it and of the
// next one.
constexpr double kMeanOnWall = 13.0 / 32.0, kMeanBesideWall = 1.0 + 1.0 / 192.0;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Node i, outwards; an end node on a closed plane stands for half a cell.
double cells(const FractionLine& line, int i) {
  const bool half =
      (i == 0 && line.closed_inner) || (i + 1 == std::ssize(line.phi) && line.closed_outer);
  return half ? 0.5 : 1.0;
}

struct Moments {
  double zero = 0, first = 0, second = 0;

  void add(const FractionLine& line, int i, double weight) {
    zero += weight * line.phi[index(i)];
    if (line.first.empty()) return;
    first += weight * line.first[index(i)];
    second += weight * line.second[index(i)];
  }
};

/// Content of the line beyond x_c as a length: constant, or the value at t of the fitted straight
/// line.
double content(const Moments& beyond, const Moments& inside) {
  const double determinant = inside.zero * inside.second - inside.first * inside.first;
  // One row of points in the band: it says nothing about the lean.
  if (determinant <= 0.02 * inside.zero * inside.second) return beyond.zero / inside.zero;
  const double lean = (beyond.first * inside.zero - beyond.zero * inside.first) / determinant;
  return (beyond.zero - std::clamp(lean, -kSteepest, kSteepest) * inside.first) / inside.zero;
}

/// A part with no node clear of both surfaces: thickness by content, place by its centre. Folding
/// spoils the centre of a part on a plane, which is taken to touch it.
LineEdge thin_edge(const FractionLine& line, int from, int to) {
  double sum = 0, moment = 0, fullest = 0;
  for (int i = std::max(0, from - kClear); i <= to; ++i) {
    const double part = cells(line, i) * line.phi[index(i)] / line.full;
    sum += part;
    moment += part * i;
    fullest = std::max(fullest, line.phi[index(i)] / line.full);
  }
  const bool on_plane = from == 0 && line.closed_inner;
  return {line.spacing * (on_plane ? sum : moment / sum + sum / 2), fullest};
}

}  // namespace

double bspline(double u) {
  u = std::abs(u);
  if (u < 0.5) return 0.75 - u * u;
  return u < 1.5 ? 0.5 * (1.5 - u) * (1.5 - u) : 0.0;
}

NodeWeights node_weights_at_end(const MeasuringAxis& axis, double u, int nearest) {
  const int last = axis.count - 1;
  const double f = u - nearest;
  NodeWeights result{};
  if (std::abs(f) <= 0.5) {
    result.weight = {0.5 * (0.5 - f) * (0.5 - f), 0.75 - f * f, 0.5 * (0.5 + f) * (0.5 + f)};
  } else {  // beyond the ends
    for (int n = 0; n < 3; ++n) result.weight[index(n)] = bspline(u - (nearest - 1 + n));
  }
  result.index = {nearest - 1, nearest, nearest + 1};
  for (int n = 0; n < 3; ++n) {
    int& i = result.index[index(n)];
    // The image of a point beyond the plane: what it gives to a node is what the point gives to the
    // node's image.
    if ((i == 0 && axis.closed[0]) || (i == last && axis.closed[1])) result.weight[index(n)] *= 2;
    if (i < 0) i = -i;
    if (i > last) i = 2 * last - i;
    i = std::clamp(i, 0, last);
  }
  return result;
}

MeasuringAxis measuring_axis(double spacing, std::array<double, 2> domain,
                             std::array<bool, 2> closed, std::array<double, 2> occupied) {
  const double length = domain[1] - domain[0];
  const double cells = std::max(1.0, std::round(length / spacing));
  MeasuringAxis axis;
  axis.spacing = length / cells;
  double first = std::floor((occupied[0] - domain[0]) / axis.spacing) - kClear;
  double last = std::ceil((occupied[1] - domain[0]) / axis.spacing) + kClear;
  // A fragment far outside the domain must not cost memory.
  first = std::clamp(first, -2.0 * kClear, cells);
  last = std::clamp(last, first + 1, cells + 2.0 * kClear);
  axis.closed = {closed[0] && first <= 0, closed[1] && last >= cells};
  if (axis.closed[0]) first = 0;
  if (axis.closed[1]) last = cells;
  axis.origin = domain[0] + first * axis.spacing;
  axis.count = static_cast<int>(last - first) + 1;
  return axis;
}

namespace {

std::optional<LineEdge> unbounded_edge(const FractionLine& line) {
  const double half = line.full / 2;
  const int count = static_cast<int>(line.phi.size());
  int last = count - 1;
  while (last >= 0 && line.phi[index(last)] < half) --last;
  if (last < 0) return std::nullopt;
  int from = last;
  while (from > 0 && line.phi[index(from - 1)] >= half) --from;

  const int beyond_last = std::min(count - 1, last + kClear);
  // Less than full on the plane: a gap narrower than the kernel, with no inside beside it.
  const bool mirrored = from == 0 && line.closed_inner && line.phi[0] > kTouching * line.full;
  const int deepest = mirrored ? std::clamp(last - kClear, 0, line.trusted) : from + kClear;
  if (!mirrored && last - kClear < deepest) {
    const LineEdge thin = thin_edge(line, from, beyond_last);
    if (line.closed_outer && last == count - 1) return LineEdge{line.spacing * last, thin.fill};
    return thin;
  }

  int cut = std::max(last - kClear, deepest);
  while (cut > deepest && line.phi[index(cut - 1)] > kRising * line.phi[index(cut)]) --cut;
  Moments inside, beyond;
  const int innermost = std::max(deepest, cut - kInside + 1);
  for (int i = innermost; i <= cut; ++i) inside.add(line, i, 1.0 / (cut - innermost + 1));
  for (int i = cut + 1; i <= beyond_last; ++i) beyond.add(line, i, cells(line, i));
  const double e = line.spacing * (cut + 0.5 + content(beyond, inside));
  return LineEdge{line.closed_outer ? std::min(e, line.spacing * (count - 1)) : e,
                  inside.zero / line.full};
}

}  // namespace

std::optional<LineEdge> outer_edge(const FractionLine& line) {
  int last = static_cast<int>(line.phi.size()) - 1;
  while (last >= 0 && line.phi[index(last)] <= 0) --last;
  if (last < 0) return std::nullopt;  // a gap: of a band of it nothing is full, neither
  std::optional<LineEdge> found = unbounded_edge(line);
  if (!found) return found;
  // Content is a length only where phi is at most about 1; no point reaches beyond its last node.
  found->place = std::min(found->place, line.spacing * last);
  return found;
}

VolumeFraction::VolumeFraction(int dimension, const std::array<MeasuringAxis, 3>& axes,
                               const std::vector<std::array<double, 3>>& x,
                               const std::vector<double>& section)
    : dimension_(dimension), axes_(axes) {
  double cell = 1;
  for (int d = 0; d < 3; ++d) {
    if (d >= dimension_) axes_[index(d)] = {.count = 1};
    cell *= axis(d).spacing;
  }
  phi_.assign(index(axes_[0].count) * index(axes_[1].count) * index(axes_[2].count), 0.0);
  if (dimension_ == 2)
    add_points<2>(x, section, cell);
  else
    add_points<3>(x, section, cell);
}

/// Every history row pays for this once per point and node. No loops: as loops over arrays of
/// weights it takes twice as long.
template <int Dim>
void VolumeFraction::add_points(const std::vector<std::array<double, 3>>& x,
                                const std::vector<double>& section, double cell) {
  const std::size_t stride = index(axes_[Dim - 1].count), lines = index(axes_[1].count);
  double* const phi = phi_.data();
  for (std::size_t p = 0; p < x.size(); ++p) {
    const NodeWeights first = node_weights(axis(0), x[p][0]);
    const NodeWeights across = Dim == 3 ? node_weights(axis(1), x[p][1]) : NodeWeights{};
    const NodeWeights along = node_weights(axis(Dim - 1), x[p][Dim - 1]);
    const auto add_row = [&](std::size_t line, double share) {
      double* const row = phi + line * stride;
      row[along.index[0]] += share * along.weight[0];
      row[along.index[1]] += share * along.weight[1];
      row[along.index[2]] += share * along.weight[2];
    };
    const auto add_plane = [&](int i, double share) {
      if constexpr (Dim == 2) {
        add_row(index(i), share);
      } else {
        add_row(index(i) * lines + index(across.index[0]), share * across.weight[0]);
        add_row(index(i) * lines + index(across.index[1]), share * across.weight[1]);
        add_row(index(i) * lines + index(across.index[2]), share * across.weight[2]);
      }
    };
    const double filled = section[p] / cell;
    add_plane(first.index[0], filled * first.weight[0]);
    add_plane(first.index[1], filled * first.weight[1]);
    add_plane(first.index[2], filled * first.weight[2]);
  }
}

std::size_t VolumeFraction::offset(const std::array<int, 3>& i) const {
  return (index(i[0]) * index(axes_[1].count) + index(i[1])) * index(axes_[2].count) + index(i[2]);
}

/// Edge of the line through `node` (its entry along `axis` does not matter), as a position.
std::optional<LineEdge> VolumeFraction::edge(int axis, int side, std::array<int, 3> node) const {
  const MeasuringAxis& a = axes_[index(axis)];
  FractionLine line;
  line.spacing = a.spacing;
  line.closed_inner = a.closed[index(1 - side)];
  line.closed_outer = a.closed[index(side)];
  line.phi.resize(index(a.count));
  for (int i = 0; i < a.count; ++i) {
    node[index(axis)] = side == 1 ? i : a.count - 1 - i;
    line.phi[index(i)] = phi_[offset(node)];
  }
  std::optional<LineEdge> found = outer_edge(line);
  if (found)
    found->place = side == 1 ? a.origin + found->place : a.node(a.count - 1) - found->place;
  return found;
}

VolumeFraction::Surface VolumeFraction::surface(int axis, int side) const {
  Surface result;
  result.lines = {axes_[0].count, axes_[1].count, axes_[2].count};
  result.lines[index(axis)] = 1;
  for (int i = 0; i < result.lines[0]; ++i) {
    for (int j = 0; j < result.lines[1]; ++j) {
      for (int k = 0; k < result.lines[2]; ++k) result.edges.push_back(edge(axis, side, {i, j, k}));
    }
  }
  return result;
}

/// On a wall the folded kernel averages the edge over heights of mean kMeanOnWall, and would miss
/// 0.4 a of a flare. The straight line through this edge and that of the next line, each at its
/// mean height, gives the edge on the wall.
double VolumeFraction::extrapolated(const Surface& surface, const std::array<int, 3>& line,
                                    const Walls& walls) const {
  const double e = surface.at(line)->place;
  double change = 0;
  for (int d = 0; d < dimension_; ++d) {
    const MeasuringAxis& a = axes_[index(d)];
    for (int s = 0; s < 2; ++s) {
      if (surface.lines[index(d)] < 2 || !a.closed[index(s)] || !walls[index(d)][index(s)])
        continue;
      if (line[index(d)] != (s == 0 ? 0 : a.count - 1)) continue;
      std::array<int, 3> next = line;
      next[index(d)] += s == 0 ? 1 : -1;
      const std::optional<LineEdge>& beside = surface.at(next);
      if (!beside) continue;
      const double lean = (e - beside->place) / (a.spacing * (kMeanBesideWall - kMeanOnWall));
      change += std::clamp(lean, -kSteepest, kSteepest) * a.spacing * kMeanOnWall;
    }
  }
  return e + change;
}

/// Change by the mean (1/4 1/2 1/4) with the lines beside it, so that the furthest of many lines is
/// not the noisiest: by content, along directions in which the surface does not flare, where they
/// belong to the same surface.
double VolumeFraction::smoothing(const Surface& surface, const std::array<int, 3>& line,
                                 const Walls& walls) const {
  double change = 0;
  const double e = surface.at(line)->place;
  for (int d = 0; d < dimension_; ++d) {
    const MeasuringAxis& a = axes_[index(d)];
    const int count = surface.lines[index(d)];
    if (count < 2 || (a.closed[0] && walls[index(d)][0]) || (a.closed[1] && walls[index(d)][1]))
      continue;
    double sum = 2 * surface.at(line)->fill, moment = 0;
    for (const int step : {-1, 1}) {
      std::array<int, 3> beside = line;
      beside[index(d)] += step;
      if (beside[index(d)] < 0 || beside[index(d)] >= count) beside[index(d)] -= 2 * step;
      const std::optional<LineEdge>& other = surface.at(beside);
      if (!other || std::abs(other->place - e) > a.spacing) continue;
      sum += other->fill;
      moment += other->fill * (other->place - e);
    }
    change += moment / sum;
  }
  return change;
}

VolumeFraction::Outermost VolumeFraction::outermost(int axis, int side, const Walls& walls) const {
  Outermost out;
  const auto extend = [side](double& furthest, double e) {
    if (std::isnan(furthest) || (side == 1 ? e > furthest : e < furthest)) furthest = e;
  };
  const Surface all = surface(axis, side);
  for (int i = 0; i < all.lines[0]; ++i) {
    for (int j = 0; j < all.lines[1]; ++j) {
      for (int k = 0; k < all.lines[2]; ++k) {
        const std::array<int, 3> line{i, j, k};
        const std::optional<LineEdge>& found = all.at(line);
        if (!found) continue;
        const double e = extrapolated(all, line, walls) + smoothing(all, line, walls);
        extend(out.of_any, e);
        if (found->fill >= kFilled) extend(out.of_filled, e);
      }
    }
  }
  return out;
}

}  // namespace krater
