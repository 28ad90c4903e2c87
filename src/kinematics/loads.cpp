// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/loads.hpp"

#include "krater/core/ranks.hpp"

namespace krater {

namespace {

Triple vector_at(const PointStore& points, int column, int dimension, int i) {
  Triple x{};
  for (int a = 0; a < dimension; ++a)
    x[static_cast<std::size_t>(a)] = points.at(column + kLanes * a, i);
  return x;
}

Eigen::Vector3d vector(const Triple& x) { return {x[0], x[1], x[2]}; }

}  // namespace

Triple accelerate(PointStore& points, const PointColumns& c, int reference, int dimension,
                  const Acceleration& load, double time) {
  Triple force{};
  for (int i = 0; i < points.count(); ++i) {
    const Triple b = load(vector_at(points, c.position, dimension, i),
                          vector_at(points, reference, dimension, i), time);
    for (int a = 0; a < dimension; ++a)
      points.at(c.body_acceleration + kLanes * a, i) = b[static_cast<std::size_t>(a)];
    for (std::size_t a = 0; a < 3; ++a) force[a] += points.at(c.mass, i) * b[a];
  }
  points.pad(c.mass);
  return force;
}

void load_rigid(RigidBody& body, BlockGrid& grid, const PointColumns& c, const Acceleration& load,
                double time) {
  const int dimension = grid.geometry().dimension;
  ReproducibleSums<6> sums;
  for (const Patch& patch : grid.patches()) {
    if (patch.body != body.options().body) continue;
    const PointStore& points = patch.points;
    for (int i = 0; i < points.count(); ++i) {
      const Triple x = vector_at(points, c.position, dimension, i);
      const Triple X = vector_at(points, body.options().reference, dimension, i);
      const Eigen::Vector3d f = points.at(c.mass, i) * vector(load(x, X, time));
      const Eigen::Vector3d moment = (vector(x) - body.twist().centre).cross(f);
      sums.add(f.data(), 3);
      sums.add(moment.data(), 3, 3);
    }
  }
  ranks::sum(sums.all);
  Eigen::Vector3d force, moment;
  sums.read(force.data(), 3);
  sums.read(moment.data(), 3, 3);
  body.set_load(force, moment);
}

}  // namespace krater
