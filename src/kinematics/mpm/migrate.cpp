// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mpm/migrate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace krater {

namespace {

// Deeper than this, in cells, a point did not pass a closed side by round-off.
constexpr double kRoundOff = 1e-9;

/// A column of a tensor over tensor axes or grid axes: its image in a plane across `axis`.
/// `row_sign`: of each row; each column changes sign where it is `axis`.
void mirror_matrix(PointStore& points, int offset, int size, int axis,
                   const std::array<double, 3>& row_sign, int i) {
  if (offset < 0) return;
  for (int row = 0; row < size; ++row)
    for (int k = 0; k < size; ++k) {
      const double sign = row_sign[static_cast<unsigned>(row)] * (k == axis ? -1.0 : 1.0);
      if (sign < 0) {
        double& x = points.at(offset + kLanes * (size * row + k), i);
        x = -x;
      }
    }
}

/// Shear components of a symmetric tensor xx yy zz yz xz xy that change sign across tensor axis n.
void mirror_shear(PointStore& points, int offset, int n, int i) {
  if (offset < 0) return;
  for (int k = 0; k < 3; ++k)
    if (k != n) {
      double& x = points.at(offset + kLanes * (6 - n - k), i);
      x = -x;
    }
}

/// Beyond a closed side: its image inside, with everything that has a direction. What the points
/// receive so is the plane's impulse and work.
void reflect(Patch& patch, const PointColumns& c, const GridGeometry& geometry,
             const BoundarySet& boundary, int axis, int side, int i, Removed& removed) {
  const int dim = geometry.dimension;
  const Boundary& plane =
      boundary.conditions()[static_cast<unsigned>(axis)][static_cast<unsigned>(side)];
  double& x = patch.points.at(c.position + kLanes * axis, i);
  const double at = boundary.position(axis, side, boundary.step());
  const double depth = std::abs(x - at) * geometry.inv_h;
  removed.reflections += 1;
  if (depth > kRoundOff) removed.penetrations += 1;
  removed.deepest = std::max(removed.deepest, depth);
  x = 2 * at - x;
  std::array<double, 3> sign{1, 1, 1}, stress_sign{1, 1, 1};
  const double m = patch.points.at(c.mass, i);
  for (int a = 0; a < dim; ++a) {
    const auto k = static_cast<unsigned>(a);
    if (a != axis && plane.kind != BoundaryKind::sticky) continue;
    sign[k] = -1;
    double& v = patch.points.at(c.velocity + kLanes * a, i);
    const double image = 2 * plane.velocity[k] - v;
    removed.side_impulse[static_cast<unsigned>(2 * axis + side)][k] += m * (image - v);
    removed.side_work += 0.5 * m * (image * image - v * v);
    v = image;
  }
  mirror_matrix(patch.points, c.affine, dim, axis, sign, i);
  const int n = dim == 2 ? 2 * axis : axis;
  stress_sign[static_cast<unsigned>(n)] = -1;
  mirror_shear(patch.points, c.stress, n, i);
  mirror_shear(patch.points, c.domain, n, i);
  mirror_matrix(patch.points, c.deformation, 3, n, stress_sign, i);
}

void tally(Patch& patch, const PointColumns& c, const GridGeometry& geometry, int i,
           Removed& removed) {
  const double m = patch.points.at(c.mass, i);
  removed.count += 1;
  removed.mass += m;
  removed.kinetic += point_kinetic(patch.points.point(i), c, geometry);
  if (c.energy >= 0) removed.internal += m * patch.points.at(c.energy, i);
  if (c.carried >= 0) removed.internal += m * patch.points.at(c.carried, i);
  for (int a = 0; a < geometry.dimension; ++a)
    removed.momentum[static_cast<unsigned>(a)] += m * patch.points.at(c.velocity + kLanes * a, i);
}

/// False when a point left through an open side; puts it back inside closed sides.
bool keep_inside(Patch& patch, const GridGeometry& geometry, const BoundarySet& boundary,
                 const PointColumns& c, int i, Removed& removed) {
  for (int a = 0; a < geometry.dimension; ++a) {
    const double x = patch.points.at(c.position + kLanes * a, i);
    const bool low = boundary.beyond(a, 0, x), high = boundary.beyond(a, 1, x);
    if (!low && !high) continue;
    const int side = low ? 0 : 1;
    if (low && boundary.clearance(a) > 0) {
      double& near = patch.points.at(c.position + kLanes * a, i);
      const double least = boundary.position(a, 0) + BoundarySet::kClearance * geometry.h;
      if (x < boundary.position(a, 0)) reflect(patch, c, geometry, boundary, a, side, i, removed);
      near = std::max(least, near);
      continue;
    }
    if (boundary.is_open(a, side)) return false;
    reflect(patch, c, geometry, boundary, a, side, i, removed);
  }
  return true;
}

/// Of the level of the patch, or of the point's own place.
struct Places {
  BlockKey here, owner;
};
Places places_of_point(const Patch& patch, const Levels& levels, const PointColumns& c, int i) {
  double position[3];
  for (int a = 0; a < levels.geometry().dimension; ++a)
    position[a] = patch.points.at(c.position + kLanes * a, i);
  return {block_of(levels.geometry(patch.key.level), position), levels.block_at(position)};
}

/// Lanes of a group that failure takes out, among the points of the patch.
unsigned failed_lanes(const Patch& patch, const PointColumns& c, int g) {
  if (c.removed < 0) return 0;
  unsigned lanes = 0;
  for (int l = 0; l < kLanes && kLanes * g + l < patch.points.count(); ++l)
    if (patch.points.at(c.removed, kLanes * g + l) > 0.5) lanes |= 1U << l;
  return lanes;
}

enum class Fate { stays, goes, changes_level, removed };

/// What is to be done with a point, and where it goes.
struct Judgement {
  Fate fate = Fate::stays;
  int slot = 0;
  BlockKey key;
};

/// Puts a point back inside closed sides, then says where it belongs.
Judgement judge(Patch& patch, const Levels& levels, const BoundarySet& boundary,
                const PointColumns& c, int i, Removed& removed) {
  const GridGeometry& geometry = levels.geometry(patch.key.level);
  Judgement out;
  if (!keep_inside(patch, geometry, boundary, c, i, removed)) {
    out.fate = Fate::removed;
    return out;
  }
  const Places at = places_of_point(patch, levels, c, i);
  out.key = at.owner;
  bool here = true;
  for (int a = 0; a < geometry.dimension; ++a) {
    const auto k = static_cast<unsigned>(a);
    const int offset = at.here.i[k] - patch.key.i[k];
    if (offset < -1 || offset > 1) {
      if (patch.result.fault.kind == FaultKind::none)
        patch.result.fault = {FaultKind::moved_too_far, i / kLanes, 1U << (i % kLanes)};
      return {};
    }
    here = here && offset == 0;
    out.slot = 3 * out.slot + offset + 1;
  }
  if (at.owner.level != patch.key.level)
    out.fate = Fate::changes_level;
  else if (!here)
    out.fate = Fate::goes;
  return out;
}

void post(Patch& patch, const Judgement& to, int i) {
  if (to.fate == Fate::changes_level) {
    patch.points.copy_out(i, patch.outbox.other_level);
    patch.outbox.keys.push_back(to.key);
    patch.outbox.used |= Outbox::kOtherLevel;
    return;
  }
  patch.points.copy_out(i, patch.outbox.records);
  patch.outbox.slots.push_back(static_cast<std::uint8_t>(to.slot));
  patch.outbox.used |= 1U << to.slot;
}

}  // namespace

