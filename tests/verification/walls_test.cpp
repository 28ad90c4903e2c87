// SPDX-License-Identifier: GPL-3.0-or-later
// A wall holds all of what touches it, whatever lattice the points have come to: a column of nodes
// that is let go moves its points through the wall.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "verification/run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

/// Columns that the wall holds in the first step of a block of 40 cells that moves towards it. Its
/// columns of points lie in pairs (whole ones at the symmetry planes, images included), `depth`
/// cells lower and higher, `gap` cells above the wall.
double held(double depth, double gap) {
  Run run = start_text(
      "frame: plane_strain\ngrid: {cell: 1, box: {min: [0, 0], max: [40, 12]}, boundary: {x_min: "
      "symmetry, x_max: symmetry, z_min: {wall: {friction: 0}}}}\ntime: {end: 1}\nmaterials: "
      "{steel: {density: 7850, youngs_modulus: 200e9, poisson_ratio: 0.3, eos: linear, strength: "
      "elastic}}\nbodies: {block: {material: steel, shape: {box: {min: [0, -1, 0], max: [40, 1, "
      "6]}}, velocity: [0, -50]}}\nmethod: {points_per_direction: 1, stagger: false}\n");
  const std::vector<double> x = column(run, field::Position::info, 0);
  std::vector<double> z = column(run, field::Position::info, 1);
  for (std::size_t i = 0; i < z.size(); ++i)
    z[i] += gap + (std::lround(std::floor((x[i] + 1) / 2)) % 2 == 0 ? -depth : depth);
  set_column(run, field::Position::info, 1, z);
  run.sim->step(1e-9);
  return run.sim->audit().wall_columns;
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("a wall holds every column of an uneven lattice, and none before a gap closes") {
    for (const double depth : {0.0, 0.1, 0.2, 0.25}) {
      CAPTURE(depth);
      CHECK(held(depth, 0) == 41);
      CHECK(held(depth, 0.6) == 0);
    }
  }
}
