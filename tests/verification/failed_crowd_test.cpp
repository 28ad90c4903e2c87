// SPDX-License-Identifier: GPL-3.0-or-later
// Failed material in a crowd keeps the velocity gradient that its neighbours give it; smoothing it
// away would cost the energy that the scheme is to keep. A few failed points on their own drop it:
// nothing would end their expansion.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "run_support.hpp"

TEST_SUITE("verification") {
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
