// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/simulation/rigid_course.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "krater/core/errors.hpp"
#include "krater/core/ranks.hpp"

namespace krater {

namespace {

using Eigen::Vector3d;

constexpr int kMostSteps = 20000;
constexpr double kTravel = 0.25;   // cells in a step
constexpr int kLeastSteps = 1000;  // a motion that starts from rest must be seen to start
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Points that reach furthest along the directions of the neighbours of a cell, at the start.
std::vector<Vector3d> outermost(const Simulation& sim, const RigidBody& body) {
  const int dim = dimension(sim.scene().frame);
  std::vector<Vector3d> directions;
  for (int n = 0; n < 27; ++n) {
    const Vector3d d{n % 3 - 1.0, n / 3 % 3 - 1.0, dim == 3 ? n / 9 - 1.0 : 0.0};
    if (d.squaredNorm() > 0 && (dim == 3 || n < 9)) directions.push_back(d);
  }
  std::vector<Vector3d> found;
  std::vector<double> reach(directions.size(), -kNever);
  for (int s = 0; s < sim.set_count(); ++s) {
    if (sim.set(s).body != body.options().body) continue;
    for (int i = 0; i < sim.set(s).count(); ++i) {
      Vector3d X = Vector3d::Zero();
      for (int a = 0; a < dim; ++a) X[a] = sim.value(s, i, body.options().reference / kLanes + a);
      found.resize(directions.size(), X);
      for (std::size_t k = 0; k < directions.size(); ++k) {
        if (!(directions[k].dot(X) > reach[k])) continue;
        reach[k] = directions[k].dot(X);
        found[k] = X;
      }
    }
  }
  return found;
}

/// The side, 2 axis + (0, 1), that x has passed.
std::optional<int> passed(const GridOptions& grid, int dim, const Vector3d& x) {
  for (int a = 0; a < dim; ++a) {
    const auto k = static_cast<std::size_t>(a);
    if (x[a] < grid.min[k]) return 2 * a;
    if (x[a] > grid.max[k]) return 2 * a + 1;
  }
  return std::nullopt;
}

/// When the body runs into each side, for the first that it runs into; kNever otherwise. Points
/// that leave through open sides run into nothing.
std::array<double, 6> course(const Scene& scene, RigidBody body, std::vector<Vector3d> points) {
  std::array<double, 6> when;
  when.fill(kNever);
  const int dim = dimension(scene.frame);
  const double end = scene.time.end, least = end / kMostSteps;
  double time = 0;
  for (int step = 0; step < kMostSteps && time < end && !points.empty(); ++step) {
    double fastest = 0;
    for (const Vector3d& X : points)
      fastest = std::max(fastest, body.twist().at(body.position(X)).norm());
    double dt = std::min(end / kLeastSteps, end - time);
    if (fastest > 0) dt = std::min(dt, std::max(least, kTravel * scene.grid.cell / fastest));
    body.begin(time, dt);
    body.finish(dt);
    time += dt;
    bool met = false;
    std::erase_if(points, [&](const Vector3d& X) {
      const std::optional<int> side = passed(scene.grid, dim, body.position(X));
      if (!side) return false;
      const auto s = static_cast<std::size_t>(*side);
      if (scene.grid.boundary[s / 2][s % 2].closed()) {
        when[s] = std::min(when[s], time);
        met = true;
      }
      return true;
    });
    if (met) break;
  }
  return when;
}

std::string side_name(const Scene& scene, const SideCollision& c) {
  return fmt::format("{}_{}", axis_name(scene.frame, c.axis), c.side == 0 ? "min" : "max");
}

}  // namespace

std::optional<SideCollision> foresee_collision(const Simulation& sim, const RigidBody& body) {
  const std::array<double, 6> mine = course(sim.scene(), body, outermost(sim, body));
  SideCollision first{0, 0, kNever};
  for (int s = 0; s < 6; ++s) {
    const double time = -ranks::max(-mine[static_cast<std::size_t>(s)]);
    if (time < first.time) first = {s / 2, s % 2, time};
  }
  if (first.time == kNever) return std::nullopt;
  return first;
}

void require_way(const Simulation& sim) {
  const Scene& scene = sim.scene();
  if (scene.stop.when != StopOptions::When::never) return;
  for (const RigidBody& body : sim.rigid().all()) {
    if (body.options().free) continue;
    if (const auto met = foresee_collision(sim, body))
      throw InputError(fmt::format(
          "{}: its motion runs into {} at {:.3g} s (time.end is {:.3g} s), and a rigid body that "
          "meets a side with a condition ends the run: enlarge grid.box, make that side open, or "
          "end before",
          body.options().where, side_name(scene, *met), met->time, scene.time.end));
  }
}

std::vector<std::string> doubt_course(const Simulation& sim) {
  const Scene& scene = sim.scene();
  std::vector<std::string> doubts;
  for (const RigidBody& body : sim.rigid().all())
    if (const auto met = foresee_collision(sim, body))
      doubts.push_back(fmt::format(
          "{}: if nothing {} before, it runs into {} at {:.3g} s, and a rigid body that meets a "
          "side with a condition ends the run: enlarge grid.box, or make that side open",
          body.options().name, body.options().free ? "stops it" : "ends the run",
          side_name(scene, *met), met->time));
  return doubts;
}

}  // namespace krater
