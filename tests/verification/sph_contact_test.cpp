// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of particles that meet others (kinematics/sph/sph_contact.hpp).
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "krater/core/parallel.hpp"
#include "verification/run_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

const std::string kMetal =
    "{density: 8000, youngs_modulus: 200 GPa, poisson_ratio: 0.3, eos: linear, strength: elastic}";
const std::string kParticles = "kinematics: {sph: {spacing: 0.5 mm}}", kPoints = "kinematics: mpm",
                  kElements = "kinematics: {lagrangian_mesh: {element: 0.5 mm}}";

/// Two bars of 40 mm meet end on at a hundredth of the wave's speed; the joint lies at `place`.
std::string two_bars(double cell, double place, const std::string& first,
                     const std::string& second) {
  const auto mm = [](double x) { return std::to_string(x) + " mm"; };
  return "frame: plane_strain\ngrid: {cell: " + mm(cell) +
         ", box: {min: [0, -50 mm], max: [4 mm, 50 mm]}, boundary: {x_min: symmetry, x_max: "
         "symmetry}}\ntime: {end: 17.9 us, energy_error: off}\nmaterials: {metal: " +
         kMetal +
         "}\ncontact: {friction: 0}\nbodies:\n  striker: {material: metal, shape: {box: "
         "{min: [0, " +
         mm(place - 40) + "], max: [4 mm, " + mm(place) + "]}}, velocity: [0, 58.02 m/s], " +
         first + "}\n  target: {material: metal, shape: {box: {min: [0, " + mm(place) +
         "], max: [4 mm, " + mm(place + 40) + "]}}, " + second + "}\n";
}

/// A block at 70 m/s each way on a base that is wider; `more` of the bodies.
std::string oblique(double friction, const std::string& block, const std::string& base) {
  return "frame: plane_strain\ngrid: {cell: 1 mm, box: {min: [-30 mm, -20 mm], max: [30 mm, 30 "
         "mm]}}\ntime: {end: 6 us, energy_error: off}\nmaterials: {metal: " +
         kMetal + "}\ncontact: {friction: " + std::to_string(friction) +
         "}\nbodies:\n  block: {material: metal, shape: {box: {min: [-5 mm, 0.1 mm], max: [5 mm, "
         "6.1 mm]}}, velocity: [70 m/s, -70 m/s], " +
         block +
         "}\n  base: {material: metal, shape: {box: {min: [-15 mm, -8 mm], max: [15 mm, "
         "0]}}, " +
         base + "}\n";
}

/// What a meeting did.
struct Outcome {
  double taken;     ///< share of the momentum that the target has
  double lost;      ///< share of the energy that contact took
  double momentum;  ///< relative error of the sum
  double residual;  ///< of the energy, over that at the start
};
Outcome meet(const std::string& text) {
  Run run = start_text(text);
  const Totals start = run.sim->totals();
  run_to(run, run.scene->time.end);
  const double p = start.momentum[1];
  return {run.sim->totals(1).momentum[1] / p, run.sim->audit().contact_heat / start.kinetic,
          std::abs(run.sim->totals().momentum[1] / p - 1),
          std::abs(energy_residual(run)) / start.kinetic};
}

}  // namespace

