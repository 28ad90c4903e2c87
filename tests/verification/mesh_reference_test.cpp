// SPDX-License-Identifier: GPL-3.0-or-later
// Elements on their initial reference (kinematics/mesh/placed_element.hpp).
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "verification/mesh_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

constexpr auto kCurrent = ElementReference::current, kInitial = ElementReference::initial,
               kAdaptive = ElementReference::adaptive;

struct Momenta {
  Triple momentum{};
  double about = 0;
};
Momenta momenta_of(MeshRun& run) {
  const NodeTotals all = run.mesh().totals(0);
  return {all.momentum, all.angular_momentum};
}

/// Greatest component of what holds the hourglass [J].
double greatest_hold(MeshRun& run) {
  const std::vector<double> state = run.mesh().state(0);
  const std::size_t first = 8 * run.mesh().node_count(0),
                    size = run.mesh().mesh(0).dimension == 3 ? 12 : 2;
  double most = 0;
  for (std::size_t k = 0; k < 8 * size; ++k) most = std::max(most, std::abs(state[first + k]));
  return most;
}

struct ClosedPath {
  double greatest = 0, left = 0;
};
/// One element goes round a square of two random distortions of 3 %, in four steps; forces are
/// nothing against its speed.
ClosedPath closed_path(const std::string& frame, ElementReference reference) {
  const int dim = frame == "3d" ? 3 : 2;
  const Mesh mesh = block_mesh(dim, {1, 1, 1}, {2, 2, 2}, {1, 1, 1});
  MeshRun run{text_of(frame, "[0, 0, 0]"),
              mesh,
              {"time.first_step=1e-7", "time.max_step=1e-7"},
              {},
              0.9,
              reference};
  std::mt19937 random{11};
  std::uniform_real_distribution<double> move{-0.03, 0.03};
  std::vector<Triple> one(mesh.nodes.size()), two = one;
  for (auto* side : {&one, &two})
    for (Triple& u : *side)
      for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) u[a] = move(random) / 1e-7;
  const auto back = [](std::vector<Triple> v) {
    for (Triple& u : v)
      for (double& component : u) component = -component;
    return v;
  };
  ClosedPath out;
  for (const auto& v : {one, two, back(one), back(two)}) {
    set_velocities(run, v);
    run.step(1);
    out.greatest = std::max(out.greatest, greatest_hold(run));
  }
  out.left = greatest_hold(run);
  return out;
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("mesh: on other references momentum, spin and energy are exact too") {
    for (const std::string frame : {"3d", "plane_strain", "axisymmetric"})
      for (int trial = 0; trial < 6; ++trial) {
        const auto kind = static_cast<HourglassOptions::Kind>(trial % 3);
        const auto on = trial < 3 ? kInitial : kAdaptive;
        CAPTURE(frame);
        CAPTURE(trial);
        const int dim = frame == "3d" ? 3 : 2;
        const std::string v = dim == 3 ? "[\"0.1*y\", \"-0.1*x\", \"0.1*sin(3*x*y)\"]"
                              : frame == "axisymmetric" ? "[\"-0.1*r\", \"0.1*sin(4*r)\"]"
                                                        : "[\"0.2*z\", \"-0.2*x + 0.1*sin(4*x)\"]";
        MeshRun run{text_of(frame, v, ", viscosity: {}"),
                    shaken(block_mesh(dim, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}), 0.05, 5),
                    {},
                    {.kind = kind},
                    0.9,
                    on,
                    0.01};
        const Momenta start = momenta_of(run);
        for (int i = 0; i < 200; ++i) run.step(100);
        const Momenta end = momenta_of(run);
        const bool round = frame == "axisymmetric";  // across the axis it is no momentum
        for (std::size_t a = round ? 1 : 0; a < 3; ++a)
          CHECK(std::abs(end.momentum[a] - start.momentum[a]) < (round ? 1e-12 : 1e-14));
        if (!round) CHECK(std::abs(end.about - start.about) < 1e-13);
        CHECK(std::abs(run.energy_change()) < 1e-13 * run.audit().initial_kinetic);
        CHECK(run.audit().internal > 0.005 * run.audit().initial_kinetic);
        // Of 27, or 9, elements.
        CHECK((run.audit().new_references > 18) == (on == kAdaptive));
      }
  }

  TEST_CASE("mesh: a brick in affine motion is the same on both references") {
    for (const std::string frame : {"3d", "plane_strain"}) {
      CAPTURE(frame);
      const int dim = frame == "3d" ? 3 : 2;
      const std::string v = dim == 3 ? "[\"0.3*x + 0.2*y\", \"-0.1*y + 0.1*z\", \"-0.2*x\"]"
                                     : "[\"0.3*x + 0.2*z\", \"-0.1*z - 0.2*x\"]";
      const Mesh mesh = block_mesh(dim, {0, 0, 0}, {1, 0.7, 1.2}, {1, 1, 1});
      MeshRun now{text_of(frame, v), mesh, {"time.max_step=0.02"}, {}, 0.9, kCurrent},
          start{text_of(frame, v), mesh, {"time.max_step=0.02"}, {}, 0.9, kInitial};
      for (int i = 0; i < 60; ++i)
        for (MeshRun* run : {&now, &start}) run->step(100);
      REQUIRE(now.dt() == start.dt());
      REQUIRE(std::abs(now.column(field::Density::info)[0] - 1) > 0.02);
      CHECK(start.column(field::Density::info)[0] ==
            doctest::Approx(now.column(field::Density::info)[0]).epsilon(1e-12));
      for (int k = 0; k < 6; ++k)
        CHECK(std::abs(start.column(field::DeviatoricStress::info, k)[0] -
                       now.column(field::DeviatoricStress::info, k)[0]) < 1e-13);
      for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
        for (std::size_t a = 0; a < 3; ++a)
          CHECK(std::abs(start.mesh().position(0, n)[a] - now.mesh().position(0, n)[a]) < 1e-13);
    }
  }

  // On the current one 6 to 7 % of the greatest force are left (a trial of the design), on the
  // initial one nothing but for nu, which is that of rho c^2: the volume changes by some 6 %, and
  // 1/(1 - nu) by 1.4 %.
  TEST_CASE("mesh: on the initial reference a closed path leaves no hourglass") {
    for (const std::string frame : {"3d", "plane_strain"}) {
      CAPTURE(frame);
      const ClosedPath now = closed_path(frame, kCurrent), start = closed_path(frame, kInitial);
      MESSAGE(frame, ": left of the greatest, current ", now.left / now.greatest, ", initial ",
              start.left / start.greatest);
      CHECK(now.left > 0.03 * now.greatest);
      CHECK(start.left < 0.014 * start.greatest);
    }
  }

  TEST_CASE("mesh: on the initial reference a turn of 64 degrees strains nothing") {
    const double angle = 64 * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
    for (const std::string frame : {"3d", "plane_strain"}) {
      const int dim = frame == "3d" ? 3 : 2;
      const Mesh mesh = shaken(block_mesh(dim, {1, 1, 1}, {2, 2, 2}, {2, 2, 2}), 0.1, 4);
      MeshRun run{text_of(frame, "[0, 0, 0]"),
                  mesh,
                  {"time.first_step=1e-7", "time.max_step=1e-7"},
                  {},
                  0.9,
                  kInitial};
      std::vector<Triple> v;
      for (const Triple& x : mesh.nodes)
        v.push_back({((c - 1) * x[0] - s * x[1]) / 1e-7, (s * x[0] + (c - 1) * x[1]) / 1e-7, 0});
      set_velocities(run, v);
      run.step(1);
      for (const double p : run.column(field::Pressure::info)) CHECK(std::abs(p) < 1e-14);
      for (int k = 0; k < 6; ++k)
        for (const double stress : run.column(field::DeviatoricStress::info, k))
          CHECK(std::abs(stress) < 1e-14);
      CHECK(greatest_hold(run) < 1e-14);
    }
  }
}
