// SPDX-License-Identifier: GPL-3.0-or-later
// Two elastic discs that collide and part (theory D7, inputs/two_discs.yaml), and an elastic disc
// that spins freely (theory 3, 16): what the transfers cost.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <vector>

#include "verification/run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

struct Collision {
  double start = 0, least = 1e300, least_at = 0, stored = 0, end = 0, total = 0, residual = 0;
  double momentum = 0;  ///< greatest component over the run, by that of one disc [1]
  double lost = 0, numerical_heat = 0;  ///< internal energy beyond the law's own, and as booked [J]
};

/// What the bodies' own law can give back [J]: its W, from the deformation of the points.
double stored_energy(const Run& run) {
  const double E = 1000, nu = 0.3, rho0 = 1000, G = E / (2 * (1 + nu)),
               lambda = 2 * G * nu / (1 - 2 * nu);
  double sum = 0;
  for (const int body : {0, 1}) {
    const auto mass = column(run, field::Mass::info, 0, body),
               density = column(run, field::Density::info, 0, body);
    std::array<std::vector<double>, 9> F;
    for (int c = 0; c < 9; ++c)
      F[static_cast<std::size_t>(c)] = column(run, field::DeformationGradient::info, c, body);
    for (std::size_t i = 0; i < mass.size(); ++i) {
      const double J = F[4][i] * (F[0][i] * F[8][i] - F[2][i] * F[6][i]),
                   averaged = rho0 / density[i], logJ = std::log(averaged);
      double squares = 0;
      for (const auto& component : F) squares += component[i] * component[i];
      squares *= std::pow(averaged / J, 2.0 / 3);
      sum += mass[i] / rho0 * (0.5 * G * (squares - 3) - G * logJ + 0.5 * lambda * logJ * logJ);
    }
  }
  return sum;
}

Collision collide(const Overrides& method) {
  Run run = start_input("two_discs.yaml", method);
  Collision c;
  c.start = run.sim->totals().kinetic;
  const double one_disc = run.sim->totals(0).momentum[0];
  while (!run.sim->done()) {
    run.sim->step(3.0);
    const Totals t = run.sim->totals();
    if (t.kinetic < c.least) c.least = t.kinetic, c.least_at = run.sim->time();
    c.stored = std::max(c.stored, t.internal);
    for (std::size_t a = 0; a < 2; ++a)
      c.momentum = std::max(c.momentum, std::abs(t.momentum[a]) / one_disc);
    c.end = t.kinetic, c.total = t.kinetic + t.internal - run.sim->audit().numerical_heat;
  }
  c.residual = energy_residual(run);
  c.lost = run.sim->totals().internal - stored_energy(run);
  c.numerical_heat = run.sim->audit().numerical_heat;
  MESSAGE("KE0 ", c.start, ", least ", c.least, " at ", c.least_at, ", most stored ", c.stored,
          ", KE(3) ", c.end, ", total/KE0 ", c.total / c.start, ", momentum ", c.momentum,
          ", lost ", c.lost, ", booked ", c.numerical_heat);
  return c;
}

/// Radius 1, speed of the rim 0.1 sqrt(E/rho). From the unstressed state the disc breathes with
/// 0.16 % of its energy about the stretched one; the scheme damps that, which is no fault of its
/// rotation: 32 cells lose 0.18, 0.25, 0.30 % (CFL 0.2, 0.5, 0.8), from the stretched state 0.11,
/// 0.16, 0.20 %.
constexpr double kSpin = 0.1, kTurns = 3;

std::string disc(int cells_across, double cfl) {
  const double h = 2.0 / cells_across;
  std::ostringstream yaml;
  yaml.precision(17);
  yaml << "frame: plane_strain\n"
       << "grid: {cell: " << h << ", box: {min: [" << -1 - 4 * h << ", " << -1 - 4 * h
       << "], max: [" << 1 + 4 * h << ", " << 1 + 4 * h << "]}}\n"
       << "time: {end: " << kTurns * 2 * std::numbers::pi / kSpin << ", cfl: " << cfl << "}\n"
       << "materials:\n  rubber: {density: 1000, youngs_modulus: 1000, poisson_ratio: 0.3, "
          "strength: neo_hookean}\n"
       << "bodies:\n  disc:\n    material: rubber\n"
       << "    shape: {cylinder: {radius: 1, height: 1, axis: y, base: [0, -0.5, 0]}}\n"
       << "    velocity: [\"-" << kSpin << "*z\", \"" << kSpin << "*x\"]\n";
  return yaml.str();
}

