// SPDX-License-Identifier: GPL-3.0-or-later
// The kinds of measures on made-up points with known answers, and their documentation.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

#include "krater/core/errors.hpp"
#include "krater/measure/measure_series.hpp"
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

BodyPoints two_points() {
  BodyPoints body;
  body.x = {{1 * h, 2 * h}, {3 * h, 2 * h}};
  body.v = {{1, -3, 0}, {5, 1, 0}};
  body.mass = {1, 3};
  body.density = {1000, 1000};
  return body;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("measure kinds: the registry is in order, complete and documented with its units") {
    const auto& kinds = measure_kinds();
    REQUIRE(kinds.size() == static_cast<std::size_t>(MeasureKind::bulge) + 1);
    std::ifstream stream(std::string{KRATER_SOURCE_DIR} + "/src/output/README.md");
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      const std::string kind_name = kinds[i].name;
      CAPTURE(kind_name);
      CHECK(static_cast<std::size_t>(kinds[i].kind) == i);
      const std::string unit = *kinds[i].unit != '\0' ? kinds[i].unit : "of the field";
      const std::size_t row = text.find("| `" + std::string{kinds[i].name} + "` | " + unit + " |");
      CHECK(row != std::string::npos);
    }
  }

  TEST_CASE("measure kinds: momentum, energies, masses") {
    const MeasureContext context =
        measuring_domain(Frame::plane_strain, h, {0, 0}, {20 * h, 12 * h});
    BodyPoints body = two_points();
    CHECK(evaluate(of_kind(MeasureKind::momentum, 0), body, context) == 16);
    CHECK(evaluate(of_kind(MeasureKind::momentum, 1), body, context) == 0);
    CHECK(evaluate(of_kind(MeasureKind::kinetic_energy), body, context) == 44);
    CHECK(evaluate(of_kind(MeasureKind::mass), body, context) == 4);
    body.scalars["internal_energy"] = {10, 20};
    CHECK(evaluate(of_kind(MeasureKind::internal_energy), body, context) == 70);
    CHECK(evaluate(of_kind(MeasureKind::failed_mass), body, context) == 0);
    body.scalars["failed"] = {0, 1};
    CHECK(evaluate(of_kind(MeasureKind::failed_mass), body, context) == 3);
    CHECK(evaluate(of_kind(MeasureKind::removed_mass), body, context, {.mass = 6}) == 2);
    CHECK(evaluate(of_kind(MeasureKind::removed_mass), body, context, {.mass = 4 + 1e-15}) == 0);
    CHECK(evaluate(of_kind(MeasureKind::mass_lost), body, context, {.mass = 6}) == 5);
    CHECK(evaluate(of_kind(MeasureKind::mass_lost), BodyPoints{}, context, {.mass = 6}) == 6);
    body.scalars.erase("internal_energy");
    CHECK_THROWS_AS(evaluate(of_kind(MeasureKind::internal_energy), body, context), InputError);
  }

  TEST_CASE("measure kinds: how a rod flies in 3d, whole and cut by a plane of symmetry") {
    MeasureContext context =
        measuring_domain(Frame::cartesian_3d, h, {0, 0, 0}, {30 * h, 30 * h, 30 * h});
    BodyPoints rod = lattice_points(context, {6 * h, 0, 10 * h}, {22 * h, 4 * h, 14 * h},
                                    [](const Triple&) { return true; });
    for (std::size_t p = 0; p < rod.count(); ++p)  // turns about y through its middle
      rod.v.at(p) = {30 + 2 * (rod.x[p][2] - 12 * h), 0, 40 - 2 * (rod.x[p][0] - 14 * h)};
    MeasureOptions line = of_kind(MeasureKind::obliquity, 2);
    CHECK(evaluate(line, rod, context) == doctest::Approx(std::atan2(3, 4)));
    CHECK(evaluate(of_kind(MeasureKind::yaw), rod, context) ==
          doctest::Approx(std::atan2(4, 3)).epsilon(1e-6));
    line = of_kind(MeasureKind::tilt);
    line.direction = {std::sqrt(0.5), 0, std::sqrt(0.5)};
    CHECK(evaluate(line, rod, context) == doctest::Approx(std::atan2(1, 1)).epsilon(1e-6));
    line.kind = MeasureKind::momentum;
    const double mass = evaluate(of_kind(MeasureKind::mass), rod, context);
    CHECK(evaluate(line, rod, context) == doctest::Approx(mass * 70 * std::sqrt(0.5)));
    const double spin = evaluate(of_kind(MeasureKind::angular_momentum, 1), rod, context);
    CHECK(spin == doctest::Approx(2 * mass * (256 + 16) * h * h / 12).epsilon(0.02));
    context.boundary[1][0] = BoundaryKind::symmetry;
    CHECK(evaluate(of_kind(MeasureKind::yaw), rod, context) ==
          doctest::Approx(std::atan2(4, 3)).epsilon(1e-6));
    const BodyPoints cube = lattice_points(context, {6 * h, 6 * h, 6 * h}, {14 * h, 14 * h, 14 * h},
                                           [](const Triple&) { return true; });
    CHECK(std::isnan(evaluate(of_kind(MeasureKind::tilt, 2), cube, context)));
  }

  TEST_CASE("measure kinds: sound mass, bulge, impulse along a line") {
    MeasureContext context =
        measuring_domain(Frame::axisymmetric, h, {0, -20 * h}, {20 * h, 20 * h});
    BodyPoints plate =
        lattice_points(context, {0, -5 * h}, {12 * h, 5 * h}, [](const Triple&) { return true; });
    plate.scalars["failed"].assign(plate.count(), 0);
    plate.scalars["failed"].front() = 1;
    CHECK(
        evaluate(of_kind(MeasureKind::sound_mass), plate, context) ==
        doctest::Approx(evaluate(of_kind(MeasureKind::mass), plate, context) - plate.mass.front()));
    MeasureOptions bulge = of_kind(MeasureKind::bulge, 1);
    bulge.side = 0;
    const MeasureStart start{.face = face_position(bulge, plate, context)};
    for (std::size_t p = 0; p < plate.count(); ++p) plate.x[p][1] -= 3 * h;
    CHECK(std::abs(evaluate(bulge, plate, context, start) - 3 * h) < 0.02 * h);
    context.impulse = {1, 2, 0};
    MeasureOptions impulse = of_kind(MeasureKind::impulse);
    impulse.direction = {0.6, 0.8, 0};
    CHECK(evaluate(impulse, BodyPoints{}, context) == doctest::Approx(2.2));
  }

  TEST_CASE("measure kinds: penetration depth counts from the target's face, into the target") {
    for (const int side : {0, 1}) {
      const MeasureContext context =
          measuring_domain(Frame::axisymmetric, h, {0, -20 * h}, {20 * h, 20 * h});
      const auto all = [](const Triple&) { return true; };
      const BodyPoints target = lattice_points(context, {0, -5 * h}, {12 * h, 5 * h}, all);
      const BodyPoints rod = lattice_points(context, {0, -3 * h}, {3 * h, 3 * h}, all);
      MeasureOptions depth = of_kind(MeasureKind::penetration_depth, 1);
      depth.side = side;
      MeasureStart start;
      start.face = face_position(depth, target, context);
      CHECK(std::abs(start.face - (side == 1 ? 5 : -5) * h) < 0.02 * h);
      CHECK(std::abs(evaluate(depth, rod, context, start) - 8 * h) < 0.03 * h);
    }
  }

  TEST_CASE("measure kinds: debris extent of a share of the mass, mirrored at the axis") {
    MeasureContext context = measuring_domain(Frame::plane_strain, h, {0, 0}, {200 * h, 12 * h});
    BodyPoints body;
    for (int i = 0; i < 100; ++i) {  // spacing h / 2 from 10 h to 60 h, in a scrambled order
      body.x.push_back({10.25 * h + 0.5 * h * (37 * i % 100), 2 * h});
      body.v.push_back({});
      body.mass.push_back(2);
      body.density.push_back(1000);
    }
    MeasureOptions length = of_kind(MeasureKind::debris_extent, 0);
    CHECK(evaluate(length, body, context) == doctest::Approx(50 * h).epsilon(1e-12));
    body.x.push_back({150 * h, 2 * h});  // a splinter
    body.v.push_back({});
    body.mass.push_back(1e-3);
    body.density.push_back(1000);
    CHECK(evaluate(length, body, context) == doctest::Approx(140 * h).epsilon(1e-2));
    length.mass_share = 0.9;
    CHECK(std::abs(evaluate(length, body, context) - 45 * h) < 1.01 * h);
    context.boundary[0][0] = BoundaryKind::symmetry;
    CHECK(std::abs(evaluate(length, body, context) - 2 * 55 * h) < 1.01 * h);
    body.mass[0] = 1e6;  // most of the mass in one point, at 10.25 h
    CHECK(evaluate(length, body, context) == doctest::Approx(2 * 10.5 * h).epsilon(1e-12));
  }

  TEST_CASE("measure kinds: largest diameter, wherever it is") {
    for (const Frame frame : all_frames) {
      const bool space = frame == Frame::cartesian_3d;
      const auto z = static_cast<std::size_t>(dimension(frame) - 1);
      const double low = frame == Frame::axisymmetric ? 0 : -9 * h;
      const MeasureContext context = measuring_domain(frame, h, {low, space ? low : 0, 0},
                                                      {9 * h, space ? 9 * h : 24 * h, 24 * h});
      for (const double middle : {4.0 * h, 11.3 * h, 20.0 * h}) {
        CAPTURE(name(frame));
        CAPTURE(middle / h);
        Triple from{low, low, low}, to{9 * h, 9 * h, 9 * h};
        from[z] = 0, to[z] = 24 * h;
        const BodyPoints body = lattice_points(context, from, to, [&](const Triple& x) {
          const double r = space ? std::hypot(x[0], x[1]) : std::abs(x[0]);
          const double bulge = std::max(0.0, 3 * h - 0.1 * std::pow(x[z] - middle, 2) / h);
          return r < 4 * h + bulge && x[z] > 2 * h && x[z] < 22 * h;
        });
        const double found = evaluate(of_kind(MeasureKind::largest_diameter), body, context);
        CHECK(std::abs(found - 14 * h) < 0.2 * h);  // the curvature takes 0.13 R'' b^2 per side
      }
    }
  }

  TEST_CASE("measure series: deceleration, its peak and its end") {
    MeasureOptions now = of_kind(MeasureKind::deceleration, 0), peak = now;
    MeasureOptions end = of_kind(MeasureKind::settling_time, 0);
    peak.keep = Keep::largest;
    MeasureSeries a, b, c;
    // -300 m/s, from 2 us on slower by 100 m/s in 1 us, by 50 m/s in the next, then steady.
    const double times[] = {0, 1e-6, 2e-6, 3e-6, 4e-6, 5e-6, 6e-6};
    const double speeds[] = {-300, -300, -300, -200, -150, -150, -150};
    const double expected[] = {0, 0, 0, 1e8, 5e7, 0, 0};
    for (int i = 0; i < 7; ++i) {
      CAPTURE(i);
      CHECK(follow(now, a, times[i], speeds[i]) == doctest::Approx(expected[i]));
      CHECK(follow(now, a, times[i], speeds[i]) == doctest::Approx(expected[i]));  // asked twice
      follow(peak, b, times[i], speeds[i]);
      follow(end, c, times[i], speeds[i]);
    }
    CHECK(b.kept == doctest::Approx(1e8));
    CHECK(b.kept_time == 3e-6);
    // 1 % of 150 m/s is left when 48.5 of 50 m/s are gone.
    CHECK(settling_time(c) == doctest::Approx(3e-6 + 48.5 / 50 * 1e-6));
    MeasureSeries steady{{1, 2, 3}, {7, 7, 7}};
    CHECK(settling_time(steady) == 1);
    MeasureSeries ringing{{0, 1, 2, 3, 4}, {10, -1, 1, 0, 0}};
    CHECK(settling_time(ringing) == doctest::Approx(2 + 0.9));
    MeasureSeries across{{0, 1, 2}, {10, 0.05, 0}};
    CHECK(settling_time(across) == doctest::Approx((10 - 0.1) / (10 - 0.05)));
    CHECK(std::isnan(settling_time({})));
  }

  TEST_CASE("measure series: the extreme so far passes over what is not a number") {
    MeasureOptions smallest = of_kind(MeasureKind::min, 0);
    smallest.keep = Keep::smallest;
    MeasureSeries series;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(std::isnan(follow(smallest, series, 0, nan)));
    CHECK(follow(smallest, series, 1, 5) == 5);
    CHECK(follow(smallest, series, 2, 4) == 4);
    CHECK(follow(smallest, series, 3, nan) == 4);
    CHECK(follow(smallest, series, 4, 6) == 4);
    CHECK(series.kept_time == 2);
  }
}
