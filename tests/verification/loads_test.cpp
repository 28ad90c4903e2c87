// SPDX-License-Identifier: GPL-3.0-or-later
// Pressure, traction, velocity on faces, and damping, against closed forms; their work against the
// account of energy.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "verification/run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

constexpr double kDensity = 7850, kBulk = 163.5e9, kShear = 80e9;
const double kWaveSpeed = std::sqrt((kBulk + 4.0 / 3.0 * kShear) / kDensity);

/// A bar of 1 m in uniaxial strain, some cells wide; `sides` and `rest`: of z, and further blocks.
std::string bar(const std::string& frame, int cells, const std::string& sides,
                const std::string& rest, const std::string& velocity = "0", int width = 2) {
  const double h = 1.0 / cells, w = width * h;
  std::ostringstream yaml;
  yaml.precision(17);
  const bool space = frame == "3d", round = frame == "axisymmetric";
  const char* y = space ? ", 0" : "";
  yaml << "frame: " << frame << "\ngrid:\n  cell: " << h << "\n  box: {min: [0" << y
       << ", -0.2], max: [" << w;
  if (space) yaml << ", " << w;
  yaml << ", 1.2]}\n  boundary: {" << sides
       << (round ? "r_min: axis, r_max: symmetry" : "x_min: symmetry, x_max: symmetry")
       << (space ? ", y_min: symmetry, y_max: symmetry" : "") << "}\n"
       << "time: {end: 1, cfl: 0.4}\nmethod: {stagger: false, transfer: flip}\n"
       << "materials:\n  steel:\n    density: " << kDensity << "\n    bulk_modulus: " << kBulk
       << "\n    shear_modulus: " << kShear << "\n    eos: linear\n    strength: elastic\n"
       << "bodies:\n  bar:\n    material: steel\n    shape: "
       << (round ? "{cylinder: {radius: 1, height: 1}}"
                 : "{box: {min: [-1, -1, 0], max: [1, 1, 1]}}")
       << "\n    velocity: [0, " << velocity << "]\n"
       << rest;
  return yaml.str();
}

/// Mean by mass over the points between two heights of velocity and stress along z.
struct Mean {
  double velocity = 0, stress = 0;
};
Mean mean(const Run& run, double from, double to) {
  const int z_axis = dimension(run.scene->frame) - 1;
  const auto z = column(run, field::Position::info, z_axis),
             v = column(run, field::Velocity::info, z_axis), p = column(run, field::Pressure::info),
             s = column(run, field::DeviatoricStress::info, 2), m = column(run, field::Mass::info);
  Mean out;
  double mass = 0;
  for (std::size_t i = 0; i < z.size(); ++i)
    if (z[i] > from && z[i] < to) {
      out.velocity += m[i] * v[i];
      out.stress += m[i] * (s[i] - p[i]);
      mass += m[i];
    }
  out.velocity /= mass;
  out.stress /= mass;
  return out;
}

void check_account(const Run& run, double tolerance = 1e-10) {
  const Audit& audit = run.sim->audit();
  CHECK(audit.load_work + audit.damping_work == doctest::Approx(audit.external_work));
  CHECK(std::abs(energy_residual(run)) < tolerance * std::abs(audit.external_work));
}

constexpr double kPressure = 1e6;
const double kParticle = kPressure / (kDensity * kWaveSpeed);

/// The wave that runs down, and its reflection at the free end, within 0.5 %.
void check_bar(const std::string& frame, const std::string& sides, const std::string& load,
               Overrides overrides = {}) {
  overrides.push_back("materials.steel.viscosity={q_lin: 0.3, q_quad: 0}");  // a step rings
  Run run = start_text(bar(frame, 100, sides, load), overrides);
  run_to(run, 0.6 / kWaveSpeed);
  Mean behind = mean(run, 0.6, 0.9);
  CHECK(behind.velocity == doctest::Approx(-kParticle).epsilon(0.005));
  CHECK(behind.stress == doctest::Approx(-kPressure).epsilon(0.005));
  CHECK(std::abs(mean(run, 0.1, 0.25).velocity) < 0.005 * kParticle);
  CHECK(mean(run, 0.9, 1.1).stress == doctest::Approx(-kPressure).epsilon(0.02));
  check_account(run);
  run_to(run, 1.6 / kWaveSpeed);
  behind = mean(run, 0.1, 0.4);
  CHECK(behind.velocity == doctest::Approx(-2 * kParticle).epsilon(0.005));
  CHECK(std::abs(behind.stress) < 0.005 * kPressure);
  check_account(run);
}

