// SPDX-License-Identifier: GPL-3.0-or-later
// Points that become one: what is kept, and which do not.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "krater/kinematics/mpm/merge.hpp"
#include "krater/points/ledger_fields.hpp"
#include "krater/points/load_fields.hpp"

#include "cells_support.hpp"

namespace {

using namespace krater;

constexpr double kDensity = 3, kCell = 0.5;

/// Points of one body in a block of coarse cells, with a pressure, F and a damage.
struct Block {
  explicit Block(int dimension, bool hoop = false)
      : geometry{test::cells_of(dimension, kCell)},
        size{kDensity, {2, 2, 2}, hoop},
        layout{dimension} {
    constexpr const char* test = "test";
    layout.state<field::Id>(0, test);
    c.position = layout.state<field::Position>(0, test).offset;
    c.velocity = layout.state<field::Velocity>(0, test).offset;
    c.mass = layout.state<field::Mass>(0, test).offset;
    c.density = layout.state<field::Density>(0, test).offset;
    c.affine = layout.state<field::AffineVelocity>(0, test).offset;
    c.energy = layout.state<field::InternalEnergy>(0, test).offset;
    c.carried = layout.state<field::CarriedEnergy>(0, test).offset;
    c.pressure = layout.state<field::Pressure>(0, test).offset;
    c.deformation = layout.state<field::DeformationGradient>(0, test).offset;
    damage = layout.state<field::Damage>(0, test).offset;
    failed = layout.state<field::Failed>(0, test).offset;
    c.stride = layout.stride();
    body.columns = c;
    patch.points = PointStore{c.stride};
  }
  double& at(int offset, int i, int k = 0) { return patch.points.at(offset + kLanes * k, i); }
  double at(int offset, int i, int k = 0) const { return patch.points.at(offset + kLanes * k, i); }

  /// `share` of a full point's mass at `x`, in cells of the block; all else is small and random.
  int add(const Triple& x, double share) {
    std::uniform_real_distribution<double> in{-1, 1};
    std::vector<double> record(static_cast<std::size_t>(c.stride / kLanes));
    for (double& value : record) value = 0.02 * in(random);
    patch.append(record.data());
    const int i = patch.points.count() - 1;
    at(0, i) = 100 + i;
    for (int a = 0; a < geometry.dimension; ++a) {
      const auto k = static_cast<std::size_t>(a);
      at(c.position, i, a) = geometry.min[k] + x[k] * kCell;
      at(c.velocity, i, a) = in(random);
      for (int b = 0; b < geometry.dimension; ++b)
        at(c.affine, i, geometry.dimension * a + b) = in(random);
    }
    at(c.mass, i) = share * size.mass(geometry, at(c.position, i));
    at(c.density, i) = kDensity * (1 + 0.2 * in(random));
    at(c.energy, i) = 2 + in(random);
    at(c.carried, i) = 0;
    for (const int k : {0, 4, 8}) at(c.deformation, i, k) += 1;
    if (geometry.dimension == 2)  // nothing turns out of the plane
      for (const int k : {1, 3, 5, 7}) at(c.deformation, i, k) = 0;
    at(failed, i) = 0;
    return i;
  }
  /// All of the bins of some cells, `per_bin` points of equal mass in each, moved about.
  void fill(int per_bin, int bins) {
    std::uniform_real_distribution<double> in{0.1, 0.9};
    for (int i = 0; i < bins; ++i)
      for (int j = 0; j < bins; ++j)
        for (int n = 0; n < per_bin; ++n) {
          Triple x{0.5 * (i + in(random)), 0.5 * (j + in(random)), 0.5 * in(random)};
          for (double& y : x) y += 0.5;  // the block begins half a cell inside the plane
          add(x, 1.0 / per_bin);
        }
    patch.points.pad(c.mass);
  }
  Merged merge() { return merge_points(patch, geometry, body, size, plan_merging(layout, c)); }

