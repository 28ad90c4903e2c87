// SPDX-License-Identifier: GPL-3.0-or-later
// Elements that become material points (kinematics/mesh/conversion.hpp).
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "krater/core/parallel.hpp"
#include "verification/run_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

const std::string kMetal =
    "materials: {metal: {density: 8000, youngs_modulus: 100 GPa, poisson_ratio: 0.3, eos: linear, "
    "strength: {von_mises: {Y: 0.1 GPa, H: 0}}}}\n";

/// A free block that turns, stretches and shears; elements of `element`, cells of 1 mm. `failure`:
/// of its kinematics.
std::string spinning(const std::string& frame, const std::string& element,
                     const std::string& failure) {
  const bool space = frame == "3d";
  const std::string low = space ? "[-2 mm, -1.5 mm, -1 mm]" : "[-2 mm, -1.5 mm]",
                    high = space ? "[2 mm, 1.5 mm, 1 mm]" : "[2 mm, 1.5 mm]",
                    velocity =
                        space ? R"(["100 + 2e4*x - 3e4*y", "3e4*x - 1e4*y", "50 + 4e3*x - 1e4*z"])"
                              : R"(["100 + 2e4*x - 3e4*z", "20 + 3e4*x - 1e4*z"])";
  return "frame: " + frame + "\ngrid: {cell: 1 mm, box: {min: " +
         (space ? "[-8 mm, -8 mm, -8 mm], max: [8 mm, 8 mm, 8 mm]"
                : "[-8 mm, -8 mm], max: [8 mm, 8 mm]") +
         "}}\ntime: {end: 10 us, energy_error: off}\ncontact: {friction: 0}\n" + kMetal +
         "bodies: {block: {material: metal, velocity: " + velocity + ", shape: {box: {min: " + low +
         ", max: " + high + "}}, kinematics: {lagrangian_mesh: {element: " + element + failure +
         "}}}}\n";
}

std::string becomes_points(const std::string& when) {
  return ", failure: {action: convert, when: " + when + "}";
}

/// A bar on a wall that rubs; what it becomes meets what is left.
std::string bar(const std::string& frame) {
  const bool space = frame == "3d", round = frame == "axisymmetric";
  const std::string low = space   ? "-9 mm, -9 mm"
                          : round ? "0"
                                  : "-9 mm",
                    high = space ? "9 mm, 9 mm" : "9 mm",
                    velocity = space   ? "20 m/s, 10 m/s"
                               : round ? "0"
                                       : "20 m/s",
                    shape = round   ? "cylinder: {radius: 2 mm, height: 12 mm}"
                            : space ? "box: {min: [-2 mm, -2 mm, 0], max: [2 mm, 2 mm, 12 mm]}"
                                    : "box: {min: [-2 mm, 0], max: [2 mm, 12 mm]}";
  return "frame: " + frame + "\ngrid: {cell: 1 mm, box: {min: [" + low + ", 0], max: [" + high +
         ", 16 mm]}, boundary: {z_min: {wall: {friction: 0.3}}}}\n"
         "time: {end: 12 us, energy_error: off}\ncontact: {friction: 0.2}\n" +
         kMetal + "bodies: {bar: {material: metal, velocity: [" + velocity +
         ", -300 m/s], shape: {" + shape + "}, kinematics: {lagrangian_mesh: {element: 1 mm" +
         becomes_points("{plastic_strain: 0.4}") + "}}}}\n";
}