Removed collect_leavers(Patch& patch, const Levels& levels, const BoundarySet& boundary,
                        const PointColumns& columns, const unsigned char* leavers) {
  Removed removed;
  patch.outbox.clear();
  std::vector<int> holes;
  for (int g = 0; g < patch.points.groups(); ++g) {
    const unsigned failed = failed_lanes(patch, columns, g), all = leavers[g] | failed;
    if (all == 0) continue;
    for (int l = 0; l < kLanes; ++l) {
      if (((all >> l) & 1U) == 0) continue;
      const int i = kLanes * g + l;
      const bool is_failed = ((failed >> l) & 1U) != 0;
      Judgement to;
      to.fate = Fate::removed;
      if (!is_failed) to = judge(patch, levels, boundary, columns, i, removed);
      if (is_failed) removed.failed += 1;
      if (to.fate == Fate::stays) continue;
      if (to.fate != Fate::removed)
        post(patch, to, i);
      else
        tally(patch, columns, levels.geometry(patch.key.level), i, removed);
      holes.push_back(i);
    }
  }
  patch.points.remove(holes);
  if (!holes.empty()) patch.settled = false;
  return removed;
}

void send_away(Patch& patch, const Levels& levels, const PointColumns& columns) {
  if (patch.count() > 0) patch.outbox.used |= Outbox::kOtherLevel;
  patch.held = 0;
  for (int i = 0; i < patch.points.count(); ++i) {
    patch.points.copy_out(i, patch.outbox.other_level);
    patch.outbox.keys.push_back(places_of_point(patch, levels, columns, i).owner);
  }
  patch.points.truncate(0);
  patch.touch();
}

