// SPDX-License-Identifier: GPL-3.0-or-later
// What is known before the run of where rigid bodies go: a prescribed motion that ends in a closed
// side is refused, at the time at which the run would have ended; a body that turns beside a side
// and does not reach it is not.
#include <doctest/doctest.h>

#include <cmath>

#include "krater/core/errors.hpp"
#include "krater/simulation/rigid_course.hpp"
#include "verification/run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

constexpr double kCell = 0.02;

/// A bar of 0.6 by 0.1 m that turns about y and moves, in a box whose upper side in x is a wall.
std::string bar(const std::string& motion, const std::string& end, const std::string& more = "") {
  return "frame: plane_strain\ngrid: {cell: 0.02, box: {min: [-0.5, -0.5], max: [0.5, 0.5]}, "
         "boundary: {x_max: wall}}\ntime: {end: " +
         end + more +
         "}\nmaterials:\n  heavy: {density: 7850}\n"
         "bodies:\n  bar: {material: heavy, shape: {box: {min: [-0.3, -0.05], max: [0.3, 0.05]}}, "
         "thin: allowed, " +
         motion + "}\ncontact: {}\n";
}

const std::string kStops = ", stop_when: \"time > 1e3\"";  // so that it is doubted, not refused

/// When the bar comes to the wall, which must be foreseen within `step` of `expected`.
void check_meeting(const std::string& motion, double expected, double step) {
  Run run = start_text(bar(motion, "1", kStops));
  const auto met = foresee_collision(*run.sim, run.sim->rigid().all().front());
  REQUIRE(met);
  CHECK((met->axis == 0 && met->side == 1));
  CHECK(met->time >= expected * (1 - 1e-9));
  CHECK(met->time <= (expected + step) * (1 + 1e-9));
}

std::vector<std::string> doubts(const std::string& scene) {
  return doubt_course(*start_text(scene).sim);
}

TEST_SUITE("rigid_course") {
  // The outermost points lie a quarter of a cell within the bar's end: 0.205 m are left.
  TEST_CASE("a prescribed motion into a closed side is refused") {
    const std::string flies = "rigid: {velocity: [100, 0]}";
    CHECK_THROWS_WITH_AS(start_text(bar(flies, "1")),
                         doctest::Contains("its motion runs into x_max at 0.002"), InputError);
    CHECK(doubts(bar(flies, "2.04e-3")).empty());
    CHECK(doubts(bar("rigid: {velocity: [-100, 0]}", "1")).empty());  // out by an open side
    CHECK(doubts(bar("rigid: {velocity: [0, 100]}", "1")).empty());
    const auto stops = doubts(bar(flies, "1", kStops));
    REQUIRE(stops.size() == 1);
    CHECK(stops[0].find("bar: if nothing ends the run before, it runs into x_max at 0.002") == 0);
    check_meeting(flies, 0.205 / 100, kCell / 4 / 100);
  }

  TEST_CASE("accelerated from rest, and back before the side") {
    const double at = std::sqrt(2 * 0.205 / 1000);
    check_meeting("rigid: {velocity: [\"1000*t\", 0]}", at, kCell / 4 / (1000 * at));
    // 0.19 sin(w t): comes within a cell of the side a hundred times.
    CHECK(doubts(bar("rigid: {velocity: [\"19*cos(100*t)\", 0]}", "6")).empty());
  }

  TEST_CASE("what turns is where its points are, not where its box is") {
    // Moved by 0.18 m to the right: corners come to 0.304 m about the centre, where 0.32 m are
    // left; the box that holds it, turned by 45 degrees, would come to 0.354 m.
    const std::string at = "shape: {box: {min: [-0.12, -0.05], max: [0.48, 0.05]}}";
    std::string scene = bar("rigid: {velocity: [\"-50*z\", \"50*(x - 0.18)\"]}", "1");
    const std::string shape = "shape: {box: {min: [-0.3, -0.05], max: [0.3, 0.05]}}";
    scene.replace(scene.find(shape), shape.size(), at);
    CHECK(doubts(scene).empty());
    CHECK(doubts(bar("rigid: free, velocity: [1, 0]", "0.2")).empty());
    const auto free = doubts(bar("rigid: free, velocity: [1, 0]", "0.3"));
    REQUIRE(free.size() == 1);
    CHECK(free[0].find("bar: if nothing stops it before, it runs into x_max at 0.2") == 0);
  }

  TEST_CASE("the run ends when it was foreseen, turning or not") {
    for (const std::string motion : {"[100, 0]", "[\"100 - 300*z\", \"300*x\"]"}) {
      CAPTURE(motion);
      Run run = start_text(bar("rigid: free, velocity: " + motion, "1"));
      const auto met = foresee_collision(*run.sim, run.sim->rigid().all().front());
      REQUIRE(met);
      CHECK((met->axis == 0 && met->side == 1));
      CHECK_THROWS_WITH_AS(run_to(run, 1), doctest::Contains("has run into the upper"),
                           NumericalError);
      // Both in steps of at most a cell.
      CHECK(std::abs(run.sim->time() - met->time) < kCell / 100);
    }
  }
}

}  // namespace
