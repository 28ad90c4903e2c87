// SPDX-License-Identifier: GPL-3.0-or-later
// Points that are split: what is kept, and where the parts stand.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "krater/kinematics/mpm/split.hpp"

namespace {

using namespace krater;

/// A record of id, mass, position, velocity, density, L and e.
PointColumns columns(int dimension) {
  PointColumns c;
  int at = kLanes;  // after the id
  const auto take = [&at](int components) {
    const int offset = at;
    at += components * kLanes;
    return offset;
  };
  c.mass = take(1);
  c.position = take(dimension);
  c.velocity = take(dimension);
  c.density = take(1);
  c.affine = take(dimension * dimension);
  c.energy = take(1);
  c.stride = at;
  return c;
}

double at(const Arrival& point, int offset, int k = 0) {
  return point.record[static_cast<std::size_t>(offset / kLanes + k)];
}

Levels all_refined(int dimension, int depth) {
  GridGeometry g;
  g.dimension = dimension;
  g.h = 0.5;
  g.inv_h = 1 / g.h;
  g.cells = {16, 16, dimension == 3 ? 16 : 0};
  Levels levels{g};
  BlockSet wanted;
  for (int l = 0; l < depth; ++l) {
    const int blocks = (16 << l) / block_edge(dimension) + 1;
    for (int i = 0; i <= blocks; ++i)
      for (int j = 0; j <= blocks; ++j)
        for (int k = 0; k <= (dimension == 3 ? blocks : 0); ++k) wanted.insert({{i, j, k}, l});
  }
  levels.set(wanted);
  return levels;
}

Arrival point_of(const Levels& levels, const PointColumns& c, unsigned seed) {
  std::mt19937_64 random{seed};
  std::uniform_real_distribution<double> in{-1, 1};
  const int dimension = levels.geometry().dimension;
  Arrival out;
  out.record.assign(static_cast<std::size_t>(c.stride / kLanes), 0.0);
  for (double& x : out.record) x = in(random);
  const auto set = [&](int offset, double x) {
    out.record[static_cast<std::size_t>(offset / kLanes)] = x;
  };
  set(c.density, 3);
  set(c.mass, 3 * std::pow(0.25, dimension));
  for (int a = 0; a < dimension; ++a)
    set(c.position + kLanes * a, 4 + 0.25 * at(out, c.position, a));
  out.key = levels.block_at(out.record.data() + c.position / kLanes);
  return out;
}

struct Sums {
  double mass = 0, heat = 0;
  Triple momentum{}, centre{}, turning{};  ///< turning: of axes (0, 1), (0, 2), (1, 2)
};

Sums sums(const std::vector<Arrival>& points, const Levels& levels, const PointColumns& c) {
  Sums out;
  const int dimension = levels.geometry().dimension;
  for (const Arrival& p : points) {
    const double m = at(p, c.mass), h = levels.geometry(p.key.level).h;
    out.mass += m;
    out.heat += m * at(p, c.energy);
    for (int a = 0; a < dimension; ++a) {
      out.momentum[static_cast<std::size_t>(a)] += m * at(p, c.velocity, a);
      out.centre[static_cast<std::size_t>(a)] += m * at(p, c.position, a);
      for (int b = a + 1; b < dimension; ++b)
        out.turning[static_cast<std::size_t>(a + b - 1)] +=
            m * (at(p, c.position, a) * at(p, c.velocity, b) -
                 at(p, c.position, b) * at(p, c.velocity, a)) +
            m * 0.25 * h * h *
                (at(p, c.affine, dimension * b + a) - at(p, c.affine, dimension * a + b));
    }
  }
  return out;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("split: parts keep mass, momentum and centre; staggered ones turn as plain ones do") {
    for (const int dimension : {2, 3})
      for (const int depth : {1, 2}) {
        const Levels levels = all_refined(dimension, depth);
        const PointColumns c = columns(dimension);
        PointSize size{3, {2, 2, 2}, false, true, 100};
        Arrival whole = point_of(levels, c, 5);
        REQUIRE(whole.key.level == depth);
        const Sums before = sums({whole}, levels, c);
        std::vector<Arrival> plain, staggered;
        const double heat = arrive(levels, c, size, 0, whole, plain);
        whole.inside = true;
        arrive(levels, c, size, 0, whole, staggered);
        CHECK(staggered.size() == std::pow(corner_count(dimension), depth));
        const Sums p = sums(plain, levels, c), s = sums(staggered, levels, c);
        CHECK(std::abs(s.mass - before.mass) < 1e-15);
        CHECK(std::abs(p.heat - before.heat - heat) < 1e-15);
        for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
          CHECK(std::abs(s.momentum[a] - before.momentum[a]) < 1e-15);
          CHECK(std::abs(s.centre[a] - before.centre[a]) < 1e-15);
        }
        double worst = 0;
        for (std::size_t k = 0; k < (dimension == 3 ? 3U : 1U); ++k)
          worst = std::max(worst, std::abs(s.turning[k] - p.turning[k]));
        if (depth == 1) CHECK(worst < 1e-15);  // a second one begins with another L
      }
  }

  TEST_CASE("split: columns of a staggered lattice are staggered again") {
    // Parents of spacing 1/4, odd columns half of that higher; parts have spacing 1/8.
    const Levels levels = all_refined(2, 1);
    const PointColumns c = columns(2);
    PointSize size{3, {2, 2, 2}, false, true, 100};
    std::vector<double> heights;  // over the spacing, by column of parts
    for (int column = 0; column < 4; ++column) {
      Arrival whole = point_of(levels, c, 1);
      whole.inside = true;
      whole.record[static_cast<std::size_t>(c.position / kLanes)] = 2.125 + 0.25 * column;
      whole.record[static_cast<std::size_t>(c.position / kLanes + 1)] =
          2.125 + 0.125 * (column % 2);
      std::vector<Arrival> parts;
      arrive(levels, c, size, 0, whole, parts);
      for (const int lower : {0, 1})
        heights.push_back(8 * at(parts[static_cast<std::size_t>(lower)], c.position, 1));
    }
    for (std::size_t k = 0; k + 1 < heights.size(); ++k) {
      const double apart = heights[k + 1] - heights[k];
      CHECK(std::abs(std::abs(apart - std::round(apart)) - 0.5) < 1e-12);
    }
  }
}
