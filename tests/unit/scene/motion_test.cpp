// SPDX-License-Identifier: GPL-3.0-or-later
// Velocities by speed and direction, and turns about an axis.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "krater/core/errors.hpp"
#include "krater/simulation/simulation.hpp"
#include "scene_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// The small scene with other motion keys of its rod, in a frame.
std::string with_motion(const std::string& keys, const std::string& frame = "3d") {
  return replaced(replaced(small_scene(), "velocity: [0, -100 m/s]", keys), "frame: axisymmetric",
                  "frame: " + frame);
}

Triple velocity(const std::string& keys, const std::string& frame, const Triple& x = {}) {
  const ScratchFolder folder;
  const Scene scene = read_scene(folder.write("a.yaml", with_motion(keys, frame)));
  return scene.bodies[0].velocity ? (*scene.bodies[0].velocity)(x, x, 0) : Triple{};
}

std::string problem(const std::string& keys, const std::string& frame) {
  const ScratchFolder folder;
  return message_of(folder.write("a.yaml", with_motion(keys, frame)));
}

void check_near(const Triple& a, const Triple& b, double tolerance = 1e-12) {
  for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(a[k] - b[k]) <= tolerance);
}

}  // namespace

TEST_CASE("motion: a speed towards a vector, a word, at an angle, in three frames") {
  check_near(velocity("velocity: {speed: 830 m/s, towards: [0, 3, -4]}", "3d"), {0, 498, -664});
  check_near(velocity("velocity: {speed: 830 m/s, towards: [3, -4]}", "plane_strain"),
             {498, -664, 0});
  for (const char* frame : {"axisymmetric", "plane_strain", "3d"}) {
    const Triple down = frame[0] == '3' ? Triple{0, 0, -830} : Triple{0, -830, 0};
    for (const char* way : {"towards: [0, -2]", "towards: -z", "angle: 0"})
      CHECK(velocity("velocity: {speed: 0.83 km/s, " + std::string{way} + "}", frame) == down);
  }
  const double s = 830 * std::sin(30 * kDegree), c = 830 * std::cos(30 * kDegree);
  check_near(velocity("velocity: {speed: 830 m/s, angle: 30 deg}", "3d"), {s, 0, -c}, 1e-10);
  check_near(velocity("velocity: {speed: 830 m/s, angle: 30 degree}", "plane_strain"), {s, -c, 0},
             1e-10);
  CHECK(velocity("velocity: {speed: 0, towards: z}", "3d") == Triple{});
}

TEST_CASE("motion: a turn is about the centroid, or through a point, and adds to the velocity") {
  const double w = 3000 * 2 * std::numbers::pi / 60;  // the rod's centroid is at z = 6 mm
  check_near(velocity("turn: {axis: y, rate: 3000 rpm}", "3d", {0.001, 0, 0.008}),
             {w * 0.002, 0, -w * 0.001});
  check_near(velocity("turn: {rate: 3000 rpm}", "plane_strain", {0.001, 0.008, 0}),
             {w * 0.002, -w * 0.001, 0}, 1e-4);  // the domain halves the section
  check_near(velocity("velocity: {speed: 5 m/s, towards: -z}\n    turn: {axis: [0, 0, 2], rate: 10 "
                      "rad/s, through: [1, 0, 0]}",
                      "3d", {1, 2, 0}),
             {-20, 0, -5});
}

TEST_CASE("motion: a rigid body carries its centre of rotation along") {
  const ScratchFolder folder;
  const Scene scene = read_scene(folder.write(
      "a.yaml",
      with_motion("rigid: {velocity: {speed: 2 m/s, towards: x}, turn: {axis: z, rate: 1 rad/s}}") +
          "contact: {friction: 0}\n"));
  const FieldFunction& v = *scene.bodies[0].velocity;
  CHECK(v.depends_on_time());
  check_near(v({0, 0, 0}, {}, 0), {2, 0, 0});
  check_near(v({2, 1, 0}, {}, 1), {1, 0, 0});
}

TEST_CASE("motion: resolved.yaml holds components and reads back to the same field") {
  const ScratchFolder folder;
  const Scene scene = read_scene(folder.write(
      "a.yaml",
      with_motion("velocity: {speed: 830 m/s, angle: 30 deg}\n    turn: {axis: [1, 2, 2], rate: 60 "
                  "rpm}")));
  const Scene again = read_scene(folder.write("b.yaml", scene.resolved));
  CHECK(scene.resolved.find("speed") == std::string::npos);
  const Triple x{0.1, 0.2, 0.3};
  CHECK((*scene.bodies[0].velocity)(x, x, 0) == (*again.bodies[0].velocity)(x, x, 0));
}

TEST_CASE("motion: what has no meaning is refused by name") {
  const auto says = [](const std::string& keys, const std::string& frame, const char* part) {
    const std::string text = problem(keys, frame);
    CHECK_MESSAGE(text.find(part) != std::string::npos, keys, " in ", frame, ": ", text);
    CHECK_MESSAGE(text.find("bodies.rod.") != std::string::npos, text);
  };
  says("velocity: {speed: 830 m/s, angle: 30 deg}", "axisymmetric", "frame: 3d or plane_strain");
  says("velocity: {speed: 830 m/s}", "3d", "a speed needs one direction");
  says("velocity: {speed: 830 m/s, angle: 0, towards: -z}", "3d", "a speed needs one direction");
  says("velocity: {towards: -z}", "3d", "missing key 'speed'");
  says("velocity: {speed: -830 m/s, towards: z}", "3d", "must not be negative");
  says("velocity: {speed: 830 m, towards: z}", "3d", "wrong dimension");
  says("velocity: {speed: 830 m/s, towards: [0, 0]}", "3d", "no direction");
  says("velocity: {speed: 830 m/s, towards: y}", "plane_strain", "no direction of plane_strain");
  says("velocity: {speed: 830 m/s, toward: z}", "3d", "did you mean towards");
  says("turn: {rate: 3 rpm}", "3d", "missing key 'axis'");
  says("turn: {axis: y}", "3d", "missing key 'rate'");
  says("turn: {axis: [0, 0, 0], rate: 3 rpm}", "3d", "no axis");
  says("turn: {axis: q, rate: 3 rpm}", "3d", "expected x, y, z");
  says("turn: {axis: x, rate: 3 rpm}", "plane_strain", "about y only");
  says("turn: {axis: z, rate: 3 rpm}", "axisymmetric", "use frame: 3d");
  says("turn: {axis: y, rate: 3 kHz}", "3d", "write rpm or rad/s");
  says("velocity: [\"3*x\", 0, 0]\n    turn: {axis: y, rate: 3 rpm}", "3d", "velocity of numbers");
}

TEST_CASE("motion: the energy and angular momentum of a spinning box are those of its inertia") {
  const ScratchFolder folder;
  const std::string text =
      replaced(with_motion("turn: {axis: z, rate: 100 rad/s}\n    points: {lattice: body}"),
               "cylinder: {radius: 3 mm, height: 12 mm}",
               "box: {min: [-3 mm, -3 mm, 0], max: [3 mm, 3 mm, 12 mm]}");
  const Scene scene = read_scene(folder.write("a.yaml", text));
  const Totals totals = Simulation{scene}.totals();
  const double inertia = totals.mass * (2 * 6e-3 * 6e-3) / 12;
  CHECK(totals.angular_momentum == doctest::Approx(100 * inertia).epsilon(1e-3));
  CHECK(totals.kinetic == doctest::Approx(0.5 * 100 * 100 * inertia).epsilon(1e-3));
}
