// SPDX-License-Identifier: GPL-3.0-or-later
// Craters and holes of known shape in made-up plates.
#include "krater/measure/openings.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "unit/measure/point_sets_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

constexpr double h = 0.5e-3;

/// Axisymmetric, plane strain about a symmetry plane, a quarter and the whole in 3d.
struct Case {
  Frame frame;
  bool cut;
};

MeasureContext room(const Case& c, double width = 14 * h) {
  const double low = c.cut || c.frame == Frame::axisymmetric ? 0 : -width;
  const bool space = c.frame == Frame::cartesian_3d;
  MeasureContext context = measuring_domain(c.frame, h, {low, space ? low : 0, 0},
                                            {width, space ? width : 16 * h, 16 * h});
  if (c.cut) context.boundary[0][0] = BoundaryKind::symmetry;
  if (c.cut && space) context.boundary[1][0] = BoundaryKind::symmetry;
  return context;
}

/// A plate between z = 2 h and 8 h, out to 12 h, of what is not in `removed(r, z)`.
template <class R>
BodyPoints plate(const Case& c, const R& removed) {
  const MeasureContext context = room(c);
  const int last = dimension(c.frame) - 1;
  const double low = context.min[0];
  const auto z = static_cast<std::size_t>(last);
  Triple from{low, low, low}, to{14 * h, 14 * h, 14 * h};
  from[z] = 0, to[z] = 16 * h;
  return lattice_points(context, from, to, [&](const Triple& x) {
    const double r = last == 2 ? std::hypot(x[0], x[1]) : std::abs(x[0]);
    return r < 12 * h && x[z] > 2 * h && x[z] < 8 * h && !removed(r, x[z]);
  });
}

const Case kCases[] = {{Frame::axisymmetric, false},
                       {Frame::plane_strain, true},
                       {Frame::plane_strain, false},
                       {Frame::cartesian_3d, true},
                       {Frame::cartesian_3d, false}};

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("openings: depth and diameter of a conical crater, on either face") {
    for (const Case& c : kCases)
      for (const int side : {0, 1})
        for (const double depth : {2.5 * h, 4.0 * h}) {
          CAPTURE(name(c.frame));
          CAPTURE(c.cut);
          CAPTURE(side);
          CAPTURE(depth / h);
          // Flat bottom of radius 3 h, flank of 45 degrees.
          const double face = side == 1 ? 8 * h : 2 * h;
          const BodyPoints body = plate(c, [&](double r, double z) {
            const double below = side == 1 ? face - z : z - face;
            return below < depth && r < 3 * h + depth - below;
          });
          const MeasureContext context = room(c);
          CHECK(std::abs(crater_depth(body, context, side, face) - depth) < 0.1 * h);
          for (const double level : {1.0 * h, 1.5 * h, 2.0 * h}) {
            CAPTURE(level / h);
            const double D = 2 * (3 * h + depth - level);
            CHECK(std::abs(crater_diameter(body, context, side, face, level) - D) < 0.3 * h);
          }
          CHECK(std::abs(crater_depth(body, context, 1 - side, 10 * h - face)) < 0.05 * h);
          CHECK(crater_diameter(body, context, 1 - side, 10 * h - face, 0.25 * h) == 0);
        }
  }

  TEST_CASE("openings: a lip does not count; a perforated plate has no crater depth") {
    for (const Case& c : kCases) {
      CAPTURE(name(c.frame));
      CAPTURE(c.cut);
      const BodyPoints lipped = plate(c, [](double r, double z) {
        const bool crater = r < 5 * h && z > 5 * h;
        return crater || (z > 7 * h && r > 8 * h);  // the plate's face at 7 h, a lip up to 8 h
      });
      CHECK(std::abs(crater_depth(lipped, room(c), 1, 7 * h) - 2 * h) < 0.1 * h);
      CHECK(std::abs(crater_diameter(lipped, room(c), 1, 7 * h, h) - 10 * h) < 0.2 * h);
      const BodyPoints holed = plate(c, [](double r, double) { return r < 4.3 * h; });
      CHECK(std::isnan(crater_depth(holed, room(c), 1, 8 * h)));
      CHECK(std::abs(crater_diameter(holed, room(c), 1, 8 * h, h) - 8.6 * h) < 0.2 * h);
    }
  }

  TEST_CASE("openings: a hole is measured at its throat, where it is and if it is one") {
    for (const Case& c : kCases) {
      if (c.frame == Frame::plane_strain) continue;
      CAPTURE(name(c.frame));
      CAPTURE(c.cut);
      for (const double radius : {3.0 * h, 4.37 * h, 6.0 * h}) {
        CAPTURE(radius / h);
        const BodyPoints straight = plate(c, [&](double r, double) { return r < radius; });
        // In 3d low by a^2 / (2 R): smoothing, and chords instead of arcs.
        const bool space = c.frame == Frame::cartesian_3d;
        const double bias = space ? -h * h / (2 * radius) : 0;
        CHECK(std::abs(hole_diameter(straight, room(c)) - 2 * radius - bias) < 0.08 * h);
        const BodyPoints waisted = plate(c, [&](double r, double z) {
          return r < radius + std::max(0.0, std::abs(z - 5 * h) - h);
        });
        CHECK(std::abs(hole_diameter(waisted, room(c)) - 2 * radius) < 0.2 * h);
      }
      CHECK(hole_diameter(plate(c, [](double, double) { return false; }), room(c)) < 1e-3 * h);
      const BodyPoints blind = plate(c, [](double r, double z) { return r < 4 * h && z > 4 * h; });
      CHECK(hole_diameter(blind, room(c)) < 0.02 * h);
    }
  }

  TEST_CASE("openings: of two holes in 3d the larger, a notch in the edge is none") {
    const Case c{Frame::cartesian_3d, false};
    const MeasureContext context = room(c);
    const BodyPoints body = lattice_points(
        context, {-14 * h, -14 * h, 0}, {14 * h, 14 * h, 16 * h}, [&](const Triple& x) {
          const bool in_plate =
              std::abs(x[0]) < 12 * h && std::abs(x[1]) < 12 * h && x[2] > 2 * h && x[2] < 6 * h;
          const bool hole = std::hypot(x[0] - 5 * h, x[1] - 5 * h) < 4 * h ||
                            std::hypot(x[0] + 5 * h, x[1] + 4 * h) < 2.5 * h;
          const bool notch = x[0] > 6 * h && std::abs(x[1] + 6 * h) < 3 * h;
          return in_plate && !hole && !notch;
        });
    CHECK(std::abs(hole_diameter(body, context) - 8 * h + h / 8) < 0.05 * h);
  }
}