  GridGeometry geometry;
  PointSize size;
  Layout layout;
  PointColumns c;
  Patch patch;
  BodyKernelData body;
  int damage = -1, failed = -1;
  std::mt19937_64 random{7};
};

struct Sums {
  double mass = 0, volume = 0, energy = 0, section = 0, pressure = 0, stretch = 0;
  Triple momentum{}, centre{}, turning{};
};

Sums sums(const Block& b) {
  Sums out;
  const int dim = b.geometry.dimension;
  const double arm = 0.25 * kCell * kCell;
  for (int i = 0; i < b.patch.points.count(); ++i) {
    const auto v = [&](int a) { return b.at(b.c.velocity, i, a); };
    const auto x = [&](int a) { return b.at(b.c.position, i, a); };
    const auto L = [&](int r, int k) { return b.at(b.c.affine, i, dim * r + k); };
    const auto F = [&](int r, int k) { return b.at(b.c.deformation, i, 3 * r + k); };
    const double m = b.at(b.c.mass, i), V = m / b.at(b.c.density, i);
    out.mass += m;
    out.volume += V;
    out.section += m / x(0);
    out.pressure += V * b.at(b.c.pressure, i);
    out.energy += m * (b.at(b.c.energy, i) + b.at(b.c.carried, i));
    for (int r = 0; r < 3; ++r)
      out.stretch +=
          m * F(0, r) *
          (F(1, (r + 1) % 3) * F(2, (r + 2) % 3) - F(1, (r + 2) % 3) * F(2, (r + 1) % 3));
    for (int a = 0; a < dim; ++a) {
      const auto k = static_cast<std::size_t>(a);
      out.momentum[k] += m * v(a);
      out.centre[k] += b.size.hoop && a == 0 ? m : m * x(a);
      out.energy += 0.5 * m * v(a) * v(a);
      for (int s = 0; s < dim; ++s) out.energy += 0.5 * m * arm * L(a, s) * L(a, s);
      for (int s = a + 1; s < dim; ++s)
        out.turning[static_cast<std::size_t>(a + s - 1)] +=
            m * (x(a) * v(s) - x(s) * v(a) + arm * (L(s, a) - L(a, s)));
    }
  }
  return out;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("merge: mass, momentum, centre, turning, volume and energy are kept") {
    for (const int dimension : {2, 3})
      for (const bool hoop : {false, true}) {
        if (hoop && dimension == 3) continue;
        Block block{dimension, hoop};
        block.fill(4, 4);
        const Sums before = sums(block);
        const Merged merged = block.merge();
        const Sums after = sums(block);
        CHECK(block.patch.points.count() == 16);
        CHECK(merged.points == 48);
        CHECK(merged.heat != 0);
        CHECK(merged.unfelt == merged.heat);  // no law makes a pressure of the energy here
        const auto same = [](double a, double b, double scale) {
          CHECK(std::abs(a - b) < 1e-13 * scale);
        };
        const double length = 16 * kCell;
        same(after.mass, before.mass, before.mass);
        same(after.volume, before.volume, before.volume);
        same(after.pressure, before.pressure, before.volume);
        same(after.energy, before.energy, before.energy);
        same(after.stretch, before.stretch, before.stretch);
        if (hoop) same(after.section, before.section, before.section);
        for (std::size_t a = 0; a < 3; ++a) {
          same(after.momentum[a], before.momentum[a], before.mass);
          same(after.centre[a], before.centre[a], before.mass * length);
          if (!hoop) same(after.turning[a], before.turning[a], before.mass * length);
        }
        std::set<double> ids;
        for (int i = 0; i < block.patch.points.count(); ++i) ids.insert(block.at(0, i));
        CHECK(ids.size() == 16);
        CHECK(*ids.begin() == 100);
        CHECK(block.patch.tile.state == Tile::State::stale);
      }
  }

  TEST_CASE("merge: what was split is in its place again") {
    for (const bool hoop : {false, true}) {
      Block block{2, hoop};
      GridGeometry coarse = block.geometry;
      Levels levels{coarse};
      BlockSet all;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) all.insert({{i, j, 0}, 0});
      levels.set(all);
      const int whole = block.add({3.75, 3.25, 0}, 1);
      for (int k = 0; k < 9; ++k) block.at(block.c.deformation, whole, k) = k % 4 == 0 ? 1 : 0;
      Arrival point;
      block.patch.points.copy_out(whole, point.record);
      const Triple x{block.at(block.c.position, whole), block.at(block.c.position, whole, 1)},
          v{block.at(block.c.velocity, whole), block.at(block.c.velocity, whole, 1)};
      const double energy = sums(block).energy;
      block.patch.points.truncate(0);
      std::vector<Arrival> parts;
      arrive(levels, block.c, block.size, 0, point, parts);
      REQUIRE(parts.size() == 4);
      for (const Arrival& part : parts) block.patch.append(part.record.data());
      block.merge();
      REQUIRE(block.patch.points.count() == 1);
      CHECK(std::abs(block.at(block.c.position, 0) - x[0]) < 1e-14);
      CHECK(std::abs(block.at(block.c.position, 0, 1) - x[1]) < 1e-14);
      CHECK(std::abs(block.at(block.c.velocity, 0) - v[0]) < 1e-14);
      CHECK(std::abs(block.at(block.c.velocity, 0, 1) - v[1]) < 1e-14);
      // What splitting booked as heat is of the finer cells' arms: only the parts' own is left.
      CHECK(sums(block).energy > 0.5 * energy);
    }
  }

  TEST_CASE("merge: other histories, heavy, few and lone points stay as they are") {
    Block failed{2};
    failed.fill(4, 4);
    for (int i = 0; i < 64; i += 4) failed.at(failed.failed, i) = 1;
    CHECK(failed.merge().points == 0);

    Block damaged{2};
    damaged.fill(4, 4);
    for (int i = 0; i < 32; i += 4) damaged.at(damaged.damage, i) = 0.5;
    CHECK(damaged.merge().points == 24);  // of eight bins

    Block whole{2};
    whole.fill(1, 4);
    CHECK(whole.merge().points == 0);

    Block two{2};  // twice what its mass is worth: not crowded
    two.fill(2, 4);
    CHECK(two.merge().points == 0);

    Block dense{2};  // a bin of 2 points' mass becomes two points
    for (int n = 0; n < 8; ++n) dense.add({1.1 + 0.04 * n, 1.25, 0}, 0.25);
    CHECK(dense.merge().points == 6);
    CHECK(dense.at(dense.c.mass, 0) == doctest::Approx(dense.at(dense.c.mass, 1)).scale(0));

    Block light{2};  // half of a point would be too large a hole in the lattice
    for (int n = 0; n < 4; ++n) light.add({1.1 + 0.04 * n, 1.25, 0}, 0.1);
    CHECK(light.merge().points == 0);
  }

  TEST_CASE("merge: not what loads mark, nor rigid bodies") {
    Layout layout{2};
    layout.state<field::Id>(0, "test");
    layout.state<field::LoadShare>(0, "test");
    PointColumns c;
    c.energy = 8;
    CHECK_FALSE(plan_merging(layout, c).possible);
    CHECK_FALSE(plan_merging(Layout{2}, PointColumns{}).possible);
  }
}