/// The state of a disc that spins for ever: x = X + u, u = k r ((3 - 2 nu) R^2 - r^2), k = rho w^2
/// (1 - 2 nu)(1 + nu)/(8 E (1 - nu)), written into the points where they are. What is left to ring
/// is of the order of the strain squared.
void stretch(Run& run) {
  const double E = 1000, nu = 0.3, rho = 1000, G = E / (2 * (1 + nu)),
               lambda = 2 * G * nu / (1 - 2 * nu);
  const double k = rho * kSpin * kSpin * (1 - 2 * nu) * (1 + nu) / (8 * E * (1 - nu));
  auto mass = column(run, field::Mass::info);
  const auto x = column(run, field::Position::info, 0), z = column(run, field::Position::info, 1);
  const std::size_t n = mass.size();
  std::vector<double> density(n), pressure(n), energy(n);
  std::array<std::vector<double>, 9> F;
  std::array<std::vector<double>, 6> s;
  for (auto& component : F) component.assign(n, 0.0);
  for (auto& component : s) component.assign(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const double r2 = x[i] * x[i] + z[i] * z[i];
    const double around = 1 + k * (3 - 2 * nu - r2), change = -2 * k;  // F = around + change x x
    const double xx = around + change * x[i] * x[i], zz = around + change * z[i] * z[i],
                 xz = change * x[i] * z[i], J = xx * zz - xz * xz, logJ = std::log(J);
    const double Bxx = xx * xx + xz * xz, Bzz = zz * zz + xz * xz, Bxz = xz * (xx + zz);
    const double mean = (Bxx + Bzz + 1) / 3;
    F[0][i] = xx, F[2][i] = F[6][i] = xz, F[4][i] = 1, F[8][i] = zz;
    s[0][i] = G / J * (Bxx - mean), s[1][i] = G / J * (1 - mean), s[2][i] = G / J * (Bzz - mean);
    s[4][i] = G / J * Bxz;
    pressure[i] = -(lambda * logJ + G * (mean - 1)) / J;
    energy[i] = (1.5 * G * (mean - 1) - G * logJ + 0.5 * lambda * logJ * logJ) / rho;
    density[i] = rho / J, mass[i] /= J;
  }
  set_column(run, field::Mass::info, 0, mass);
  set_column(run, field::Density::info, 0, density);
  set_column(run, field::Pressure::info, 0, pressure);
  set_column(run, field::InternalEnergy::info, 0, energy);
  for (int c = 0; c < 9; ++c)
    set_column(run, field::DeformationGradient::info, c, F[static_cast<std::size_t>(c)]);
  for (int c = 0; c < 6; ++c)
    set_column(run, field::DeviatoricStress::info, c, s[static_cast<std::size_t>(c)]);
}

struct Loss {
  double angular_momentum = 0, energy = 0;  ///< greatest relative change over the run
};

