// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies must not push before they touch, wherever corner, edge or face lie on the grid, and
// whichever way they move; where they touch the normal must be theirs. One step at each gap: what
// has no pair of nodes in contact has no force.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "verification/run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

/// Two bodies (shapes, in cells) that touch; `apart` moves the second one away.
struct Meeting {
  const char *name, *target, *striker;
  std::array<double, 3> apart;
  bool touches;  ///< the grid sees contact at once; a tip narrower than a cell goes deeper first
};

std::string moved(const char* shape, const std::array<double, 3>& by) {
  std::string at;
  for (const double x : by) at += (at.empty() ? "" : ", ") + std::to_string(x);
  return std::string{"{move: {by: ["} + at + "], shape: " + shape + "}}";
}

/// The most pairs of nodes that push, for some directions of the striker's velocity. The cell is
/// 1 m.
int pairs(const std::string& frame, const Meeting& m, double gap,
          const std::array<double, 3>& offset) {
  std::array<double, 3> away = offset;
  for (std::size_t a = 0; a < 3; ++a) away[a] += gap * m.apart[a];
  const bool flat = frame != "3d", round = frame == "axisymmetric";
  const std::string low = round ? "[0, -9]" : flat ? "[-9, -9]" : "[-9, -9, -9]";
  Run run = start_text(
      "frame: " + frame + "\ngrid: {cell: 1, box: {min: " + low + ", max: " +
      (flat ? "[9, 9]" : "[9, 9, 9]") + "}" + (round ? ", boundary: {r_min: axis}" : "") +
      "}\ntime: {end: 1}\nmaterials: {steel: {density: 7850, youngs_modulus: 200e9, "
      "poisson_ratio: 0.3, eos: linear, strength: elastic}}\nbodies:\n  target: {material: steel, "
      "thin: allowed, shape: " +
      moved(m.target, offset) + "}\n  striker: {material: steel, thin: allowed, shape: " +
      moved(m.striker, away) + "}\ncontact: {}\n");
  int most = 0;
  for (const std::array<double, 2>& v :
       std::vector<std::array<double, 2>>{{0, -20}, {20, 0}, {-20, 0}, {14, -14}, {-14, -14}}) {
    for (int body = 0; body < 2; ++body)
      for (int c = 0; c < (flat ? 2 : 3); ++c) {
        std::vector<double> values = column(run, field::Velocity::info, c, body);
        const double speed = c == 0 ? v[0] : (c == (flat ? 1 : 2) ? v[1] : 0);
        values.assign(values.size(), body == 1 ? speed : 0);
        set_column(run, field::Velocity::info, c, values, body);
      }
    run.sim->step(1e-9);
    most = std::max(most, static_cast<int>(run.sim->audit().contact_pairs));
  }
  return most;
}

void sweep(const std::string& frame, const std::vector<Meeting>& meetings,
           const std::vector<std::array<double, 3>>& offsets) {
  for (const Meeting& m : meetings)
    for (const std::array<double, 3>& offset : offsets) {
      CAPTURE(std::string{m.name});
      CAPTURE(offset[0]);
      CAPTURE(offset[1]);
      CAPTURE(offset[2]);
      for (const double gap : {2.0, 1.4, 1.0, 0.9, 0.7, 0.5, 0.25}) {
        CAPTURE(gap);
        CHECK(pairs(frame, m, gap, offset) == 0);
      }
      if (m.touches) CHECK(pairs(frame, m, 1e-3, offset) > 0);
    }
}

/// Thirty wedges about a node, the first of them wedge `first`. Wedges 28 and 29 approach each
/// other, every other two part. Momenta of these two along the grid, after a step.
std::array<double, 4> wedges(int first) {
  constexpr int kWedges = 30;
  const double width = 2 * std::numbers::pi / kWedges;
  std::string bodies;
  for (int i = 0; i < kWedges; ++i) {
    const int k = (first + i) % kWedges;
    const double a = (k + 0.13) * width, middle = a + 0.5 * width;
    double vx = 100 * std::cos(middle), vz = 100 * std::sin(middle);
    const double meet = a + (k == 28 ? width : 0);  // the face between the two
    const double push = k == 28 ? 25 : (k == 29 ? -25 : 0);
    vx -= push * std::sin(meet);
    vz += push * std::cos(meet);
    const auto corner = [&](double at) {
      return "[" + std::to_string(6 * std::cos(at)) + ", " + std::to_string(6 * std::sin(at)) + "]";
    };
    bodies += "  w" + std::to_string(k) +
              ": {material: steel, thin: allowed, shape: {extrusion: {axis: y, min: -1, max: 1, "
              "polygon: [[0, 0], " +
              corner(a) + ", " + corner(a + width) + "]}}, velocity: [" + std::to_string(vx) +
              ", " + std::to_string(vz) + "]}\n";
  }
  Run run = start_text(
      "frame: plane_strain\ngrid: {cell: 1, box: {min: [-12, -12], max: [12, 12]}}\ntime: {end: "
      "1}\nmaterials: {steel: {density: 7850, youngs_modulus: 200e9, poisson_ratio: 0.3, eos: "
      "linear, strength: elastic}}\nbodies:\n" +
      bodies + "contact: {}\n");
  run.sim->step(1e-9);
  const auto of = [&](int wedge) {
    return run.sim->totals((wedge - first + kWedges) % kWedges).momentum;
  };
  return {of(28)[0], of(28)[1], of(29)[0], of(29)[1]};
}

