// SPDX-License-Identifier: GPL-3.0-or-later
// Elements that are taken out (kinematics/mesh/erosion.hpp).
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "krater/core/parallel.hpp"
#include "verification/run_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

/// A soft bar of 4 x 12 elements on a wall that rubs, eroding.
std::string bar(const std::string& when, const std::string& frame = "plane_strain") {
  const bool space = frame == "3d";
  return "frame: " + frame + "\ngrid: {cell: 1 mm, box: {min: [" +
         (space ? "-6 mm, -6 mm, 0], max: [6 mm, 6 mm, 16 mm]" : "-6 mm, 0], max: [6 mm, 16 mm]") +
         "}, boundary: {z_min: {wall: {friction: 0.3}}}}\ntime: {end: 12 us, energy_error: off}\n"
         "materials: {metal: {density: 8000, youngs_modulus: 100 GPa, poisson_ratio: 0.3, eos: "
         "linear, strength: {von_mises: {Y: 0.1 GPa, H: 0}}}}\n"
         "bodies: {bar: {material: metal, velocity: " +
         (space ? "[20 m/s, 10 m/s, -300 m/s]" : "[20 m/s, -300 m/s]") + ", shape: {box: {min: [" +
         (space ? "-2 mm, -2 mm, 0], max: [2 mm, 2 mm, 12 mm]" : "-2 mm, 0], max: [2 mm, 12 mm]") +
         "}}, kinematics: {lagrangian_mesh: {element: 1 mm, failure: {action: erode, when: " +
         when + "}}}}}\n";
}

