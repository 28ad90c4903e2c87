// SPDX-License-Identifier: GPL-3.0-or-later
// Connected pieces and selections of made-up points.
#include "krater/measure/pieces.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "unit/measure/point_sets_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

constexpr double h = 1e-3;

MeasureContext plane() {
  return measuring_domain(Frame::plane_strain, h, {0, 0}, {40 * h, 40 * h});
}

BodyPoints block(const MeasureContext& context, Triple low, Triple high, Triple v, int body = 0) {
  BodyPoints points = lattice_points(
      context, low, high, [](const Triple&) { return true; }, body);
  std::fill(points.v.begin(), points.v.end(), v);
  return points;
}

MeasureOptions of_kind(MeasureKind kind) {
  MeasureOptions options;
  options.kind = kind;
  options.axis = 0;
  return options;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("pieces: mass, velocity, centre, range and number of two blocks, the heavier first") {
    const MeasureContext context = plane();
    const BodyPoints points = together(block(context, {2 * h, 2 * h}, {4 * h, 6 * h}, {3, -1}),
                                       block(context, {10 * h, 2 * h}, {16 * h, 6 * h}, {-5, 2}));
    const Pieces pieces = connected_pieces(points, context);
    REQUIRE(pieces.list.size() == 2);
    const Piece& heavy = pieces.list[0];
    CHECK(heavy.points == 96);
    CHECK(pieces.list[1].points == 32);
    CHECK(heavy.mass == doctest::Approx(24 * h * h * 1000).epsilon(1e-12));
    CHECK(heavy.velocity[0] == doctest::Approx(-5));
    CHECK(heavy.velocity[1] == doctest::Approx(2));
    CHECK(heavy.centre[0] == doctest::Approx(13 * h).epsilon(1e-12));
    CHECK(heavy.centre[1] == doctest::Approx(4 * h).epsilon(1e-12));
    CHECK(heavy.low[0] == doctest::Approx(10.25 * h).epsilon(1e-12));
    CHECK(heavy.high[1] == doctest::Approx(5.75 * h).epsilon(1e-12));
    CHECK(heavy.number == 0);
    CHECK(pieces.list[1].number == 1);
    CHECK(pieces.of.front() == 1);
    CHECK(pieces.of.back() == 0);
  }

  TEST_CASE("pieces: joined up to a cell apart, parted beyond two, wherever the grid lies") {
    for (const double shift : {0.0, 0.2, 0.5, 0.9}) {
      CAPTURE(shift);
      for (const Frame frame : {Frame::plane_strain, Frame::cartesian_3d}) {
        const MeasureContext context =
            measuring_domain(frame, h, {0, 0, 0}, {40 * h, 40 * h, 40 * h});
        for (int axis = 0; axis < dimension(frame); ++axis)
          for (const double gap : {0.99, 2.01}) {
            BodyPoints points;
            for (int i = 0; i < 6; ++i) {
              Triple x{(7 + shift) * h, (8 + shift) * h, (9 + shift) * h};
              x[static_cast<std::size_t>(axis)] += i * gap * h;
              points.x.push_back(x);
              points.v.push_back({});
              points.mass.push_back(1);
              points.density.push_back(1);
            }
            const Pieces pieces = connected_pieces(points, context);
            CHECK(pieces.list.size() == (gap < 1 ? 1 : 6));
          }
      }
    }
  }

  TEST_CASE("pieces: diagonal neighbours hold, bodies stay apart, below the origin too") {
    MeasureContext context =
        measuring_domain(Frame::cartesian_3d, h, {0, 0, 0}, {9 * h, 9 * h, 9 * h});
    BodyPoints points;
    for (int i = -3; i < 4; ++i) {
      points.x.push_back({i * h + 0.5 * h, -i * h + 0.5 * h, i * h + 0.5 * h});
      points.v.push_back({});
      points.mass.push_back(1);
      points.density.push_back(1);
      points.body.push_back(2);
    }
    CHECK(connected_pieces(points, context).list.size() == 1);
    points.body[3] = 0;
    const Pieces pieces = connected_pieces(points, context);
    REQUIRE(pieces.list.size() == 3);
    CHECK(pieces.list[2].body == 0);
    CHECK(pieces.list[2].number == 0);
    CHECK(pieces.list[1].number == 1);
    points.x[0] = {1e300, -1e300, 0};
    CHECK(connected_pieces(points, context).list.size() == 4);
    CHECK(connected_pieces(BodyPoints{}, context).list.empty());
  }

  TEST_CASE("pieces: rubble between two blocks holds nothing together, and joins what it touches") {
    const MeasureContext context = plane();
    BodyPoints points = block(context, {2 * h, 2 * h}, {14 * h, 6 * h}, {});
    CHECK(connected_pieces(points, context).list.size() == 1);
    points.rubble.assign(points.count(), 0);
    const auto loosen = [&](double low, double high) {
      for (std::size_t p = 0; p < points.count(); ++p)
        points.rubble[p] = points.x[p][0] > low && points.x[p][0] < high ? 1 : 0;
    };
    loosen(6 * h, 8 * h);  // both columns of cells touch a block: a chain through them holds
    CHECK(connected_pieces(points, context).list.size() == 2);
    loosen(6 * h, 9 * h);  // the middle column touches none: 4 cells on their own
    const Pieces parted = connected_pieces(points, context);
    CHECK(parted.list.size() == 2 + 4);
    CHECK(parted.list[0].points == 6 * 4 * 4);
    loosen(6 * h, 7 * h);  // one column touches both blocks
    CHECK(connected_pieces(points, context).list.size() == 1);
  }

  TEST_CASE("pieces: the order of the points changes nothing") {
    const MeasureContext context = plane();
    BodyPoints points = together(block(context, {2 * h, 2 * h}, {9 * h, 3 * h}, {}),
                                 block(context, {8 * h, 3 * h}, {9 * h, 9 * h}, {}));
    points = together(points, block(context, {2 * h, 8 * h}, {6 * h, 9 * h}, {}));
    const Pieces before = connected_pieces(points, context);
    REQUIRE(before.list.size() == 2);
    std::vector<std::size_t> order(points.count());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::reverse(order.begin(), order.end());
    std::swap_ranges(order.begin(), order.begin() + 20, order.begin() + 30);
    BodyPoints shuffled;
    for (const std::size_t p : order) {
      shuffled.x.push_back(points.x[p]);
      shuffled.v.push_back(points.v[p]);
      shuffled.mass.push_back(points.mass[p]);
      shuffled.density.push_back(points.density[p]);
      shuffled.body.push_back(points.body[p]);
    }
    const Pieces after = connected_pieces(shuffled, context);
    REQUIRE(after.list.size() == 2);
    for (std::size_t i = 0; i < order.size(); ++i) CHECK(after.of[i] == before.of[order[i]]);
  }

  TEST_CASE("selection: region, largest piece, least points; the region is cut out first") {
    const MeasureContext context = plane();
    BodyPoints points = together(block(context, {2 * h, 2 * h}, {4 * h, 6 * h}, {3, 0}),
                                 block(context, {10 * h, 2 * h}, {16 * h, 6 * h}, {-5, 0}));
    points = together(points, block(context, {30 * h, 2 * h}, {31 * h, 3 * h}, {100, 0}));
    for (std::size_t p = 0; p < points.count(); ++p)
      points.scalars["temperature"].push_back(static_cast<double>(p));
    MeasureOptions velocity = of_kind(MeasureKind::mean_velocity);
    const auto value = [&](const MeasureOptions& options) {
      return evaluate(options, select(options.selection, points, context), context);
    };
    CHECK(value(velocity) == doctest::Approx((32 * 3 - 96 * 5 + 4 * 100) / 132.0));
    velocity.selection.largest_piece = true;
    CHECK(value(velocity) == doctest::Approx(-5));
    velocity.selection.region[0][1] = 11 * h;  // leaves 16 points of the heavier block
    CHECK(value(velocity) == doctest::Approx(3));
    MeasureOptions count = of_kind(MeasureKind::fragments);
    CHECK(value(count) == 3);
    count.selection.least_points = 5;
    CHECK(value(count) == 2);
    count.selection.least_points = 33;
    CHECK(value(count) == 1);
    MeasureOptions hottest = of_kind(MeasureKind::maximum);
    hottest.field = "temperature";
    hottest.mass_share = 0;  // the single point
    hottest.selection.region[0] = {0, 5 * h};
    CHECK(value(hottest) == 31);
    MeasureOptions nothing = of_kind(MeasureKind::mass);
    nothing.selection.region[1] = {20 * h, 30 * h};
    CHECK(value(nothing) == 0);
    nothing.kind = MeasureKind::mean_velocity;
    CHECK(std::isnan(value(nothing)));
  }
}
