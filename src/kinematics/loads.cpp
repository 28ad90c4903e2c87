// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/loads.hpp"

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
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = force;
  for (const Patch& patch : grid.patches()) {
    if (patch.body != body.options().body) continue;
    const PointStore& points = patch.points;
    for (int i = 0; i < points.count(); ++i) {
      const Triple x = vector_at(points, c.position, dimension, i);
      const Triple X = vector_at(points, body.options().reference, dimension, i);
      const Eigen::Vector3d f = points.at(c.mass, i) * vector(load(x, X, time));
      force += f;
      moment += (vector(x) - body.twist().centre).cross(f);
    }
  }
  body.set_load(force, moment);
}

}  // namespace krater