/// Largest velocity across the plane x = 0 (r = 0), or y = 0 in 3d, of the nodes on it.
double across(const BlockGrid& grid, int axis) {
  const GridGeometry& geometry = grid.geometry();
  const int edge = block_edge(geometry.dimension);
  double most = 0;
  for (const NodeBlock& block : grid.node_blocks())
    for (int n = 0; n < kBlockNodes; ++n) {
      int at = n;
      for (int a = geometry.dimension - 1; a > axis; --a) at /= edge;
      if (block.key.i[static_cast<std::size_t>(axis)] * edge + at % edge == 1)
        most = std::max(most, std::abs(block.nodes[kNodeDoubles * n + axis]));
    }
  return most;
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("no force before the gap closes: plane strain") {
    const char *plate = "{box: {min: [-6, -1, -3], max: [6, 1, 0]}}",
               *left = "{box: {min: [-5, -1, -4], max: [0, 1, 0]}}",
               *tilted =
                   "{rotate: {axis: y, angle: 20 degree, shape: {box: {min: [-5, -1, -3], max: [5, "
                   "1, 0]}}}}";
    std::vector<std::array<double, 3>> offsets;
    for (const double x : {0.0, 0.25, 0.5, 0.7})
      for (const double z : {0.0, 0.3, 0.5, 0.75}) offsets.push_back({x, 0, z});
    sweep(
        "plane_strain",
        {{"face", plate, "{box: {min: [-3, -1, 0], max: [3, 1, 4]}}", {0, 0, 1}, true},
         {"overhang", left, "{box: {min: [-2, -1, 0], max: [4, 1, 4]}}", {0, 0, 1}, true},
         {"narrow overhang", left, "{box: {min: [-0.6, -1, 0], max: [4, 1, 4]}}", {0, 0, 1}, true},
         {"beside", left, "{box: {min: [0, -1, -1.5], max: [5, 1, 3]}}", {1, 0, 0}, true},
         {"corners", left, "{box: {min: [0, -1, 0], max: [5, 1, 5]}}", {0.7071, 0, 0.7071}, false},
         {"thin",
          "{box: {min: [-6, -1, -1.5], max: [6, 1, 0]}}",
          "{box: {min: [-3, -1, 0], max: [3, 1, 1.5]}}",
          {0, 0, 1},
          true},
         {"wedge",
          plate,
          "{extrusion: {axis: y, min: -1, max: 1, polygon: [[0, 0], [3, 4], [-3, 4]]}}",
          {0, 0, 1},
          false},
         {"tip",
          plate,
          "{rotate: {axis: y, angle: -45 degree, shape: {box: {min: [0, -1, 0], max: [4, 1, 4]}}}}",
          {0, 0, 1},
          false},
         {"disc",
          plate,
          "{cylinder: {radius: 4, height: 2, axis: y, base: [0, -1, 4]}}",
          {0, 0, 1},
          false},
         {"oblique faces",
          tilted,
          "{rotate: {axis: y, angle: 20 degree, shape: {box: {min: [-3, -1, 0], max: [3, 1, 3]}}}}",
          {0.34202, 0, 0.93969},
          true}},
        offsets);
  }

  TEST_CASE("no force before the gap closes: axisymmetric") {
    sweep("axisymmetric",
          {{"rod",
            "{cylinder: {radius: 6, height: 3, base: [0, -3]}}",
            "{cylinder: {radius: 3, height: 4, base: [0, 0]}}",
            {0, 0, 1},
            true},
           {"ring",
            "{cylinder: {radius: 6, height: 3, base: [0, -3]}}",
            "{tube: {inner_radius: 2, outer_radius: 4, height: 4, base: [0, 0]}}",
            {0, 0, 1},
            true},
           {"cone",
            "{cylinder: {radius: 6, height: 3, base: [0, -3]}}",
            "{cone: {radius: 0, top_radius: 3, height: 4, base: [0, 0]}}",
            {0, 0, 1},
            false}},
          {{0, 0, 0}, {0, 0, 0.3}, {0, 0, 0.5}, {0, 0, 0.75}});
  }

  TEST_CASE("no force before the gap closes: 3d") {
    const char *plate = "{box: {min: [-4, -4, -3], max: [4, 4, 0]}}",
               *low = "{box: {min: [-4, -4, -4], max: [0, 0, 0]}}";
    sweep(
        "3d",
        {{"face", plate, "{box: {min: [-2, -2, 0], max: [2, 2, 3]}}", {0, 0, 1}, true},
         {"overhang", low, "{box: {min: [-2, -2, 0], max: [2, 2, 3]}}", {0, 0, 1}, true},
         {"edges", low, "{box: {min: [0, -3, 0], max: [3, 1, 3]}}", {0.7071, 0, 0.7071}, false},
         {"corners",
          low,
          "{box: {min: [0, 0, 0], max: [3, 3, 3]}}",
          {0.5774, 0.5774, 0.5774},
          false},
         {"edge down",
          plate,
          "{rotate: {axis: y, angle: -45 degree, shape: {box: {min: [0, -2, 0], max: [3, 2, 3]}}}}",
          {0, 0, 1},
          false}},
        {{0, 0, 0}, {0.5, 0.3, 0.5}, {0.25, 0.7, 0.75}});
  }

  TEST_CASE("contact pushes no node of a symmetry plane across it") {
    // The joint lies beside the plane, where a rim meets a rim and the normal is oblique.
    const std::string head =
        "\ntime: {end: 1}\nmaterials: {steel: {density: 7850, youngs_modulus: "
        "200e9, poisson_ratio: 0.3, eos: linear, strength: elastic}}\n";
    const std::string round =
        "bodies:\n  target: {material: steel, thin: allowed, shape: {tube: {inner_radius: 0.8, "
        "outer_radius: 6, height: 3, base: [0, -3]}}}\n  striker: {material: steel, velocity: [0, "
        "-200], shape: {cone: {radius: 0.6, top_radius: 4, height: 4, base: [0, 0.01]}}}\ncontact: "
        "{friction: 0.3";
    for (const std::string normal : {"volume_gradient", "logistic_regression"})
      for (const bool axis : {true, false}) {
        CAPTURE(normal);
        CAPTURE(axis);
        Run run = start_text(std::string{axis ? "frame: axisymmetric" : "frame: plane_strain"} +
                             "\ngrid: {cell: 1, box: {min: [0, -9], max: [9, 9]}, boundary: {" +
                             (axis ? "r_min: axis" : "x_min: symmetry") + "}}" + head + round +
                             ", normal: " + normal + "}\n");
        const Totals start = run.sim->totals();
        double pushed = 0, most = 0;
        for (int i = 0; i < 60; ++i) {
          run.sim->step(1);
          pushed += run.sim->audit().contact_pairs;
          most = std::max(most, across(run.sim->grid(), 0));
        }
        REQUIRE(pushed > 5);
        CHECK(most == 0);
        CHECK(run.sim->totals().momentum[1] == doctest::Approx(start.momentum[1]).epsilon(1e-12));
      }
  }

  TEST_CASE("a node where thirty bodies meet, 435 pairs, knows each of them") {
    // Only one pair pushes, the last or the first of the pairs: nothing depends on their order.
    const std::array<double, 4> last = wedges(0), first = wedges(28);
    for (std::size_t k = 0; k < 4; ++k) CHECK(last[k] == doctest::Approx(first[k]).epsilon(1e-12));
  }

  TEST_CASE("without friction a block slides on, whatever the normals are made of") {
    // Lattices of the two bodies in different phases: the base ends elsewhere, columns in line.
    for (const std::string normal : {"volume_gradient", "logistic_regression"})
      for (const std::string end : {"0.05", "0.049", "0.0473"}) {
        Run run = start_text(
            "frame: plane_strain\ngrid: {cell: 0.001, box: {min: [-0.04, -0.012], max: [0.06, "
            "0.02]}}\ntime: {end: 1}\nmaterials: {steel: {density: 7850, youngs_modulus: 200e9, "
            "poisson_ratio: 0.3, eos: linear, strength: elastic}}\nbodies:\n  base: {material: "
            "steel, shape: {box: {min: [-0.03, -1, -0.01], max: [" +
            end +
            ", 1, 0]}}}\n  block: {material: steel, shape: {box: {min: [-0.01, -1, 0], max: "
            "[0.01, 1, 0.01]}}, velocity: [100, 0]}\ncontact: {friction: 0, normal: " +
            normal + "}\n");
        run_to(run, 1e-4);  // ten cells
        const Totals block = run.sim->totals(1);
        MESSAGE(normal, ", ", end, ": ", block.momentum[0] / block.mass, " m/s along, of 100; ",
                block.momentum[1] / block.mass, " m/s up");
        CHECK(block.momentum[0] / block.mass == doctest::Approx(100).epsilon(2e-4));
      }
  }
}