const std::string kOnFace = "loads: {push: {body: bar, face: z_max, pressure: 1 MPa}}\n";

}  // namespace

TEST_CASE(
    "loads: a bar under a pressure step in three frames: p/(rho c), its reflection, its work") {
  for (const char* frame : {"plane_strain", "axisymmetric", "3d"}) {
    CAPTURE(frame);
    check_bar(frame, "", kOnFace);
  }
}

TEST_CASE("loads: planes of symmetry one cell apart hold a bar as those two apart do") {
  for (const char* frame : {"plane_strain", "3d"}) {
    CAPTURE(frame);
    Mean behind[2];
    for (const int width : {1, 2}) {
      Run run = start_text(bar(frame, 40, "", kOnFace, "0", width));
      run_to(run, 0.6 / kWaveSpeed);
      behind[width - 1] = mean(run, 0.55, 0.9);
      check_account(run);
      double across = 0;
      for (const double v : column(run, field::Velocity::info, 0))
        across = std::max(across, std::abs(v));
      CHECK(across < 1e-9 * kParticle);
    }
    CHECK(behind[0].velocity == doctest::Approx(behind[1].velocity).epsilon(1e-9));
    CHECK(behind[0].stress == doctest::Approx(behind[1].stress).epsilon(1e-9));
  }
}

TEST_CASE("loads: tables and formulas of time, tractions, sides of the box, all references") {
  const auto loaded = [](const std::string& value) {
    return "loads: {push: {body: bar, face: z_max, " + value + "}}\n";
  };
  check_bar("plane_strain", "", loaded("pressure: \"1e6*(t>=0)\""));
  check_bar("plane_strain", "", loaded("pressure: {table: [[-1 us, 1 MPa], [1 s, 1 MPa]]}"));
  check_bar("plane_strain", "", loaded("traction: [0, -1 MPa]"));
  check_bar("plane_strain", "", kOnFace, {"method.reference=initial"});
}

TEST_CASE("loads: a face that moves at the given velocity sends p = rho c v") {
  std::ostringstream load;
  load.precision(17);
  load << "loads: {push: {body: bar, face: z_max, velocity: [free, " << -kParticle << "]}}\n";
  Run run = start_text(bar("plane_strain", 100, "", load.str()));
  run_to(run, 0.6 / kWaveSpeed);
  const Mean behind = mean(run, 0.55, 0.9);
  CHECK(behind.velocity == doctest::Approx(-kParticle).epsilon(0.005));
  CHECK(behind.stress == doctest::Approx(-kPressure).epsilon(0.01));
  check_account(run);
}

TEST_CASE("loads: a body under uniform pressure on all sides stays where it is") {
  // The stress that carries the pressure from the start: then nothing moves, to round-off.
  const std::string text =
      "frame: plane_strain\ngrid: {cell: 1, box: {min: [-10, -10], max: [10, 10]}}\n"
      "time: {end: 1}\nmaterials: {gas: {density: 1, eos: {ideal_gas: {gamma: 1.4, "
      "initial_pressure: 1e5}}}}\n"
      "bodies: {ball: {material: gas, shape: {sphere: {radius: 6}}}}\n"
      "method: {grid_pressure: none}\n"
      "loads: {around: {body: ball, pressure: 1e5}}\n";
  Run run = start_text(text);
  run_steps(run, 3);
  double fastest = 0;
  for (const int a : {0, 1})
    for (const double v : column(run, field::Velocity::info, a))
      fastest = std::max(fastest, std::abs(v));
  CHECK(fastest < 1e-9);
}

