// SPDX-License-Identifier: GPL-3.0-or-later
// Points among cells of several levels: what is exact on one level is exact on many.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "krater/core/parallel.hpp"
#include "verification/run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

const char* const kMetal =
    "{metal: {density: 2700, youngs_modulus: 70 GPa, poisson_ratio: 0.3, strength: elastic, eos: "
    "{mie_gruneisen_shock: {c0: 5350 m/s, S1: 1.34, gamma0: 2}}}}";

/// A block that flies from coarse cells through a region of level 1 with one of level 2 in it, past
/// edges and corners.
std::string flight(int dimension) {
  const std::string y = dimension == 3 ? "3 mm, " : "", top = dimension == 3 ? "9 mm, " : "";
  const auto point = [&](const std::string& x, const std::string& mid, const std::string& z) {
    return dimension == 3 ? "[" + x + ", " + mid + ", " + z + "]" : "[" + x + ", " + z + "]";
  };
  return std::string{"frame: "} + (dimension == 3 ? "3d" : "plane_strain") +
         "\ngrid:\n  cell: 1 mm\n  box: {min: " + point("0", "0", "0") +
         ", max: " + point("48 mm", "12 mm", "40 mm") +
         "}\n  refine:\n    - {region: {box: {min: " + point("18 mm", "0", "8 mm") +
         ", max: " + point("36 mm", "12 mm", "26 mm") + "}}, level: 1}\n" +
         "    - {region: {box: {min: " + point("24 mm", "4 mm", "14 mm") +
         ", max: " + point("30 mm", "12 mm", "20 mm") + "}}, level: 2}\n" +
         "time: {end: 1 s}\nmaterials: " + kMetal +
         "\nbodies: {block: {material: metal, velocity: " + point("100 m/s", "0 m/s", "60 m/s") +
         ", shape: {box: {min: " + (dimension == 3 ? "[6 mm, 3 mm, 4 mm]" : "[6 mm, -1, 4 mm]") +
         ", max: " + (dimension == 3 ? "[12 mm, 9 mm, 10 mm]" : "[12 mm, 1, 10 mm]") + "}}}}\n";
}