double component(const Simulation& sim, int set, int point, const FieldInfo& field, int k = 0) {
  return sim.value(set, point, sim.bodies()[0]->slot(field, k));
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("conversion: mass, momentum and angular momentum are exact") {
    for (const char* frame : {"plane_strain", "3d"})
      for (const char* element : {"0.4 mm", "1 mm", "1.5 mm"}) {
        CAPTURE(frame);
        CAPTURE(element);
        Run run = start_text(spinning(frame, element, becomes_points("{step: 1 s}")));
        const Totals start = run.sim->totals();
        run.sim->step(1);
        const Totals now = run.sim->totals();
        REQUIRE(run.sim->set(0).count() == 0);
        CHECK(run.sim->mesh()->converted().step == start.count);
        CHECK(now.count >= start.count);
        CHECK(std::abs(now.mass / start.mass - 1) < 1e-13);
        const double p = start.mass * 100;
        for (std::size_t a = 0; a < 3; ++a)
          CHECK(std::abs(now.momentum[a] - start.momentum[a]) < 1e-13 * p);
        const double turn = now.angular_momentum / start.angular_momentum;
        if (std::string{element} == "1.5 mm")  // larger than a cell: no more energy, less turn
          CHECK(turn < 1 - 1e-3);
        else
          CHECK(std::abs(turn - 1) < 1e-12);
        CHECK(std::abs(energy_residual(run)) < 1e-13 * start.kinetic);
        const double heat = run.sim->audit().conversion_heat;
        CHECK(heat > (std::string{element} == "1.5 mm" ? -1e-13 * start.kinetic : 0.0));
      }
  }

  TEST_CASE("conversion: the state is the element's, bit for bit") {
    for (const char* frame : {"plane_strain", "3d"}) {
      CAPTURE(frame);
      Run points = start_text(spinning(frame, "1 mm", becomes_points("{step: 1 s}"))),
          elements = start_text(spinning(frame, "1 mm", ""));
      points.sim->step(1);
      elements.sim->step(1);
      const int count = elements.sim->set(0).count(), parts = frame[0] == '3' ? 8 : 4;
      REQUIRE(points.sim->point_count() == static_cast<std::size_t>(parts * count));
      for (int s = 0; s < points.sim->set_count(); ++s)
        for (int i = 0; i < points.sim->set(s).count(); ++i) {
          const double number = component(*points.sim, s, i, field::Id::info);
          const int e = static_cast<int>((number - count) / kPartsOfElement);
          REQUIRE(component(*elements.sim, 0, e, field::Id::info) == e);
          REQUIRE(component(*points.sim, s, i, field::Density::info) ==
                  component(*elements.sim, 0, e, field::Density::info));
          for (int k = 0; k < 6; ++k)
            REQUIRE(component(*points.sim, s, i, field::DeviatoricStress::info, k) ==
                    component(*elements.sim, 0, e, field::DeviatoricStress::info, k));
        }
    }
  }

  TEST_CASE("conversion: parts of an element by the axis are those of the revolution") {
    const std::string scene =
        "frame: axisymmetric\ngrid: {cell: 1 mm, box: {min: [0, -4 mm], max: [8 mm, 8 mm]}}\n"
        "time: {end: 1 us}\ncontact: {friction: 0}\n" +
        kMetal +
        "bodies: {disc: {material: metal, velocity: [0, 10 m/s], shape: {cylinder: {radius: 2 mm, "
        "height: 1 mm}}, kinematics: {lagrangian_mesh: {element: 1 mm" +
        becomes_points("{step: 1 s}") + "}}}}\n";
    Run run = start_text(scene);
    const Totals start = run.sim->totals();
    run.sim->step(1e-12);
    const double whole = start.mass;
    for (int s = 0; s < run.sim->set_count(); ++s)
      for (int i = 0; i < run.sim->set(s).count(); ++i) {
        const double r = component(*run.sim, s, i, field::Position::info) * 1e3;
        // Rings of half a millimetre, two layers: m = whole r dr/(R^2/2)/2, r their middle.
        CHECK(std::abs(r / 0.5 - 0.5 - std::round(r / 0.5 - 0.5)) < 1e-9);
        CHECK(component(*run.sim, s, i, field::Mass::info) ==
              doctest::Approx(whole * r * 0.5 / 4).epsilon(1e-12));
      }
    CHECK(run.sim->point_count() == 8);
    CHECK(std::abs(run.sim->totals().momentum[1] / start.momentum[1] - 1) < 1e-13);
  }

  TEST_CASE("conversion: energy and momentum close in a run, with walls and contact") {
    for (const char* frame : {"plane_strain", "axisymmetric", "3d"}) {
      CAPTURE(frame);
      Run run = start_text(bar(frame));
      const Totals start = run.sim->totals();
      const std::size_t axis = std::string{frame} == "3d" ? 2 : 1;
      while (!run.sim->done()) {
        run.sim->step(run.sim->scene().time.end);
        REQUIRE(std::abs(energy_residual(run)) < 1e-12 * start.kinetic);
      }
      const Totals now = run.sim->totals();
      const Audit& audit = run.sim->audit();
      CHECK(run.sim->mesh()->converted().plastic_strain > 0);
      CHECK(run.sim->mesh()->eroded().all() == 0);
      CHECK(audit.contact_heat > 0);
      CHECK(std::abs(now.mass / start.mass - 1) < 1e-12);
      for (std::size_t a = 0; a <= axis; ++a)
        if (std::string{frame} != "axisymmetric" || a == axis)
          CHECK(std::abs(now.momentum[a] - start.momentum[a] - audit.wall_impulse[a]) <
                1e-11 * std::abs(start.momentum[axis]));
      double node_mass = 0, element_mass = 0;
      for (std::size_t n = 0; n < run.sim->mesh()->node_count(0); ++n)
        node_mass += run.sim->mesh()->mass(0, n);
      for (int i = 0; i < run.sim->set(0).count(); ++i)
        element_mass += component(*run.sim, 0, i, field::Mass::info);
      CHECK(node_mass == doctest::Approx(element_mass).epsilon(1e-12));
    }
  }

  TEST_CASE("conversion: the same bits on any threads and across a restart") {
    const int before = set_threads(1);
    const std::string scene = bar("3d");
    Run one = start_text(scene);
    run_steps(one, 60);
    const Checkpoint middle = saved_state(*one.sim);
    const double then = one.sim->mesh()->converted().all();
    REQUIRE(then > 0);
    run_steps(one, 40);
    REQUIRE(one.sim->mesh()->converted().all() > then);
    set_threads(3);
    Run three = start_text(scene), again = start_text(scene);
    run_steps(three, 100);
    again.sim->restore(middle);
    run_steps(again, 40);
    set_threads(before);
    CHECK(all_bits(*three.sim) == all_bits(*one.sim));
    CHECK(all_bits(*again.sim) == all_bits(*one.sim));
  }

  TEST_CASE("conversion: a step may pass before its points have a limit of their own") {
    Run run = start_text(spinning("plane_strain", "4 mm", becomes_points("{step: 1 s}")));
    run.sim->step(1);
    CHECK(run.sim->stable_step() < 1e-3 / (2 * 100));
  }
}
