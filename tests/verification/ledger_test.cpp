// SPDX-License-Identifier: GPL-3.0-or-later
// The energy ledger (kinematics/mpm/ledger.hpp): in one step of any state whatever, kinetic and
// internal energy change by the work from outside, to round-off, and an observer who moves sees the
// same heat.
#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <sstream>

#include "krater/points/ledger_fields.hpp"
#include "verification/run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

struct Case {
  std::string frame, more;
  int bodies = 2;
  bool contact = false;
  std::string low = "symmetry", high = "wall";  ///< sides of every axis
};

/// Blocks of 3 cells side by side along the first axis in [0, 3 n], cells of 1 m.
std::string blocks(const Case& c) {
  const bool space = c.frame == "3d", axis = c.frame == "axisymmetric";
  const double length = 3 * c.bodies;
  std::ostringstream yaml;
  const auto sides = [&](const std::string& name, const std::string& low, const std::string& high) {
    yaml << name << "_min: " << low << ", " << name << "_max: " << high;
  };
  const int margin = c.low == "open" ? 2 : 0, low = -margin, high = 3 + margin;
  const auto list = [&](double first, int other) {
    yaml << "[" << first << ", ";
    if (space) yaml << other << ", ";
    yaml << other << "]";
  };
  yaml << "frame: " << c.frame << "\ngrid:\n  cell: 1\n  box: {min: ";
  list(axis ? 0 : low, low);
  yaml << ", max: ";
  list(length + margin, high);
  yaml << "}\n  boundary: {";
  sides(axis ? "r" : "x", axis ? "axis" : c.low, c.high);
  if (space) yaml << ", ", sides("y", c.low, c.high);
  yaml << ", ", sides("z", c.low, c.high);
  yaml << "}\ntime: {end: 1, first_step: 3e-5}\nmaterials:\n"
       << "  m: {density: 1000, bulk_modulus: 1e9, shear_modulus: 5e8, eos: linear, "
          "strength: elastic, viscosity: {q_lin: 0.3, q_quad: 2.0}}\nbodies:\n";
  for (int b = 0; b < c.bodies; ++b) {
    yaml << "  body" << b << ": {material: m, shape: {";
    if (axis && b == 0) {
      yaml << "cylinder: {radius: 3, height: 3, base: [0, 0, 0]}}}\n";
    } else if (axis) {
      yaml << "tube: {inner_radius: " << 3 * b << ", outer_radius: " << 3 * b + 3
           << ", height: 3, base: [0, 0, 0]}}}\n";
    } else {
      yaml << "box: {min: ";
      list(3 * b, 0);
      yaml << ", max: ";
      list(3 * b + 3, 3);
      yaml << "}}}\n";
    }
  }
  if (c.contact) yaml << "contact: {friction: 0.3}\n";
  return yaml.str() + c.more;
}

/// Velocities, velocity gradients, stresses, pressures, masses and shock indicators at random.
void shake(Run& run, int bodies, double boost = 0) {
  std::mt19937_64 engine{11};
  const int dim = run.sim->geometry().dimension;
  const auto randomize = [&](int body, const FieldInfo& field, double low, double high) {
    const Column* c = run.sim->bodies()[static_cast<std::size_t>(body)]->layout().find(field.name);
    if (c == nullptr) return;
    for (int k = 0; k < c->components; ++k) {
      std::vector<double> x = column(run, field, k, body);
      for (double& value : x) value = std::uniform_real_distribution<double>{low, high}(engine);
      set_column(run, field, k, x, body);
    }
  };
  for (int b = 0; b < bodies; ++b) {
    randomize(b, field::Velocity::info, -30, 30);
    randomize(b, field::AffineVelocity::info, -10, 10);
    randomize(b, field::DeviatoricStress::info, -2e6, 2e6);
    randomize(b, field::Pressure::info, -1e7, 3e7);
    randomize(b, field::ViscousPressure::info, 0, 1e6);
    randomize(b, field::Mass::info, 60, 300);
    randomize(b, field::ShockIndicator::info, 0, 0.005);
    for (int a = 0; a < dim && boost != 0; ++a) {
      std::vector<double> v = column(run, field::Velocity::info, a, b);
      for (double& x : v) x += (a + 1) * boost;
      set_column(run, field::Velocity::info, a, v, b);
    }
  }
}

