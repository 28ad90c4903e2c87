// SPDX-License-Identifier: GPL-3.0-or-later
// Levels of cells: they nest to the last bit, and which nodes are tied is what the definition says.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "krater/grid/blocks.hpp"

namespace {

using namespace krater;

GridGeometry coarsest(int dimension) {
  GridGeometry g;
  g.dimension = dimension;
  g.h = 0.7e-3;
  g.inv_h = 1 / g.h;
  g.min = {-3.1e-3, 0.2e-3, 1.7e-3};
  g.cells = {37, 29, 31};
  return g;
}

/// Quadratic B-spline about 0, in its own cells.
double spline(double x) {
  const double a = std::abs(x);
  return a < 0.5 ? 0.75 - a * a : a < 1.5 ? 0.5 * (1.5 - a) * (1.5 - a) : 0;
}

/// A map with blocks at random, some of them two and three levels deep.
Levels random_map(int dimension, unsigned seed) {
  std::mt19937 random{seed};
  Levels levels{coarsest(dimension)};
  BlockSet wanted;
  const auto pick = [&](int end) {
    return static_cast<std::int32_t>(random() % static_cast<unsigned>(end));
  };
  for (int k = 0; k < 6; ++k) {
    BlockKey key{{pick(5), pick(4), dimension == 3 ? pick(8) : 0}};
    wanted.insert(key);
    for (int a = 0; a < dimension; ++a) {
      const auto i = static_cast<std::size_t>(a);
      key.i[i] = 2 * key.i[i] + pick(2);
    }
    key.level = 1;
    if (k % 2 == 0) wanted.insert(key);
    for (int a = 0; a < dimension; ++a) key.i[static_cast<std::size_t>(a)] *= 2;
    key.level = 2;
    if (k % 4 == 0) wanted.insert(key);
  }
  levels.set(wanted);
  return levels;
}

/// Is the cell of level l at t (in its knots) in R_l? Straight from the definition: walk down from
/// the coarsest block that holds it.
bool in_refined_space(const Levels& levels, std::array<int, 3> cell, int level) {
  const GridGeometry& g = levels.geometry(level);
  const int edge = block_edge(g.dimension);
  for (int a = 0; a < g.dimension; ++a) {
    const auto k = static_cast<std::size_t>(a);
    const int first = static_cast<int>(g.origin), last = first + g.cells[k] - 1;
    if (cell[k] < first) cell[k] = 2 * first - 1 - cell[k];
    if (cell[k] > last) cell[k] = 2 * last + 1 - cell[k];
  }
  for (int l = 0; l < level; ++l) {
    BlockKey key;
    key.level = l;
    for (int a = 0; a < g.dimension; ++a) {
      const auto k = static_cast<std::size_t>(a);
      key.i[k] = static_cast<int>(std::floor(cell[k] / std::ldexp(1.0, level - l) / edge));
    }
    if (!levels.is_refined(key)) return false;
  }
  return true;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("levels: cells nest to the last bit, faces included") {
    Levels levels = random_map(3, 1);
    std::mt19937_64 random{7};
    std::uniform_real_distribution<double> in{0, 1};
    const GridGeometry& g = levels.geometry();
    int checked = 0;
    for (int k = 0; k < 300000; ++k) {
      double x = g.min[0] + in(random) * (g.upper(0) - g.min[0]);
      if (k % 3 == 0)  // on or beside a knot of the finest level
        x = g.min[0] + std::floor(in(random)*8 * g.cells[0]) / 8 * g.h;
      if (k % 3 == 1) x = std::nextafter(x, in(random) < 0.5 ? 1.0 : -1.0);
      double coarse = std::floor(g.knots(x, 0));
      for (int l = 1; l < levels.count(); ++l) {
        const double fine = std::floor(levels.geometry(l).knots(x, 0));
        checked += std::floor(fine / 2) == coarse;
        coarse = fine;
      }
    }
    CHECK(levels.count() == 4);
    CHECK(checked == 3 * 300000);
  }

  TEST_CASE("levels: a function of the coarse grid is one of the fine grid") {
    double worst = 0;
    for (int n = -2; n <= 2; ++n)
      for (double x = -2; x <= 2; x += 0.01) {
        // node J = 0 of the coarse grid lies at t = -1/2; children -2 .. 1 at (2 t) = n - 1/2
        const double w[4] = {0.25, 0.75, 0.75, 0.25};
        double sum = 0;
        for (int k = 0; k < 4; ++k) sum += w[k] * spline(2 * x - (k - 2 - 0.5));
        worst = std::max(worst, std::abs(sum - spline(x + 0.5)));
      }
    CHECK(worst < 1e-15);
  }

  TEST_CASE("levels: tied nodes are those whose support leaves the refined space, masters never") {
    for (const int dimension : {2, 3}) {
      int tied_nodes = 0, wrong = 0, tied_masters = 0;
      for (unsigned seed = 1; seed <= 6; ++seed) {
        const Levels levels = random_map(dimension, seed);
        const int edge = block_edge(dimension);
        for (const BlockKey& parent : levels.refined())
          for (int slot = 0; slot < neighbour_count(dimension); ++slot) {
            BlockKey key = shifted(parent, slot, dimension);
            for (int a = 0; a < dimension; ++a) key.i[static_cast<std::size_t>(a)] *= 2;
            key.level += 1;
            const std::uint64_t tied = levels.tied_nodes(key);
            for (int n = 0; n < kBlockNodes; ++n) {
              std::array<int, 3> node{};
              for (int a = dimension - 1, rest = n; a >= 0; --a, rest /= edge)
                node[static_cast<std::size_t>(a)] =
                    key.i[static_cast<std::size_t>(a)] * edge + rest % edge;
              int inside = 0;
              for (int s = 0; s < neighbour_count(dimension); ++s) {
                std::array<int, 3> cell = node;
                for (int a = 0; a < dimension; ++a)
                  cell[static_cast<std::size_t>(a)] += slot_offset(s, a, dimension) - 1;
                inside += in_refined_space(levels, cell, key.level);
              }
              const bool is_tied = (tied >> n & 1U) != 0;
              wrong += is_tied != (inside < neighbour_count(dimension));
              if (!is_tied || inside == 0) continue;  // no fine point sees it
              ++tied_nodes;
              for (int c = 0; c < corner_count(dimension) && key.level > 1; ++c) {
                BlockKey above;
                above.level = key.level - 1;
                int local = 0;
                for (int a = 0; a < dimension; ++a) {
                  const auto k = static_cast<std::size_t>(a);
                  const int J = floor_div(node[k], 2) + corner_offset(c, a);
                  above.i[k] = floor_div(J, edge);
                  local = local * edge + J - above.i[k] * edge;
                }
                tied_masters += (levels.tied_nodes(above) >> local & 1U) != 0;
              }
            }
          }
      }
      CHECK(tied_nodes > 1000);
      CHECK(wrong == 0);
      CHECK(tied_masters == 0);
    }
  }
}
