// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/point_layers.hpp"

#include <algorithm>
#include <limits>
#include <memory>

#include "krater/core/parallel.hpp"
#include "measure/surface_points.hpp"

namespace krater {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Calls visit(lanes, lane) for the points of a set from `low` to `high` along an axis.
template <class Visit>
void for_points_between(const PointStore& points, int along, double low, double high,
                        const Visit& visit) {
  for (int g = 0; g < points.groups(); ++g) {
    const double* const lanes = points.point(kLanes * g);
    const int count = std::min(kLanes, points.count() - kLanes * g);
    for (int lane = 0; lane < count; ++lane) {
      const double at = lanes[kLanes * along + lane];
      if (at >= low && at <= high) visit(lanes, lane);
    }
  }
}

void widen(SurfaceMemo::Bounds& bounds, const PointBounds& by, int dimension) {
  for (std::size_t a = 0; a < index(dimension); ++a) {
    std::array<double, 2>& all = bounds.all[a];
    all = {std::min(all[0], by.low[a]), std::max(all[1], by.high[a])};
  }
}

}  // namespace

bool looks_at_layers(const MeasureOptions& measure) {
  switch (measure.kind) {
    case MeasureKind::extent:
    case MeasureKind::max:
    case MeasureKind::min:
    case MeasureKind::diameter:
    case MeasureKind::largest_diameter:
    case MeasureKind::penetration_depth:
    case MeasureKind::bulge: {
      MeasureSelection whole;
      whole.bodies = measure.selection.bodies;
      return measure.selection == whole;
    }
    default:
      return false;
  }
}

bool PointLayers::should_gather(const Simulation& sim, const std::vector<int>& bodies) {
  std::size_t count = 0;
  for (const int b : bodies) count += sim.point_count(b);
  return count > kFew && sim.scene().grid.refine.empty() && sim.has_all_points() &&
         std::all_of(bodies.begin(), bodies.end(),
                     [&](int b) { return sim.bodies()[index(b)]->options().material_points(); });
}

void PointLayers::begin(const Simulation& sim, const std::vector<int>& bodies,
                        const std::vector<PointSurvey>& survey) {
  sim_ = &sim;
  sets_.clear();
  used_ = 0;
  for (const int b : bodies) {
    const Body& body = *sim.bodies()[index(b)];
    const Slots slots{body.slot(field::Position::info), body.slot(field::Mass::info),
                      body.slot(field::Density::info)};
    for (int s = 0; s < sim.set_count(); ++s) {
      if (sim.set(s).body != b || sim.set(s).count() == 0) continue;
      sets_.push_back({s, slots, survey[index(s)].bounds});
    }
  }
}

/// Sparse points lie in sets with a point of more than a cell: these are looked at one by one.
SurfaceMemo::Bounds PointLayers::bounds(const MeasureContext& context) {
  SurfaceMemo::Bounds found;
  found.all.fill({kInfinite, -kInfinite});
  std::vector<Part> suspects;
  std::size_t count = 0;
  for (std::size_t i = 0; i < sets_.size(); ++i) {
    const PointBounds& bounds = sets_[i].bounds;
    widen(found, bounds, sim_->geometry().dimension);
    if (!(bounds.greatest_volume > most_filled(context, bounds.low[0]))) continue;
    suspects.push_back({i, index(sim_->set(sets_[i].number).count()), count});
    count += suspects.back().count;
  }
  if (sim_->geometry().dimension == 2) found.all[2] = {0, 0};
  found.sparse.fill({kInfinite, -kInfinite});
  if (suspects.empty()) return found;
  Layer& layer = next(0, -kInfinite, kInfinite);
  gather(std::move(suspects), layer);
  found.sparse = bounds_of(layer.points, context).sparse;
  --used_;  // no layer: it holds suspects only
  return found;
}

PointLayers::Layer& PointLayers::next(int axis, double low, double high) {
  Layer& layer = used_ < layers_.size() ? layers_[used_] : layers_.emplace_back();
  ++used_;
  layer.axis = axis;
  layer.low = low;
  layer.high = high;
  return layer;
}

