// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/measure/measure_surface.hpp"

#include "measure/mesh_surface.hpp"
#include "measure/surface_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>

#include "krater/core/parallel.hpp"

namespace krater {

namespace {

constexpr double kTouching = 1.0;  // a body this near to a symmetry plane, in a, is cut by it

std::size_t index(int i) { return static_cast<std::size_t>(i); }

double volume(const BodyPoints& body, std::size_t p) { return body.mass[p] / body.density[p]; }

/// filled_volume() of many points.
class Filling {
 public:
  explicit Filling(const MeasureContext& context)
      : revolved_{context.frame == Frame::axisymmetric},
        a_{node_spacing(context)},
        cell_{a_ * a_ * (context.frame == Frame::cartesian_3d ? a_ : 1)} {}
  double operator()(const BodyPoints& body, std::size_t p) const {
    return std::min(volume(body, p), most(body.x[p][0]));
  }
  /// At a distance from the axis.
  double most(double r) const {
    return cell_ * (revolved_ ? 2 * std::numbers::pi * std::max(r, 0.2 * a_) : 1.0);
  }

 private:
  bool revolved_;
  double a_, cell_;
};

}  // namespace

std::array<double, 2> range(const BodyPoints& body, int axis) {
  if (body.memo && body.memo->bounds) return body.memo->bounds->all[index(axis)];
  std::array<double, 2> result{std::numeric_limits<double>::infinity(),
                               -std::numeric_limits<double>::infinity()};
  for (const Triple& x : body.x) {
    result = {std::min(result[0], x[index(axis)]), std::max(result[1], x[index(axis)])};
  }
  return result;
}

double section(double volume, double r, double share, double a) {
  return volume / (2 * std::numbers::pi * share * std::max(r, 0.2 * a));
}

MeasuringAxis body_axis(const BodyPoints& body, const MeasureContext& context, int d,
                        bool to_planes) {
  std::array<double, 2> occupied = range(body, d);
  if (to_planes && is_symmetry(context, d, 0)) occupied[0] = context.min[index(d)];
  if (to_planes && is_symmetry(context, d, 1)) occupied[1] = context.max[index(d)];
  return measuring_axis(node_spacing(context), {context.min[index(d)], context.max[index(d)]},
                        {is_closed(context, d, 0), is_closed(context, d, 1)}, occupied);
}

void copy_points_between(const BodyPoints& body, int axis, double low, double high,
                         BodyPoints& out) {
  out.x.clear();
  out.mass.clear();
  out.density.clear();
  for (std::size_t p = 0; p < body.count(); ++p) {
    const double x = body.x[p][index(axis)];
    if (!(x >= low && x <= high)) continue;
    out.x.push_back(body.x[p]);
    out.mass.push_back(body.mass[p]);
    out.density.push_back(body.density[p]);
  }
}

double node_spacing(const MeasureContext& context) {
  return 2 * context.h / context.points_per_direction;
}

double filled_volume(const BodyPoints& body, const MeasureContext& context, std::size_t p) {
  return Filling{context}(body, p);
}

double most_filled(const MeasureContext& context, double r) { return Filling{context}.most(r); }

bool is_closed(const MeasureContext& context, int axis, int side) {
  return context.boundary[index(axis)][index(side)] != BoundaryKind::open;
}

bool is_symmetry(const MeasureContext& context, int axis, int side) {
  return context.boundary[index(axis)][index(side)] == BoundaryKind::symmetry;
}

std::optional<int> cut_side(const BodyPoints& body, const MeasureContext& context, int axis) {
  const std::array<double, 2> occupied = range(body, axis);
  const double near = kTouching * node_spacing(context);
  if (is_symmetry(context, axis, 0) && occupied[0] - context.min[index(axis)] < near) return 0;
  if (is_symmetry(context, axis, 1) && context.max[index(axis)] - occupied[1] < near) return 1;
  return std::nullopt;
}

VolumeFraction volume_fraction(const BodyPoints& body, const MeasureContext& context,
                               bool to_planes) {
  std::array<MeasuringAxis, 3> axes;
  for (int d = 0; d < dimension(context.frame); ++d)
    axes[index(d)] = body_axis(body, context, d, to_planes);
  const Filling filling{context};
  const double a = node_spacing(context);
  std::vector<double> sections(body.count());
  for (std::size_t p = 0; p < body.count(); ++p) {
    const double V = filling(body, p);
    sections[p] = context.frame == Frame::axisymmetric ? section(V, body.x[p][0], 1, a) : V;
  }
  return {dimension(context.frame), axes, body.x, sections};
}

VolumeFraction::Walls walls_of(const MeasureContext& context) {
  VolumeFraction::Walls walls{};
  for (int d = 0; d < dimension(context.frame); ++d) {
    for (int s = 0; s < 2; ++s) {
      walls[index(d)][index(s)] = is_closed(context, d, s) && !is_symmetry(context, d, s);
    }
  }
  return walls;
}

namespace {

using Bounds = SurfaceMemo::Bounds;

constexpr std::array<double, 2> kNowhere{std::numeric_limits<double>::infinity(),
                                         -std::numeric_limits<double>::infinity()};

void widen(std::array<double, 2>& range, const std::array<double, 2>& by) {
  range = {std::min(range[0], by[0]), std::max(range[1], by[1])};
}

/// Of the points from `first` to `end`. Sparse ones fill the cell they lie in, however far their
/// neighbours are.
Bounds bounds_of(const BodyPoints& body, const Filling& filling, std::size_t first,
                 std::size_t end) {
  Bounds found{{kNowhere, kNowhere, kNowhere}, {kNowhere, kNowhere, kNowhere}};
  for (std::size_t p = first; p < end; ++p) {
    const Triple& x = body.x[p];
    for (std::size_t d = 0; d < 3; ++d) widen(found.all[d], {x[d], x[d]});
    if (filling(body, p) == volume(body, p)) continue;
    for (std::size_t d = 0; d < 3; ++d) widen(found.sparse[d], {x[d], x[d]});
  }
  return found;
}

}  // namespace

SurfaceMemo::Bounds bounds_of(const BodyPoints& body, const MeasureContext& context) {
  constexpr std::size_t kPart = 8192;  // points of one work item
  const Filling filling{context};
  std::vector<Bounds> parts((body.count() + kPart - 1) / kPart);
  for_each(parts.size(), [&](std::size_t i) {
    parts[i] = bounds_of(body, filling, i * kPart, std::min(body.count(), (i + 1) * kPart));
  });
  Bounds found{{kNowhere, kNowhere, kNowhere}, {kNowhere, kNowhere, kNowhere}};
  for (const Bounds& part : parts)
    for (std::size_t d = 0; d < 3; ++d) {
      widen(found.all[d], part.all[d]);
      widen(found.sparse[d], part.sparse[d]);
    }
  return found;
}

namespace {

bool has_source(const BodyPoints& body) { return body.memo && body.memo->source != nullptr; }

}  // namespace

const BodyPoints& layer_of(const BodyPoints& body, int axis, double low, double high,
                           BodyPoints& own) {
  if (has_source(body)) return body.memo->source->between(axis, low, high);
  copy_points_between(body, axis, low, high, own);
  return own;
}

const BodyPoints& all_of(const BodyPoints& body) {
  return has_source(body) ? body.memo->source->all() : body;
}

namespace {

/// The outermost surface is looked for among the points at the end first, in a layer of kLayer a,
/// and believed if a well filled line has it within kSure a of the outermost point: what lies
/// kInside nodes deeper does not touch it then (volume_fraction.cpp).
constexpr double kLayer = 14, kSure = 4;

/// `all`: least and greatest coordinate of the points along the axis.
std::array<double, 2> find_ends(const BodyPoints& body, const MeasureContext& context, int axis,
                                const std::array<double, 2>& all) {
  const VolumeFraction::Walls walls = walls_of(context);
  const double a = node_spacing(context), depth = kLayer * a;
  std::array<double, 2> found{};
  std::array<bool, 2> sure{};
  if (all[1] - all[0] > 1.5 * depth) {
    const auto layer_at = [&](std::size_t side, BodyPoints& own) -> const BodyPoints& {
      return side == 0 ? layer_of(body, axis, all[0], all[0] + depth, own)
                       : layer_of(body, axis, all[1] - depth, all[1], own);
    };
    std::array<BodyPoints, 2> own;
    // A source gathers one layer after the other, each on all threads.
    for (std::size_t side = 0; has_source(body) && side < 2; ++side) layer_at(side, own[side]);
    for_each(2, [&](std::size_t side) {
      found[side] = volume_fraction(layer_at(side, own[side]), context)
                        .outermost(axis, static_cast<int>(side), walls)
                        .of_filled;
      sure[side] = std::abs(found[side] - all[side]) < kSure * a;
    });
  }
  if (sure[0] && sure[1]) return found;
  const VolumeFraction whole = volume_fraction(all_of(body), context);
  for (const int side : {0, 1})
    if (!sure[index(side)]) found[index(side)] = whole.outermost(axis, side, walls).place();
  return found;
}

}  // namespace

std::array<double, 2> surface_ends(const BodyPoints& body, const MeasureContext& context,
                                   int axis) {
  SurfaceMemo alone;
  SurfaceMemo& memo = body.memo ? *body.memo : alone;
  auto& kept = memo.ends[index(axis)];
  if (kept) return *kept;
  if (!body.edges.empty()) {
    kept = mesh_ends(body, axis);
    return *kept;
  }
  if (!memo.bounds) memo.bounds = bounds_of(body, context);
  const std::array<double, 2> all = memo.bounds->all[index(axis)],
                              sparse = memo.bounds->sparse[index(axis)];
  std::array<double, 2> at = find_ends(body, context, axis, all);
  if (std::isfinite(sparse[0])) at = {std::fmin(at[0], sparse[0]), std::fmax(at[1], sparse[1])};
  const double a = node_spacing(context);
  kept = {std::max({at[0], all[0] - a, context.min[index(axis)]}),
          std::min({at[1], all[1] + a, context.max[index(axis)]})};
  return *kept;
}

double outermost(const BodyPoints& body, const MeasureContext& context, int axis, int side) {
  return surface_ends(body, context, axis)[index(side)];
}

double extent(const BodyPoints& body, const MeasureContext& context, int axis) {
  const auto [low, high] = surface_ends(body, context, axis);
  return high - low;
}

}  // namespace krater
