// SPDX-License-Identifier: GPL-3.0-or-later
// The axis of revolution: no point is left on it, where sigma_tt/r is not a number.
#include <doctest/doctest.h>

#include <algorithm>

#include "run_support.hpp"

TEST_SUITE("verification") {
  TEST_CASE("axis: a point keeps 1e-9 cells off it") {
    using namespace krater::test;
    const double h = 0.762e-3;
    Run run = start_input("taylor_copper.yaml", {"grid.cell=0.762 mm"});
    std::vector<double> radius = column(run, krater::field::Position::info);
    const auto nearest = std::min_element(radius.begin(), radius.end());
    *nearest = 1e-13 * h;
    set_column(run, krater::field::Position::info, 0, radius);
    run_steps(run, 20);
    const std::vector<double> after = column(run, krater::field::Position::info);
    CHECK(*std::min_element(after.begin(), after.end()) >= 0.999e-9 * h);
    CHECK(run.sim->audit().reflections == 0);  // it was not beyond the axis: it goes on as it did
  }
}
