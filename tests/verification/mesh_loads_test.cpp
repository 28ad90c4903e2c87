// SPDX-License-Identifier: GPL-3.0-or-later
// Loads on elements (kinematics/mesh/mesh_loads.hpp), and sides that drive them.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "krater/core/parallel.hpp"
#include "verification/run_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

const std::string kElastic =
    "materials: {metal: {density: 8000, youngs_modulus: 100 GPa, poisson_ratio: 0.25, eos: linear, "
    "strength: elastic}}\n";

std::string body(const std::string& frame, const std::string& more = "", int length = 8) {
  const std::string top = std::to_string(length) + " mm";
  const std::string shape =
      frame == "axisymmetric" ? "cylinder: {radius: 2 mm, height: " + top + "}"
      : frame == "3d"         ? "box: {min: [-2 mm, -2 mm, 0], max: [2 mm, 2 mm, " + top + "]}"
                              : "box: {min: [-2 mm, 0], max: [2 mm, " + top + "]}";
  return kElastic + "bodies: {bar: {material: metal, shape: {" + shape + "}" + more +
         ", kinematics: {lagrangian_mesh: {element: 1 mm}}}}\n";
}

std::string domain(const std::string& frame, const std::string& end = "20 us",
                   const std::string& sides = "", const std::string& bottom = "-9 mm") {
  const std::string across = frame == "axisymmetric" ? "0"
                             : frame == "3d"         ? "-9 mm, -9 mm"
                                                     : "-9 mm",
                    high = frame == "3d" ? "9 mm, 9 mm, 99 mm" : "9 mm, 99 mm";
  return "frame: " + frame + "\ngrid: {cell: 1 mm, box: {min: [" + across + ", " + bottom +
         "], max: [" + high + "]}" + sides + "}\ntime: {end: " + end + ", energy_error: off}\n";
}

std::size_t axis_of(const std::string& frame) { return frame == "3d" ? 2 : 1; }

const std::vector<std::string> kFrames{"plane_strain", "axisymmetric", "3d"};

}  // namespace

