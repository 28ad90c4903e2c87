// SPDX-License-Identifier: GPL-3.0-or-later
// What measures rest on: extremes on a share of the mass, surfaces on points that stand for no more
// than a cell, a caliper's heights.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "krater/measure/measure_surface.hpp"
#include "krater/measure/measures.hpp"
#include "unit/measure/point_sets_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

constexpr double h = 1e-3;

MeasureOptions of_kind(MeasureKind kind, int axis = -1) {
  MeasureOptions options;
  options.kind = kind;
  options.axis = axis;
  return options;
}

/// Gas that filled z < 40 h and has expanded towards an open end: x' = z + stretch * z^4 / (40
/// h)^3, density that of its space.
struct Expanded {
  MeasureContext context;
  BodyPoints gas;
  int z;
  double farthest;
};

Expanded expanded(Frame frame, int points_per_direction, double stretch) {
  const bool space = frame == Frame::cartesian_3d;
  const int z = dimension(frame) - 1;
  Triple high{4 * h, space ? 4 * h : 300 * h, 300 * h}, filled = high;
  filled[static_cast<std::size_t>(z)] = 40 * h;
  Expanded e{measuring_domain(frame, h, {}, high), {}, z, 0};
  e.context.points_per_direction = points_per_direction;
  for (int d = 0; d < z; ++d)
    e.context.boundary[static_cast<std::size_t>(d)] = {BoundaryKind::symmetry,
                                                       BoundaryKind::symmetry};
  e.context.boundary[static_cast<std::size_t>(z)][0] = BoundaryKind::symmetry;
  e.gas = lattice_points(e.context, {}, filled, [](const Triple&) { return true; });
  for (std::size_t p = 0; p < e.gas.count(); ++p) {
    double& x = e.gas.x[p][static_cast<std::size_t>(z)];
    const double u = x / (40 * h);
    e.gas.density[p] /= 1 + 4 * stretch * u * u * u;
    x *= 1 + stretch * u * u * u;
    e.farthest = std::max(e.farthest, x);
  }
  return e;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("measures: the surface of a gas that has expanded is at its points, in the domain") {
    for (const Frame frame : all_frames)
      for (const int points : {1, 2, 4})
        for (const double stretch : {0.0, 0.5, 3.0, 6.45}) {  // ends at 40, 60, 160, 298 h
          CAPTURE(name(frame));
          CAPTURE(points);
          CAPTURE(stretch);
          if (frame == Frame::cartesian_3d && points == 4) continue;  // a million points
          const Expanded e = expanded(frame, points, stretch);
          const MeasureOptions front = of_kind(MeasureKind::max, e.z);
          const double found = evaluate(front, e.gas, e.context);
          CHECK(found <= std::min(e.farthest + 2 * h, 300 * h));
          CHECK(found > e.farthest - 0.15 * e.farthest);
          const double length = evaluate(of_kind(MeasureKind::extent, e.z), e.gas, e.context);
          CHECK(std::abs(length - found) < 0.1 * h);
          // Expanded 1, 3, 13 and 27 times at the end; a cell holds the first volume of 4 or 8
          // points.
          const bool sparse = stretch > (frame == Frame::cartesian_3d ? 3 : 0.5);
          CHECK(std::abs(evaluate(of_kind(MeasureKind::min, e.z), e.gas, e.context)) < 0.1 * h);
          CHECK(rarefied(front, e.gas, e.context) == sparse);
          CHECK(rarefied(of_kind(MeasureKind::extent, e.z), e.gas, e.context) == sparse);
          CHECK(!rarefied(of_kind(MeasureKind::min, e.z), e.gas, e.context));
          const double across = evaluate(of_kind(MeasureKind::max, 0), e.gas, e.context);
          CHECK(across <= 4 * h);
        }
  }

  TEST_CASE("measures: lone points of any volume move no surface beyond a cell of the points") {
    for (const Frame frame : all_frames) {
      const bool space = frame == Frame::cartesian_3d;
      const MeasureContext context =
          measuring_domain(frame, h, {}, {30 * h, space ? 30 * h : 40 * h, 40 * h});
      const auto z = static_cast<std::size_t>(dimension(frame) - 1);
      BodyPoints body =
          lattice_points(context, {}, {6 * h, 6 * h, 6 * h}, [](const Triple&) { return true; });
      for (const double density : {10.0, 1e-3, 1e-9}) {
        BodyPoints cloud = body;
        for (int i = 0; i < 4; ++i) {
          Triple x{2.1 * h, 2.1 * h, 2.1 * h};
          x[z] = (12.3 + 5 * i) * h;
          cloud.x.push_back(x);
          cloud.v.push_back({});
          cloud.mass.push_back(body.mass[0]);
          cloud.density.push_back(density);
          cloud.body.push_back(0);
        }
        for (const MeasureKind kind : {MeasureKind::max, MeasureKind::extent})
          CHECK(evaluate(of_kind(kind, static_cast<int>(z)), cloud, context) <= 29.3 * h);
        CHECK(evaluate(of_kind(MeasureKind::largest_diameter), cloud, context) <= 20 * h);
        MeasureOptions crater = of_kind(MeasureKind::crater_depth, static_cast<int>(z));
        crater.side = 1;
        const double depth = evaluate(crater, cloud, context, {.face = 6 * h});
        CHECK((std::isnan(depth) || depth >= -34 * h));
      }
    }
  }

  TEST_CASE("measures: an extreme is what a share of the mass reaches") {
    const MeasureContext context =
        measuring_domain(Frame::plane_strain, h, {0, 0}, {200 * h, 12 * h});
    BodyPoints body;
    for (int i = 0; i < 1000; ++i) {
      body.x.push_back({i * 0.1 * h, h, 0});
      body.v.push_back({});
      body.mass.push_back(2);
      body.density.push_back(1000);
      body.scalars["pressure"].push_back((7 * i) % 1000);  // every value from 0 to 999 once
    }
    body.scalars["pressure"][3] = 1e12;
    body.scalars["pressure"][4] = -1e12;
    MeasureOptions largest = of_kind(MeasureKind::maximum), least = of_kind(MeasureKind::minimum);
    largest.field = least.field = "pressure";
    const auto of_share = [&](MeasureOptions& measure, double share) {
      measure.mass_share = share;
      return evaluate(measure, body, context);
    };
    CHECK(of_share(largest, 0) == 1e12);
    CHECK(of_share(least, 0) == -1e12);
    CHECK(of_share(largest, 0.001) == 1e12);  // the point has that share
    CHECK(of_share(largest, 0.002) == 999);
    CHECK(of_share(largest, 0.1) == 901);
    CHECK(of_share(least, 0.002) == 0);
    CHECK(of_share(largest, 1) == -1e12);
    // Two lattices of the same field: a share finds the same value, a point does not.
    body.mass[3] = 1e-3;
    CHECK(of_share(largest, kExtremeShare) == 999);
  }

  TEST_CASE("measures: a caliper at the foot sees no bulge above it") {
    for (const Frame frame : all_frames) {
      const bool space = frame == Frame::cartesian_3d;
      const auto z = static_cast<std::size_t>(dimension(frame) - 1);
      const double low = frame == Frame::axisymmetric ? 0 : -9 * h;
      const MeasureContext context = measuring_domain(frame, h, {low, space ? low : 0, 0},
                                                      {9 * h, space ? 9 * h : 24 * h, 24 * h});
      Triple from{low, low, low}, to{9 * h, 9 * h, 9 * h};
      from[z] = 0, to[z] = 24 * h;
      const BodyPoints body = lattice_points(context, from, to, [&](const Triple& x) {
        const double r = space ? std::hypot(x[0], x[1]) : std::abs(x[0]);
        const double radius = x[z] < 6 * h ? 6 : x[z] < 14 * h ? 4 : 8;
        return r < radius * h && x[z] > 2 * h && x[z] < 22 * h;
      });
      MeasureOptions foot = of_kind(MeasureKind::largest_diameter);
      CHECK(std::abs(evaluate(foot, body, context) - 16 * h) < 0.2 * h);
      foot.level = 3 * h;
      CHECK(std::abs(evaluate(foot, body, context) - 12 * h) < 0.2 * h);
    }
  }
}
