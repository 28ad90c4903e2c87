// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "krater/contact/rigid.hpp"
#include "krater/core/errors.hpp"
#include "krater/core/stability.hpp"

namespace krater {

void RigidBodies::add(RigidOptions options) {
  const auto body = static_cast<std::size_t>(options.body);
  if (of_body_.size() <= body) of_body_.resize(body + 1, -1);
  of_body_[body] = static_cast<int>(bodies_.size());
  bodies_.emplace_back(std::move(options));
}

RigidBody* RigidBodies::find(int body) {
  return const_cast<RigidBody*>(static_cast<const RigidBodies*>(this)->find(body));
}

const RigidBody* RigidBodies::find(int body) const {
  const auto b = static_cast<std::size_t>(body);
  if (b >= of_body_.size() || of_body_[b] < 0) return nullptr;
  return &bodies_[static_cast<std::size_t>(of_body_[b])];
}

void RigidBodies::write_velocities(BlockGrid& grid,
                                   const std::vector<PointColumns>& columns) const {
  for (Patch& patch : grid.patches()) {
    const RigidBody* body = find(patch.body);
    if (!body) continue;
    const PointColumns& c = columns[static_cast<std::size_t>(patch.body)];
    for (int i = 0; i < patch.points.count(); ++i) {
      Eigen::Vector3d x = Eigen::Vector3d::Zero();
      for (int a = 0; a < grid.geometry().dimension; ++a)
        x[a] = patch.points.at(c.position + kLanes * a, i);
      const Eigen::Vector3d v = body->twist().at(x);
      for (int a = 0; a < grid.geometry().dimension; ++a)
        patch.points.at(c.velocity + kLanes * a, i) = v[a];
    }
    patch.points.pad(c.mass);
  }
}

double RigidBodies::kinetic() const {
  double sum = 0;
  for (const RigidBody& body : bodies_) sum += body.kinetic();
  return sum;
}

Triple RigidBodies::momentum() const {
  Triple sum{};
  for (const RigidBody& body : bodies_)
    for (int a = 0; a < 3; ++a)
      sum[static_cast<unsigned>(a)] += body.mass() * body.twist().velocity[a];
  return sum;
}

double RigidBodies::begin(double dt) {
  rewind();
  const double before = kinetic();
  for (RigidBody& body : bodies_) body.begin(time_, dt);
  return kinetic() - before;
}

void RigidBodies::rewind() {
  for (RigidBody& body : bodies_) body.rewind();
}

void RigidBodies::finish(double dt) {
  for (RigidBody& body : bodies_) body.finish(dt);
}

void RigidBodies::move(Patch& patch, const Levels& levels, const BoundarySet& boundary,
                       const PointColumns& c, unsigned char* leavers) const {
  const RigidBody& body = *find(patch.body);
  const GridGeometry& geometry = levels.geometry(patch.key.level);
  const int dimension = geometry.dimension;
  PatchResult& result = patch.result;
  result.kinetic = result.max_rate = 0;
  result.limiter = 1;
  result.crossed = 0;
  std::fill(leavers, leavers + patch.points.groups(), static_cast<unsigned char>(0));
  for (int i = 0; i < patch.points.count(); ++i) {
    Eigen::Vector3d X = Eigen::Vector3d::Zero();
    for (int a = 0; a < dimension; ++a)
      X[a] = patch.points.at(body.options().reference + kLanes * a, i);
    const Eigen::Vector3d x = body.position(X), v = body.twist().at(x);
    bool outside = false;
    for (int a = 0; a < dimension; ++a) {
      patch.points.at(c.position + kLanes * a, i) = x[a];
      patch.points.at(c.velocity + kLanes * a, i) = v[a];
      const double s = geometry.storage(x[a], a);
      const bool low = s<geometry.lower_storage(), high = s> geometry.upper_storage(a);
      outside = outside || low || high;
      if ((low || high) && !boundary.is_open(a, low ? 0 : 1))
        result.crossed = 1 + 2 * a + (low ? 0 : 1);
      const double rate = std::abs(v[a]) * geometry.inv_h / kMostTravel;
      if (rate > result.max_rate) {
        result.max_rate = rate;
        result.limiting_point = i;
      }
    }
    result.kinetic += 0.5 * patch.points.at(c.mass, i) * v.squaredNorm();
    if (outside || levels.block_at(x.data()) != patch.key)
      leavers[i / kLanes] = static_cast<unsigned char>(leavers[i / kLanes] | 1U << (i % kLanes));
  }
}

void RigidBodies::throw_collisions(const BlockGrid& grid) const {
  for (const Patch& patch : grid.patches()) {
    if (patch.result.crossed == 0) continue;
    const int side = patch.result.crossed - 1;
    throw NumericalError(fmt::format(
        "rigid body '{}' has run into the {} side of the domain across grid axis {}, which carries "
        "a condition; a rigid body meets deformable bodies only: enlarge grid.box, or make that "
        "side open",
        find(patch.body)->options().name, side % 2 == 0 ? "lower" : "upper", side / 2));
  }
}

}  // namespace krater
