// SPDX-License-Identifier: GPL-3.0-or-later
// Elastic waves in a strip in uniaxial strain (plane strain between two planes of symmetry), where
// the bar's sigma = rho c v/2, contact time 2L/c and mode frequency (theory D3) hold with
// c = c_L = sqrt((K + 4G/3)/rho).
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
constexpr double kSpeed = 1.0;  // [m/s], strains of 2e-4: linear

/// Strip of 1 m and `bodies` (YAML) between planes of symmetry; z from `low` to 1.2.
std::string strip(int cells, double low, const std::string& z_min, const std::string& bodies,
                  bool viscous) {
  const double h = 1.0 / cells;
  std::ostringstream yaml;
  yaml.precision(17);
  yaml << "frame: plane_strain\n"
       << "grid:\n  cell: " << h << "\n  box: {min: [0, " << low << "], max: [" << 2 * h
       << ", 1.2]}\n"
       << "  boundary: {z_min: " << z_min << ", x_min: symmetry, x_max: symmetry}\n"
       << "time: {end: 1}\n"
       << "method: {stagger: false}\n"
       << "materials:\n  steel:\n    density: " << kDensity << "\n    bulk_modulus: " << kBulk
       << "\n    shear_modulus: " << kShear << "\n    eos: linear\n    strength: elastic\n"
       << (viscous ? "    viscosity: {q_lin: 0.1, q_quad: 2.0}\n" : "") << "bodies:\n"
       << bodies;
  return yaml.str();
}

std::string bar(const std::string& name, double from, double to, const std::string& velocity) {
  std::ostringstream yaml;
  yaml << "  " << name << ":\n    material: steel\n    shape: {box: {min: [-1, " << from
       << "], max: [1, " << to << "]}}\n    velocity: [0, " << velocity << "]\n";
  return yaml.str();
}

/// Mean stress along z of the points between two positions.
double mean_stress(const Run& run, double from, double to) {
  const auto z = column(run, field::Position::info, 1), p = column(run, field::Pressure::info),
             s = column(run, field::DeviatoricStress::info, 2);
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < z.size(); ++i)
    if (z[i] > from && z[i] < to) sum += s[i] - p[i], count += 1;
  return sum / count;
}

double mean_velocity(const Run& run) {
  const Totals t = run.sim->totals();
  return t.momentum[1] / t.mass;
}

