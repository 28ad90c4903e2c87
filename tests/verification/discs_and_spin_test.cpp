// SPDX-License-Identifier: GPL-3.0-or-later
// Two elastic discs that collide and part (exact.md D7, inputs/two_discs.yaml), and an elastic disc
// that spins freely (numerics A2, A4): what the transfers cost.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "verification/run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

struct Collision {
  double start = 0, least = 1e300, least_at = 0, stored = 0, end = 0, total = 0, residual = 0;
  double momentum = 0;  ///< greatest component over the run, by that of one disc [1]
};

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
    c.end = t.kinetic, c.total = t.kinetic + t.internal;
  }
  c.residual = energy_residual(run);
  MESSAGE("KE0 ", c.start, ", least ", c.least, " at ", c.least_at, ", most stored ", c.stored,
          ", KE(3) ", c.end, ", total/KE0 ", c.total / c.start, ", momentum ", c.momentum);
  return c;
}

/// Radius 1, speed of the rim 0.1 sqrt(E/rho), from the unstressed state: the disc breathes by
/// (1 - nu) v^2 rho/(4 E) = 0.2 % of its radius about its stretched state, 0.6 % of the energy goes
/// to and fro.
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

struct Loss {
  double angular_momentum = 0, energy = 0;  ///< greatest relative change over the run
};

Loss spin(int cells_across, double cfl, const Overrides& method = {}) {
  Run run = start_text(disc(cells_across, cfl), method);
  const Totals start = run.sim->totals();
  Loss loss;
  while (!run.sim->done()) {
    for (int i = 0; i < 20 && !run.sim->done(); ++i) run.sim->step(run.scene->time.end);
    const Totals t = run.sim->totals();
    const double energy = t.kinetic + t.internal;
    loss.angular_momentum =
        std::max(loss.angular_momentum, std::abs(t.angular_momentum / start.angular_momentum - 1));
    loss.energy = std::max(loss.energy, std::abs(energy / start.kinetic - 1));
  }
  MESSAGE(cells_across, " cells, CFL ", cfl, method.empty() ? "" : ", " + method.front(),
          ": angular momentum ", 100 * loss.angular_momentum, " %, energy ", 100 * loss.energy,
          " %");
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

  TEST_CASE("two discs: momentum stays zero, and FLIP with double projection keeps the energy") {
    CHECK(collide({}).momentum < 1e-12);
    const Collision flip = collide({"method.transfer=flip", "method.update=musl"});
    CHECK(flip.momentum < 1e-12);
    CHECK(flip.total == doctest::Approx(flip.start).epsilon(0.01));
  }

  TEST_CASE("spinning disc: 3 turns keep angular momentum within 0.1 %, energy within 0.3 %") {
    for (const double cfl : {0.2, 0.5, 0.8}) {
      const Loss loss = spin(32, cfl);
      CHECK(loss.angular_momentum < 1e-3);
      CHECK(loss.energy < 3e-3);
    }
  }

  TEST_CASE("spinning disc: what the affine part is for") {
    // A spinning body starts with the affine part of its field: otherwise 1 % jumps in at once.
    const Loss apic = spin(20, 0.5, {"method.transfer=apic"});
    CHECK(apic.angular_momentum < 2e-4);
    CHECK(apic.energy < 3e-3);
    CHECK(spin(20, 0.5).angular_momentum < 1.5e-3);
    CHECK(spin(20, 0.5, {"method.transfer=xpic"}).angular_momentum > 0.5);
  }
}
