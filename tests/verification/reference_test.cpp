// SPDX-License-Identifier: GPL-3.0-or-later
// Reference configurations (theory 3, CCF Theorem 1): the same weak form on any reference must give
// the same answer while the discretisation is the same, and a wall must be met where the body is
// now.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "verification/run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

const char* const kReferences[] = {"method.reference=initial", "method.reference=adaptive"};

/// The Taylor rod, coarse; `gap` above the wall [m].
Run rod(const Overrides& more, double gap = 0) {
  Overrides options{"grid.cell=0.762 mm", "time.end=20 us", "output.frames=0"};
  if (gap > 0)
    options.push_back("bodies.rod.shape.cylinder.base=[0, 0, " + std::to_string(gap) + "]");
  options.insert(options.end(), more.begin(), more.end());
  return start_input("taylor_copper.yaml", options);
}

double lowest(const Run& run) {
  const auto z = column(run, field::Position::info, 1);
  return *std::min_element(z.begin(), z.end());
}
double highest(const Run& run) {
  const auto z = column(run, field::Position::info, 1);
  return *std::max_element(z.begin(), z.end());
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("one step on the initial configuration is one step on the current one") {
    for (const std::string frame : {"axisymmetric", "plane_strain"}) {
      Run current = rod({"frame=" + frame}), fixed = rod({"frame=" + frame, kReferences[0]});
      current.sim->step(1), fixed.sim->step(1);
      for (int a = 0; a < 2; ++a) {
        const auto v = column(current, field::Velocity::info, a),
                   w = column(fixed, field::Velocity::info, a);
        for (std::size_t i = 0; i < v.size(); ++i) REQUIRE(std::abs(v[i] - w[i]) < 1e-9 * 190);
      }
    }
  }

  TEST_CASE("Taylor impact: current, initial and adaptive agree, energy and momentum close") {
    Run current = rod({});
    run_to(current, 20e-6);
    for (const char* reference : kReferences) {
      CAPTURE(std::string{reference});
      Run run = rod({reference});
      run_to(run, 20e-6);
      const Audit& audit = run.sim->audit();
      CHECK(highest(run) == doctest::Approx(highest(current)).epsilon(2e-3));
      CHECK(lowest(run) > 0);
      CHECK(std::abs(energy_residual(run)) < 1e-12 * audit.initial_kinetic);
      CHECK(std::abs(audit.error_fraction()) < 0.015);
      const double start = 190 * run.sim->totals().mass;
      CHECK(std::abs(run.sim->totals().momentum[1] + start - audit.wall_impulse[1]) <
            1e-10 * start);
      MESSAGE(std::string{reference}, ": top ", highest(run), " m (current ", highest(current),
              "), ", audit.new_references, " references, energy error ", audit.error_fraction());
    }
  }

  TEST_CASE("a body that flies to a wall meets it where the wall is") {
    const std::string taller = "grid.box={min: [0, 0], max: [12 mm, 30 mm]}";
    const double gap = 2.5 * 0.762e-3;  // its reference lies away from the wall for ever
    Run current = rod({"time.end=32 us", taller}, gap);
    run_to(current, 32e-6);
    for (const char* reference : kReferences) {
      CAPTURE(std::string{reference});
      Run run = rod({"time.end=32 us", taller, reference}, gap);
      run_to(run, 32e-6);
      const Audit& audit = run.sim->audit();
      MESSAGE(std::string{reference}, ": lowest point ", lowest(run) / 0.762e-3, " cells, top ",
              highest(run), " m (current ", highest(current), "), energy error ",
              audit.error_fraction());
      CHECK(lowest(run) > -0.05 * 0.762e-3);
      CHECK(highest(run) == doctest::Approx(highest(current)).epsilon(1e-2));
      CHECK(std::abs(energy_residual(run)) < 1e-12 * audit.initial_kinetic);
    }
  }
}