/// Relative error of the first mode's frequency of a bar fixed at z = 0, from the zero crossings of
/// its mean velocity over 5 periods.
double frequency_error(int cells, const Overrides& overrides = {}) {
  Overrides all = overrides;
  all.push_back("time.cfl=0.2");
  Run run =
      start_text(strip(cells, 0, "symmetry", bar("bar", 0, 1, "\"0.01*sin(pi*z/2)\""), false), all);
  const double exact = std::numbers::pi / 2 * kWaveSpeed, period = 2 * std::numbers::pi / exact;
  double first = NAN, last = NAN, before = mean_velocity(run), time = 0;
  int crossings = 0;
  while (run.sim->time() < 5.1 * period) {
    run.sim->step(5.1 * period);
    const double now = mean_velocity(run);
    if (before * now < 0) {
      const double at = time + (run.sim->time() - time) * before / (before - now);
      if (crossings == 0) first = at;
      last = at;
      ++crossings;
    }
    before = now, time = run.sim->time();
  }
  return (crossings - 1) * std::numbers::pi / (last - first) / exact - 1;
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("elastic bar against a plane of symmetry: contact stress, release at the free end") {
    Run run = start_text(strip(100, 0, "symmetry", bar("bar", 0, 1, "-1"), true));
    const double exact = -kDensity * kWaveSpeed * kSpeed;
    run_to(run, 0.7 / kWaveSpeed);
    const double loaded = mean_stress(run, 0.05, 0.5), ahead = mean_stress(run, 0.9, 1.0);
    run_to(run, 1.5 / kWaveSpeed);
    const double held = mean_stress(run, 0.05, 0.35), released = mean_stress(run, 0.7, 0.95);
    MESSAGE("stress / (rho c v): loaded " << loaded / exact << ", ahead " << ahead / exact
                                          << "; after the free end: held " << held / exact
                                          << ", released " << released / exact);
    CHECK(loaded == doctest::Approx(exact).epsilon(0.005));
    CHECK(std::abs(ahead / exact) < 0.005);
    CHECK(held == doctest::Approx(exact).epsilon(0.005));
    CHECK(std::abs(released / exact) < 0.01);
    CHECK(std::abs(run.sim->audit().error_fraction()) < 0.01);
  }

  // The filter of TFLIP works on cells of one body: half a cell of each bar, where the plane sees a
  // whole one. Without it the two are the same; with it they differ by what it takes, 1 - alpha.
  TEST_CASE("two equal bars meet as one bar meets a plane of symmetry") {
    for (const bool filtered : {false, true}) {
      CAPTURE(filtered);
      const Overrides method = filtered ? Overrides{} : Overrides{"method.flip_fraction=1"};
      Run one = start_text(strip(60, 0, "symmetry", bar("bar", 0, 1, "-1"), true), method);
      Run two = start_text(
          strip(60, -1.2, "open", bar("upper", 0, 1, "-1") + bar("lower", -1, 0, "1"), true),
          method);
      const double end = 0.9 / kWaveSpeed;
      run_to(one, end), run_to(two, end);
      const auto p1 = column(one, field::Pressure::info), p2 = column(two, field::Pressure::info);
      REQUIRE(p1.size() == p2.size());
      double worst = 0;
      for (std::size_t i = 0; i < p1.size(); ++i) worst = std::max(worst, std::abs(p1[i] - p2[i]));
      worst /= kDensity * kWaveSpeed * kSpeed;
      MESSAGE("largest difference of pressure / (rho c v): " << worst);
      CHECK(worst < (filtered ? 1e-2 : 1e-9));
      CHECK(one.sim->steps() == two.sim->steps());
    }
  }

  TEST_CASE("elastic bar rebounds from a unilateral wall at 2 L/c with restitution 1") {
    for (const std::string wall : {"wall", "{wall: {friction: 0.3}}"}) {
      CAPTURE(wall);
      Run run = start_text(strip(100, 0, wall, bar("bar", 0, 1, "-1"), true));
      const double impact_energy = run.sim->audit().initial_kinetic;
      double left = NAN;
      while (run.sim->time() < 4 / kWaveSpeed) {
        run.sim->step(4 / kWaveSpeed);
        if (std::isnan(left) && mean_velocity(run) > 0.95) left = run.sim->time();
      }
      const double restitution = mean_velocity(run) / kSpeed;
      const double wall_impulse = run.sim->audit().wall_impulse[1];
      const double change = run.sim->totals().momentum[1] + run.sim->totals().mass * kSpeed;
      MESSAGE("restitution " << restitution << ", at 95 % after " << left * kWaveSpeed / 2
                             << " contact times, wall work / energy "
                             << run.sim->audit().wall_work / impact_energy << ", energy "
                             << run.sim->audit().error_fraction()
                             << ", wall impulse / change of momentum - 1 = "
                             << wall_impulse / change - 1);
      CHECK(restitution == doctest::Approx(1).epsilon(0.02));
      CHECK(left * kWaveSpeed == doctest::Approx(2).epsilon(0.05));
      CHECK(wall_impulse == doctest::Approx(change).epsilon(1e-9));
      CHECK(run.sim->audit().wall_columns == 0);
      CHECK(std::abs(energy_residual(run)) < 1e-11 * impact_energy);
      CHECK(std::abs(run.sim->audit().error_fraction()) < 0.02);
    }
  }

  TEST_CASE("vibrating bar: frequency of the first mode converges") {
    std::vector<double> h, error;
    for (const int cells : {10, 20, 40, 80}) {
      h.push_back(1.0 / cells), error.push_back(std::abs(frequency_error(cells)));
      MESSAGE(cells << " cells: frequency error " << 100 * error.back() << " %");
    }
    MESSAGE("observed order " << observed_order(h, error));
    CHECK(error.back() < 1e-3);
    CHECK(observed_order(h, error) > 0.9);
  }
}
