// SPDX-License-Identifier: GPL-3.0-or-later
// A rigid ogive driven through an elastic, perfectly plastic metal: the force on it lies between
// that of a cylindrical and that of a spherical cavity, in closed form, and hardly feels the cell.
//   p_s = 2Y/3 (1 + ln(E/(3 (1 - nu) Y))),  p_c = Y/sqrt(3) (1 + ln(sqrt(3) E/(2 (1 + nu) Y))),
//   F = pi a^2 (p + 3/2 N rho V^2),  N = (8 psi - 1)/(24 psi^2)  (Hill 1950; Forrestal, Okajima,
//   Luk 1988). A body that acted as if its radius were a + h would feel (1 + h/a)^2 of it: 36 % too
// much with six cells in the radius, 17 % with twelve.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "verification/run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

constexpr double kRadius = 0.01, kSpeed = 300, kDensity = 2700, kYoung = 70e9, kPoisson = 0.33,
                 kYield = 400e6, kCalibres = 3;

const std::string kNose =
    "  nose:\n    material: steel\n    shape: {ogive: {radius: 0.01, length: 0.06, crh: 3, "
    "base: [0, 0.02], axis: -z}}\n    rigid: {velocity: [0, -300]}\n    wins_over: [target]\n";
const std::string kTarget =
    "  target:\n    material: metal\n"
    "    shape: {cylinder: {radius: 0.06, height: 0.09, base: [0, -0.09]}}\n";

/// The nose begins within the metal, in a hole of its own shape.
std::string scene(int cells_in_radius, const std::string& bodies) {
  std::ostringstream yaml;
  yaml.precision(17);
  yaml << "frame: axisymmetric\ngrid:\n  cell: " << kRadius / cells_in_radius
       << "\n  box: {min: [0, -0.09], max: [0.07, 0.03]}\n  boundary: {r_min: axis}\n"
          "time: {end: 1}\nmaterials:\n  steel: {density: 8000}\n"
          "  metal: {density: 2700, youngs_modulus: 70e9, poisson_ratio: 0.33, eos: linear, "
          "rate: jaumann, strength: {von_mises: {yield_stress: 400e6}}}\n"
          "bodies:\n"
       << bodies << "contact: {friction: 0}\n";
  return yaml.str();
}

/// Mean force on the nose from 30 to 60 us, when it is steady [N].
double force(int cells_in_radius, bool nose_first = true) {
  Run run = start_text(scene(cells_in_radius, nose_first ? kNose + kTarget : kTarget + kNose));
  const RigidBody& nose = *run.sim->rigid().find(nose_first ? 0 : 1);
  run_to(run, 30e-6);
  const double before = nose.received()[1], from = run.sim->time();
  run_to(run, 60e-6);
  return (nose.received()[1] - before) / (run.sim->time() - from);
}

/// Of a cavity that needs the pressure p to grow slowly.
double cavity_force(double pressure) {
  const double N = (8 * kCalibres - 1) / (24 * kCalibres * kCalibres);
  return std::numbers::pi * kRadius * kRadius * (pressure + 1.5 * N * kDensity * kSpeed * kSpeed);
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("a rigid ogive in metal: the force of cavity expansion, whatever the cell") {
    const double spherical =
        cavity_force(2 * kYield / 3 * (1 + std::log(kYoung / (3 * (1 - kPoisson) * kYield))));
    const double cylindrical =
        cavity_force(kYield / std::sqrt(3.0) *
                     (1 + std::log(std::sqrt(3.0) * kYoung / (2 * (1 + kPoisson) * kYield))));
    const double coarse = force(6), fine = force(12);
    MESSAGE("force / that of a spherical cavity, cylindrical cavity: ", coarse / spherical, ", ",
            coarse / cylindrical, " with 6 cells in the radius; ", fine / spherical, ", ",
            fine / cylindrical, " with 12");
    CHECK(coarse > 0.95 * cylindrical);
    CHECK(coarse < 1.05 * spherical);
    CHECK(fine > 0.95 * cylindrical);
    CHECK(fine < 1.05 * spherical);
    CHECK(coarse == doctest::Approx(fine).epsilon(0.06));
    CHECK(force(6, false) == doctest::Approx(coarse).epsilon(1e-3));  // whichever is named first
  }
}
