// SPDX-License-Identifier: GPL-3.0-or-later
// A patch is scattered for the next step while its points are in the cache: the bits are those of
// runs that know no such tiles, because they begin at a checkpoint or read the points anew.
#include <doctest/doctest.h>

#include <algorithm>
#include <utility>

#include "run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

std::size_t scattered_ahead(const Run& run) {
  const std::vector<Patch>& patches = std::as_const(*run.sim).grid().patches();
  return static_cast<std::size_t>(std::count_if(patches.begin(), patches.end(), [](const Patch& p) {
    return p.tile.state == Tile::State::ahead;
  }));
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("scatter ahead: the bits of a run that starts again in every few steps") {
    for (const char* frame : {"frame=axisymmetric", "frame=3d"}) {
      CAPTURE(frame);
      const Overrides coarse{frame, "grid.cell=0.762 mm"};
      Run run = start_input("taylor_copper.yaml", coarse);
      std::size_t most = 0, least = 1000000;
      for (int n = 0; n < 12; ++n) {
        const Checkpoint state = run.sim->save();
        Run fresh = start_input("taylor_copper.yaml", coarse);
        fresh.sim->restore(state);
        run_steps(fresh, 5);
        run_steps(run, 5);
        REQUIRE(all_bits(*run.sim) == all_bits(*fresh.sim));
        most = std::max(most, scattered_ahead(run)), least = std::min(least, scattered_ahead(run));
      }
      CHECK(most > 0);  // both kinds of patches were there
      CHECK(least < run.sim->grid().patches().size());
    }
  }

  TEST_CASE("scatter ahead: points changed from outside are scattered again") {
    Run run = start_input("taylor_copper.yaml", {"grid.cell=0.762 mm"});
    run_steps(run, 8);
    REQUIRE(scattered_ahead(run) > 0);
    Run fresh = start_input("taylor_copper.yaml", {"grid.cell=0.762 mm"});
    fresh.sim->restore(run.sim->save());
    for (Run* r : {&run, &fresh}) {
      std::vector<double> v = column(*r, field::Velocity::info, 1);
      for (double& x : v) x *= 1.01;
      set_column(*r, field::Velocity::info, 1, v);
      run_steps(*r, 2);
    }
    CHECK(all_bits(*run.sim) == all_bits(*fresh.sim));
  }
}