double residual_after(const Case& c, const Overrides& overrides, int steps) {
  Run run = start_text(blocks(c), overrides);
  shake(run, c.bodies);
  const double start = run.sim->totals().kinetic;
  run_steps(run, steps);
  return std::abs(energy_residual(run)) / start;
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("ledger: one step of any state: energy changes by the work from outside") {
    for (const std::string frame : {"plane_strain", "axisymmetric", "3d"})
      for (const std::string transfer : {"tflip", "flip", "apic", "xpic"})
        for (const std::string update : {"usl", "musl", "usf"})
          for (const std::string shape : {"quadratic_bspline", "gimp"})
            for (const bool contact : {false, true}) {
              if (transfer == "xpic" && (update != "usl" || contact)) continue;
              if (transfer == "flip" && update == "usl" && shape == "gimp") continue;
              CAPTURE(frame + " " + transfer + " " + update + " " + shape);
              CAPTURE(contact);
              const Case c{
                  .frame = frame, .more = "", .bodies = contact ? 3 : 2, .contact = contact};
              // Domains of gimp that end at a node give it next to no mass; it gets no force.
              const double most = shape == "gimp" ? 1e-10 : 2e-13;
              CHECK(residual_after(c,
                                   {"method.transfer=" + transfer, "method.update=" + update,
                                    "method.shape=" + shape},
                                   2) < most);
            }
  }

  TEST_CASE("sides of every kind, body forces, fluids, fixed references") {
    for (const std::string frame : {"plane_strain", "axisymmetric", "3d"}) {
      CAPTURE(frame);
      const bool space = frame == "3d";
      for (const std::string side : {"sticky", "open", "{wall: {friction: 0.4}}", "symmetry"}) {
        CAPTURE(side);
        CHECK(residual_after({.frame = frame, .more = "", .low = side, .high = side}, {}, 2) <
              2e-13);
      }
      CHECK(residual_after({.frame = frame, .more = ""},
                           {space ? "body_force=[10 + x, 5, -3]" : "body_force=[10, 5]"},
                           2) < 2e-13);
      CHECK(residual_after({.frame = frame, .more = "", .low = "open", .high = "open"},
                           {"method.reference=initial"}, 3) < 2e-13);
      CHECK(residual_after({.frame = frame, .more = ""}, {"method.cell_averaging=false"}, 2) <
            2e-13);
      CHECK(residual_after({.frame = frame, .more = ""}, {"method.grid_pressure=all"}, 2) < 2e-13);
      CHECK(residual_after({.frame = frame, .more = ""},
                           {"method.grid_pressure=all", "method.update=musl"}, 2) < 2e-13);
      CHECK(residual_after({.frame = frame, .more = ""},
                           {"method.grid_pressure=all", "method.update=usf"}, 2) < 2e-13);
    }
  }

  // Points that move without forces, compressed at the rate a: L_p was that of the step before, and
  // the grid shows more. The affine part makes h^2/4 a^3 dt of motion per mass and axis, which cold
  // gas cannot give.
  TEST_CASE("ledger: heat that cold matter cannot give is carried, and counted") {
    constexpr double rate = 100;
    const std::string gas =
        "m: {density: 1000, eos: {ideal_gas: {gamma: 1.4, initial_pressure: 1e-3}}}";
    for (const std::string frame : {"plane_strain", "3d"}) {
      CAPTURE(frame);
      std::string scene = blocks({.frame = frame, .more = "", .bodies = 1, .high = "open"});
      const std::size_t at = scene.find("m: {density");
      scene.replace(at, scene.find('\n', at) - at, gas);
      Run run = start_text(scene, {"method.grid_pressure=none", "method.cell_averaging=false"});
      const int dim = run.sim->geometry().dimension;
      for (int a = 0; a < dim; ++a) {
        std::vector<double> v = column(run, field::Position::info, a);
        for (double& x : v) x *= -rate;
        set_column(run, field::Velocity::info, a, v);
        set_column(run, field::AffineVelocity::info, (dim + 1) * a,
                   std::vector<double>(v.size(), -rate));
      }
      const double start = run.sim->totals().kinetic;
      run_steps(run, 3);
      CHECK(run.sim->audit().transfer_gain < 0);
      CHECK(run.sim->audit().carried < 0);
      double owed = 0;
      const std::vector<double> m = column(run, field::Mass::info),
                                c = column(run, field::CarriedEnergy::info),
                                e = column(run, field::InternalEnergy::info);
      for (std::size_t i = 0; i < m.size(); ++i) {
        owed += m[i] * c[i];
        CHECK(e[i] > -1e-6);
      }
      CHECK(owed == doctest::Approx(run.sim->audit().carried).epsilon(1e-12));
      CHECK(std::abs(energy_residual(run)) < 2e-13 * start);
    }
  }

  TEST_CASE("the heat of each point is the same for every observer") {
    for (const std::string frame : {"plane_strain", "3d"})
      for (const std::string transfer : {"tflip", "flip", "apic"}) {
        CAPTURE(frame + " " + transfer);
        const Case c{.frame = frame,
                     .more = "",
                     .bodies = 2,
                     .contact = true,
                     .low = "open",
                     .high = "open"};
        std::vector<double> e[2];
        for (const int moving : {0, 1}) {
          Run run = start_text(blocks(c), {"method.transfer=" + transfer});
          shake(run, c.bodies, moving * 5000.0);
          run_steps(run, 1);
          for (int b = 0; b < c.bodies; ++b)
            for (const double x : column(run, field::InternalEnergy::info, 0, b))
              e[moving].push_back(x);
        }
        REQUIRE(e[0].size() == e[1].size());
        double difference = 0, scale = 0;
        for (std::size_t i = 0; i < e[0].size(); ++i) {
          difference = std::max(difference, std::abs(e[1][i] - e[0][i]));
          scale = std::max(scale, std::abs(e[0][i]));
        }
        MESSAGE(frame << " " << transfer << ": " << difference / scale);
        CHECK(difference < 1e-9 * scale);
      }
  }
}
