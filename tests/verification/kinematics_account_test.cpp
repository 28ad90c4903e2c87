// SPDX-License-Identifier: GPL-3.0-or-later
// What bodies of elements and of particles book of a step (kinematics/sweep_account.hpp): the
// kinetic energy that there is, and no heat where there is none.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "verification/run_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

/// An elastic block that is bent and turned, so that its hourglass modes are held.
std::string bent_block(const std::string& kinematics) {
  return "frame: plane_strain\n"
         "grid: {cell: 1 mm, box: {min: [-12 mm, -12 mm], max: [12 mm, 12 mm]}}\n"
         "time: {end: 5 us, cfl: 0.05, energy_error: off}\n"
         "materials: {metal: {density: 8000, youngs_modulus: 200 GPa, poisson_ratio: 0.3, "
         "eos: linear, strength: elastic}}\n"
         "bodies: {block: {material: metal, shape: {box: {min: [-4 mm, -4 mm], max: [4 mm, 4 "
         "mm]}}, "
         "velocity: [\"3e6*x*z\", \"1e4*x\"], kinematics: " +
         kinematics + "}}\n";
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("account: kinetic energy is that of the bodies, and an elastic body makes no heat") {
    for (const std::string kinematics :
         {"{lagrangian_mesh: {element: 1 mm}}", "{sph: {spacing: 1 mm, zero_energy: 0}}"}) {
      CAPTURE(kinematics);
      Run run = start_text(bent_block(kinematics));
      run_steps(run, 120);
      const Audit& audit = run.sim->audit();
      const Totals totals = run.sim->totals();
      run.sim->look_at_elements();
      REQUIRE(totals.internal > 1e-3 * totals.kinetic);
      CHECK(audit.kinetic == doctest::Approx(totals.kinetic).epsilon(1e-13).scale(0));
      CHECK(audit.internal == doctest::Approx(totals.internal).epsilon(1e-13).scale(0));
      if (kinematics[1] == 'l') REQUIRE(run.sim->elements().hourglass > 7e-3 * totals.internal);
      // Work runs half a step ahead; without that of the hourglass it would miss more than this.
      CHECK(std::abs(audit.numerical_heat) < 5e-3 * totals.internal);
    }
  }
}
