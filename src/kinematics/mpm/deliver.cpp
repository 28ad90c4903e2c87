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

using Places = std::set<std::pair<BlockKey, int>>;  ///< block, body

/// Nothing in it, nothing on the way from it or to it.
bool is_idle(const Patch& patch) {
  return patch.count() == 0 && patch.outbox.used == 0 && patch.outbox.keys.empty() &&
         !patch.awaited;
}

/// Blocks that points of one patch would be in after `ahead`, as they move now.
std::vector<BlockKey> blocks_ahead(const BlockGrid& grid, const Patch& patch, const PointColumns& c,
                                   double ahead) {
  std::vector<BlockKey> out;
  const GridGeometry& g = grid.geometry();
  for (int i = 0; i < patch.points.count(); ++i) {
    double x[3] = {};
    bool inside = true;
    for (int a = 0; a < g.dimension; ++a) {
      x[a] = patch.points.at(c.position + kLanes * a, i) +
             ahead * patch.points.at(c.velocity + kLanes * a, i);
      inside = inside && x[a] > g.min[static_cast<std::size_t>(a)] && x[a] < g.upper(a);
    }
    if (!inside) continue;
    const BlockKey key = grid.levels().block_at(x);
    if (key != patch.key && std::find(out.begin(), out.end(), key) == out.end()) out.push_back(key);
  }
  return out;
}

/// A change of the topology costs as much as a step of a few blocks; where fragments fly there
/// would be one in every step. So patches that the next steps will need are made with the first.
void look_ahead(BlockGrid& grid, const std::vector<BodyKernelData>& bodies, double ahead,
                const Distribution* ranks, Places& missing) {
  std::vector<std::vector<BlockKey>> found(grid.patches().size());
  for_each(found.size(), [&](std::size_t p) {
    const Patch& patch = grid.patches()[p];
    if (!patch.settled)
      found[p] =
          blocks_ahead(grid, patch, bodies[static_cast<std::size_t>(patch.body)].columns, ahead);
  });
  if (ranks != nullptr) ranks->share_keys(grid, found);
  for (std::size_t p = 0; p < found.size(); ++p)
    for (const BlockKey& key : found[p]) {
      const int body = grid.patches()[p].body;
      if (const int there = grid.find_patch(key, body); there >= 0)
        grid.patches()[static_cast<std::size_t>(there)].awaited = true;
      else
        missing.insert({key, body});
    }
}

/// Of the patches that are there: to which points come now.
void await(BlockGrid& grid, const std::vector<Arrival>& arrivals) {
  for (Patch& patch : grid.patches()) patch.awaited = false;
  const int slots = neighbour_count(grid.geometry().dimension);
  for (const Patch& patch : grid.patches())
    for (int s = 0; s < slots; ++s)
      if (const int to = patch.links.neighbours[static_cast<unsigned>(s)];
          ((patch.outbox.used >> s) & 1U) != 0 && to >= 0)
        grid.patches()[static_cast<std::size_t>(to)].awaited = true;
  for (const Arrival& a : arrivals)
    if (const int to = grid.find_patch(a.key, a.body); to >= 0)
      grid.patches()[static_cast<std::size_t>(to)].awaited = true;
}

void make_patches(BlockGrid& grid, const std::vector<BodyKernelData>& bodies,
                  const std::vector<Arrival>& arrivals, double ahead, const Distribution* ranks,
                  Places missing) {
  await(grid, arrivals);
  if (ahead > 0) look_ahead(grid, bodies, ahead, ranks, missing);
  grid.drop_patches_if(is_idle);
  for (const auto& [key, body] : missing)
    grid.add_patch(key, body, bodies[static_cast<unsigned>(body)].columns.stride).awaited = true;
  grid.rebuild(false);
}

/// Patches that nothing is in go where they are a quarter of all; true: they went.
bool drop_idle(BlockGrid& grid) {
  const auto& all = grid.patches();
  const auto idle = std::count_if(all.begin(), all.end(), is_idle);
  if (4 * static_cast<std::size_t>(idle) <= all.size()) return false;
  grid.drop_patches_if(is_idle);
  grid.rebuild(false);
  return true;
}

/// Points that changed their level, whole or in parts, and halves of long ones, in the order of
/// their patches.
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
    if (!patch.here) return;
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
                  const std::vector<BodyKernelData>& bodies, std::vector<PointSize>& sizes,
                  double ahead, Distribution* ranks) {
  const int dimension = grid.geometry().dimension, slots = neighbour_count(dimension);
  Delivered out;
  const bool any = std::any_of(grid.patches().begin(), grid.patches().end(),
                               [](const Patch& p) { return !p.outbox.keys.empty(); });
  std::vector<Arrival> arrivals;
  if (any) arrivals = find_arrivals(grid, boundary, bodies, sizes, out);
  Places missing;
  for (const Patch& patch : grid.patches())
    for (int s = 0; s < slots; ++s)
      if (((patch.outbox.used >> s) & 1U) != 0 &&
          patch.links.neighbours[static_cast<unsigned>(s)] < 0)
        missing.insert({shifted(patch.key, s, dimension), patch.body});
  for (const Arrival& a : arrivals)
    if (grid.find_patch(a.key, a.body) < 0) missing.insert({a.key, a.body});
  if (!missing.empty()) make_patches(grid, bodies, arrivals, ahead, ranks, missing);
  const auto& all = grid.patches();
  if (arrivals.empty() && std::all_of(all.begin(), all.end(), [](const Patch& p) {
        return p.steady && p.outbox.used == 0;
      })) {
    out.changed = drop_idle(grid) || !missing.empty();
    return out;
  }
  if (ranks != nullptr) ranks->send_points(grid);
  take_from_neighbours(grid, bodies);
  take_arrivals(grid, bodies, arrivals);
  for (Patch& patch : grid.patches()) patch.outbox.clear();
  if (ranks != nullptr) ranks->share_counts(grid);
  out.changed = drop_idle(grid) || !missing.empty();
  return out;
}

}  // namespace krater
