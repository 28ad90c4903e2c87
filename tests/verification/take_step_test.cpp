// SPDX-License-Identifier: GPL-3.0-or-later
// One step of several ways to move bodies: what one shortens, the others are asked again for, and
// being asked again leaves no trace.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

/// Safe up to a step of its own, and keeps what it was called with.
class Cautious final : public Kinematics {
 public:
  explicit Cautious(double safe) : safe_{safe} {}
  double force(double dt) override {
    log += "f";
    return last = std::min(dt, safe_);
  }
  void meet(double dt) override { log += dt == last ? "m" : "?"; }
  Standing move(double dt, const Standing& others) override {
    log += dt == last ? "v" : "?";
    return {others.kinetic + 1, 0, 0, 0, others.contact_pairs};
  }
  const TimeStepLimit& limit() const override { return limit_; }
  int set_count() const override { return 0; }
  PointSet set(int) const override { return {}; }
  PointStore& change(int) override { return none_; }

  std::string log;
  double last = 0;

 private:
  double safe_;
  TimeStepLimit limit_;
  PointStore none_;
};

MpmStep& stepper(Run& run) { return const_cast<MpmStep&>(run.sim->stepper()); }

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("take_step: all take the shortest step, and none moves before all agree") {
    Cautious a{1}, b{0.25}, c{0.5};
    Kinematics* all[] = {&a, &b, &c};
    CHECK(take_step(all, 2) == 0.25);
    for (const Cautious* k : {&a, &b, &c}) {
      CHECK(k->log == "ffmv");
      CHECK(k->last == 0.25);
    }
    Cautious alone{1};
    Kinematics* one[] = {&alone};
    CHECK(take_step(one, 2) == 1);
    CHECK(alone.log == "fmv");
  }

  TEST_CASE("take_step: forces asked again for a shorter step leave the bits of one question") {
    const std::string rigid = "{density: 7800}";
    const std::string scene =
        "frame: plane_strain\n"
        "grid: {cell: 1 mm, box: {min: [0, 0], max: [20 mm, 20 mm]}}\n"
        "time: {end: 20 us}\n"
        "materials: {copper: {card: ofhc_copper}, steel: " +
        rigid +
        "}\n"
        "contact: {friction: 0}\n"
        "bodies:\n"
        "  plate: {material: copper, shape: {box: {min: [4 mm, 0, 4 mm], max: [16 mm, 1, 8 mm]}}}\n"
        "  punch: {material: steel, rigid: {velocity: [0, \"-100 - 1e7 * t\"]}, "
        "shape: {box: {min: [8 mm, 0, 8 mm], max: [12 mm, 1, 14 mm]}}}\n";
    for (const char* update : {"usl", "musl", "usf"}) {
      CAPTURE(update);
      const Overrides set{std::string{"method.update="} + update};
      Run asked_twice = start_text(scene, set), asked_once = start_text(scene, set);
      for (Run* run : {&asked_twice, &asked_once}) run_steps(*run, 5);
      REQUIRE(all_bits(*asked_twice.sim) == all_bits(*asked_once.sim));
      const double dt = 0.5 * asked_once.sim->dt();
      for (int n = 0; n < 3; ++n) {
        Cautious other{dt};
        Kinematics* two[] = {&stepper(asked_twice), &other};
        Kinematics* one[] = {&stepper(asked_once)};
        CHECK(take_step(two, 2 * dt) == dt);
        CHECK(take_step(one, dt) == dt);
        CHECK(all_bits(*asked_twice.sim) == all_bits(*asked_once.sim));
      }
      CHECK(asked_once.sim->audit().external_work != 0);
    }
  }
}
