// SPDX-License-Identifier: GPL-3.0-or-later
// failure: {action: remove}: what is taken out is booked to the last bit, and nothing else changes.
#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "krater/core/parallel.hpp"
#include "run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

const Overrides kKeep{"grid.cell=0.5 mm"};
const Overrides kRemove{"grid.cell=0.5 mm", "materials.weldox.failure.action=remove"};

Overrides with(Overrides more) {
  more.insert(more.begin(), kRemove.begin(), kRemove.end());
  return more;
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("removed by failure: mass, momentum and energy with the removed close to round-off") {
    for (const Overrides& method : std::vector<Overrides>{{},
                                                          {"method.update=musl"},
                                                          {"method.update=usf"},
                                                          {"method.transfer={xpic: {order: 2}}"},
                                                          {"method.shape=gimp"}}) {
      CAPTURE(method.empty() ? "usl" : method.front());
      Run run = start_input("bar_pulled_apart.yaml", with(method));
      const Totals start = run.sim->totals();
      const Audit& audit = run.sim->audit();
      // What is not booked at once would hide in the next step's time centring: compare every step.
      while (run.sim->time() < 20e-6) {
        run.sim->step(20e-6);
        const Totals t = run.sim->totals();
        REQUIRE(std::abs(audit.kinetic - t.kinetic) < 1e-12 * start.kinetic);
        REQUIRE(std::abs(audit.internal - t.internal) < 1e-12 * start.kinetic);
      }
      const Totals now = run.sim->totals();
      CHECK(audit.removed_failed > 20);
      CHECK(audit.removed_failed == audit.removed_points);  // none left the domain
      CHECK(audit.removed_failed == audit.failures);
      CHECK(now.count + audit.removed_points == start.count);
      CHECK(now.mass + audit.removed_mass == doctest::Approx(start.mass).epsilon(1e-13));
      const double scale = 2 * start.kinetic / 200;  // the bar as a whole is at rest
      CHECK(std::abs(now.momentum[1] + audit.removed_momentum[1] - start.momentum[1]) <
            1e-11 * scale);
      // A node with next to no mass, where a gimp domain ends, gets no force: its work is missing.
      const bool gimp = !method.empty() && method.front().find("gimp") != std::string::npos;
      CHECK(std::abs(energy_residual(run)) < (gimp ? 1e-10 : 1e-12) * start.kinetic);
      CHECK(audit.removed_energy > 0);
      for (const double failed : column(run, field::Failed::info)) CHECK(failed == 0);
      const std::vector<double> ids = column(run, field::Id::info);
      CHECK(std::set<double>(ids.begin(), ids.end()).size() == ids.size());
      CHECK(ids.back() >= static_cast<double>(ids.size()));  // the others keep theirs
    }
  }

  TEST_CASE("removed by failure: same points as lose their strength, until the first is gone") {
    Run keeps = start_input("bar_pulled_apart.yaml", kKeep),
        removes = start_input("bar_pulled_apart.yaml", kRemove);
    while (keeps.sim->audit().failures == 0) run_steps(keeps, 1), run_steps(removes, 1);
    CHECK(removes.sim->audit().failures == keeps.sim->audit().failures);
    const std::vector<double> failed = column(keeps, field::Failed::info);
    std::vector<double> left;
    for (std::size_t i = 0; i < failed.size(); ++i)
      if (failed[i] < 0.5) left.push_back(static_cast<double>(i));
    CHECK(column(removes, field::Id::info) == left);
    CHECK(removes.sim->audit().removed_mass > 0);
    CHECK(keeps.sim->audit().removed_points == 0);
  }

  TEST_CASE("removed by failure: the same bits for any threads and level, and across a restart") {
    std::vector<std::uint64_t> bits;
    for (const int n : {1, 2, 3}) {
      set_threads(n);
      Run run = start_input("bar_pulled_apart.yaml", kRemove,
                            n == 3 ? IsaLevel::portable : best_isa_level());
      run_to(run, 15e-6);
      REQUIRE(run.sim->audit().removed_failed > 0);
      const Checkpoint half = saved_state(*run.sim);
      run_to(run, 18e-6);
      const auto now = all_bits(*run.sim);
      if (bits.empty()) bits = now;
      CHECK(now == bits);
      Run again = start_input("bar_pulled_apart.yaml", kRemove);
      again.sim->restore(half);
      run_to(again, 18e-6);
      CHECK(all_bits(*again.sim) == bits);
    }
    set_threads(1);
  }

  TEST_CASE("removed by failure: a body may vanish whole") {
    Run run = start_input("bar_pulled_apart.yaml",
                          with({"materials.weldox.damage.lemaitre_energy.S=1",
                                "materials.weldox.damage.lemaitre_energy.triaxiality_min=-100",
                                "bodies.bar.velocity=[0, \"1e5 * z\"]"}));
    const Totals start = run.sim->totals();
    run_to(run, 20e-6);
    CHECK(run.sim->totals().count == 0);
    CHECK(run.sim->audit().removed_mass == doctest::Approx(start.mass).epsilon(1e-13));
    CHECK(std::abs(energy_residual(run)) < 1e-12 * start.kinetic);
  }
}