double spread(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("levels: a block flies through three levels, edges and corners, and is split") {
    Run run = start_text(flight(2));
    const Totals start = run.sim->totals();
    run_to(run, 200e-6);
    const Totals end = run.sim->totals();
    CHECK(run.sim->audit().split_points > 500);
    CHECK(end.count == start.count + run.sim->audit().split_points);
    CHECK(std::abs(end.mass - start.mass) < 1e-14 * start.mass);
    for (const int a : {0, 1}) {
      CHECK(spread(column(run, field::Velocity::info, a)) < 1e-11);
      CHECK(std::abs(end.momentum[static_cast<std::size_t>(a)] -
                     start.momentum[static_cast<std::size_t>(a)]) < 1e-12 * start.momentum[0]);
    }
    CHECK(spread(column(run, field::Pressure::info)) < 1e-13 * 2700 * 5350 * 5350);
    const std::vector<double> ids = column(run, field::Id::info);
    CHECK(std::adjacent_find(ids.begin(), ids.end()) == ids.end());
  }

  TEST_CASE("levels: a linear field is seen exactly across faces, edges and corners") {
    for (const int dimension : {2, 3}) {
      // over three levels at once
      Run run = start_text(
          flight(dimension),
          {dimension == 3 ? "bodies.block.velocity=[\"3e3*x-1e3*y+2e3*z\", \"5e2*x+z*1e3\", "
                            "\"4e3*y-2e3*z\"]"
                          : "bodies.block.velocity=[\"3e3*x+2e3*z\", \"1e3*x-2e3*z\"]",
           dimension == 3
               ? "bodies.block.shape={box: {min: [16 mm, 2 mm, 6 mm], max: [32 mm, 10 mm, 22 mm]}}"
               : "bodies.block.shape={box: {min: [14 mm, -1, 4 mm], max: [34 mm, 1, 24 mm]}}"});
      std::vector<std::vector<double>> before;
      for (int k = 0; k < dimension * dimension; ++k)
        before.push_back(column(run, field::AffineVelocity::info, k));
      double scale = 0, worst = 0, fastest = 0;
      for (int a = 0; a < dimension; ++a)
        for (const double v : column(run, field::Velocity::info, a))
          fastest = std::max(fastest, std::abs(v));
      run_steps(run, 1);
      REQUIRE(run.sim->grid().levels().count() == 3);
      for (int k = 0; k < dimension * dimension; ++k) {
        const std::vector<double> after = column(run, field::AffineVelocity::info, k);
        for (std::size_t i = 0; i < after.size(); ++i) {
          scale = std::max(scale, std::abs(before[static_cast<std::size_t>(k)][i]));
          worst = std::max(worst, std::abs(after[i] - before[static_cast<std::size_t>(k)][i]));
        }
      }
      CHECK(scale > 1e3);
      // Rounding of v over a cell of level 2: with the observer (1 km/s more: 1130/137 as much) and
      // with 1/h it grows alike on one level, so neither is the ties' doing.
      CHECK(worst < 1e-14 * fastest * run.sim->grid().geometry(2).inv_h);
    }
  }

  TEST_CASE("levels: points split at the start have the velocity of their own places") {
    Run run = start_text(
        flight(2), {"bodies.block.velocity=[\"2e4*z*z\", \"1e4*x*x\"]",
                    "bodies.block.shape={box: {min: [14 mm, -1, 4 mm], max: [34 mm, 1, 24 mm]}}"});
    const std::vector<double> x = column(run, field::Position::info, 0),
                              z = column(run, field::Position::info, 1),
                              u = column(run, field::Velocity::info, 0),
                              w = column(run, field::Velocity::info, 1);
    REQUIRE(x.size() > 5000);
    double worst = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      worst =
          std::max({worst, std::abs(u[i] - 2e4 * z[i] * z[i]), std::abs(w[i] - 1e4 * x[i] * x[i])});
    CHECK(worst < 1e-13);  // of 12 m/s
  }

  TEST_CASE("levels: failed points see a crowd across an edge, and keep their gradient") {
    // They drop it where more than 0.4 of the mass they see is their own: tied nodes hold none.
    Run run = start_text(
        flight(2), {"materials.metal.spall_strength=2 GPa",
                    "bodies.block.velocity=[\"3e3*x+2e3*z\", \"1e3*x-2e3*z\"]",
                    "bodies.block.shape={box: {min: [14 mm, -1, 4 mm], max: [34 mm, 1, 24 mm]}}"});
    std::vector<double> failed = column(run, field::Failed::info);
    REQUIRE(failed.size() > 1000);
    std::fill(failed.begin(), failed.end(), 1.0);
    set_column(run, field::Failed::info, 0, failed);
    std::vector<double> before[4];
    for (int k = 0; k < 4; ++k) before[k] = column(run, field::AffineVelocity::info, k);
    const std::vector<double> x = column(run, field::Position::info, 0),
                              z = column(run, field::Position::info, 1);
    run_steps(run, 1);
    double worst = 0;
    int looked_at = 0;
    for (int k = 0; k < 4; ++k) {
      const std::vector<double> after = column(run, field::AffineVelocity::info, k);
      for (std::size_t i = 0; i < x.size(); ++i) {
        if (x[i] < 16e-3 || x[i] > 32e-3 || z[i] < 6e-3 || z[i] > 22e-3) continue;  // no surface
        worst = std::max(worst, std::abs(after[i] - before[k][i]));
        ++looked_at;
      }
    }
    CHECK(looked_at > 4000);
    CHECK(worst < 1e-8);  // of 3e3 1/s
  }

  TEST_CASE("levels: one level of half the cells everywhere is a grid of half the cells") {
    // Nodes of level 1 lie half a fine cell from the planes: so does a grid whose box begins there.
    const std::string scene =
        "frame: plane_strain\ntime: {end: 1 s}\nmaterials: " + std::string{kMetal} +
        "\nbodies: {block: {material: metal, velocity: [\"20+2e3*z\", \"16-2e3*x\"], shape: {box: "
        "{min: [4 mm, -1, 4 mm], max: [12 mm, 1, 10 mm]}}}}\n"
        "method: {stagger: false}\ngrid: ";
    Run fine = start_text(scene +
                          "{cell: 0.5 mm, box: {min: [-0.25 mm, -0.25 mm], max: [16.25 mm, "
                          "16.25 mm]}}");
    Run level =
        start_text(scene +
                   "{cell: 1 mm, box: {min: [0, 0], max: [16 mm, 16 mm]}, refine: [{region: {box: "
                   "{min: [0, 0], max: [16 mm, 16 mm]}}, level: 1}]}");
    CHECK(fine.sim->point_count() == level.sim->point_count());
    run_steps(fine, 300);
    run_steps(level, 300);
    for (const int a : {0, 1}) {
      std::vector<double> x = column(fine, field::Position::info, a),
                          y = column(level, field::Position::info, a);
      std::sort(x.begin(), x.end());
      std::sort(y.begin(), y.end());
      double worst = 0;
      for (std::size_t i = 0; i < x.size(); ++i) worst = std::max(worst, std::abs(x[i] - y[i]));
      CHECK(worst < 1e-12);  // of a body of 8 mm
    }
  }

  TEST_CASE("levels: half a model is half the whole, a plane of symmetry across the levels") {
    // Blocks of the whole are no mirror image of each other: edges across the plane only.
    const std::string rest =
        ", refine: [{region: {box: {min: [-8 mm, 3 mm], max: [8 mm, 9 mm]}}, level: 1}, {region: "
        "{box: {min: [-8 mm, 5 mm], max: [8 mm, 7 mm]}}, level: 2}]}\nframe: plane_strain\n"
        "method: {stagger: false}\n"
        "time: {end: 1 s}\nmaterials: " +
        std::string{kMetal} +
        "\nbodies: {block: {material: metal, velocity: [\"2e4*x\", \"1e4*z-2e3*abs(x)\"], shape: "
        "{box: {min: [-6 mm, -1, 2 mm], max: [6 mm, 1, 10 mm]}}}}\n";
    Run whole = start_text("grid: {cell: 1 mm, box: {min: [-8 mm, 0], max: [8 mm, 16 mm]}" + rest);
    Run half = start_text(
        "grid: {cell: 1 mm, box: {min: [0, 0], max: [8 mm, 16 mm]}, boundary: "
        "{x_min: symmetry}" +
        rest);
    run_steps(whole, 200);
    run_steps(half, 200);
    const Totals w = whole.sim->totals(), h = half.sim->totals();
    CHECK(2 * h.count == w.count);
    CHECK(std::abs(2 * h.kinetic - w.kinetic) < 1e-11 * w.kinetic);
    CHECK(std::abs(2 * h.internal - w.internal) < 1e-10 * w.internal);
    CHECK(std::abs(energy_residual(half)) < 1e-12 * w.kinetic);
  }
}