double node_mass(const Simulation& sim) {
  double sum = 0;
  for (std::size_t n = 0; n < sim.mesh()->node_count(0); ++n) sum += sim.mesh()->mass(0, n);
  return sum;
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("erosion: energy and momentum close, mass stays on the nodes") {
    for (const char* frame : {"plane_strain", "3d"}) {
      CAPTURE(frame);
      Run run = start_text(bar("{plastic_strain: 0.4}", frame));
      const Totals start = run.sim->totals();
      const double mass = node_mass(*run.sim), elements = start.count;
      const std::size_t axis = start.momentum[2] != 0 ? 2 : 1;
      while (!run.sim->done()) {
        run.sim->step(run.sim->scene().time.end);
        REQUIRE(std::abs(energy_residual(run)) < 1e-12 * start.kinetic);
      }
      const Totals now = run.sim->totals();
      const Audit& audit = run.sim->audit();
      CHECK(now.count < 0.9 * elements);
      CHECK(now.count + audit.removed_failed == elements);
      CHECK(run.sim->mesh()->eroded().plastic_strain == audit.removed_failed);
      CHECK(audit.removed_energy > 0);
      CHECK(node_mass(*run.sim) == mass);
      CHECK(now.mass == doctest::Approx(start.mass).epsilon(1e-14));
      for (std::size_t a = 0; a <= axis; ++a)
        CHECK(std::abs(now.momentum[a] - start.momentum[a] - audit.wall_impulse[a]) <
              1e-12 * std::abs(start.momentum[axis]));
      double greatest = 0;
      const int plastic = run.sim->bodies()[0]->slot(field::PlasticStrain::info);
      for (int i = 0; i < run.sim->set(0).count(); ++i)
        greatest = std::max(greatest, run.sim->value(0, i, plastic));
      CHECK(greatest < 0.4);
    }
  }

  TEST_CASE("erosion: each cause, counted apart") {
    const auto eroded_by = [](const char* when) {
      Run run = start_text(bar(when));
      while (!run.sim->done()) run.sim->step(run.sim->scene().time.end);
      return run.sim->mesh()->eroded();
    };
    const Eroded thin = eroded_by("{jacobian: 0.5}"), fast = eroded_by("{step: 1e-7 s}"),
                 small = eroded_by("{least_volume: 0.995}");
    CHECK(thin.jacobian > 0);
    CHECK(thin.all() == thin.jacobian);
    CHECK(fast.step > 0);
    CHECK(fast.all() == fast.step);
    CHECK(small.volume_ratio > 0);
    CHECK(small.all() == small.volume_ratio);
    CHECK(eroded_by("{plastic_strain: 50}").all() == 0);
  }

  TEST_CASE("erosion: faces of what is left are exposed, nodes without elements fly on") {
    Run run = start_text(bar("{plastic_strain: 0.4}"));
    const std::size_t before = run.sim->mesh()->meeting_faces(0).size();
    while (!run.sim->done()) run.sim->step(run.sim->scene().time.end);
    // Every exposed edge belongs to one element that is left, or is a node of none.
    const Mesh& mesh = run.sim->mesh()->mesh(0);
    std::vector<int> used(run.sim->mesh()->node_count(0), 0);
    for (const std::int32_t n : mesh.elements) used[static_cast<std::size_t>(n)] = 1;
    std::size_t alone = 0, edges = 0;
    for (const auto& face : run.sim->mesh()->meeting_faces(0)) {
      const auto first = static_cast<std::size_t>(face[0]);
      if (face[1] < 0) {
        ++alone;
        CHECK(used[first] == 0);
      } else {
        ++edges;
        CHECK(used[first] == 1);
        CHECK(used[static_cast<std::size_t>(face[1])] == 1);
      }
    }
    CHECK(edges == exposed_faces(mesh).size());
    CHECK(alone + static_cast<std::size_t>(std::count(used.begin(), used.end(), 1)) == used.size());
    CHECK(alone > 0);
    CHECK(before == exposed_faces(block_mesh(2, {0, 0, 0}, {4, 12, 0}, {4, 12, 1})).size());
  }

  // All its elements are gone at the first step; what it strikes gets its momentum nevertheless.
  TEST_CASE("erosion: nodes without elements push what they meet") {
    for (const std::string& target : {std::string{"kinematics: {lagrangian_mesh: {element: 1 mm}}"},
                                      std::string{"kinematics: mpm"}}) {
      CAPTURE(target);
      Run run = start_text(
          "frame: plane_strain\ngrid: {cell: 1 mm, box: {min: [-12 mm, -10 mm], max: [12 mm, 10 "
          "mm]}}\ntime: {end: 40 us, energy_error: off}\ncontact: {friction: 0}\n"
          "materials: {metal: {density: 8000, youngs_modulus: 100 GPa, poisson_ratio: 0.3, eos: "
          "linear, strength: elastic}}\nbodies:\n"
          "  shot: {material: metal, velocity: [0, -100 m/s], shape: {box: {min: [-2 mm, 1 mm], "
          "max: [2 mm, 3 mm]}}, kinematics: {lagrangian_mesh: {element: 1 mm, failure: {action: "
          "erode, when: {step: 1 s}}}}}\n"
          "  plate: {material: metal, shape: {box: {min: [-10 mm, -4 mm], max: [10 mm, 0]}}, " +
          target + "}\n");
      const Totals start = run.sim->totals();
      while (!run.sim->done()) run.sim->step(run.sim->scene().time.end);
      const Totals now = run.sim->totals(), plate = run.sim->totals(1);
      CHECK(run.sim->totals(0).count == 0);
      CHECK(plate.momentum[1] / start.momentum[1] > 0.9);
      CHECK(std::abs(now.momentum[1] / start.momentum[1] - 1) < 1e-12);
      CHECK(std::abs(energy_residual(run)) < 1e-12 * start.kinetic);
    }
  }

  TEST_CASE("erosion: the same bits on any threads and across a restart") {
    const int before = set_threads(1);
    const std::string scene = bar("{plastic_strain: 0.3}", "3d");
    Run one = start_text(scene);
    run_steps(one, 120);
    const Checkpoint middle = saved_state(*one.sim);
    REQUIRE(one.sim->audit().removed_failed > 0);
    const double then = one.sim->audit().removed_failed;
    run_steps(one, 60);
    REQUIRE(one.sim->audit().removed_failed > then);
    set_threads(3);
    Run three = start_text(scene), again = start_text(scene);
    run_steps(three, 180);
    again.sim->restore(middle);
    run_steps(again, 60);
    set_threads(before);
    CHECK(all_bits(*three.sim) == all_bits(*one.sim));
    CHECK(all_bits(*again.sim) == all_bits(*one.sim));
    CHECK(again.sim->mesh()->eroded().all() == one.sim->mesh()->eroded().all());
  }
}
