// SPDX-License-Identifier: GPL-3.0-or-later
// Programmed burn (eos/jwl_burn.hpp) against theory: a plane detonation of TNT that starts at a
// rigid wall is the Chapman-Jouguet state at the front, z = D t, and behind it Taylor's simple
// wave, z/t = u + c along the isentrope of the products through that state, down to rest.
// Published for TNT (Dobratz and Crawford, LLNL Explosives Handbook, 1985): D 6930 m/s, p 21 GPa.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "krater/materials/eos/jwl.hpp"
#include "verification/run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

constexpr double kDensity = 1630, kD = 6930, kPressure = 21e9;

/// A strip of 1 m, two cells wide, against a plane of symmetry at z = 0.
Run start_charge(int cells, const std::string& burn, const std::string& more,
                 const Overrides& overrides = {}) {
  const double h = 1.0 / cells;
  std::ostringstream yaml;
  yaml.precision(17);
  yaml << "frame: plane_strain\ngrid:\n  cell: " << h << "\n  box: {min: [0, 0], max: [" << 2 * h
       << ", 1.1]}\n  boundary: {z_min: symmetry, x_min: symmetry, x_max: symmetry}\n"
       << "time: {end: 1}\nmaterials:\n  tnt:\n    density: " << kDensity
       << "\n    eos: {jwl_burn: {A: 371.2 GPa, B: 3.231 GPa, R1: 4.15, R2: 0.95, omega: 0.3, "
          "E0: 7 GPa, D: 6930, p_CJ: 21 GPa, bulk_modulus: 10.8 GPa, burn: "
       << burn << "}}\n    viscosity: {q_lin: 0.3, q_quad: 2}\n"
       << "bodies:\n  charge:\n    material: tnt\n    shape: {box: {min: [-1, -1, 0], max: [1, 1, "
          "1]}}\n"
       << more;
  return start_text(yaml.str(), overrides);
}

struct State {
  double v, p, e, u, c;
};

/// Front and Taylor wave, from the front back to rest.
std::vector<State> exact_wave() {
  const double values[] = {371.2e9, 3.231e9, 4.15, 0.95, 0.3, 7e9};
  const Jwl law = make_law<Jwl>(values, {kDensity, 0, 293});
  const double v0 = 1 / kDensity, e0 = law.initial_energy;
  const auto complete = [&](double v, double e, double u) {
    const double rho = 1 / v, p = pressure_at(law, rho, v, e);
    return State{v, p, e, u, std::sqrt(law.bulk_modulus(rho, v, p, e) * v)};
  };
  State front{};
  double least = 1e300;
  for (double x = 1.05; x < 1.8; x += 1e-5) {
    const double v = v0 / x;
    const auto s = law.split(1 / v, v);
    const double p = (s.cold + s.thermal * e0) / (1 - 0.5 * s.thermal * (v0 - v));
    const double D = v0 * std::sqrt(p / (v0 - v));
    if (D >= least) continue;
    least = D;
    front = complete(v, e0 + 0.5 * p * (v0 - v), std::sqrt(p * (v0 - v)));
  }
  std::vector<State> wave{front};
  while (wave.back().u > 0 && wave.size() < 100000) {  // du = dp/(rho c) = - c dv/v, de = - p dv
    const State& s = wave.back();
    const double dv = 1e-5 * v0;
    const State half = complete(s.v + 0.5 * dv, s.e - 0.5 * s.p * dv, s.u);
    wave.push_back(complete(s.v + dv, s.e - half.p * dv, s.u - half.c * dv / half.v));
  }
  return wave;
}

double exact_pressure(const std::vector<State>& wave, double speed) {  // speed = z/t
  if (speed >= kD) return 0;
  const auto at =
      std::find_if(wave.begin(), wave.end(), [&](const State& s) { return s.u + s.c <= speed; });
  return at == wave.end() ? wave.back().p : at->p;
}

