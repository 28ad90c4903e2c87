// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>

#include "geometry_cases.hpp"

using namespace krater;
using namespace krater::test;

namespace {

LatticeOptions spacing(double cell, std::array<double, 3> origin = {}) {
  LatticeOptions options;
  options.cell = cell;
  options.origin = origin;
  return options;
}

bool same(const std::vector<SeedPoint>& a, const std::vector<SeedPoint>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& p, const auto& q) {
    return p.x == q.x && p.measure == q.measure && p.half_width == q.half_width;
  });
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("lattice: measure and centroid exact, seeds inside, for any solid, frame and offset") {
    for (const Case& c : exact_cases()) {
      for (const double offset : {0.0, 0.31, 0.5}) {
        for (const bool stagger : {true, false}) {
          CAPTURE(c.name);
          CAPTURE(offset);
          CAPTURE(stagger);
          LatticeOptions options = spacing(1.1e-3, {offset * 0.55e-3, offset * 0.4e-3, 0});
          options.stagger = stagger;
          FillReport report;
          const auto points = fill(*c.solid, c.frame, options, c.domain, &report);
          CHECK(report.count == points.size());
          CHECK(std::abs(report.measure_points / c.measure - 1) < 1e-12);
          CHECK(std::abs(report.measure_exact / c.measure - 1) < 1e-12);
          const std::size_t first =
              c.frame == Frame::axisymmetric ? 1 : 0;  // r is not a mass centre
          for (std::size_t a = first; a < 3; ++a) {
            double moment = 0;
            for (const auto& p : points) moment += p.measure * p.x[a];
            CHECK(std::abs(moment / c.measure - c.centroid[a]) < 1e-12 * 25.4e-3);
          }
          long outside = 0;
          for (const auto& p : points) {
            outside += !c.solid->contains(c.frame, p.x);
            outside += !encloses(c.domain, p.x, dimension(c.frame));
          }
          CHECK(outside == 0);
        }
      }
    }
  }

  TEST_CASE("lattice: masses lie between half and about twice the nominal one") {
    double least = 9, greatest = 0;
    for (const Case& c : exact_cases()) {
      for (const double offset : {0.0, 0.31, 0.5, 0.83}) {
        CAPTURE(c.name);
        FillReport report;
        const double s = 0.4e-3;
        const auto points =
            fill(*c.solid, c.frame, spacing(2 * s, {offset * s, offset * s, 0}), c.domain, &report);
        CHECK(report.slivers_kept == 0);
        for (const auto& p : points) {
          double nominal = c.frame == Frame::cartesian_3d ? s * s * s : s * s;
          if (c.frame == Frame::axisymmetric) nominal *= 2 * pi * p.x[0];
          least = std::min(least, p.measure / nominal);
          greatest = std::max(greatest, p.measure / nominal);
        }
      }
    }
    CHECK(least > 0.4999);
    CHECK(greatest <
          1.5 * 1.5 * 1.5);  // at a corner of a box a point may end a sliver along each axis
    MESSAGE("share of the nominal measure: " << least << " .. " << greatest);
  }

  TEST_CASE("lattice: an axisymmetric rod has its mass and its hoop force") {
    const double radius = 3.81e-3, height = 25.4e-3;
    const CylinderSolid rod(radius, height, {0, 0, 0});
    for (const double cell : {0.381e-3, 0.4e-3, 0.73e-3}) {
      CAPTURE(cell);
      FillReport report;
      const auto points = fill(rod, Frame::axisymmetric, spacing(cell), everywhere, &report);
      CHECK(std::abs(report.measure_points / (pi * radius * radius * height) - 1) < 1e-13);
      // int s_tt 2 pi dA with s_tt = 1: exact, as is the tiling by the points' domains.
      double hoop = 0, tiles = 0;
      for (const auto& p : points) {
        hoop += p.measure / p.x[0];
        tiles += 4 * p.half_width[0] * p.half_width[1];
      }
      CHECK(std::abs(hoop / (2 * pi * radius * height) - 1) < 1e-13);
      CHECK(std::abs(tiles / (radius * height) - 1) < 1e-13);
    }
    // Why r is not the volume's centroid: at the axis the hoop force would be a quarter too small.
    const CellPart first = whole_box(Frame::axisymmetric, {{0, 0, 0}, {1, 1, 0}});
    CHECK(first.measure / first.centroid[0] == doctest::Approx(0.75 * 2 * pi));
  }

  TEST_CASE("lattice: counts of the Taylor rod in 3D, whole and quarter") {
    const double radius = 3.81e-3, height = 25.4e-3, volume = pi * radius * radius * height;
    const CylinderSolid rod(radius, height, {0, 0, 0});
    FillReport report;
    const auto whole = fill(rod, Frame::cartesian_3d, spacing(0.381e-3), everywhere, &report);
    CHECK(whole.size() > 165000);
    CHECK(whole.size() < 171000);
    CHECK(std::abs(report.measure_points / volume - 1) < 1e-12);
    CHECK(report.smallest_thickness_in_cells == doctest::Approx(20));
    MESSAGE("rod: " << whole.size() << " points, " << report.slivers_merged << " slivers, error "
                    << report.measure_points / volume - 1);
    const Box quarter{{0, 0, 0}, {1, 1, 1}};
    const auto part = fill(rod, Frame::cartesian_3d, spacing(0.381e-3), quarter, &report);
    CHECK(std::abs(4 * report.measure_points / volume - 1) < 1e-12);
    // Not equal: mirrored columns i and -1 - i have opposite parity, so that half cells and slivers
    // differ at the ends.
    CHECK(static_cast<double>(4 * part.size()) ==
          doctest::Approx(static_cast<double>(whole.size())).epsilon(1e-3));
  }

  TEST_CASE("lattice: odd columns are shifted by half a spacing along z") {
    const BoxSolid block({{-2, -2, -2}, {2, 2, 2}});
    for (const Frame frame : {Frame::plane_strain, Frame::cartesian_3d}) {
      const auto last = static_cast<std::size_t>(dimension(frame) - 1);
      LatticeOptions options = spacing(1.0);
      std::size_t halves = 0;
      const auto points = fill(block, frame, options, everywhere);
      for (const auto& p : points) {
        long column = std::lround(std::floor(p.x[0] * 2));
        if (last == 2) column += std::lround(std::floor(p.x[1] * 2));
        if (p.half_width[last] < 0.2) {  // the half cells at the ends of shifted columns
          CHECK(p.half_width[last] == doctest::Approx(0.125));
          CHECK(std::abs(p.x[last]) == doctest::Approx(1.875));
          ++halves;
          continue;
        }
        const double z = p.x[last] * 2 - (column & 1 ? 0.0 : 0.5);
        CHECK(z == doctest::Approx(std::round(z)));
      }
      CHECK(halves == (last == 2 ? 64 : 8));
      options.stagger = false;
      CHECK(fill(block, frame, options, everywhere).size() == (last == 2 ? 512 : 64));
    }
  }

  TEST_CASE(
      "lattice: seeds do not depend on anything but the arguments, and mirror with the body") {
    const SphereSolid ball(5e-3, {0, 0, 0});
    LatticeOptions options = spacing(0.9e-3);
    options.stagger = false;
    const auto a = fill(ball, Frame::cartesian_3d, options, everywhere);
    CHECK(same(a, fill(ball, Frame::cartesian_3d, options, everywhere)));
    double skew = 0, total = 0;
    for (const auto& p : a) {
      skew += p.measure * p.x[0] * p.x[1] * p.x[2];
      total += p.measure;
    }
    CHECK(std::abs(skew) < 1e-15 * total * std::pow(5e-3, 3) * static_cast<double>(a.size()));
  }

  TEST_CASE("lattice: jitter moves points within the body, by the seed, and keeps measures") {
    const CylinderSolid rod(3e-3, 8e-3, {0, 0, 0});
    LatticeOptions options = spacing(0.5e-3);
    const auto regular = fill(rod, Frame::axisymmetric, options, everywhere);
    options.jitter = 0.3;
    options.seed = 4;
    const auto shaken = fill(rod, Frame::axisymmetric, options, everywhere);
    CHECK(same(shaken, fill(rod, Frame::axisymmetric, options, everywhere)));
    options.seed = 5;
    CHECK_FALSE(same(shaken, fill(rod, Frame::axisymmetric, options, everywhere)));
    REQUIRE(shaken.size() == regular.size());
    double spread = 0;
    for (std::size_t n = 0; n < shaken.size(); ++n) {
      CHECK(shaken[n].measure == regular[n].measure);
      CHECK(std::abs(shaken[n].x[0] - regular[n].x[0]) <= 0.3 * 0.25e-3);
      CHECK(rod.contains(Frame::axisymmetric, shaken[n].x));
      spread += std::abs(shaken[n].x[1] - regular[n].x[1]) / (0.15 * 0.25e-3);
    }
    CHECK(spread / static_cast<double>(shaken.size()) == doctest::Approx(1).epsilon(0.1));
  }

  TEST_CASE("lattice: thin and absent bodies are reported, not lost") {
    FillReport report;
    const BoxSolid sheet({{0, 0, 0.01}, {1, 1, 0.05}});  // 0.4 of a spacing
    const auto points = fill(sheet, Frame::cartesian_3d, spacing(0.2), everywhere, &report);
    CHECK(report.measure_points == doctest::Approx(0.04).epsilon(1e-13));
    CHECK(report.smallest_thickness_in_cells == doctest::Approx(0.2));
    CHECK(report.slivers_kept > 0);
    CHECK(points.size() >= 50);
    for (const auto& p : points) CHECK(sheet.contains(Frame::cartesian_3d, p.x));
    const SphereSolid grain(1e-3, {0.33, 0.44, 0.55});
    CHECK(fill(grain, Frame::cartesian_3d, spacing(1), everywhere, &report).size() == 1);
    CHECK(report.measure_points == doctest::Approx(4 * pi / 3 * 1e-9).epsilon(1e-12));
    CHECK(fill(grain, Frame::cartesian_3d, spacing(1), {{1, 1, 1}, {2, 2, 2}}, &report).empty());
    CHECK(report.count == 0);
    CHECK(report.measure_exact == 0);
  }

  TEST_CASE("lattice: options that make no lattice are refused") {
    const SphereSolid ball(1, {0, 0, 0});
    const BoxSolid block({{0, 0, 0}, {1, 1, 1}});
    LatticeOptions options = spacing(0.5);
    CHECK_THROWS_AS(fill(block, Frame::axisymmetric, options, everywhere), std::invalid_argument);
    options.points_per_direction = {0, 0, 0};
    CHECK_THROWS_AS(fill(ball, Frame::cartesian_3d, options, everywhere), std::invalid_argument);
    CHECK_THROWS_AS(fill(ball, Frame::cartesian_3d, spacing(0), everywhere), std::invalid_argument);
    CHECK_THROWS_AS(fill(ball, Frame::cartesian_3d, spacing(1e-12), everywhere),
                    std::invalid_argument);
  }
}
