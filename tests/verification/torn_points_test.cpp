// SPDX-License-Identifier: GPL-3.0-or-later
// Numerical fracture is told where the grid makes it, and only there (simulation/torn_points.hpp).
// A block without strength to speak of is pulled or sheared by its own velocity, so that its
// deformation gradient is known.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "verification/run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

std::string block(const std::string& velocity, const std::string& method,
                  const std::string& strength = "{von_mises: {Y: 1e3}}") {
  return "frame: plane_strain\ngrid: {cell: 1, box: {min: [-60, -60], max: [60, 60]}, boundary: "
         "{x_min: open}}\ntime: {end: 1, energy_error: off}\noutput: {fields: "
         "[deformation_gradient]}\n"
         "method: {" +
         method +
         "}\nmaterials: {soft: {density: 7850, youngs_modulus: 1e3, poisson_ratio: 0.3, eos: "
         "linear, strength: " +
         strength +
         "}}\nbodies: {block: {material: soft, shape: {box: {min: [-6, -1, -6], max: [6, 1, 6]}}, "
         "velocity: " +
         velocity + "}}\n";
}

struct Look {
  double least, most;  ///< stretch along z of the block's points
  TornPoints points;
};

Look look_at(Run& run) {
  const std::vector<double> F = column(run, field::DeformationGradient::info, 8);
  const auto [least, most] = std::minmax_element(F.begin(), F.end());
  run.sim->look_for_torn_points();
  return {*least, *most, run.sim->torn_points()};
}

/// Steps until some point, and until every one is torn; what they were stretched to then.
std::array<double, 2> onset(const std::string& method) {
  Run run = start_text(block("[0, 50*z]", "numerical_fracture: watch, " + method));
  std::array<double, 2> out{};
  for (int i = 0; i < 2000 && out[1] == 0; ++i) {
    run.sim->step(1);
    if (i % 4 != 0) continue;
    const Look now = look_at(run);
    if (out[0] == 0 && now.points.torn > 0) out[0] = now.most;
    if (now.points.torn == run.sim->point_count()) out[1] = now.least;
    CHECK(now.points.torn <= now.points.stretched);
  }
  return out;
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("a pulled lattice is torn where its points share no node any more") {
    // Two points to a cell, in rows: at 2R - h = 2 h for quadratic functions, and for gimp, whose
    // widths grow to half a cell; at h for linear ones. Looked at every four steps.
    const auto [first, last] = onset("stagger: false");
    CHECK(first == doctest::Approx(4).epsilon(0.04));
    CHECK(first > 4);
    CHECK(last == doctest::Approx(4).epsilon(0.04));
    const auto [gimp, all_gimp] = onset("stagger: false, shape: gimp");
    CHECK(gimp > 4);
    CHECK(all_gimp == doctest::Approx(4).epsilon(0.04));
    const auto [linear, all_linear] =
        onset("stagger: false, shape: linear, update: musl, transfer: flip, cell_averaging: false");
    CHECK(linear > 2);
    CHECK(all_linear == doctest::Approx(2).epsilon(0.04));
    // Of staggered columns the next one's points lie half way.
    CHECK(onset("stagger: true")[0] > 5);
  }

  TEST_CASE("shear stretches, and tears nothing but free tips") {
    Run run = start_text(block("[50*z, 0]", "numerical_fracture: watch"));
    run_to(run, 0.12);
    const Look now = look_at(run);
    CHECK(now.points.stretched > 100);
    CHECK(now.points.greatest_stretch > 1.3);
    CHECK(now.points.torn <= 4);  // the tips of the sheared block are free ends
  }

  TEST_CASE(
      "what has failed, and what bears no tension, is not torn; the mass is that of the torn") {
    const std::string watch = "numerical_fracture: watch, stagger: false";
    Run gas = start_text(block("[0, 50*z]", watch, "none"));
    run_to(gas, 0.08);
    CHECK(look_at(gas).points.stretched == 0);
    Run run = start_text(block("[0, 50*z]", watch));
    run_to(run, 0.08);
    const Look now = look_at(run);
    CHECK(now.points.torn == run.sim->point_count());
    CHECK(now.points.torn_by_body == std::vector<std::size_t>{run.sim->point_count()});
    CHECK(now.points.torn_mass == doctest::Approx(run.sim->totals().mass).epsilon(1e-12));
    const auto& told = run.sim->warnings().all();
    CHECK(std::count_if(told.begin(), told.end(), [](const Warning& w) {
            return w.kind == "numerical_fracture" && w.count > 100;
          }) == 1);
  }

  TEST_CASE("half a block at a plane of symmetry is torn as the whole") {
    const std::string whole = block("[0, 50*z]", "numerical_fracture: watch, stagger: false");
    std::string half = whole;
    half.replace(half.find("min: [-60, -60]"), 15, "min: [-60, 0]");
    half.replace(half.find("x_min: open"), 11, "z_min: symmetry");
    Run one = start_text(whole), other = start_text(half);
    for (const double t : {0.055, 0.0595, 0.061, 0.063}) {
      run_to(one, t);
      run_to(other, t);
      CHECK(look_at(one).points.torn == 2 * look_at(other).points.torn);
    }
  }

  TEST_CASE("unasked, no domain is kept and nothing is looked for") {
    Run run = start_text(block("[0, 50*z]", "stagger: false"));
    CHECK(run.sim->bodies()[0]->slot(field::Domain::info) < 0);
    run_to(run, 0.1);
    run.sim->look_for_torn_points();
    CHECK(run.sim->torn_points().stretched == 0);
    CHECK_THROWS_WITH(start_text(block("[0, 0]", "numerical_fracture: watch, reference: initial")),
                      doctest::Contains("watch and split are for reference: current"));
  }
}