TEST_SUITE("verification") {
  // Under pressure all around a body only rings: its centre stays, and its damped state has the
  // pressure of the load but for the square of the strain, 1e-4.
  TEST_CASE("mesh loads: pressure all around is the uniform stress -p") {
    for (const std::string& frame : kFrames) {
      CAPTURE(frame);
      Run run = start_text(domain(frame, "60 us") + "damping: {mass: 5e5 1/s}\n" +
                           "loads: {sea: {body: bar, pressure: 10 MPa}}\n" + body(frame));
      while (!run.sim->done()) run.sim->step(run.sim->scene().time.end);
      const Body& b = *run.sim->bodies()[0];
      for (int i = 0; i < run.sim->set(0).count(); ++i) {
        const double p = run.sim->value(0, i, b.slot(field::Pressure::info));
        const double s = run.sim->value(0, i, b.slot(field::DeviatoricStress::info, 2));
        const double mean = p - (frame == "plane_strain" ? s : 0);  // of the plane: held across
        CHECK(std::abs(mean - 10e6) < 1e4);
      }
      const Totals now = run.sim->totals();
      for (std::size_t a = 0; a < 3; ++a)
        if (!(frame == "axisymmetric" && a == 0))
          CHECK(std::abs(now.momentum[a]) < 1e-12 * now.mass);
    }
  }

  // A long bar: the wave of a suddenly applied traction moves its end by v = p/(rho c).
  TEST_CASE("mesh loads: traction, momentum and work") {
    for (const std::string& frame : kFrames)
      for (const char* kind : {"pressure: 10 MPa", "traction"}) {
        CAPTURE(frame);
        CAPTURE(kind);
        const std::string load = kind[0] == 'p'  ? kind
                                 : frame == "3d" ? "traction: [0, 0, 10 MPa]"
                                                 : "traction: [0, 10 MPa]";
        Run run = start_text(domain(frame, "5 us") + "loads: {push: {body: bar, face: z_min, " +
                             load + "}}\n" + body(frame, "", 40));
        const std::size_t z = axis_of(frame);
        while (!run.sim->done()) {
          run.sim->step(run.sim->scene().time.end);
          REQUIRE(std::abs(energy_residual(run)) <
                  1e-12 * std::max(run.sim->audit().load_work, 1e-9));
        }
        const double area = frame == "plane_strain"   ? 4e-3
                            : frame == "axisymmetric" ? 3.14159265358979 * 4e-6
                                                      : 16e-6;
        const double impulse = 10e6 * area * 5e-6;
        const Audit& audit = run.sim->audit();
        CHECK(run.sim->totals().momentum[z] == doctest::Approx(impulse).epsilon(1e-3).scale(0));
        CHECK(audit.load_impulse[z] ==
              doctest::Approx(run.sim->totals().momentum[z]).epsilon(1e-12).scale(0));
        CHECK(audit.load_work > 0);
        CHECK(audit.external_work == audit.load_work);
      }
  }

  TEST_CASE("mesh loads: a face with a region, and one that is driven") {
    const std::string scene = domain("plane_strain", "10 us") +
                              "loads: {drive: {body: bar, face: z_max, velocity: [free, -2 m/s], "
                              "where: {x_min: 0}}}\n" +
                              body("plane_strain");
    Run run = start_text(scene);
    while (!run.sim->done()) {
      run.sim->step(run.sim->scene().time.end);
      REQUIRE(std::abs(energy_residual(run)) <
              1e-12 * std::max(std::abs(run.sim->audit().load_work), 1e-9));
    }
    int driven = 0;
    for (std::size_t n = 0; n < run.sim->mesh()->node_count(0); ++n) {
      const Triple X = run.sim->mesh()->mesh(0).nodes[n];
      const double v = run.sim->mesh()->velocity(0, n)[1];
      if (X[1] == 8e-3 && X[0] > -1e-9) {
        CHECK(v == doctest::Approx(-2).epsilon(1e-14));
        ++driven;
      } else if (X[1] == 8e-3) {
        CHECK(std::abs(v + 2) > 1e-6);
      }
    }
    CHECK(driven == 3);
  }

  TEST_CASE("mesh loads: damping and a body force have their exact decay and fall") {
    for (const std::string& frame : kFrames) {
      CAPTURE(frame);
      const std::size_t z = axis_of(frame);
      const std::string velocity = frame == "3d" ? "[0, 0, 5 m/s]" : "[0, 5 m/s]",
                        down = frame == "3d" ? "[0, 0, \"-1e5\"]" : "[0, \"-1e5\"]";
      Run damped = start_text(domain(frame) + "damping: {mass: 3e4 1/s}\n" +
                              body(frame, ", velocity: " + velocity)),
          falling = start_text(domain(frame) + "body_force: " + down + "\n" +
                               body(frame, ", velocity: " + velocity));
      const double mass = damped.sim->totals().mass;
      for (Run* run : {&damped, &falling})
        while (!run->sim->done()) {
          run->sim->step(run->sim->scene().time.end);
          REQUIRE(std::abs(energy_residual(*run)) < 1e-12 * mass * 25);
        }
      // Crank and Nicolson over steps of 1e-7 s: (eta dt)^2/12 of the exponent.
      CHECK(damped.sim->totals().momentum[z] / mass ==
            doctest::Approx(5 * std::exp(-0.6)).epsilon(1e-5).scale(0));
      CHECK(damped.sim->audit().damping_work < 0);
      CHECK(falling.sim->totals().momentum[z] / mass == doctest::Approx(3).epsilon(1e-10));
      CHECK(falling.sim->audit().external_impulse[z] ==
            doctest::Approx(-2 * mass).epsilon(1e-10).scale(0));
    }
  }

  TEST_CASE("mesh loads: what falls against damping ends at b/eta") {
    Run run = start_text(domain("plane_strain", "60 us") + "damping: {mass: 4e5 1/s}\n" +
                         "body_force: [0, \"-1e5\"]\n" + body("plane_strain"));
    while (!run.sim->done()) run.sim->step(run.sim->scene().time.end);
    const Totals now = run.sim->totals();
    CHECK(now.momentum[1] / now.mass == doctest::Approx(-0.25).epsilon(1e-9).scale(0));  // exp(-24)
  }

  TEST_CASE("mesh loads: the same bits on any threads and across a restart") {
    const std::string scene =
        domain("3d", "20 us", ", boundary: {z_min: {velocity: [0, 0, 5 m/s]}}", "0") +
        "damping: {mass: 1e4 1/s}\nbody_force: [0, 0, \"-1e8*x\"]\n"
        "loads: {push: {body: bar, face: z_max, pressure: {table: [[0, 0], [5 us, 1 GPa]]}}}\n" +
        body("3d", "", 40);  // more nodes than one thread takes at once
    const int before = set_threads(1);
    Run one = start_text(scene);
    run_steps(one, 10);
    const Checkpoint middle = saved_state(*one.sim);
    run_steps(one, 15);
    set_threads(3);
    Run three = start_text(scene), again = start_text(scene);
    run_steps(three, 25);
    again.sim->restore(middle);
    run_steps(again, 15);
    set_threads(before);
    CHECK(all_bits(*three.sim) == all_bits(*one.sim));
    CHECK(all_bits(*again.sim) == all_bits(*one.sim));
    CHECK(one.sim->audit().load_work != 0);
    CHECK(one.sim->audit().wall_work != 0);
  }

  // A piston at 10 m/s that begins at the body: behind the wave matter goes with it.
  TEST_CASE("mesh loads: a side that drives is a piston") {
    for (const std::string& frame : kFrames) {
      CAPTURE(frame);
      const std::size_t z = axis_of(frame);
      const std::string side = frame == "3d" ? "[0, 0, 10 m/s]" : "[0, 10 m/s]";
      const std::string box =
          domain(frame, "4 us", ", boundary: {z_min: {velocity: " + side + "}}", "0");
      Run run = start_text(box + body(frame, "", 40));
      while (!run.sim->done()) {
        run.sim->step(run.sim->scene().time.end);
        REQUIRE(std::abs(energy_residual(run)) <
                1e-12 * std::max(run.sim->audit().wall_work, 1e-9));
      }
      CHECK(run.sim->audit().wall_work > 0);
      CHECK(run.sim->totals().momentum[z] ==
            doctest::Approx(run.sim->audit().wall_impulse[z]).epsilon(1e-12).scale(0));
      for (std::size_t n = 0; n < run.sim->mesh()->node_count(0); ++n)
        if (run.sim->mesh()->mesh(0).nodes[n][z] == 0) {
          CHECK(run.sim->mesh()->position(0, n)[z] ==
                doctest::Approx(40e-6).epsilon(2e-2).scale(0));
          CHECK(run.sim->mesh()->velocity(0, n)[z] >= 10 * (1 - 1e-9));
        }
    }
  }

  // What erosion exposes deep inside is not the face that is driven.
  TEST_CASE("mesh loads: a driven face stays that of the start") {
    Run run = start_text(
        "frame: plane_strain\ngrid: {cell: 1 mm, box: {min: [-40 mm, -40 mm], max: [40 mm, 40 "
        "mm]}}\ntime: {end: 4 us, energy_error: off}\ncontact: {friction: 0}\n"
        "materials: {metal: {density: 8000, youngs_modulus: 100 GPa, poisson_ratio: 0.3, eos: "
        "linear, viscosity: {}, strength: {von_mises: {Y: 0.1 GPa, H: 0}}}}\n"
        "bodies: {block: {material: metal, velocity: [\"800*exp(-(x^2+z^2)/0.002^2)\", \"0\"], "
        "shape: {box: {min: [-10 mm, -10 mm], max: [10 mm, 10 mm]}}, kinematics: {lagrangian_mesh: "
        "{element: 1 mm, failure: {action: erode, when: {plastic_strain: 0.2}}}}}}\n"
        "loads: {push: {body: block, face: z_max, velocity: [free, 50]}}\n");
    while (!run.sim->done()) run.sim->step(run.sim->scene().time.end);
    REQUIRE(run.sim->mesh()->eroded().all() > 0);
    int driven = 0;
    for (std::size_t n = 0; n < run.sim->mesh()->node_count(0); ++n)
      if (std::abs(run.sim->mesh()->velocity(0, n)[1] - 50) < 1e-9) {
        ++driven;
        CHECK(run.sim->mesh()->mesh(0).nodes[n][1] == 10e-3);
      }
    CHECK(driven == 21);
  }
}