TEST_CASE("loads: damping takes exp(-eta t) of the energy of a mode and of a motion") {
  const double omega = std::numbers::pi / 2 * kWaveSpeed, eta = 0.1 * omega,
               omega_d = std::sqrt(omega * omega - 0.25 * eta * eta),
               period = 2 * std::numbers::pi / omega_d;
  std::ostringstream damping;
  damping.precision(17);
  damping << "damping: {mass: " << eta << "}\n";
  const auto kinetic = [](const Run& run) { return run.sim->totals().kinetic; };
  for (const std::string frame : {"plane_strain", "axisymmetric", "3d"}) {
    CAPTURE(frame);
    const std::string text = bar(frame, 40, "", damping.str(), "\"0.01*cos(pi*z)\"");
    // The free bar's first mode has omega = pi c / L: twice that of one held at an end.
    Run run = start_text(text);
    const double start = kinetic(run), T = std::numbers::pi / (omega)*1.0;
    for (int n = 1; n <= 3; ++n) {
      run_to(run, n * T);
      CHECK(kinetic(run) / start == doctest::Approx(std::exp(-eta * n * T)).epsilon(0.02));
    }
    check_account(run);
  }
  Run run = start_text(bar("plane_strain", 20, "", damping.str(), "1"));
  const double start = kinetic(run);
  run_to(run, 2 * period);
  CHECK(kinetic(run) / start == doctest::Approx(std::exp(-2 * eta * 2 * period)).epsilon(1e-3));
  check_account(run);
}

TEST_CASE(
    "loads: a tube under internal pressure against Lame, about the axis and on a curved face") {
  constexpr double a = 10e-3, b = 20e-3, p = 1e6;
  for (const bool round : {true, false}) {
    CAPTURE(round);
    std::ostringstream yaml;
    yaml << "frame: " << (round ? "axisymmetric" : "plane_strain")
         << "\ngrid:\n  cell: 0.5 mm\n  box: {min: [0, 0], max: [22 mm, "
         << (round ? "1 mm" : "22 mm") << "]}\n  boundary: {"
         << (round ? "z_min: symmetry, z_max: symmetry" : "x_min: symmetry, z_min: symmetry")
         << "}\ntime: {end: 100 us}\nmethod: {transfer: flip}\ndamping: {mass: 5e5 1/s}\n"
         << "materials:\n  steel:\n    density: 7850\n    bulk_modulus: 163.5 GPa\n"
            "    shear_modulus: 80 GPa\n    eos: linear\n    strength: elastic\n"
         << "bodies:\n  tube:\n    material: steel\n    shape: {tube: {inner_radius: 10 mm, "
            "outer_radius: 20 mm, height: 2 m, base: "
         << (round ? "[0, 0, -1 m], axis: z" : "[0, -1 m, 0], axis: y") << "}}\n"
         << "loads:\n  gas:\n    body: tube\n    inside: {cylinder: {radius: 13 mm, height: 2 m, "
         << (round ? "base: [0, 0, -1 m], axis: z" : "base: [0, -1 m, 0], axis: y")
         << "}}\n    pressure: {table: [[0, 0], [20 us, 1 MPa]]}\n";
    Run run = start_text(yaml.str());
    run_to(run, 60e-6);
    const auto x = column(run, field::Position::info, 0), z = column(run, field::Position::info, 1),
               pressure = column(run, field::Pressure::info);
    std::array<std::vector<double>, 6> s;
    for (int k = 0; k < 6; ++k)
      s[static_cast<std::size_t>(k)] = column(run, field::DeviatoricStress::info, k);
    double hoop = 0, hoop_exact = 0, radial = 0, radial_exact = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double r = round ? x[i] : std::hypot(x[i], z[i]);
      if (r < a + 1.5e-3 || r > b - 1.5e-3) continue;
      const double c = round ? 1 : x[i] / r, n = round ? 0 : z[i] / r;
      const double rr = c * c * s[0][i] + n * n * s[2][i] + 2 * c * n * s[4][i],
                   tt = round ? s[1][i] : n * n * s[0][i] + c * c * s[2][i] - 2 * c * n * s[4][i];
      const double k = p * a * a / (b * b - a * a);
      hoop += tt - pressure[i];
      radial += rr - pressure[i];
      hoop_exact += k * (1 + b * b / (r * r));
      radial_exact += k * (1 - b * b / (r * r));
    }
    CHECK(hoop == doctest::Approx(hoop_exact).epsilon(0.01));
    CHECK(radial == doctest::Approx(radial_exact).epsilon(0.02));
    check_account(run);
  }
}
