// SPDX-License-Identifier: GPL-3.0-or-later
// Matter that has been drawn to threads thinner than a cell: the step that its points bear
// (kinematics/mpm/lone.hpp), and what heat the ledger may take from what is in tension
// (materials/stages/heat_floor_stage.hpp).
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "krater/points/ledger_fields.hpp"
#include "run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

constexpr double kDensity = 7850, kSound = 4569;

std::string steel(const char* shear, const char* shape, const char* more = "") {
  return std::string{
             "frame: 3d\ngrid: {cell: 1 mm, box: {min: [-8 mm, -8 mm, -8 mm], max: [8 mm, 8 mm, 8 "
             "mm]}}\ntime: {end: 1 ms, energy_error: off}\nmaterials: {m: {density: 7850, "
             "shear_modulus: "} +
         shear + ", eos: {mie_gruneisen_shock: {c0: 4569, S1: 1.49, gamma0: 2.17}}, strength: " +
         "{von_mises: {Y: 5 GPa}}, viscosity: {}, heating: {energy: {c_v: 477}}" + more +
         "}}\nbodies: {b: {material: m, thin: allowed, shape: " + shape + "}}\n";
}

/// A line of points half a cell apart, `turn` about y, shaken by a millionth of the sound speed.
Run thread(double turn) {
  Run run = start_text(
      steel("30 GPa", ("{rotate: {axis: y, angle: " + std::to_string(turn) +
                       ", shape: {box: {min: [0, 0, -3 mm], max: [0.5 mm, 0.5 mm, 3 mm]}}}}")
                          .c_str()));
  std::mt19937 random{3};
  std::uniform_real_distribution<double> speed{-1e-6 * kSound, 1e-6 * kSound};
  for (int a = 0; a < 3; ++a) {
    std::vector<double> v = column(run, field::Velocity::info, a);
    for (double& one : v) one = speed(random);
    set_column(run, field::Velocity::info, a, v);
  }
  return run;
}

double greatest_pressure(const Run& run) {
  double most = 0;
  for (const double p : column(run, field::Pressure::info)) most = std::max(most, std::abs(p));
  return most;
}

/// Eight points at 0.7 of their density, under the tension that they have there if they bear it.
Run in_tension(bool failed) {
  Run run = start_text(steel("80 GPa", "{box: {min: [0, 0, 0], max: [1 mm, 1 mm, 1 mm]}}",
                             failed ? ", spall: {strength: 90 GPa}" : ""));
  const std::vector<double> all(column(run, field::Density::info).size(), 1);
  const auto everywhere = [&](const FieldInfo& field, double value) {
    std::vector<double> values = all;
    for (double& one : values) one = value;
    set_column(run, field, 0, values);
  };
  everywhere(field::Density::info, 0.7 * kDensity);
  everywhere(field::InternalEnergy::info, 2e6);
  if (failed) everywhere(field::Failed::info, 1);
  run_to(run, 1e-13);  // what follows from these
  return run;
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("a thread of points in 3d stays at rest at the step it is given") {
    for (const double turn : {0.0, 0.4, 0.7854}) {
      Run run = thread(turn);
      REQUIRE(column(run, field::Density::info).size() > 8);
      run_steps(run, 40);
      const double early = greatest_pressure(run);
      run_steps(run, 160);
      CHECK(greatest_pressure(run) < early);
    }
  }

  TEST_CASE("what is in tension does not give the energy of its tension for heat") {
    for (const bool failed : {false, true}) {
      Run run = in_tension(failed);
      const double debt = -1.5e6, e = column(run, field::InternalEnergy::info)[0],
                   p = column(run, field::Pressure::info)[0];
      CHECK((failed ? std::abs(p) < 1 : p < -10e9));
      set_column(run, field::CarriedEnergy::info, 0, std::vector<double>(8, debt));
      run_to(run, 2e-13);
      const double after = column(run, field::InternalEnergy::info)[0],
                   owed = column(run, field::CarriedEnergy::info)[0];
      CHECK(after + owed == doctest::Approx(e + debt).epsilon(1e-6));
      if (failed) {  // it is heat, all of it
        CHECK(owed == 0);
      } else {
        const double T = column(run, field::Temperature::info)[0];
        CHECK(owed < -0.1e6);
        CHECK(T > 0);
        CHECK(T < 293);
      }
    }
  }
}