struct Answer {
  double peak, error, front, wall;  ///< shares of the exact; error: mean of |p - p_exact|/p_CJ
};
Answer compare(const Run& run, const std::vector<State>& wave) {
  const auto z = column(run, field::Position::info, 1), p = column(run, field::Pressure::info),
             m = column(run, field::Mass::info), F = column(run, field::BurnFraction::info);
  const double t = run.sim->time();
  Answer a{};
  double mass = 0, wall = 0, near = 0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    a.peak = std::max(a.peak, p[i] / kPressure);
    if (F[i] > 0.5) a.front = std::max(a.front, z[i]);
    if (z[i] < 0.3 * kD * t) wall += p[i], near += 1;
    if (z[i] > 1.05 * kD * t) continue;
    a.error += m[i] * std::abs(p[i] - exact_pressure(wave, z[i] / t)) / kPressure;
    mass += m[i];
  }
  a.error /= mass;
  a.wall = wall / near / wave.back().p;
  return a;
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("detonation: Chapman-Jouguet front and Taylor wave of TNT at two cells") {
    const auto wave = exact_wave();
    CHECK(wave.front().p == doctest::Approx(kPressure).epsilon(0.005));
    Answer answers[2];
    for (const int k : {0, 1}) {
      Run run = start_charge(k == 0 ? 100 : 200, "both",
                             "detonators: {wall: {plane: {through: [0, 0], normal: [0, 1]}}}\n");
      const double start = run.sim->audit().energy();
      run_to(run, 0.85 / kD);
      answers[k] = compare(run, wave);
      const Answer& a = answers[k];
      MESSAGE("peak " << a.peak << ", mean error " << a.error << ", front " << a.front / 0.85
                      << ", at the wall " << a.wall);
      CHECK(a.wall == doctest::Approx(1).epsilon(0.02));
      CHECK(std::abs(energy_residual(run)) < 1e-10 * start);
      CHECK(run.sim->audit().internal + run.sim->audit().kinetic ==
            doctest::Approx(start).epsilon(1e-10));
    }
    CHECK(answers[1].error < 0.7 * answers[0].error);
    CHECK(answers[1].peak == doctest::Approx(1).epsilon(0.06));
    CHECK(std::abs(answers[1].peak - 1) < std::abs(answers[0].peak - 1));
  }

  TEST_CASE("detonation that compression alone carries runs at the Chapman-Jouguet velocity") {
    // A flyer of the explosive itself starts it: nothing prescribes its speed.
    Run run = start_charge(100, "compression", "    velocity: [0, \"-2500*(z < 0.08)\"]\n");
    const auto front = [&] {
      const auto z = column(run, field::Position::info, 1),
                 F = column(run, field::BurnFraction::info);
      double far = 0;
      for (std::size_t i = 0; i < z.size(); ++i)
        if (F[i] > 0.5) far = std::max(far, z[i]);
      return far;
    };
    run_to(run, 0.45 / kD);
    const double z1 = front(), t1 = run.sim->time();
    run_to(run, 0.85 / kD);
    const double D = (front() - z1) / (run.sim->time() - t1);
    MESSAGE("D = " << D << " m/s");
    CHECK(D == doctest::Approx(kD).epsilon(0.02));
  }

  TEST_CASE("an explosive waits at rest for its lighting") {
    Run run = start_charge(50, "front", "detonators: {late: {point: [0, 0], time: 40 us}}\n");
    run_to(run, 39e-6);
    CHECK(run.sim->totals().kinetic == 0);
    const auto F = column(run, field::BurnFraction::info);
    CHECK(*std::max_element(F.begin(), F.end()) == 0.0);
    run_to(run, 80e-6);
    const auto z = column(run, field::Position::info, 1),
               later = column(run, field::BurnFraction::info);
    double front = 0;
    for (std::size_t i = 0; i < z.size(); ++i)
      if (later[i] > 0) front = std::max(front, z[i]);
    CHECK(front == doctest::Approx(kD * 40e-6).epsilon(0.03));
  }
}
