// SPDX-License-Identifier: GPL-3.0-or-later
// Symmetric plate impact (theory 13, theory D1): one plate moves at u_p against a plane of
// symmetry. No strength, so that the Hugoniot is exact. Plane strain, a strip 2 cells wide.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "verification/run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

struct Hugoniot {
  std::string material;
  double rho0, c0, s, gamma0, impact, u_p, U_s, p, compression, energy;
};

std::vector<Hugoniot> hugoniot_rows() {
  std::vector<Hugoniot> rows;
  const auto table = read_table("hugoniot.csv");
  for (std::size_t i = 1; i < table.size(); ++i) {
    const auto number = [&](std::size_t k) { return std::stod(table[i].at(k)); };
    rows.push_back({table[i][0], number(1), number(2), number(3), number(4), number(5), number(6),
                    number(7), number(8), number(9), number(10)});
  }
  return rows;
}

/// A plate of 1 m so that everything is in shares of its length.
Run start_impact(const Hugoniot& x, int cells, const Overrides& overrides = {}) {
  const double h = 1.0 / cells;
  std::ostringstream yaml;
  yaml.precision(17);
  yaml << "frame: plane_strain\n"
       << "grid:\n  cell: " << h << "\n  box: {min: [0, 0], max: [" << 2 * h << ", " << 1 + 4 * h
       << "]}\n"
       << "  boundary: {z_min: symmetry, x_min: symmetry, x_max: symmetry, z_max: open}\n"
       << "time: {end: 1, cfl: 0.5}\n"
       << "materials:\n  plate:\n    density: " << x.rho0
       << "\n    eos: {mie_gruneisen_shock: {c0: " << x.c0 << ", S1: " << x.s
       << ", gamma0: " << x.gamma0 << "}}\n    viscosity: {q_lin: " << (x.impact > 4000 ? 0.5 : 0.3)
       << ", q_quad: 2.0}\n"
       << "bodies:\n  plate:\n    material: plate\n"
       << "    shape: {box: {min: [-1, 0], max: [1, 1]}}\n"
       << "    velocity: [0, " << -x.u_p << "]\n";
  return start_text(yaml.str(), overrides);
}

/// Means over points of cells of width h along z.
struct Profile {
  double h;
  std::vector<double> pressure, density;
};
Profile profile(const Run& run) {
  const auto z = column(run, field::Position::info, 1), p = column(run, field::Pressure::info),
             rho = column(run, field::Density::info), m = column(run, field::Mass::info);
  Profile out{run.sim->geometry().h, {}, {}};
  const auto bins = static_cast<std::size_t>(run.sim->geometry().cells[1]) + 1;
  std::vector<double> volume(bins), mass(bins), pressure(bins);
  for (std::size_t i = 0; i < z.size(); ++i) {
    const auto b = static_cast<std::size_t>(z[i] / out.h);
    volume[b] += m[i] / rho[i], mass[b] += m[i], pressure[b] += p[i] * m[i] / rho[i];
  }
  for (std::size_t b = 0; b < bins && volume[b] > 0; ++b) {
    out.pressure.push_back(pressure[b] / volume[b]);
    out.density.push_back(mass[b] / volume[b]);
  }
  return out;
}

/// Where the pressure falls through half the plateau.
double front(const Profile& x, double plateau) {
  std::size_t b = x.pressure.size();
  while (b > 0 && x.pressure[b - 1] < 0.5 * plateau) --b;
  if (b == 0 || b == x.pressure.size()) return NAN;
  const double share = (x.pressure[b - 1] - 0.5 * plateau) / (x.pressure[b - 1] - x.pressure[b]);
  return x.h * (static_cast<double>(b) - 0.5 + share);
}

struct Plateau {
  double pressure, density;
};
/// The band from 0.2 to 0.7 of the front's exact position: at 100 cells at least 9 cells from the
/// plane, where q leaves its wall heating, and 14 from the front.
Plateau plateau(const Profile& x, double exact_front) {
  Plateau sum{0, 0};
  double count = 0;
  for (std::size_t b = 0; b < x.pressure.size(); ++b) {
    const double z = x.h * (static_cast<double>(b) + 0.5);
    if (z < 0.2 * exact_front || z > 0.7 * exact_front) continue;
    sum.pressure += x.pressure[b], sum.density += x.density[b], count += 1;
  }
  return {sum.pressure / count, sum.density / count};
}

