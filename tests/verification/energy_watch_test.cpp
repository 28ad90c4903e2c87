// SPDX-License-Identifier: GPL-3.0-or-later
// No run makes energy; what limits the time step is named by its id; a halved step is one step for
// strain and motion alike.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "krater/core/errors.hpp"
#include "run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

/// What the step says when it ends the run.
std::string message_of(Run& run) {
  try {
    run.sim->step(run.scene->time.end);
  } catch (const NumericalError& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("energy watch: what throws nodes about ends the run before a point is touched") {
    for (const Overrides& method :
         std::vector<Overrides>{{}, {"method.update=musl"}}) {  // usf strains before that
      Run run = start_input("taylor_copper.yaml", method);
      run_steps(run, 3);
      CHECK(message_of(run).empty());
      const Body& body = *run.sim->bodies()[0];
      // Energy that no account knows of.
      run.sim->set_value(0, 0, body.slot(field::Velocity::info, 1), 1e6);
      const std::vector<double> z = column(run, field::Position::info, 1);
      const std::string text = message_of(run);
      CAPTURE(text);
      CHECK(text.find("energy from nowhere") != std::string::npos);
      CHECK(text.find("body '" + body.name() + "', point") != std::string::npos);
      CHECK(text.find("time ") != std::string::npos);
      CHECK(run.sim->broken());
      if (method.empty()) CHECK(column(run, field::Position::info, 1) == z);
    }
  }

  TEST_CASE("energy watch: gains, driven sides, and entries that are no number") {
    const GridGeometry geometry{2, 1, 1, {}, {4, 4, 0}};
    BoundaryConditions open;  // const, clang 14 ends on it
    const BoundarySet sides{geometry, open};
    const EnergyWatch watch{sides};
    Audit audit;
    audit.initial_kinetic = audit.kinetic = audit.peak_energy = 100;
    for (const double loss : {10.0, 90.0}) {  // losses are reported, not judged
      audit.kinetic = 100 - loss;
      CHECK_NOTHROW(watch.check(audit, 1));
    }
    audit.kinetic = 80, audit.internal = 65, audit.transfer_gain = -45;
    CHECK_NOTHROW(watch.check(audit, 1));
    audit.internal = 95;  // 75 J too many, more than half of the greatest so far, 145 J
    CHECK_THROWS_WITH_AS(watch.check(audit, 1),
                         doctest::Contains("transfer between points and grid"), EnergyError);
    audit.external_work = 80;  // it was work from outside
    CHECK_NOTHROW(watch.check(audit, 1));
    audit.contact_heat = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH_AS(watch.check(audit, 1), doctest::Contains("contact_heat is nan"),
                         EnergyError);
    audit.contact_heat = 0, audit.wall_impulse[1] = std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH_AS(watch.check(audit, 1), doctest::Contains("wall_impulse_1 is inf"),
                         EnergyError);
    audit.wall_impulse = {};
    CHECK_NOTHROW(watch.check_nodes(audit, 250, {0, 0}));
    CHECK_THROWS_AS(watch.check_nodes(audit, 300, {0, 0}), EnergyError);
    CHECK_NOTHROW(watch.check_nodes(audit, 300, {100, 0}));
    CHECK_THROWS_AS(watch.check_nodes(audit, std::numeric_limits<double>::quiet_NaN(), {0, 0}),
                    EnergyError);
  }

  TEST_CASE("energy watch: no entry of the account may be other than a number") {
    const GridGeometry geometry{2, 1, 1, {}, {4, 4, 0}};
    BoundaryConditions open;  // const, clang 14 ends on it
    const BoundarySet sides{geometry, open};
    const EnergyWatch watch{sides};
    for (std::size_t i = 0; i < audit_entries(); ++i) {
      Audit audit;
      audit.initial_kinetic = audit.kinetic = audit.peak_energy = 100;
      std::string broken;
      std::size_t at = 0;
      for_each_entry(audit, [&](const char* name, double& value) {
        if (at++ != i) return;
        value = std::numeric_limits<double>::quiet_NaN();
        broken = name;
      });
      CAPTURE(broken);
      CHECK_THROWS_WITH_AS(watch.check(audit, 1), doctest::Contains((broken + " is nan").c_str()),
                           EnergyError);
    }
  }

  TEST_CASE("energy watch: what is not physical ends a run when its energy has come") {
    Audit audit;
    audit.peak_energy = 100;
    audit.peak_energy_time = 100;  // all of it for 1 s
    audit.initial_kinetic = 100, audit.kinetic = 80, audit.internal = 20;
    audit.contact_heat = 10, audit.wall_heat = 3, audit.transfer_loss = 20;
    const auto check = [&audit](double time, bool last) {
      EnergyWatch::check_error(audit, 0.1, time, last);
    };
    CHECK_NOTHROW(check(1, true));  // heat of matter that knows its energy is physical
    audit.numerical_heat = -9;
    CHECK_NOTHROW(check(1, true));
    audit.numerical_heat = -11;
    CHECK_THROWS_WITH_AS(check(1, false), doctest::Contains("numerical_heat (-11 J)"), EnergyError);
    CHECK_THROWS_WITH_AS(check(1, false), doctest::Contains("transfer between points and grid"),
                         EnergyError);
    CHECK_THROWS_WITH_AS(check(1, false), doctest::Contains("time.energy_error"), EnergyError);
    audit.transfer_gain = -12;
    CHECK_THROWS_WITH_AS(check(1, false), doctest::Contains("mostly of contact"), EnergyError);
    audit.transfer_loss = audit.contact_heat = audit.wall_heat = 1;  // less than half of it
    CHECK_THROWS_WITH_AS(check(1, false), doctest::Contains("a smaller time.cfl"), EnergyError);
    CHECK_NOTHROW(check(2, false));  // the energy came half-way: wait
    CHECK_THROWS_AS(check(2, true), EnergyError);
    audit.numerical_heat = 30, audit.friction_work = -25;  // friction is physical
    CHECK_NOTHROW(check(2, true));
    audit.numerical_heat = -11;
    audit.carried = -12;
    CHECK_THROWS_WITH_AS(check(1, false), doctest::Contains("most of it carried_energy (-12 J)"),
                         EnergyError);
    audit.kinetic = 60;
    CHECK_THROWS_WITH_AS(check(1, false), doctest::Contains("most of it energy_residual (-20 J)"),
                         EnergyError);
    CHECK_NOTHROW(EnergyWatch::check_error(audit, 0, 1, true));
  }

  TEST_CASE("time step: the point that limits it is named by its id, whoever migrates") {
    Run run = start_input("taylor_copper.yaml", {"bodies.rod.velocity=[0, -1900]"});
    int checked = 0;
    for (int n = 0; n < 150; ++n) {
      run_steps(run, 1);
      const TimeStepLimit& limit = run.sim->stepper().limit();
      CHECK(limit.kind == run.sim->limiter_kind());
      if (limit.kind == 2) continue;
      const std::vector<double> id = column(run, field::Id::info),
                                c = column(run, field::SoundSpeed::info),
                                vr = column(run, field::Velocity::info, 0),
                                vz = column(run, field::Velocity::info, 1);
      for (std::size_t i = 0; i < id.size(); ++i) {
        if (id[i] != limit.id) continue;
        const double speed = std::max(std::abs(vr[i]), std::abs(vz[i]));
        const double signal = limit.rate * run.scene->grid.cell - speed;
        CHECK(signal > c[i]);  // c, and what the shear and the viscosity add
        CHECK((signal > speed ? 0 : 1) == limit.kind);
        ++checked;
      }
    }
    CHECK(checked > 50);
  }

  TEST_CASE("a halved step is one step for strain and motion alike, whatever the update") {
    // A column of gas drawn out evenly; its free end makes the first step too long.
    const std::string scene =
        "frame: plane_strain\n"
        "grid: {cell: 0.01, box: {min: [0, 0], max: [0.04, 0.2]}, "
        "boundary: {x_min: symmetry, x_max: symmetry, z_min: symmetry}}\n"
        "time: {end: 1.65e-5, first_step: 1.65e-5, cfl: 1}\n"
        "method: {transfer: flip}\n"
        "materials: {gas: {density: 1000, eos: {ideal_gas: {gamma: 1.4, initial_pressure: 1e8}}}}\n"
        "bodies: {gas: {material: gas, shape: {box: {min: [0, 0, 0], max: [0.04, 1, 0.1]}}, "
        "velocity: [0, \"300 * z\"]}}\n";
    for (const char* update : {"usl", "musl"}) {  // usf strains the step before
      CAPTURE(update);
      Run run = start_text(scene, {std::string{"method.update="} + update});
      const std::vector<double> before = column(run, field::Position::info, 1);
      run_to(run, 1.65e-5);
      CHECK(run.sim->audit().retries > 0);
      const std::vector<double> z = column(run, field::Position::info, 1),
                                rho = column(run, field::Density::info);
      for (std::size_t i = 0; i < z.size(); ++i) {
        if (before[i] > 0.05) continue;  // the end is not drawn out evenly
        const double stretch = z[i] / before[i] - 1;
        CHECK(1000 / rho[i] - 1 == doctest::Approx(stretch).epsilon(0.02));
      }
    }
  }

  TEST_CASE("numerical heat: concrete whose pressure knows its energy has none") {
    // A block of a few cells that a wall stops; of rht only the solid's B0 and B1 tell.
    const std::string scene =
        "frame: plane_strain\ngrid: {cell: 1 mm, box: {min: [0, 0], max: [12 mm, 12 mm]}, "
        "boundary: {z_min: wall}}\ntime: {end: 4 us, energy_error: off}\nmaterials: {m: {card: "
        "concrete_c30_37_rht, viscosity: {}}}\nbodies: {b: {material: m, shape: {box: {min: [3 mm, "
        "-1 m, 0], max: [9 mm, 1 m, 6 mm]}}, velocity: [0, -400]}}\n";
    for (const bool knows : {true, false}) {
      Run run = start_text(
          scene, knows ? Overrides{}
                       : Overrides{"materials.m.model.rht.B0=0", "materials.m.model.rht.B1=0"});
      run_to(run, 4e-6);
      const Audit& audit = run.sim->audit();
      CHECK(std::abs(energy_residual(run)) < 1e-12 * audit.peak_energy);
      if (knows)
        CHECK(audit.numerical_heat == 0);
      else
        CHECK(audit.numerical_heat > 0.01 * audit.peak_energy);
    }
  }
}