TEST_SUITE("verification") {
  // Exact: the target takes all, and nothing is lost. Two spacings to a cell have the bounds of
  // elements and points at a cell of one element (mesh_contact_test.cpp), for here as there a face
  // is found from fillings; between two bodies of particles both ways back smooth, and the bounds
  // are what a trial of the design had with all nodes and four passes (design of kinematics,
  // section 4). A cell as fine as the particles, or of four, only keeps its books.
  TEST_CASE("sph contact: two elastic bars of particles, points and elements") {
    struct Case {
      const std::string &first, &second;
    };
    for (const Case& c :
         {Case{kParticles, kParticles}, Case{kParticles, kPoints}, Case{kPoints, kParticles},
          Case{kParticles, kElements}, Case{kElements, kParticles}})
      for (const auto& lattice :
           {std::pair{1.0, 0.0}, std::pair{1.0, 0.5}, std::pair{0.5, 0.0}, std::pair{2.0, 0.5}}) {
        const auto& [cell, place] = lattice;
        CAPTURE(c.first);
        CAPTURE(c.second);
        CAPTURE(lattice.first);
        CAPTURE(lattice.second);
        const Outcome out = meet(two_bars(cell, place, c.first, c.second));
        const bool both = c.first == c.second;
        if (cell == 1) CHECK(out.taken > (both ? 0.95 : 0.977));
        if (cell == 1) CHECK(out.lost < (both ? 0.07 : 0.027));
        CHECK(out.taken <= 1);
        CHECK(out.lost >= 0);
        CHECK(out.momentum < 1e-12);
        CHECK(out.residual < 1e-12);
      }
  }

  TEST_CASE("sph contact: oblique, friction is Coulomb's, on every partner") {
    for (const std::string& base :
         {kParticles, kPoints, kElements, std::string{"rigid: {velocity: [0, 0]}"}})
      for (const double friction : {0.0, 0.2}) {
        CAPTURE(base);
        CAPTURE(friction);
        Run run = start_text(oblique(friction, kParticles, base));
        const Totals start = run.sim->totals(), before = run.sim->totals(0);
        run_to(run, run.scene->time.end);
        const Totals end = run.sim->totals(), after = run.sim->totals(0);
        const double up = after.momentum[1] - before.momentum[1],
                     along = after.momentum[0] - before.momentum[0];
        CHECK(up > 60 * before.mass);
        CHECK(std::abs(along + friction * up) < 0.02 * up);
        CHECK(std::abs(energy_residual(run)) < 1e-12 * start.kinetic);
        const Audit& audit = run.sim->audit();
        for (std::size_t a = 0; a < 2; ++a)
          CHECK(std::abs(end.momentum[a] - start.momentum[a] - audit.external_impulse[a]) <
                1e-12 * std::abs(start.momentum[0]));
        if (friction == 0) CHECK(audit.friction_work == 0);
        if (friction > 0) CHECK(audit.friction_work < 0);
      }
  }

  TEST_CASE("sph contact: a free rigid ball bounces off a block of particles") {
    Run run = start_text(
        "frame: 3d\ngrid: {cell: 1 mm, box: {min: [0, 0, 0], max: [8 mm, 8 mm, 16 mm]}, boundary: "
        "{x_min: symmetry, y_min: symmetry}}\ntime: {end: 8 us, energy_error: off}\nmaterials: "
        "{metal: " +
        kMetal +
        "}\ncontact: {friction: 0.1}\nbodies:\n  ball: {material: metal, "
        "shape: {sphere: {radius: 2 mm, center: [0, 0, 8.1 mm]}}, rigid: free, velocity: [0, 0, "
        "-50 m/s]}\n  block: {material: metal, shape: {box: {min: [-5 mm, -5 mm, 2 mm], max: [5 "
        "mm, 5 mm, 6 mm]}}, " +
        kParticles + "}\n");
    const Totals start = run.sim->totals();
    run_to(run, run.scene->time.end);
    const Totals end = run.sim->totals();
    CHECK(run.sim->totals(0).momentum[2] / start.momentum[2] < 0);
    CHECK(std::abs(end.momentum[2] / start.momentum[2] - 1) < 1e-12);
    for (const std::size_t a : {0U, 1U})
      CHECK(std::abs(end.momentum[a] - run.sim->audit().wall_impulse[a]) <
            1e-12 * std::abs(start.momentum[2]));
    CHECK(std::abs(energy_residual(run)) < 1e-12 * start.kinetic);
  }

  TEST_CASE("sph contact: four kinds of bodies, threads and a restart leave every bit") {
    std::string text = oblique(0.2, kParticles, kPoints);
    text +=
        "  beside: {material: metal, shape: {box: {min: [5.2 mm, 0.1 mm], max: [9.2 mm, 4.1 mm]}}, "
        "velocity: [0, -70 m/s], " +
        kElements + "}\n" +
        "  ball: {material: metal, shape: {cylinder: {radius: 2 mm, height: 2 mm, base: [0, -1 mm, "
        "8.3 mm], axis: y}}, velocity: [0, -100 m/s], rigid: free}\n" +
        "  other: {material: metal, shape: {box: {min: [-9.2 mm, 0.1 mm], max: [-5.2 mm, 4.1 "
        "mm]}}, velocity: [90 m/s, 0], " +
        kParticles + "}\n";
    const int before = threads();
    std::vector<std::uint64_t> one;
    for (const int count : {1, 2, 3}) {
      set_threads(count);
      Run run = start_text(text);
      const Totals start = run.sim->totals();
      run_steps(run, 40);
      if (count == 1) one = all_bits(*run.sim);
      CHECK(all_bits(*run.sim) == one);
      CHECK(run.sim->audit().contact_heat > 0);
      CHECK(std::abs(energy_residual(run)) < 1e-12 * start.kinetic);
      for (std::size_t a = 0; a < 2; ++a)
        CHECK(std::abs(run.sim->totals().momentum[a] - start.momentum[a]) <
              1e-12 * std::abs(start.momentum[1]));
    }
    Run first = start_text(text), second = start_text(text);
    run_steps(first, 25);
    second.sim->restore(saved_state(*first.sim));
    run_steps(second, 15);
    CHECK(all_bits(*second.sim) == one);
    set_threads(before);
  }

  // The points stand where particles are met, far from where the elements were.
  TEST_CASE("particle contact: points that elements became are met") {
    Run run = start_text(
        "frame: plane_strain\ngrid: {cell: 1 mm, box: {min: [-10 mm, -10 mm], max: [40 mm, 10 "
        "mm]}}\ntime: {end: 30 us, energy_error: off}\nmaterials: {metal: " +
        kMetal +
        "}\ncontact: {friction: 0}\nbodies:\n  block: {material: metal, velocity: [600 m/s, 0], "
        "shape: {box: {min: [-4 mm, -2 mm], max: [0, 2 mm]}}, kinematics: {lagrangian_mesh: "
        "{element: 1 mm, failure: {action: convert, when: {step: 1 s}}}}}\n"
        "  wall: {material: metal, shape: {box: {min: [12 mm, -4 mm], max: [16 mm, 4 mm]}}, " +
        kParticles + "}\n");
    const Totals start = run.sim->totals();
    run_to(run, run.scene->time.end);
    REQUIRE(run.sim->mesh()->converted().all() > 0);
    CHECK(run.sim->totals(1).momentum[0] > 0.9 * start.momentum[0]);
    CHECK(std::abs(run.sim->totals().momentum[0] / start.momentum[0] - 1) < 1e-12);
  }
}
