// SPDX-License-Identifier: GPL-3.0-or-later
// Points under way between blocks arrive, some of them in parts.
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "krater/core/parallel.hpp"
#include "krater/kinematics/mpm/interior.hpp"
#include "krater/kinematics/mpm/migrate.hpp"

namespace krater {

namespace {

/// Patches without points go; true: there were some.
bool drop_empty(BlockGrid& grid) {
  const auto& all = grid.patches();
  const bool emptied =
      std::any_of(all.begin(), all.end(), [](const Patch& p) { return p.points.count() == 0; });
  if (emptied) grid.rebuild(true);
  return emptied;
}

/// Points that changed their level, in the order of their patches; whole or in parts.
std::vector<Arrival> find_arrivals(BlockGrid& grid, const BoundarySet& boundary,
                                   const std::vector<BodyKernelData>& bodies,
                                   std::vector<PointSize>& sizes, Delivered& out) {
  std::vector<Arrival> arrivals;
  Interior interior{grid, boundary.conditions(), bodies, sizes};
  for (Patch& patch : grid.patches()) {
    Outbox& box = patch.outbox;
    const PointColumns& columns = bodies[static_cast<std::size_t>(patch.body)].columns;
    const auto width = static_cast<std::ptrdiff_t>(columns.stride / kLanes);
    PointSize& size = sizes[static_cast<std::size_t>(patch.body)];
    for (std::size_t k = 0; k < box.keys.size(); ++k) {
      const auto from = box.other_level.begin() + static_cast<std::ptrdiff_t>(k) * width;
      const std::size_t before = arrivals.size();
      Arrival whole{box.keys[k], patch.body, {from, from + width}};
      if (size.stagger && will_split(grid.levels(), columns, size, patch.key.level, whole))
        whole.inside = interior.holds(whole.record.data() + columns.position / kLanes,
                                      patch.key.level, patch.body);
      const double heat =
          arrive(grid.levels(), columns, size, patch.key.level, std::move(whole), arrivals);
      out.heat += heat;
      if (bodies[static_cast<std::size_t>(patch.body)].heat_floor == nullptr) out.unfelt += heat;
      out.made += static_cast<double>(arrivals.size() - before - 1);
      const int finer = box.keys[k].level - patch.key.level;
      out.finer_rate = std::max(out.finer_rate, std::ldexp(patch.result.max_rate, finer));
    }
  }
  for (Patch& patch : grid.patches()) {
    patch.outbox.keys.clear();
    patch.outbox.other_level.clear();
  }
  return arrivals;
}

void take_arrivals(BlockGrid& grid, const std::vector<BodyKernelData>& bodies,
                   const std::vector<Arrival>& arrivals) {
  std::set<int> touched;
  for (const Arrival& a : arrivals) {
    const int p = grid.find_patch(a.key, a.body);
    grid.patches()[static_cast<std::size_t>(p)].append(a.record.data());
    touched.insert(p);
  }
  for (const int p : touched) {
    Patch& patch = grid.patches()[static_cast<std::size_t>(p)];
    patch.points.pad(bodies[static_cast<std::size_t>(patch.body)].columns.mass);
  }
}

void take_from_neighbours(BlockGrid& grid, const std::vector<BodyKernelData>& bodies) {
  const int slots = neighbour_count(grid.geometry().dimension);
  for_each(grid.patches().size(), [&](std::size_t p) {
    Patch& patch = grid.patches()[p];
    const BodyKernelData& body = bodies[static_cast<unsigned>(patch.body)];
    const int width = body.columns.stride / kLanes;
    for (int s = 0; s < slots; ++s) {
      const int source = patch.links.neighbours[static_cast<unsigned>(s)];
      const int towards_us = slots - 1 - s;
      if (source < 0) continue;
      const Outbox& box = grid.patches()[static_cast<unsigned>(source)].outbox;
      if (((box.used >> towards_us) & 1U) == 0) continue;
      for (std::size_t k = 0; k < box.slots.size(); ++k)
        if (box.slots[k] == towards_us)
          patch.append(box.records.data() + k * static_cast<std::size_t>(width));
    }
    if (patch.points.count() > 0) patch.points.pad(body.columns.mass);
  });
}

}  // namespace

Delivered deliver(BlockGrid& grid, const BoundarySet& boundary,
                  const std::vector<BodyKernelData>& bodies, std::vector<PointSize>& sizes) {
  const int dimension = grid.geometry().dimension, slots = neighbour_count(dimension);
  Delivered out;
  std::vector<Arrival> arrivals;
  if (!grid.levels().single()) arrivals = find_arrivals(grid, boundary, bodies, sizes, out);
  std::set<std::pair<BlockKey, int>> missing;
  for (const Patch& patch : grid.patches())
    for (int s = 0; s < slots; ++s)
      if (((patch.outbox.used >> s) & 1U) != 0 &&
          patch.links.neighbours[static_cast<unsigned>(s)] < 0)
        missing.insert({shifted(patch.key, s, dimension), patch.body});
  for (const Arrival& a : arrivals)
    if (grid.find_patch(a.key, a.body) < 0) missing.insert({a.key, a.body});
  for (const auto& [key, body] : missing) {
    grid.add_patch(key, body, bodies[static_cast<unsigned>(body)].columns.stride);
  }
  if (!missing.empty()) grid.rebuild(false);
  const auto& all = grid.patches();
  if (arrivals.empty() && std::all_of(all.begin(), all.end(), [](const Patch& p) {
        return p.steady && p.outbox.used == 0;
      })) {
    out.changed = drop_empty(grid);
    return out;
  }
  take_from_neighbours(grid, bodies);
  take_arrivals(grid, bodies, arrivals);
  for (Patch& patch : grid.patches()) patch.outbox.clear();
  out.changed = drop_empty(grid) || !missing.empty();
  return out;
}

}  // namespace krater
