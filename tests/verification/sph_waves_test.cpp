// SPDX-License-Identifier: GPL-3.0-or-later
// Waves in smoothed particles, against those of their sums.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "verification/run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

/// g(k) of a plane lattice of spacing 1, corrected: sum w d sin(k d)/sum w d^2 over neighbours at
/// (e, d), w = W'(r)/r.
double discrete_wave_number(const std::string& kernel, double smoothing, double k) {
  double sum = 0, moment = 0;
  for (int e = -4; e <= 4; ++e)
    for (int d = -4; d <= 4; ++d) {
      const double q = std::hypot(e, d) / smoothing;
      if (q == 0 || q >= 2) continue;
      const double slope = kernel == "quadratic"     ? q / 2 - 1
                           : kernel == "wendland_c2" ? -5 * q * std::pow(1 - q / 2, 3)
                           : q < 1                   ? -3 * q + 2.25 * q * q
                                                     : -0.75 * (2 - q) * (2 - q);
      sum += slope / q * d * std::sin(k * d);
      moment += slope / q * d * d;
    }
  return sum / moment;
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("sph: a bar between mirrors rings at the frequency of its discrete mode") {
    // v = sin(kz): sin(w dt/2) = (c dt/2) g(k), g the corrected gradient of a plane wave.
    const int count = 20;
    const double dx = 0.1, c = std::sqrt(1.3461538461538463), dt = 0.5 * dx / c;
    for (const std::string kernel : {"cubic_spline", "wendland_c2", "quadratic"})
      for (const std::string reference : {"current", "initial"})
        for (const int mode : {1, 7, 16}) {
          const double k = mode * std::numbers::pi / (count * dx);
          const std::string step = std::to_string(dt);
          Run run = start_text(
              std::string{"frame: plane_strain\ngrid: {cell: 0.2, box: {min: [0, 0], max: [0.4, "
                          "2]}, boundary: "
                          "{x_min: symmetry, x_max: symmetry, z_min: symmetry, z_max: "
                          "symmetry}}\ntime: {end: "
                          "100}\nmaterials: {matter: {"} +
                  "density: 1, youngs_modulus: 1, poisson_ratio: 0.3, eos: linear, strength: "
                  "elastic}}\nbodies: {bar: {material: matter, shape: {box: {min: [0, -1, 0], max: "
                  "[0.4, "
                  "1, "
                  "2]}}, kinematics: {sph: {zero_energy: 0, kernel: " +
                  kernel + ", reference: " + reference + "}}, velocity: [0, \"1e-7*sin(" +
                  std::to_string(k) + "*z)\"]}}\n",
              {"time.first_step=" + step, "time.max_step=" + step});
          const auto start = column(run, field::Position::info, 1);
          const auto amplitude = [&] {
            double sum = 0;
            const auto v = column(run, field::Velocity::info, 1);
            for (std::size_t i = 0; i < v.size(); ++i) sum += v[i] * std::sin(k * start[i]);
            return sum;
          };
          const double before = amplitude();
          run.sim->step(100);
          const double now = amplitude();
          run.sim->step(100);
          const double after = amplitude(), taken = run.sim->dt();
          const double w = std::acos((after + before) / (2 * now)) / taken;
          const double g = discrete_wave_number(kernel, 1.2, k * dx) / dx;
          CAPTURE(kernel);
          CAPTURE(reference);
          CAPTURE(mode);
          CHECK(w == doctest::Approx(2 / taken * std::asin(c * taken / 2 * g)).epsilon(1e-6));
        }
  }
}