Loss spin(int cells_across, double cfl, bool at_rest_state, const Overrides& method = {}) {
  Run run = start_text(disc(cells_across, cfl), method);
  if (!at_rest_state) stretch(run);
  const Totals start = run.sim->totals();
  const double energy_start = start.kinetic + start.internal;
  double least = 1e300, most = 0;
  Loss loss;
  while (!run.sim->done()) {
    for (int i = 0; i < 20 && !run.sim->done(); ++i) run.sim->step(run.scene->time.end);
    const Totals t = run.sim->totals();
    const double energy = t.kinetic + t.internal;
    loss.angular_momentum =
        std::max(loss.angular_momentum, std::abs(t.angular_momentum / start.angular_momentum - 1));
    loss.energy = std::max(loss.energy, std::abs(energy / energy_start - 1));
    least = std::min(least, t.internal / energy_start),
    most = std::max(most, t.internal / energy_start);
  }
  MESSAGE(cells_across, " cells, CFL ", cfl, method.empty() ? "" : ", " + method.front(),
          ": angular momentum ", 100 * loss.angular_momentum, " %, energy ", 100 * loss.energy,
          " %, internal ", 100 * least, " to ", 100 * most, " %");
  return loss;
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("two discs: they collide and part, and the loss is that of 4 cells per radius") {
    const Collision coarse = collide({});
    // The continuum's kinetic energy: masses are exact.
    CHECK(coarse.start == doctest::Approx(2.51327).epsilon(1e-4));
    // First contact at 1.586 s and half a period of the discs' compression; mpmat 1.938 s.
    CHECK(coarse.least_at > 1.85);
    CHECK(coarse.least_at < 2.1);
    // At the turn the centres rest; what remains is vibration. mpmat: 2.4 % of the start.
    CHECK(coarse.least < 0.06 * coarse.start);
    CHECK(coarse.stored > 0.9 * coarse.start);
    // mpmat keeps 92 % of the kinetic and 97 % of all energy with linear functions and FLIP. Ours
    // loses more at this resolution (the affine part smooths the rim in contact) ...
    CHECK(coarse.end > 0.8 * coarse.start);
    CHECK(coarse.total > 0.88 * coarse.start);
    CHECK(coarse.total < 1.005 * coarse.start);
    CHECK(std::abs(coarse.residual) < 1e-10 * coarse.start);
    // ... and the loss falls with the cell.
    const Collision fine = collide({"grid.cell=0.025"});
    CHECK(1 - fine.total / fine.start < 0.6 * (1 - coarse.total / coarse.start));
  }

  TEST_CASE(
      "two discs: momentum stays zero, and FLIP with double projection gives more motion back") {
    const Collision tflip = collide({});
    CHECK(tflip.momentum < 1e-12);
    const Collision flip = collide({"method.transfer=flip", "method.update=musl"});
    CHECK(flip.momentum < 1e-12);
    CHECK(flip.end > tflip.end);
  }

  TEST_CASE(
      "two discs: what their law cannot give back is numerical heat, however they are updated") {
    for (const Overrides& method : {Overrides{},
                                    {"method.transfer=flip"},
                                    {"method.update=musl"},
                                    {"method.update=usf"},
                                    {"method.transfer=flip", "method.update=usf"}}) {
      const Collision c = collide(method);
      CHECK(std::abs(c.numerical_heat - c.lost) < 5e-3 * c.start);
    }
  }

  TEST_CASE("spinning disc: 3 turns keep angular momentum within 0.1 %, energy within 0.3 %") {
    for (const double cfl : {0.2, 0.5, 0.8}) {
      const Loss loss = spin(32, cfl, false);
      CHECK(loss.angular_momentum < 1e-3);
      CHECK(loss.energy < 3e-3);
    }
  }

  TEST_CASE("spinning disc: a fixed reference turns with it") {
    for (const char* reference : {"method.reference=initial", "method.reference=adaptive"}) {
      const Loss loss = spin(32, 0.5, false, {reference});
      CHECK(loss.angular_momentum < 1e-3);
      CHECK(loss.energy < 3e-3);
    }
  }

  TEST_CASE("spinning disc: what the affine part is for") {
    // Points of spacing h/2 with the second moment h^2/4 of their shape function.
    const double h = 0.1, mass = 1000 * std::numbers::pi, squares = 0.5 + h * h * (0.5 - 1.0 / 24);
    const Totals start = start_text(disc(20, 0.5)).sim->totals();
    CHECK(start.angular_momentum == doctest::Approx(mass * kSpin * squares).epsilon(1e-4));
    CHECK(start.kinetic == doctest::Approx(0.5 * mass * kSpin * kSpin * squares).epsilon(1e-4));
    // A spinning body starts with the affine part of its field: otherwise 1 % jumps in at once.
    // 20 cells are too few for 0.1 % at CFL 0.8 (0.14 %), which APIC keeps.
    const Loss apic = spin(20, 0.5, true, {"method.transfer=apic"});
    CHECK(apic.angular_momentum < 2e-4);
    CHECK(apic.energy < 3e-3);
    CHECK(spin(20, 0.5, true).angular_momentum < 1.5e-3);
    CHECK(spin(20, 0.5, true, {"method.transfer=xpic"}).angular_momentum > 0.5);
  }
}
