// SPDX-License-Identifier: GPL-3.0-or-later
// A standing sound wave of gas between two planes, half a wave in 20 cells: v = u sin(pi z), c = 1.
// Its energy goes to and fro between motion and compression, and motion is the smaller part of what
// there is by 1e6: any of it that comes out of heat, or goes there, is seen.
//
// Amplitude 1e-3 and constant steps from the start, for two reasons that are no damping: the first
// steps grow five-fold, and v is half a step behind e, so that the wave loses 1.5 % once (as dt;
// CFL 0.1: 0.1 %); and at 0.01 c it steepens (distance to the shock: 33 of its 40 half periods'
// way), and 20 cells carry no harmonics: 4.9 % after 19 periods, 2.3 and 1.0 % in 40 and 80 cells.
#include <doctest/doctest.h>

#include <algorithm>

#include "run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

/// Greatest kinetic energy between two times.
double peak(Run& run, double from, double to) {
  run_to(run, from);
  double most = 0;
  while (run.sim->time() < to) {
    run_steps(run, 1);
    most = std::max(most, run.sim->audit().kinetic);
  }
  return most;
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("sound wave: it stands for 19 periods, and never grows") {
    Run run = start_text(
        "frame: plane_strain\n"
        "grid: {cell: 0.05, box: {min: [0, 0], max: [0.1, 1]}, boundary: {x_min: symmetry, "
        "x_max: symmetry, z_min: symmetry, z_max: symmetry}}\n"
        "time: {end: 40, first_step: 0.0245, max_step: 0.0245}\n"
        "materials: {gas: {density: 1, eos: {ideal_gas: {gamma: 1.4, initial_pressure: "
        "0.7142857142857143}}}}\n"
        "bodies: {gas: {material: gas, shape: {box: {min: [0, -1, 0], max: [0.1, 1, 1]}}, "
        "velocity: [0, \"0.001*sin(pi*z)\"]}}\n");
    const double start = run.sim->audit().kinetic;
    for (const double time : {10.0, 20.0, 30.0, 39.0}) {
      const double change = peak(run, time - 0.4, time + 0.4) / start - 1;
      MESSAGE("peak kinetic energy at t = ", time, ": ", 100 * change, " %");
      CHECK(change < 0.004);  // v half a step before or behind its peak, and the first step's
      CHECK(change > -0.01);
    }
  }
}