/// From a layer of the same axis that is there, if one is wide enough.
const BodyPoints& PointLayers::between(int axis, double low, double high) {
  double least = kInfinite, greatest = -kInfinite;
  for (const Set& set : sets_) {
    least = std::min(least, set.bounds.low[index(axis)]);
    greatest = std::max(greatest, set.bounds.high[index(axis)]);
  }
  low = std::max(low, least);
  high = std::min(high, greatest);
  for (std::size_t i = 0; i < used_; ++i) {
    const Layer& there = layers_[i];
    if (there.axis != axis || there.low > low || there.high < high) continue;
    if (there.low == low && there.high == high) return there.points;
    Layer& layer = next(axis, low, high);
    layer.points.memo = nullptr;
    copy_points_between(there.points, axis, low, high, layer.points);
    return layer.points;
  }
  Layer& layer = next(axis, low, high);
  std::vector<Part> parts;
  for (std::size_t i = 0; i < sets_.size(); ++i)
    if (sets_[i].bounds.low[index(axis)] <= high && sets_[i].bounds.high[index(axis)] >= low)
      parts.push_back({i, 0, 0});
  for_each(parts.size(),
           [&](std::size_t i) { parts[i].count = count_between(sets_[parts[i].set], layer); });
  std::size_t count = 0;
  for (Part& part : parts) {
    part.first = count;
    count += part.count;
  }
  gather(std::move(parts), layer);
  return layer.points;
}

const BodyPoints& PointLayers::all() { return between(0, -kInfinite, kInfinite); }

std::size_t PointLayers::count_between(const Set& set, const Layer& layer) const {
  const PointSet points = sim_->set(set.number);
  if (set.bounds.low[index(layer.axis)] >= layer.low &&
      set.bounds.high[index(layer.axis)] <= layer.high)
    return index(points.count());
  std::size_t count = 0;
  for_points_between(*points.points, set.slots.x + layer.axis, layer.low, layer.high,
                     [&](const double*, int) { ++count; });
  return count;
}

/// With their bounds: for a measuring grid about them.
void PointLayers::gather(std::vector<Part> parts, Layer& layer) const {
  const std::size_t count = parts.empty() ? 0 : parts.back().first + parts.back().count;
  layer.points.x.resize(count);
  layer.points.mass.resize(count);
  layer.points.density.resize(count);
  for_each(parts.size(), [&](std::size_t i) { copy_between(parts[i], layer, layer.points); });
  layer.points.memo = std::make_shared<SurfaceMemo>();
  SurfaceMemo::Bounds& bounds = layer.points.memo->bounds.emplace();
  bounds.all.fill({kInfinite, -kInfinite});
  for (const Part& part : parts) widen(bounds, part.bounds, sim_->geometry().dimension);
}

void PointLayers::copy_between(Part& part, const Layer& layer, BodyPoints& to) const {
  const Slots& slots = sets_[part.set].slots;
  const PointStore& points = *sim_->set(sets_[part.set].number).points;
  const bool space = sim_->geometry().dimension == 3;
  const std::ptrdiff_t ahead = 4 * points.stride();
  PointBounds bounds;
  std::size_t next = part.first;
  for_points_between(points, slots.x + layer.axis, layer.low, layer.high,
                     [&](const double* lanes, int lane) {
                       const double* const x = lanes + kLanes * slots.x + lane;
                       const double* const m = lanes + kLanes * slots.mass + lane;
                       const double* const rho = lanes + kLanes * slots.density + lane;
                       if (lane == 0)  // some lines of a record: not foreseen by the processor
                         for (const double* line : {x, x + kLanes, x + 2 * kLanes, m, rho})
                           __builtin_prefetch(line + ahead);
                       const Triple at{x[0], x[kLanes], space ? x[2 * kLanes] : 0.0};
                       for (std::size_t a = 0; a < 3; ++a) {
                         bounds.low[a] = std::min(bounds.low[a], at[a]);
                         bounds.high[a] = std::max(bounds.high[a], at[a]);
                       }
                       to.x[next] = at;
                       to.mass[next] = *m;
                       to.density[next] = *rho;
                       ++next;
                     });
  part.bounds = bounds;
}

}  // namespace krater
