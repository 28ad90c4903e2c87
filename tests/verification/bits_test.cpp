// SPDX-License-Identifier: GPL-3.0-or-later
// The same bits for any number of threads, any instruction set and across a restart: one body in
// every frame, bodies in contact, a reference configuration that is renewed.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "krater/core/parallel.hpp"
#include "verification/run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

struct Case {
  std::string name, input;
  Overrides options;
  int steps;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all = [] {
    std::vector<Case> out;
    const Overrides rod{"grid.cell=1.27 mm", "bodies.rod.velocity=[0, -600 m/s]"};
    for (const std::string frame : {"axisymmetric", "plane_strain", "3d"}) {
      Overrides options = rod;
      options.push_back("frame=" + frame);
      out.push_back({"rod, " + frame, "taylor_copper.yaml", options, 40});
    }
    for (const std::string normal : {"volume_gradient", "logistic_regression"})
      out.push_back({"sphere and plate, " + normal,
                     "hiermaier_al.yaml",
                     {"grid.cell=0.8 mm", "contact.normal=" + normal, "contact.friction=0.2"},
                     60});
    out.push_back({"bars", "ccf_two_bars.yaml", {"grid.cell=1.25 mm"}, 30});
    Overrides renewed = rod;
    renewed.push_back("method.reference={adaptive: {strain: 0.05}}");
    out.push_back({"rod, adaptive reference", "taylor_copper.yaml", renewed, 60});
    return out;
  }();
  return all;
}

Run start(const Case& c, const Overrides& more = {}, IsaLevel level = best_isa_level()) {
  Overrides options = c.options;
  options.insert(options.end(), more.begin(), more.end());
  return start_input(c.input, options, level);
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("the cases do what they are for") {
    for (const Case& c : cases()) {
      CAPTURE(c.name);
      Run run = start(c);
      run_steps(run, 2 * c.steps);
      if (run.scene->contact.active) CHECK(run.sim->audit().contact_pairs > 0);
      if (run.scene->method.reference == Reference::adaptive)
        CHECK(run.sim->audit().new_references > 2);
    }
  }

  TEST_CASE("1, 2 and 3 threads give the same bits") {
    const int before = threads();
    for (const Case& c : cases()) {
      CAPTURE(c.name);
      std::vector<std::uint64_t> one;
      for (const int count : {1, 2, 3}) {
        CAPTURE(count);
        set_threads(count);
        Run run = start(c);
        run_steps(run, c.steps);
        if (count == 1)
          one = all_bits(*run.sim);
        else
          CHECK(all_bits(*run.sim) == one);
      }
    }
    set_threads(before);
  }

  TEST_CASE("the instruction-set levels give the same bits") {
    const IsaLevel best = best_isa_level();
    MESSAGE("up to " << std::string{name_of(best)});
    for (const Case& c : cases()) {
      CAPTURE(c.name);
      std::vector<std::uint64_t> portable;
      for (const IsaLevel level : {IsaLevel::portable, IsaLevel::v3, IsaLevel::v4}) {
        if (level > best) continue;
        CAPTURE(std::string{name_of(level)});
        Run run = start(c, {}, level);
        run_steps(run, c.steps);
        if (level == IsaLevel::portable)
          portable = all_bits(*run.sim);
        else
          CHECK(all_bits(*run.sim) == portable);
      }
    }
  }

  TEST_CASE("a restart in mid-run continues with the same bits") {
    for (const Case& c : cases())
      for (const std::string scheme : {"tflip usl", "xpic usl", "tflip musl", "flip usf"}) {
        // Contact and a fixed reference go with fewer schemes.
        if (scheme == "xpic usl" && c.input != "taylor_copper.yaml") continue;
        if (scheme != "tflip usl" && c.name == "rod, adaptive reference") continue;
        CAPTURE(c.name);
        CAPTURE(scheme);
        const std::size_t space = scheme.find(' ');
        const Overrides options{
            "method.transfer=" + scheme.substr(0, space),
            "method.update=" + scheme.substr(space + 1),
            std::string{"method.shape="} + (scheme == "tflip musl" ? "gimp" : "quadratic_bspline")};
        Run whole = start(c, options);
        run_steps(whole, c.steps);
        Run second = start(c, options);
        second.sim->restore(whole.sim->save());
        CHECK(all_bits(*second.sim) == all_bits(*whole.sim));
        run_steps(whole, c.steps), run_steps(second, c.steps);
        CHECK(second.sim->time() == whole.sim->time());
        CHECK(all_bits(*second.sim) == all_bits(*whole.sim));
      }
  }
}
