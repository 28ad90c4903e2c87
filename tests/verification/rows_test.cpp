// SPDX-License-Identifier: GPL-3.0-or-later
// A row of history by its shortcuts and by the long way, bit by bit: patches surveyed in the sweep
// of a step (simulation/totals.cpp), measures of points gathered by layers
// (measure/point_layers.hpp).
#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "krater/measure/measurements.hpp"
#include "verification/run_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

std::vector<std::uint64_t> bits_of(const PointSurvey& survey) {
  const Totals& t = survey.totals;
  std::vector<std::uint64_t> out;
  for (const double x :
       {t.count, t.mass, t.kinetic, t.internal, t.momentum[0], t.momentum[1], t.momentum[2],
        t.angular_momentum, t.deviatoric, survey.bounds.greatest_volume})
    out.push_back(std::bit_cast<std::uint64_t>(x));
  for (std::size_t a = 0; a < 3; ++a)
    for (const double x : {survey.bounds.low[a], survey.bounds.high[a]})
      out.push_back(std::bit_cast<std::uint64_t>(x));
  return out;
}

/// How many sets of the two differ.
int different(const Run& one, const Run& other) {
  const std::vector<PointSurvey> a = one.sim->survey(), b = other.sim->survey();
  REQUIRE(a.size() == b.size());
  int count = 0;
  for (std::size_t s = 0; s < a.size(); ++s) count += bits_of(a[s]) != bits_of(b[s]) ? 1 : 0;
  return count;
}

struct Case {
  const char* input;
  Overrides overrides;
  int steps;
};

const std::vector<Case> kCases{
    {"taylor_copper.yaml", {"grid.cell=0.762 mm"}, 150},
    {"taylor_copper.yaml", {"frame=3d", "grid.cell=1.524 mm"}, 60},
    {"taylor_copper.yaml", {"grid.cell=0.762 mm", "method.update=musl"}, 60},
    {"bar_pulled_apart.yaml",
     {"grid.cell=0.5 mm", "materials.weldox.failure.action=remove",
      "method.numerical_fracture=split"},
     300},
    {"taylor_copper.yaml",
     {"grid.cell=0.762 mm",
      "grid.refine=[{region: {box: {min: [0, 0], max: [6 mm, 4 mm]}}, level: 1}]"},
     80},
    {"ccf_two_bars.yaml", {"grid.cell=2 mm"}, 40},
};

std::uint64_t bits_of(double x) { return std::bit_cast<std::uint64_t>(x); }

/// The measures of the next row, and all points asked for the same.
void compare_measures(Measurements& measures, const Run& run) {
  std::vector<int> shown;
  for (std::size_t i = 0; i < run.scene->measures.size(); ++i)
    if (run.scene->measures[i].in_history) shown.push_back(static_cast<int>(i));
  const std::vector<Quantity> row = measures.row(*run.sim, run.sim->survey());
  const std::vector<double> now = measures.now(*run.sim, shown);
  REQUIRE(row.size() == now.size());
  CHECK(row.size() >= 7);
  for (std::size_t i = 0; i < row.size(); ++i) {
    CAPTURE(row[i].name);
    CHECK(bits_of(row[i].value) == bits_of(now[i]));
  }
}

/// Every kind that looks at layers, beside those of the scene.
const Overrides kLayers{
    "measures.top={kind: max, body: rod, axis: z, history: true}",
    "measures.bottom={kind: min, body: rod, axis: z, history: true}",
    "measures.widest={kind: largest_diameter, body: rod, history: true}",
    "measures.waist={kind: diameter, body: rod, at: {z: 12 mm}, history: true}"};

Overrides with(Overrides more) {
  more.insert(more.begin(), kLayers.begin(), kLayers.end());
  return more;
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("a survey in the sweep of a step is that of a walk after it, and changes no point") {
    for (const Case& c : kCases) {
      CAPTURE(c.input);
      CAPTURE(c.overrides.back());
      Run seen = start_input(c.input, c.overrides), walked = start_input(c.input, c.overrides);
      for (int n = 0; n < c.steps; ++n) {
        seen.sim->expect_survey(n % 3 == 0 ? 1e300 : 0);  // not every step is looked at
        run_steps(seen, 1);
        run_steps(walked, 1);
        REQUIRE(different(seen, walked) == 0);
      }
      CHECK(all_bits(*seen.sim) == all_bits(*walked.sim));
    }
  }

  TEST_CASE("a survey after points were changed from outside is of the changed points") {
    Run run = start_input("taylor_copper.yaml", {"grid.cell=0.762 mm"});
    run.sim->expect_survey(0);
    run_steps(run, 20);
    const double before = run.sim->totals().momentum[1];
    const int slot = run.sim->bodies()[0]->slot(field::Velocity::info, 1);
    for (int s = 0; s < run.sim->set_count(); ++s)
      for (int i = 0; i < run.sim->set(s).count(); ++i)
        run.sim->set_value(s, i, slot, 2 * run.sim->value(s, i, slot));
    CHECK(run.sim->totals().momentum[1] == doctest::Approx(2 * before).epsilon(1e-14));
  }

  TEST_CASE("measures of points gathered by layers are those of all points") {
    for (const Overrides& frame :
         std::vector<Overrides>{{"grid.cell=0.127 mm"},
                                {"frame=plane_strain", "grid.cell=0.127 mm"},
                                {"frame=3d", "grid.cell=0.762 mm"}}) {
      CAPTURE(frame.front());
      Run run = start_input("taylor_copper.yaml", with(frame));
      Measurements measures{*run.sim};
      compare_measures(measures, run);
      for (int k = 0; k < 4; ++k) {
        run.sim->expect_survey(0);
        run_steps(run, 12);
        compare_measures(measures, run);
      }
    }
  }

  TEST_CASE("measures by layers see a sparse point as those of all points do") {
    Run run = start_input("taylor_copper.yaml", with({"grid.cell=0.127 mm"}));
    Measurements measures{*run.sim};
    const double dense = measures.now(*run.sim, {0}).front();
    const Body& body = *run.sim->bodies()[0];
    run.sim->set_value(0, 3, body.slot(field::Density::info), 10);
    // between four nodes, none of which it fills by half: no surface is there
    run.sim->set_value(0, 3, body.slot(field::Position::info, 0), 5.5 * 0.127e-3);
    run.sim->set_value(0, 3, body.slot(field::Position::info, 1), 203.5 * 0.127e-3);
    compare_measures(measures, run);
    CHECK(measures.now(*run.sim, {0}).front() > dense + 0.3e-3);
    CHECK(run.sim->point_count() > 16384);  // by layers (measure/point_layers.hpp)
  }

  TEST_CASE("measures of a body that leaves are those of all points, in the end of nothing") {
    Run run =
        start_input("taylor_copper.yaml",
                    with({"grid.cell=1.27 mm", "bodies.rod.velocity=[0, -5 km/s]",
                          "grid.boundary={z_min: open, r_min: axis, r_max: open, z_max: open}"}));
    Measurements measures{*run.sim};
    while (run.sim->point_count() > 0 && run.sim->steps() < 1000) {
      compare_measures(measures, run);
      run.sim->expect_survey(0);
      run_steps(run, 4);
    }
    REQUIRE(run.sim->point_count() == 0);
    compare_measures(measures, run);
    for (const Quantity& q : measures.row(*run.sim, run.sim->survey())) CHECK(std::isnan(q.value));
  }
}
