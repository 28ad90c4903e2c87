// SPDX-License-Identifier: GPL-3.0-or-later
// heating: energy behind a shock of the whole method, against the Hugoniot's own temperature.
//
// The method leaves 1.4 % too much energy behind a shock at eta = .37 (q_lin 0.3; 1.1 % with 0.5;
// it does not fall with h), which the temperature, the small difference of e and e_s, shows as 3.4
// %. So the law is held to the energy that is there, and the shock to what has been measured.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

/// T_s + (e - e_s)/c_v of 2024 aluminium at compression eta (theory 8), by quadrature.
double temperature_of(double e, double eta, double c_v, double T_ref) {
  const double c0 = 5328, S = 1.338, gamma = 2;
  const auto hugoniot = [&](double y) { return c0 * c0 * y / std::pow(1 - S * y, 2); };
  const int n = 2000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double y = eta * (i + 0.5) / n;
    sum += std::exp(-gamma * y) * hugoniot(y) * (1 - 0.5 * gamma * y) * eta / n;
  }
  const double e_s = std::exp(gamma * eta) * sum;
  return T_ref * std::exp(gamma * eta) + (e - e_s) / c_v;
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("shock temperature: aluminium at eta = .15 and .37 (4451 K) by heating: energy") {
    for (const double eta : {0.15, 0.37}) {
      const double speed = eta * 5328 / (1 - 1.338 * eta), shock = 5328 + 1.338 * speed;
      Run run = start_input("plate_impact.yaml",
                            {"materials.al2024.heating={energy: {c_v: 875}}",
                             "materials.al2024.initial_temperature=300",
                             "bodies.plate.velocity=[0, -" + std::to_string(speed) + "]"});
      run_to(run, 0.012 / (shock - speed));  // the front stands 12 mm from the plane
      const auto z = column(run, field::Position::info, 1);
      const auto T = column(run, field::Temperature::info);
      const auto e = column(run, field::InternalEnergy::info);
      const auto rho = column(run, field::Density::info);
      double sum = 0, sum_of_e = 0, count = 0;
      for (std::size_t i = 0; i < z.size(); ++i) {
        if (!(z[i] > 4e-3 && z[i] < 9e-3)) continue;  // beyond the wall's heat
        const double of_e = temperature_of(e[i], 1 - 2785 / rho[i], 875, 300);
        sum += T[i], sum_of_e += of_e, count += 1;
        CHECK(T[i] == doctest::Approx(of_e).epsilon(1e-2));  // e is half a step behind T
      }
      REQUIRE(count > 50);
      CHECK(sum == doctest::Approx(sum_of_e).epsilon(1e-4));  // at rest behind the shock
      const double expected = temperature_of(0.5 * speed * speed, eta, 875, 300);
      if (eta == 0.37) CHECK(expected == doctest::Approx(4451).epsilon(1e-4));
      MESSAGE("eta " << eta << ": " << sum / count << " K, exact " << expected << " K");
      CHECK(sum / count == doctest::Approx(expected).epsilon(0.01));
    }
  }
}