namespace {

using RecordsByBlock = std::map<BlockKey, std::vector<double>>;

void sort_by_blocks(Patch& patch, const Levels& levels, const BoundarySet& boundary,
                    const PointColumns& c, RecordsByBlock& sorted, Removed& removed) {
  const GridGeometry& geometry = levels.geometry(patch.key.level);
  for (int i = 0; i < patch.points.count(); ++i) {
    if (!keep_inside(patch, geometry, boundary, c, i, removed)) {
      tally(patch, c, geometry, i, removed);
      continue;
    }
    std::vector<double>& records = sorted[places_of_point(patch, levels, c, i).owner];
    patch.points.copy_out(i, records);
  }
}

}  // namespace

Removed adopt(BlockGrid& grid, int body, const std::vector<double>& records,
              const BoundarySet& boundary, const PointColumns& c) {
  const auto width = static_cast<std::size_t>(c.stride / kLanes);
  Patch arriving;
  arriving.body = body;
  arriving.points = PointStore{c.stride};
  for (std::size_t k = 0; k < records.size(); k += width) arriving.append(records.data() + k);
  Removed removed;
  RecordsByBlock sorted;
  sort_by_blocks(arriving, grid.levels(), boundary, c, sorted, removed);
  std::vector<BlockKey> missing;
  for (const auto& [key, unused] : sorted)
    if (grid.find_patch(key, body) < 0) missing.push_back(key);
  for (const BlockKey& key : missing) grid.add_patch(key, body, c.stride);
  grid.rebuild(false);
  for (const auto& [key, points] : sorted) {
    Patch& patch = grid.patches()[static_cast<std::size_t>(grid.find_patch(key, body))];
    for (std::size_t k = 0; k < points.size(); k += width) patch.append(points.data() + k);
    patch.points.pad(c.mass);
  }
  return removed;
}

Removed redistribute(BlockGrid& grid, int body, const BoundarySet& boundary, const PointColumns& c,
                     const Distribution* ranks) {
  std::vector<Removed> removed(grid.patches().size());
  std::vector<std::vector<BlockKey>> to(removed.size());
  std::vector<Arrival> moved;
  const auto width = static_cast<std::ptrdiff_t>(c.stride / kLanes);
  for (std::size_t p = 0; p < removed.size(); ++p) {
    if (grid.patches()[p].body != body) continue;
    RecordsByBlock sorted;
    sort_by_blocks(grid.patches()[p], grid.levels(), boundary, c, sorted, removed[p]);
    for (const auto& [key, records] : sorted) {
      to[p].push_back(key);
      for (auto at = records.begin(); at != records.end(); at += width)
        moved.push_back({key, body, {at, at + width}, false, static_cast<int>(p)});
    }
  }
  if (ranks != nullptr) {
    ranks->share(grid, removed);
    ranks->share_keys(grid, to);
    route(moved, *ranks);
  }
  Removed all;
  for (const Removed& r : removed) all += r;
  grid.drop_patches(body);
  std::map<BlockKey, std::size_t> place;
  for (const auto& keys : to)
    for (const BlockKey& key : keys)
      if (place.try_emplace(key, grid.patches().size()).second) grid.add_patch(key, body, c.stride);
  for (const Arrival& a : moved) grid.patches()[place[a.key]].append(a.record.data());
  for (const auto& [key, p] : place)
    if (!grid.patches()[p].points.empty()) grid.patches()[p].points.pad(c.mass);
  if (ranks != nullptr) ranks->share_counts(grid);
  grid.rebuild(true);
  return all;
}

}  // namespace krater
