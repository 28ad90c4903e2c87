// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of elements that lie on themselves (kinematics/mesh/mesh_health.hpp).
#include <doctest/doctest.h>

#include <cmath>

#include "verification/mesh_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

/// Two blocks of one body, a gap apart, that fly at each other.
MeshRun pair_of_blocks(int dim) {
  const bool space = dim == 3;
  const Vector3 low{-2e-3, space ? -2e-3 : -3e-3, space ? -3e-3 : 0},
      high{2e-3, space ? 2e-3 : -1e-3, space ? -1e-3 : 0};
  Mesh mesh =
      block_mesh(dim, low, high, space ? std::array<int, 3>{4, 4, 2} : std::array<int, 3>{4, 2, 1});
  Mesh upper = mesh;
  const auto first = static_cast<std::int32_t>(mesh.nodes.size());
  for (Vector3& x : upper.nodes) {
    x[static_cast<std::size_t>(dim - 1)] += 4e-3;
    mesh.nodes.push_back(x);
  }
  for (const std::int32_t n : upper.elements) mesh.elements.push_back(first + n);
  const std::string box = space ? "[-8 mm, -8 mm, -8 mm], max: [8 mm, 8 mm, 8 mm]"
                                : "[-8 mm, -8 mm], max: [8 mm, 8 mm]",
                    inside = space ? "[-2 mm, -2 mm, -3 mm], max: [2 mm, 2 mm, 3 mm]"
                                   : "[-2 mm, -3 mm], max: [2 mm, 3 mm]",
                    velocity = space ? "[0, 0, \"-100*z/abs(z)\"]" : "[0, \"-100*z/abs(z)\"]";
  return MeshRun{std::string{"frame: "} + (space ? "3d" : "plane_strain") +
                     "\ngrid: {cell: 1 mm, box: {min: " + box +
                     "}}\ntime: {end: 20 us, energy_error: off}\n"
                     "materials: {metal: {density: 8000, youngs_modulus: 100 GPa, poisson_ratio: "
                     "0.3, eos: linear, strength: elastic}}\n"
                     "bodies: {two: {material: metal, velocity: " +
                     velocity + ", shape: {box: {min: " + inside +
                     "}}, kinematics: lagrangian_mesh}}\n",
                 mesh};
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("mesh overlap: what lies on itself is found, and nothing else") {
    for (const int dim : {2, 3}) {
      CAPTURE(dim);
      MeshRun run = pair_of_blocks(dim);
      CHECK(run.mesh().overlap(1e-3).nodes == 0);
      run.run_to(9.9e-6);  // about to touch
      CHECK(run.mesh().overlap(1e-3).nodes == 0);
      run.run_to(16e-6);  // 0.6 mm deep on each side
      const MeshOverlap found = run.mesh().overlap(1e-3);
      CHECK(found.nodes > 0);
      CHECK(found.most > 1.5);
      CHECK(std::abs(found.place[static_cast<std::size_t>(dim - 1)]) < 0.5e-3);
    }
  }

  // Full or not of a cell, sheared, of any size beside the cell: filled once.
  TEST_CASE("mesh overlap: a distorted mesh fills once") {
    for (const double size : {0.4e-3, 1e-3, 2.5e-3, 10e-3}) {
      CAPTURE(size);
      const int n = static_cast<int>(std::lround(10e-3 / size));
      Mesh mesh = block_mesh(2, {-5e-3, -5e-3, 0}, {5e-3, 5e-3, 0}, {n, n, 1});
      for (Vector3& x : mesh.nodes) {
        const Vector3 from = x;
        x[0] += 0.3e-3 * std::sin(900 * from[1]) + 0.4 * from[1] + 0.37e-3;
        x[1] += 0.3e-3 * std::sin(700 * from[0]);
      }
      MeshRun run{
          "frame: plane_strain\ngrid: {cell: 1 mm, box: {min: [-9 mm, -9 mm], max: [9 mm, 9 "
          "mm]}}\ntime: {end: 1 us}\nmaterials: {metal: {density: 8000, youngs_modulus: 100 GPa, "
          "poisson_ratio: 0.3, eos: linear, strength: elastic}}\nbodies: {one: {material: metal, "
          "shape: {box: {min: [-5 mm, -5 mm], max: [5 mm, 5 mm]}}, kinematics: "
          "lagrangian_mesh}}\n",
          mesh};
      CHECK(run.mesh().overlap(1e-3).nodes == 0);
    }
  }
}
