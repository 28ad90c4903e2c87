// SPDX-License-Identifier: GPL-3.0-or-later
// Failed material in a crowd keeps the velocity gradient that its neighbours give it; smoothing it
// away would cost the energy that the scheme is to keep. A few failed points on their own drop it:
// nothing would end their expansion.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "run_support.hpp"

namespace {

const char* kHalfFailed = R"(
title: A block under tension in which every second point, as on a chessboard, has failed
method: {stagger: false}
frame: plane_strain
grid: {cell: 1 mm, box: {min: [0, 0], max: [20 mm, 20 mm]}}
time: {end: 1 us}
materials:
  m:
    density: 8960
    shear_modulus: 46 GPa
    eos: {mie_gruneisen_shock: {c0: 3.94 km/s, S1: 1.49, gamma0: 2}}
    strength: {von_mises: {Y: 0.2 GPa}}
    spall: {strength: 2 GPa}
bodies:
  block:
    material: m
    shape: {box: {min: [6 mm, 0, 6 mm], max: [12 mm, 1 mm, 12 mm]}}
    velocity: [0, 100 m/s]
)";

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("failed points: no tension of their neighbours is lent to them by cell averages") {
    using namespace krater::test;
    std::vector<double> speed[2];
    for (const bool averaged : {false, true}) {
      Run run = start_text(
          kHalfFailed, {averaged ? "method.cell_averaging=true" : "method.cell_averaging=false"});
      const auto x = column(run, krater::field::Position::info, 0),
                 z = column(run, krater::field::Position::info, 1);
      std::vector<double> failed = x, pressure = x;
      for (std::size_t i = 0; i < failed.size(); ++i) {
        const auto place = [](double at) { return static_cast<int>(at / 0.5e-3); };
        failed[i] = (place(x[i]) + place(z[i])) % 2;
        pressure[i] = failed[i] > 0 ? 0 : -1e9;
      }
      set_column(run, krater::field::Failed::info, 0, failed);
      set_column(run, krater::field::Pressure::info, 0, pressure);
      run_steps(run, 2);
      for (const int axis : {0, 1}) {
        const auto v = column(run, krater::field::Velocity::info, axis);
        speed[averaged].insert(speed[averaged].end(), v.begin(), v.end());
      }
    }
    double moved = 0, apart = 0;
    for (std::size_t i = 0; i < speed[0].size(); ++i) {
      moved = std::max(moved, std::abs(speed[0][i] - (i < speed[0].size() / 2 ? 0.0 : 100.0)));
      apart = std::max(apart, std::abs(speed[0][i] - speed[1][i]));
    }
    CHECK(moved > 0.1);
    CHECK(apart < 1e-9 * moved);  // 0.3 of it with averages
  }

  TEST_CASE("failed crowd: steel on aluminium at 6 km/s loses less than 1 % by transfer") {
    using namespace krater::test;
    Run run = start_input("ccf_hypervelocity.yaml", {"grid.cell=0.355 mm"});
    run_to(run, 5e-6);
    const krater::Audit& audit = run.sim->audit();
    REQUIRE(audit.failures > 0.2 * run.sim->totals().count);
    CHECK(std::abs(audit.error_fraction()) < 0.01);  // 1.7 % where failed points drop L
  }

  TEST_CASE("failed crowd: fragments of a few points do not expand for ever") {
    using namespace krater::test;
    Run run = start_input("hiermaier_al.yaml", {});
    run_to(run, 5e-6);
    REQUIRE(run.sim->audit().failures > 500);
    const std::vector<double> density = column(run, krater::field::Density::info);
    CHECK(*std::min_element(density.begin(), density.end()) > 5);  // 1.1 where none drops L
  }
}
