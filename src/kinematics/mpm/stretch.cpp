// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mpm/stretch.hpp"

namespace krater {

namespace {

double length_squared(const Triple& d) { return d[0] * d[0] + d[1] * d[1] + d[2] * d[2]; }

BlockKey block_around(const Levels& levels, const PointColumns& c, const Arrival& point) {
  return levels.block_at(point.record.data() + c.position / kLanes);
}

}  // namespace

std::vector<int> stretched_points(const Patch& patch, const GridGeometry& g, const PointColumns& c,
                                  const PointSize& size) {
  std::vector<int> out;
  const double most = kLongestHalf * g.h;
  for (int i = 0; i < patch.points.count(); ++i) {
    const DomainTensor M = domain_of(patch.points, c, g.dimension, i);
    if (surely_within(M, most) || (c.failed >= 0 && patch.points.at(c.failed, i) > 0.5)) continue;
    if (patch.points.at(c.mass, i) < 2 * kLightest * size.mass(g, patch.points.at(c.position, i)))
      continue;
    if (length_squared(longest_half(M)) > most * most) out.push_back(i);
  }
  return out;
}

double split_stretched_points(Patch& patch, const Levels& levels, const PointColumns& c,
                              PointSize& size, const std::vector<int>& which) {
  const GridGeometry& g = levels.geometry(patch.key.level);
  std::vector<Arrival> halves;
  double heat = 0;
  for (const int i : which) {
    Arrival whole{patch.key, patch.body, {}};
    patch.points.copy_out(i, whole.record);
    const Triple half = longest_half(domain_of(patch.points, c, g.dimension, i));
    heat += halve(g, c, size, whole, half, halves);
  }
  patch.points.remove(which);
  patch.touch();
  patch.steady = false;
  for (const Arrival& half : halves) {
    const BlockKey key = block_around(levels, c, half);
    if (key == patch.key) {
      patch.points.append(half.record.data());
      continue;
    }
    Outbox& box = patch.outbox;
    box.other_level.insert(box.other_level.end(), half.record.begin(), half.record.end());
    box.keys.push_back(key);
    box.used |= Outbox::kOtherLevel;
  }
  if (!patch.points.empty()) patch.points.pad(c.mass);
  return heat;
}

}  // namespace krater
