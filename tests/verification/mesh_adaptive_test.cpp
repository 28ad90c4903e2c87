// SPDX-License-Identifier: GPL-3.0-or-later
// Elements that take new references (kinematics/mesh/placed_element.hpp).
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "krater/core/parallel.hpp"
#include "verification/mesh_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

constexpr auto kInitial = ElementReference::initial, kAdaptive = ElementReference::adaptive;

}  // namespace

TEST_SUITE("verification") {
  // A new reference changes forces and nothing else: nodes, columns and energies of the step that
  // ends with it are those of the same step on the old one, bit for bit.
  TEST_CASE("mesh: a new reference leaves state, mass and energy as they are") {
    for (const std::string frame : {"3d", "plane_strain", "axisymmetric"}) {
      CAPTURE(frame);
      const int dim = frame == "3d" ? 3 : 2;
      const std::string v = dim == 3 ? "[\"0.3*y\", \"-0.1*x\", \"0.4*sin(3*x*y)\"]"
                            : frame == "axisymmetric" ? "[\"-0.2*r\", \"0.4*sin(4*r)\"]"
                                                      : "[\"0.2*z\", \"-0.2*x + 0.4*sin(4*x)\"]";
      const Mesh mesh = shaken(block_mesh(dim, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}), 0.05, 5);
      MeshRun old{text_of(frame, v), mesh, {}, {}, 0.9, kInitial},
          renewed{text_of(frame, v), mesh, {}, {}, 0.9, kAdaptive, 0.05};
      while (renewed.audit().new_references == 0) {
        for (MeshRun* run : {&old, &renewed}) run->step(100);
        REQUIRE(old.steps() < 1000);
      }
      CHECK(renewed.steps() > 2);
      for (const FieldInfo* field :
           {&field::Density::info, &field::Pressure::info, &field::DeviatoricStress::info,
            &field::InternalEnergy::info, &field::Mass::info})
        for (int k = 0; k < field->components; ++k)
          CHECK(renewed.column(*field, k) == old.column(*field, k));
      CHECK(renewed.mesh().hourglass_energy() == old.mesh().hourglass_energy());
      CHECK(renewed.audit().kinetic == old.audit().kinetic);
      CHECK(renewed.audit().internal == old.audit().internal);
      double apart = 0, most = 0;
      Triple sum{};
      for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
        const Triple f = renewed.mesh().force_of(0, n), g = old.mesh().force_of(0, n);
        for (std::size_t a = 0; a < 3; ++a) {
          CHECK(renewed.mesh().position(0, n)[a] == old.mesh().position(0, n)[a]);
          CHECK(renewed.mesh().velocity(0, n)[a] == old.mesh().velocity(0, n)[a]);
          apart = std::max(apart, std::abs(f[a] - g[a]));
          most = std::max(most, std::abs(g[a]));
          sum[a] += f[a];
        }
      }
      CHECK(apart > 1e-6 * most);  // it is another method from here on
      CHECK(apart < 0.2 * most);
      for (std::size_t a = frame == "axisymmetric" ? 1 : 0; a < 3; ++a)
        CHECK(std::abs(sum[a]) < 1e-13 * most);
    }
  }

  // Forces of a uniform pressure p at rest: - sum x . f = d p V, and V is m/rho.
  TEST_CASE("mesh: volumes of new references are m/rho") {
    for (const std::string frame : {"3d", "plane_strain"}) {
      CAPTURE(frame);
      const int dim = frame == "3d" ? 3 : 2;
      MeshRun run{text_of(frame, dim == 3 ? "[\"0.3*y*z\", \"-0.3*x*x\", \"0.4*sin(3*x*y)\"]"
                                          : "[\"0.3*x*z\", \"-0.4*x*x*z\"]"),
                  shaken(block_mesh(dim, {1, 1, 1}, {2, 2, 2}, {1, 1, 1}), 0.1, 9),
                  {},
                  {.kind = HourglassOptions::Kind::viscous},
                  0.9,
                  kAdaptive,
                  0.02};
      while (run.audit().new_references < 3) run.step(100);
      const double volume = run.column(field::Mass::info)[0] / run.column(field::Density::info)[0];
      run.set_column(field::Pressure::info, 0, {1});
      for (int k = 0; k < 6; ++k) run.set_column(field::DeviatoricStress::info, k, {0});
      const std::size_t nodes = run.mesh().node_count(0);
      set_velocities(run, std::vector<Triple>(nodes));
      double virial = 0;
      for (std::size_t n = 0; n < nodes; ++n)
        for (std::size_t a = 0; a < 3; ++a)
          virial += run.mesh().position(0, n)[a] * run.mesh().force_of(0, n)[a];
      CHECK(virial / dim == doctest::Approx(volume).epsilon(1e-12));
    }
  }

  TEST_CASE("mesh: the same bits of new references on any threads, across a restart and erosion") {
    const std::string scene =
        "frame: plane_strain\ngrid: {cell: 0.5 mm, box: {min: [-40 mm, 0], max: [40 mm, 99 mm]}, "
        "boundary: {z_min: {wall: {friction: 0.1}}}}\ntime: {end: 1, energy_error: off}\n"
        "materials: {metal: {density: 8000, youngs_modulus: 100 GPa, poisson_ratio: 0.3, eos: "
        "linear, viscosity: {}, strength: {von_mises: {Y: 0.2 GPa, H: 0}}}}\n"
        "bodies: {bar: {material: metal, velocity: [0, \"-400 - 3e4*x\"], shape: {box: {min: [-10 "
        "mm, 0], max: [10 mm, 20 mm]}}, kinematics: {lagrangian_mesh: {element: 0.5 mm, reference: "
        "{adaptive: {strain: 0.1}}, failure: {when: {plastic_strain: 0.6}}}}}}\n";
    const int before = set_threads(1);
    Run one = start_text(scene);
    run_steps(one, 150);
    const Checkpoint middle = saved_state(*one.sim);
    run_steps(one, 60);
    set_threads(3);
    Run three = start_text(scene), again = start_text(scene);
    run_steps(three, 210);
    again.sim->restore(middle);
    run_steps(again, 60);
    set_threads(before);
    CHECK(one.sim->audit().new_references > 100);
    CHECK(one.sim->mesh()->eroded().all() > 5);
    CHECK(all_bits(*three.sim) == all_bits(*one.sim));
    CHECK(all_bits(*again.sim) == all_bits(*one.sim));
  }

  // What a new reference takes over of the hourglass has the stored energy that it had. Taken over
  // as the force that it was, cycles of strain made energy without end: 1e4 times that of the start
  // by the end of this.
  TEST_CASE("mesh: many new references make no energy of the hourglass") {
    for (const std::string frame : {"3d", "plane_strain"})
      for (const auto kind :
           {HourglassOptions::Kind::assumed_strain, HourglassOptions::Kind::stiffness}) {
        CAPTURE(frame);
        const int dim = frame == "3d" ? 3 : 2;
        const std::string v = dim == 3 ? "[\"0.1*y\", \"-0.1*x\", \"0.1*sin(3*x*y)\"]"
                                       : "[\"0.2*z\", \"-0.2*x + 0.1*sin(4*x)\"]";
        const Mesh mesh = shaken(block_mesh(dim, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}), 0.05, 5);
        MeshRun old{text_of(frame, v), mesh, {}, {.kind = kind}, 0.9, kInitial},
            renewed{text_of(frame, v), mesh, {}, {.kind = kind}, 0.9, kAdaptive, 0.02};
        double least = 0;
        for (int i = 0; i < 400; ++i) {
          renewed.step(100);
          const double rate = renewed.mesh().limit().rate;
          renewed.mesh().find_forces();  // as a restart does
          CHECK(renewed.mesh().limit().rate == rate);
          least = std::min(least, renewed.mesh().hourglass_energy());
        }
        old.run_to(renewed.time());
        CHECK(renewed.audit().new_references > 500);
        CHECK(least > -1e-3 * renewed.audit().initial_kinetic);
        CHECK(renewed.audit().kinetic ==
              doctest::Approx(old.audit().kinetic).epsilon(0.03).scale(0));
      }
  }

  // Q_ka of bending and twist of a brick goes with a_k/sqrt V, so that what is stored stays.
  TEST_CASE("mesh: a new reference keeps the stored energy of the hourglass") {
    const Mesh mesh = block_mesh(3, {0, 0, 0}, {1, 0.7, 1.2}, {1, 1, 1});
    MeshRun run{text_of("3d", "[0, 0, 0]"),
                mesh,
                {"time.first_step=1e-7", "time.max_step=1e-7"},
                {},
                0.9,
                kAdaptive,
                0.05};
    const Triple stretch{1.2, 0.9, 1.1};
    std::vector<Triple> v;
    for (const Triple& x : mesh.nodes) v.push_back({0.2e7 * x[0], -0.1e7 * x[1], 0.1e7 * x[2]});
    set_velocities(run, v);
    std::vector<double> state = run.mesh().state(0);
    for (std::size_t k = 0; k < 12; ++k)
      for (std::size_t l = 0; l < 8; ++l)
        state[8 * mesh.nodes.size() + 8 * k + l] = 0.01 * static_cast<double>(k + 1);
    REQUIRE(run.mesh().set_state(0, state));
    run.mesh().find_forces();
    run.step(1);
    REQUIRE(run.audit().new_references == 1);
    const std::vector<double> after = run.mesh().state(0);
    const double grown = std::sqrt(1.2 * 0.9 * 1.1);
    for (std::size_t k = 0; k < 12; ++k)
      CHECK(after[8 * mesh.nodes.size() + 8 * k] ==
            doctest::Approx(0.01 * static_cast<double>(k + 1) * grown / stretch[k / 4])
                .epsilon(1e-6)
                .scale(0));
  }

  // Matter so soft that nothing but its motion counts: what is left is where it would be anyway.
  TEST_CASE("mesh: an element that takes the place of another keeps its reference") {
    for (const std::string reference : {"initial", "adaptive"}) {
      CAPTURE(reference);
      const std::string scene =
          "frame: 3d\ngrid: {cell: 0.25, box: {min: [-9, -9, -9], max: [9, 9, 9]}}\ntime: {end: 1, "
          "first_step: 1e-4, max_step: 1e-4}\nmaterials: {matter: {density: 1, youngs_modulus: "
          "1e-6, poisson_ratio: 0.3, eos: linear, strength: {von_mises: {Y: 1, H: 0}}}}\n"
          "bodies: {ball: {material: matter, velocity: [\"9*x*x\", \"9*y*x\", \"-9*x*z*z\"], "
          "shape: {sphere: {radius: 1, center: [0, 0, 0]}}, kinematics: {lagrangian_mesh: "
          "{element: "
          "0.3, reference: " +
          reference + ", failure: {when: {plastic_strain: 0.5}}}}}}\n";
      Run run = start_text(scene), whole = start_text(scene);
      std::vector<double> strains(static_cast<std::size_t>(run.sim->set(0).count()), 0.0);
      strains[3] = 1;
      set_column(run, field::PlasticStrain::info, 0, strains);
      run_steps(run, 5);
      run_steps(whole, 5);
      REQUIRE(run.sim->mesh()->eroded().all() == 1);
      std::vector<double> found = column(run, field::Density::info),
                          expected = column(whole, field::Density::info);
      expected.erase(expected.begin() + 3);
      REQUIRE(found.size() == expected.size());
      for (std::size_t i = 0; i < found.size(); ++i)
        CHECK(found[i] == doctest::Approx(expected[i]).epsilon(1e-9).scale(0));
    }
  }

  TEST_CASE("mesh: forces of an affine motion are those of any reference") {
    for (const std::string frame : {"3d", "plane_strain"}) {
      CAPTURE(frame);
      const int dim = frame == "3d" ? 3 : 2;
      const Mesh mesh = block_mesh(dim, {0, 0, 0}, {1, 0.7, 1.2}, {1, 1, 1});
      const Overrides tiny{"time.first_step=1e-7", "time.max_step=1e-7"};
      MeshRun old{text_of(frame, "[0, 0, 0]"), mesh, tiny, {}, 0.9, kInitial},
          renewed{text_of(frame, "[0, 0, 0]"), mesh, tiny, {}, 0.9, kAdaptive, 0.05};
      std::vector<Triple> affine;
      for (const Triple& x : mesh.nodes)
        affine.push_back({2e6 * x[0] + 1e6 * x[1], -3e6 * x[0] + 5e5 * x[1], 0});
      for (MeshRun* run : {&old, &renewed}) {
        set_velocities(*run, affine);
        run->step(1);
      }
      REQUIRE(renewed.audit().new_references == 1);
      for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
        for (std::size_t a = 0; a < 3; ++a)
          CHECK(std::abs(renewed.mesh().force_of(0, n)[a] - old.mesh().force_of(0, n)[a]) < 1e-15);
      CHECK(std::abs(old.mesh().force_of(0, 0)[0]) > 1e-3);
    }
  }
}
