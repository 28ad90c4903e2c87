// SPDX-License-Identifier: GPL-3.0-or-later
// Points under way between blocks arrive, some of them in parts.
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "krater/core/parallel.hpp"
#include "krater/core/ranks.hpp"
#include "krater/kinematics/mpm/interior.hpp"
#include "krater/kinematics/mpm/migrate.hpp"

namespace krater {

namespace {

using Places = std::set<std::pair<BlockKey, int>>;  ///< block, body

/// Nothing in it, nothing on the way from it or to it.
bool is_idle(const Patch& patch) {
  return patch.count() == 0 && patch.outbox.used == 0 && !patch.awaited;
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
void await(BlockGrid& grid, const Places& arriving) {
  for (Patch& patch : grid.patches()) patch.awaited = false;
  const int slots = neighbour_count(grid.geometry().dimension);
  for (const Patch& patch : grid.patches())
    for (int s = 0; s < slots; ++s)
      if (const int to = patch.links.neighbours[static_cast<unsigned>(s)];
          ((patch.outbox.used >> s) & 1U) != 0 && to >= 0)
        grid.patches()[static_cast<std::size_t>(to)].awaited = true;
  for (const auto& [key, body] : arriving)
    if (const int to = grid.find_patch(key, body); to >= 0)
      grid.patches()[static_cast<std::size_t>(to)].awaited = true;
}

void make_patches(BlockGrid& grid, const std::vector<BodyKernelData>& bodies,
                  const Places& arriving, double ahead, const Distribution* ranks, Places missing) {
  await(grid, arriving);
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

/// Numbers of points that splitting makes, until all know how many these are.
constexpr double kProvisional = 0x1p52;

/// What came of the points of one patch that changed their level.
struct Changed {
  double heat = 0, unfelt = 0, made = 0, finer_rate = 0;
};

/// The points of a patch that changed their level, whole or in parts, and halves of long ones.
Changed change_level(const BlockGrid& grid, std::size_t p,
                     const std::vector<BodyKernelData>& bodies, const PointSize& of_body,
                     Interior& interior, std::vector<Arrival>& arrivals) {
  const Patch& patch = grid.patches()[p];
  const Outbox& box = patch.outbox;
  const BodyKernelData& body = bodies[static_cast<std::size_t>(patch.body)];
  const PointColumns& columns = body.columns;
  const auto width = static_cast<std::ptrdiff_t>(columns.stride / kLanes);
  PointSize size = of_body;
  size.next_id = kProvisional;
  Changed out;
  for (std::size_t k = 0; k < box.keys.size(); ++k) {
    const auto from = box.other_level.begin() + static_cast<std::ptrdiff_t>(k) * width;
    Arrival whole{box.keys[k], patch.body, {from, from + width}, false, static_cast<int>(p)};
    if (size.stagger && will_split(grid.levels(), columns, size, patch.key.level, whole))
      whole.inside = interior.holds(whole.record.data() + columns.position / kLanes,
                                    patch.key.level, patch.body);
    const double heat =
        arrive(grid.levels(), columns, size, patch.key.level, std::move(whole), arrivals);
    out.heat += heat;
    if (body.heat_floor == nullptr) out.unfelt += heat;
    const int finer = box.keys[k].level - patch.key.level;
    out.finer_rate = std::max(out.finer_rate, std::ldexp(patch.result.max_rate, finer));
  }
  out.made = size.next_id - kProvisional;
  return out;
}

/// Points of this rank that changed their level, in the order of their patches.
std::vector<Arrival> find_arrivals(BlockGrid& grid, const BoundarySet& boundary,
                                   const std::vector<BodyKernelData>& bodies,
                                   std::vector<PointSize>& sizes, const Distribution* ranks,
                                   Delivered& out) {
  std::vector<Arrival> arrivals;
  Interior interior{grid, boundary.conditions(), bodies, sizes};
  if (ranks != nullptr) interior.exchange(*ranks);
  std::vector<Changed> changed(grid.patches().size());
  for (std::size_t p = 0; p < changed.size(); ++p)
    changed[p] =
        change_level(grid, p, bodies, sizes[static_cast<std::size_t>(grid.patches()[p].body)],
                     interior, arrivals);
  if (ranks != nullptr) ranks->share(grid, changed);
  std::vector<double> first(changed.size());  // number of the first point that a patch makes
  for (std::size_t p = 0; p < changed.size(); ++p) {
    PointSize& size = sizes[static_cast<std::size_t>(grid.patches()[p].body)];
    first[p] = size.next_id;
    size.next_id += changed[p].made;
    out.heat += changed[p].heat;
    out.unfelt += changed[p].unfelt;
    out.made += changed[p].made;
    out.finer_rate = std::max(out.finer_rate, changed[p].finer_rate);
    grid.patches()[p].outbox.keys.clear();
    grid.patches()[p].outbox.other_level.clear();
    grid.patches()[p].outbox.used &= ~Outbox::kOtherLevel;
  }
  for (Arrival& a : arrivals)
    if (double& id = a.record.front(); id >= kProvisional)
      id += first[static_cast<std::size_t>(a.source)] - kProvisional;
  return arrivals;
}

/// Where arrivals of all ranks go.
Places places_of(const BlockGrid& grid, const std::vector<Arrival>& arrivals,
                 const Distribution* ranks) {
  std::vector<std::vector<BlockKey>> to(grid.patches().size());
  for (const Arrival& a : arrivals) to[static_cast<std::size_t>(a.source)].push_back(a.key);
  if (ranks != nullptr) ranks->share_keys(grid, to);
  Places out;
  for (std::size_t p = 0; p < to.size(); ++p)
    for (const BlockKey& key : to[p]) out.insert({key, grid.patches()[p].body});
  return out;
}

}  // namespace

void route(std::vector<Arrival>& arrivals, const Distribution& ranks) {
  std::vector<std::vector<double>> by_rank(static_cast<std::size_t>(ranks::count()));
  std::vector<Arrival> here;
  for (Arrival& a : arrivals) {
    const int to = ranks.owner(a.key);
    if (to == ranks::index()) {
      here.push_back(std::move(a));
      continue;
    }
    std::vector<double>& data = by_rank[static_cast<std::size_t>(to)];
    data.insert(data.end(),
                {1.0 * a.source, 1.0 * a.body, 1.0 * a.key.i[0], 1.0 * a.key.i[1], 1.0 * a.key.i[2],
                 1.0 * a.key.level, static_cast<double>(a.record.size())});
    data.insert(data.end(), a.record.begin(), a.record.end());
  }
  for (const ranks::Message& message : Distribution::exchange_any(std::move(by_rank)))
    for (auto at = message.data.begin(); at != message.data.end();) {
      Arrival& a = here.emplace_back();
      a.source = static_cast<int>(*at++);
      a.body = static_cast<int>(*at++);
      for (std::int32_t& i : a.key.i) i = static_cast<std::int32_t>(*at++);
      a.key.level = static_cast<std::int32_t>(*at++);
      const auto width = static_cast<std::ptrdiff_t>(*at++);
      const auto end = at + width;
      a.record.assign(at, end);
      at = end;
    }
  std::stable_sort(here.begin(), here.end(),
                   [](const Arrival& a, const Arrival& b) { return a.source < b.source; });
  arrivals = std::move(here);
}

namespace {

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

/// Of those that have lost points and got none.
void pad_changed(BlockGrid& grid, const std::vector<BodyKernelData>& bodies) {
  for (Patch& patch : grid.patches())
    if (!patch.steady && !patch.points.empty())
      patch.points.pad(bodies[static_cast<std::size_t>(patch.body)].columns.mass);
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
  std::vector<Arrival> arrivals;
  Places arriving, missing;
  if (std::any_of(grid.patches().begin(), grid.patches().end(),
                  [](const Patch& p) { return (p.outbox.used & Outbox::kOtherLevel) != 0; })) {
    arrivals = find_arrivals(grid, boundary, bodies, sizes, ranks, out);
    arriving = places_of(grid, arrivals, ranks);
    if (ranks != nullptr) route(arrivals, *ranks);
  }
  for (const Patch& patch : grid.patches())
    for (int s = 0; s < slots; ++s)
      if (((patch.outbox.used >> s) & 1U) != 0 &&
          patch.links.neighbours[static_cast<unsigned>(s)] < 0)
        missing.insert({shifted(patch.key, s, dimension), patch.body});
  for (const auto& place : arriving)
    if (grid.find_patch(place.first, place.second) < 0) missing.insert(place);
  if (!missing.empty()) make_patches(grid, bodies, arriving, ahead, ranks, missing);
  const auto& all = grid.patches();  // what all ranks know of them decides
  if (arriving.empty() &&
      std::all_of(all.begin(), all.end(), [](const Patch& p) { return p.outbox.used == 0; })) {
    pad_changed(grid, bodies);
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
