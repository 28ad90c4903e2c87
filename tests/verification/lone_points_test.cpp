// SPDX-License-Identifier: GPL-3.0-or-later
// A point that no other shares its nodes with has free surface all around: the tension it had, or
// would come into as a ring that grows, goes (close_lone, kinematics/mpm/lone.hpp).
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

constexpr double kBulkModulus = 8960 * 3940.0 * 3940;  // [Pa]

/// One point of copper; `shape` half a cell wide.
std::string one_point(const char* frame, const char* box, const char* shape, const char* velocity) {
  return std::string{"frame: "} + frame + "\ngrid: {cell: 1 mm, box: " + box +
         "}\ntime: {end: 1 ms, energy_error: off}\nmethod: {stagger: false}\nmaterials: {m: "
         "{density: 8960, shear_modulus: 46 GPa, eos: {mie_gruneisen_shock: {c0: 3940, S1: 1.49, "
         "gamma0: 2}}, strength: {von_mises: {Y: 0.2 GPa}}, spall: {strength: 90 GPa}}}\nbodies: "
         "{p: {material: m, thin: allowed, shape: " +
         shape + ", velocity: " + velocity + "}}\n";
}

Run ring(double speed) {
  const std::string velocity = "[" + std::to_string(speed) + ", 0]";
  return start_text(one_point("axisymmetric", "{min: [0, 0], max: [40 mm, 6 mm]}",
                              "{tube: {inner_radius: 10 mm, outer_radius: 10.5 mm, height: 0.5 mm, "
                              "base: [0, 3 mm]}}",
                              velocity.c_str()));
}

Run alone(const std::string& frame) {
  if (frame == "3d")
    return start_text(one_point("3d", "{min: [0, 0, 0], max: [12 mm, 6 mm, 6 mm]}",
                                "{box: {min: [3 mm, 3 mm, 3 mm], max: [3.5 mm, 3.5 mm, 3.5 mm]}}",
                                "[1000, 0, 0]"));
  return start_text(one_point("plane_strain", "{min: [0, 0], max: [12 mm, 6 mm]}",
                              "{box: {min: [3 mm, 0, 3 mm], max: [3.5 mm, 1, 3.5 mm]}}",
                              "[1000, 0]"));
}

double value(const Run& run, const FieldInfo& field, int component = 0) {
  const std::vector<double> all = column(run, field, component);
  REQUIRE(all.size() == 1);
  return all[0];
}

/// Steps until the radius is as asked; it is told where it never is.
template <class Reached>
void steps_until(Run& run, const Reached& reached) {
  for (int i = 0; i < 2000 && !reached(value(run, field::Position::info)); ++i) run_steps(run, 1);
  REQUIRE(reached(value(run, field::Position::info)));
}

double tension(const Run& run) { return -value(run, field::Pressure::info); }

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("a lone ring that grows stretches at constant volume and bears no mean tension") {
    // With a section that stays it would have three quarters of its density and 30 GPa of tension.
    for (const double speed : {300.0, 1000.0, 3000.0}) {
      Run run = ring(speed);
      const double start = value(run, field::Position::info);
      double most = 0;
      for (int i = 0; i < 2000 && value(run, field::Position::info) < 1.35 * start; ++i) {
        run_steps(run, 1);
        most = std::max(most, tension(run));
      }
      CHECK(value(run, field::Position::info) > 1.34 * start);
      CHECK(most < 1e-3 * kBulkModulus);
      CHECK(value(run, field::Density::info) == doctest::Approx(8960).epsilon(5e-3));
      CHECK(value(run, field::PlasticStrain::info) ==
            doctest::Approx(std::log(1.35)).epsilon(0.05));
      CHECK(std::abs(energy_residual(run)) < 1e-12 * run.sim->audit().energy());
    }
  }

  TEST_CASE("a lone ring in compression, or failed, is left as it was") {
    Run pressed = ring(-300);
    steps_until(pressed, [](double r) { return r < 10e-3; });
    CHECK(value(pressed, field::Density::info) == doctest::Approx(8960 * 10.25 / 10).epsilon(2e-3));
    Run failed = ring(300);
    set_column(failed, field::Failed::info, 0, {1});
    steps_until(failed, [](double r) { return r > 13e-3; });
    CHECK(value(failed, field::Density::info) == doctest::Approx(8960 * 10.25 / 13).epsilon(2e-3));
  }

  TEST_CASE("the tension of a lone point is gone when a wave has crossed some cells") {
    for (const std::string frame : {"plane_strain", "3d"}) {
      Run run = alone(frame);
      const double start = 2e9, cell_crossed = 1e-3 / 3940;
      set_column(run, field::Pressure::info, 0, {-start});
      set_column(run, field::Density::info, 0, {8960 * (1 - start / kBulkModulus)});
      run_to(run, 0.5 * cell_crossed);
      CHECK(tension(run) < 0.9 * start);
      CHECK(tension(run) > 0.2 * start);
      run_to(run, 8 * cell_crossed);
      CHECK(std::abs(tension(run)) < 0.05 * start);
      CHECK(value(run, field::Velocity::info) == doctest::Approx(1000).epsilon(1e-12));
      CHECK(value(run, field::Density::info) == doctest::Approx(8960).epsilon(5e-3));
    }
  }

  TEST_CASE("a lone point under pressure keeps it") {
    Run run = alone("3d");
    set_column(run, field::Pressure::info, 0, {1e9});
    set_column(run, field::Density::info, 0, {8960 * (1 + 1e9 / kBulkModulus)});
    run_to(run, 2e-6);
    CHECK(tension(run) < -0.9e9);
  }
}