struct Result {
  double pressure, density, shock_speed;  ///< relative errors
  double energy_fraction, residual;       ///< of the energy at the start
  double profile_error;                   ///< L1 of p over [0, 1.3 front], relative
};
Result impact(const Hugoniot& x, int cells, const Overrides& overrides = {}) {
  Run run = start_impact(x, cells, overrides);
  const double t1 = 0.4 / x.U_s, t2 = 0.75 / x.U_s, speed = x.U_s - x.u_p;
  run_to(run, t1);
  const double z1 = front(profile(run), x.p);
  run_to(run, t2);
  const Profile at_end = profile(run);
  const double z2 = front(at_end, x.p), exact_front = speed * t2;
  const Plateau mean = plateau(at_end, exact_front);
  const double start = run.sim->audit().initial_kinetic;
  Result r{mean.pressure / x.p - 1,
           mean.density / (x.rho0 * x.compression) - 1,
           ((z2 - z1) / (t2 - t1) + x.u_p) / x.U_s - 1,
           run.sim->audit().error_fraction(),
           energy_residual(run) / start,
           0};
  for (std::size_t b = 0; b < at_end.pressure.size(); ++b) {
    const double low = at_end.h * static_cast<double>(b);
    if (low > 1.3 * exact_front) break;
    const double behind = std::clamp((exact_front - low) / at_end.h, 0.0, 1.0);
    r.profile_error += std::abs(at_end.pressure[b] - behind * x.p) / x.p * at_end.h / exact_front;
  }
  return r;
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("plate impact: plateau, shock speed and energy of 4 materials at 5 speeds") {
    for (const Hugoniot& x : hugoniot_rows()) {
      CAPTURE(x.material);
      CAPTURE(x.impact);
      const Result r = impact(x, 100);
      MESSAGE(x.material << ", " << x.impact << " m/s: p " << 100 * r.pressure << " %, rho "
                         << 100 * r.density << " %, U_s " << 100 * r.shock_speed << " %, energy "
                         << 100 * r.energy_fraction << " %, L1 " << r.profile_error << ", residual "
                         << r.residual);
      CHECK(std::abs(r.pressure) < 0.01);
      CHECK(std::abs(r.density) < 0.01);
      CHECK(std::abs(r.shock_speed) < 0.01);
      CHECK(std::abs(r.energy_fraction) < 0.015);  // Ta at 6 km/s: -1.17 %
      CHECK(std::abs(r.residual) < 1e-11);
    }
  }

  TEST_CASE("plate impact: smoothed particles, two metals at two speeds") {
    for (const Hugoniot& x : hugoniot_rows()) {
      if (x.material != "Cu" && x.material != "Al 2024 (Marsh)") continue;
      if (x.impact != 1000 && x.impact != 4000) continue;
      CAPTURE(x.material);
      CAPTURE(x.impact);
      // A front is told to about a cell, which is 1 % of the way at 100 cells.
      const Result r = impact(x, 200, {"bodies.plate.kinematics=sph"});
      MESSAGE(x.material << ", " << x.impact << " m/s: p " << 100 * r.pressure << " %, rho "
                         << 100 * r.density << " %, U_s " << 100 * r.shock_speed << " %, L1 "
                         << r.profile_error << ", residual " << r.residual);
      CHECK(std::abs(r.pressure) < 0.01);
      CHECK(std::abs(r.density) < 0.01);
      CHECK(std::abs(r.shock_speed) < 0.01);
      CHECK(std::abs(r.residual) < 1e-11);
    }
  }

  TEST_CASE("plate impact: the profile converges at first order") {
    const auto rows = hugoniot_rows();
    const auto x = std::find_if(rows.begin(), rows.end(), [](const Hugoniot& row) {
      return row.material == "Al 2024 (Marsh)" && row.impact == 2000;
    });
    REQUIRE(x != rows.end());
    std::vector<double> h, error;
    for (const int cells : {50, 100, 200}) {
      const Result r = impact(*x, cells);
      h.push_back(1.0 / cells), error.push_back(r.profile_error);
      MESSAGE(cells << " cells: L1 " << r.profile_error << ", plateau " << 100 * r.pressure
                    << " %, U_s " << 100 * r.shock_speed << " %");
    }
    const double order = observed_order(h, error);
    MESSAGE("observed order " << order);
    CHECK(order > 0.8);
    CHECK(order < 1.4);
  }
}
