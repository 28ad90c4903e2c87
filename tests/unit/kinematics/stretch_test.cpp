// SPDX-License-Identifier: GPL-3.0-or-later
// Long points in halves: what is kept, which are cut and which are not, and how they become one.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include <Eigen/Dense>

#include "krater/kinematics/mpm/merge.hpp"
#include "krater/kinematics/mpm/stretch.hpp"
#include "krater/points/ledger_fields.hpp"

#include "cells_support.hpp"

namespace {

using namespace krater;

constexpr double kDensity = 3, kCell = 0.5;

/// Points of one body in the first block, with all that halves share out.
struct Block {
  explicit Block(int dimension, bool hoop = false)
      : dim{dimension}, levels{test::cells_of(dimension, kCell)}, size{kDensity, {2, 2, 2}, hoop} {
    Layout layout{dimension};
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
    c.reference = layout.state<field::ReferencePosition>(0, test).offset;
    c.half_width = layout.state<field::HalfWidth>(0, test).offset;
    c.domain = layout.state<field::Domain>(0, test).offset;
    c.failed = layout.state<field::Failed>(0, test).offset;
    c.stride = layout.stride();
    body.columns = c;
    plan = plan_merging(layout, c);
    patch.points = PointStore{c.stride};
    size.next_id = 1000;
    size.halves = true;
  }
  double& at(int offset, int i, int k = 0) { return patch.points.at(offset + kLanes * k, i); }
  const GridGeometry& grid() const { return levels.geometry(); }

  /// At `x` [cells], of `share` of a full point's mass; its half lengths are those of a point of
  /// the lattice, but for the longest [cells], which lies anyhow.
  int add(const Triple& x, double longest, double share = 1) {
    std::uniform_real_distribution<double> in{-1, 1};
    std::vector<double> record(static_cast<std::size_t>(c.stride / kLanes));
    for (double& value : record) value = in(random);
    patch.points.append(record.data());
    const int i = patch.points.count() - 1;
    at(0, i) = 100 + i;
    for (int a = 0; a < dim; ++a)
      at(c.position, i, a) =
          grid().min[static_cast<std::size_t>(a)] + x[static_cast<std::size_t>(a)] * kCell;
    at(c.mass, i) = share * size.mass(grid(), at(c.position, i));
    at(c.density, i) = kDensity;
    at(c.energy, i) = 5;
    at(c.carried, i) = 0;
    at(c.failed, i) = 0;
    Eigen::MatrixXd axes = Eigen::MatrixXd::Zero(dim, dim);
    for (int k = 0; k < dim * dim; ++k) axes(k / dim, k % dim) = in(random);
    axes = Eigen::HouseholderQR<Eigen::MatrixXd>{axes}.householderQ();
    Eigen::VectorXd half = Eigen::VectorXd::Constant(dim, 0.25 * kCell);
    half[0] = longest * kCell;
    const Eigen::MatrixXd M = axes * half.cwiseAbs2().asDiagonal() * axes.transpose();
    for (int k = 0; k < 6; ++k) at(c.domain, i, k) = 0;
    for (int a = 0; a < dim; ++a)
      for (int b = a; b < dim; ++b) at(c.domain, i, domain_component(dim, a, b)) = M(a, b);
    for (int k = 0; k < 9; ++k) at(c.deformation, i, k) += k % 4 == 0 ? 4 : 0;
    if (dim == 2)  // nothing turns out of the plane
      for (const int k : {1, 3, 5, 7}) at(c.deformation, i, k) = 0;
    return i;
  }
  double split() {
    const std::vector<int> which = stretched_points(patch, grid(), c, size);
    found = static_cast<int>(which.size());
    return split_stretched_points(patch, levels, c, size, which);
  }

  int dim;
  Levels levels;
  PointSize size;
  PointColumns c;
  Patch patch;
  BodyKernelData body;
  MergePlan plan;
  std::mt19937_64 random{11};
  int found = 0;
};

struct Sums {
  double mass = 0, volume = 0, energy = 0, section = 0;
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero(), centre = momentum, turning = momentum;
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();  ///< second, of the mass or the section
};

Sums sums(Block& b) {
  Sums out;
  const double arm = 0.25 * kCell * kCell;
  for (int i = 0; i < b.patch.points.count(); ++i) {
    const double m = b.at(b.c.mass, i), s = b.size.hoop ? m / b.at(b.c.position, i) : m;
    Eigen::Vector3d x = Eigen::Vector3d::Zero(), v = x;
    Eigen::Matrix3d L = Eigen::Matrix3d::Zero();
    for (int a = 0; a < b.dim; ++a) {
      x[a] = b.at(b.c.position, i, a);
      v[a] = b.at(b.c.velocity, i, a);
      for (int k = 0; k < b.dim; ++k) L(a, k) = b.at(b.c.affine, i, b.dim * a + k);
    }
    out.mass += m;
    out.volume += m / b.at(b.c.density, i);
    out.section += s;
    out.momentum += m * v;
    out.centre += s * x;
    out.energy += m * (0.5 * v.squaredNorm() + 0.5 * arm * L.squaredNorm() + b.at(b.c.energy, i) +
                       b.at(b.c.carried, i));
    const Eigen::Matrix3d spin = L - L.transpose();
    out.turning += m * (x.cross(v) + arm * Eigen::Vector3d{spin(2, 1), spin(0, 2), spin(1, 0)});
    out.moments += s * (x * x.transpose() + domain_of(b.patch.points, b.c, b.dim, i) / 3);
  }
  return out;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("stretch: halves keep mass, momentum, turning, energy, volume and second moments") {
    for (const int dimension : {2, 3})
      for (const bool hoop : {false, true}) {
        if (hoop && dimension == 3) continue;
        Block block{dimension, hoop};
        for (int n = 0; n < 5; ++n) block.add({1.2 + 0.3 * n, 2.4 - 0.3 * n, 1.6}, 0.4 + 0.1 * n);
        const Sums before = sums(block);
        const double heat = block.split();
        const Sums after = sums(block);
        CHECK(block.found == 5);
        CHECK(block.patch.points.count() == 10);
        CHECK(block.size.next_id == 1005);
        CHECK(heat != 0);
        const double scale = before.mass * 5;
        CHECK(std::abs(after.mass - before.mass) < 1e-14 * before.mass);
        CHECK(std::abs(after.volume - before.volume) < 1e-14 * before.volume);
        CHECK(std::abs(after.section - before.section) < 1e-14 * before.section);
        CHECK(std::abs(after.energy - before.energy) < 1e-14 * before.energy);
        CHECK((after.momentum - before.momentum).norm() < 1e-14 * scale);
        CHECK((after.centre - before.centre).norm() < 1e-14 * before.section * 5);
        CHECK((after.moments - before.moments).norm() < 1e-13 * before.section * 10);
        if (!hoop) CHECK((after.turning - before.turning).norm() < 1e-14 * scale * 5);
      }
  }

  TEST_CASE("stretch: a half is half as long, where matter is, with the history of the whole") {
    for (const int dimension : {2, 3}) {
      Block block{dimension};
      const int whole = block.add({2.2, 1.4, 2.1}, 0.6);
      const DomainTensor M = domain_of(block.patch.points, block.c, dimension, whole);
      const Triple half = longest_half(M);
      const double pressure = block.at(block.c.pressure, whole);
      Eigen::MatrixXd F(dimension, dimension);
      Eigen::VectorXd x(dimension), X(dimension), q(dimension);
      for (int a = 0; a < dimension; ++a) {
        x[a] = block.at(block.c.position, whole, a);
        X[a] = block.at(block.c.reference, whole, a);
        q[a] = 0.5 * half[static_cast<std::size_t>(a)];
        for (int b = 0; b < dimension; ++b)
          F(a, b) =
              block.at(block.c.deformation, whole, dimension == 2 ? 6 * a + 2 * b : 3 * a + b);
      }
      CHECK(2 * q.norm() == doctest::Approx(0.6 * kCell).epsilon(1e-12).scale(0));
      block.split();
      REQUIRE(block.patch.points.count() == 2);
      CHECK(block.at(0, 0) == 100);
      CHECK(block.at(0, 1) == 1000);
      for (int i = 0; i < 2; ++i) {
        CHECK(block.at(block.c.pressure, i) == pressure);
        const DomainTensor now = domain_of(block.patch.points, block.c, dimension, i);
        const Triple left = longest_half(now);
        CHECK(std::hypot(left[0], left[1], left[2]) ==
              doctest::Approx(0.3 * kCell).epsilon(1e-12).scale(0));
        const double side = i == 0 ? -1 : 1;
        Eigen::VectorXd from_x(dimension), from_X(dimension);
        for (int a = 0; a < dimension; ++a) {
          from_x[a] = block.at(block.c.position, i, a) - x[a];
          from_X[a] = block.at(block.c.reference, i, a) - X[a];
          CHECK(block.at(block.c.half_width, i, a) ==
                doctest::Approx(std::sqrt(now(a, a))).epsilon(1e-12).scale(0));
        }
        CHECK((from_x - side * q).norm() < 1e-14);
        CHECK((F * from_X - side * q).norm() < 1e-14);
      }
    }
  }

  TEST_CASE("stretch: short, failed and light points stay whole; those at a side stay inside") {
    Block block{2};
    block.add({3, 3, 0}, 0.374);
    block.add({3, 4, 0}, 0.9, 1.9 / 256);
    block.at(block.c.failed, block.add({4, 3, 0}, 0.9)) = 1;
    const int loose = block.add({4, 4, 0}, 0.376);
    CHECK(stretched_points(block.patch, block.grid(), block.c, block.size) ==
          std::vector<int>{loose});
    Block corner{2};
    corner.add({0.05, 0.02, 0}, 1.5);
    corner.split();
    for (int i = 0; i < 2; ++i)
      for (int a = 0; a < 2; ++a)
        CHECK(corner.at(corner.c.position, i, a) > corner.grid().min[static_cast<std::size_t>(a)]);
  }

  TEST_CASE("stretch: a half beyond the edge of its block goes on to the next") {
    Block block{2};
    block.patch.key = block.levels.block_at(Triple{2 * kCell, 2 * kCell, 0}.data());
    block.add({6.9, 3, 0}, 0.25);
    for (int a = 0; a < 2; ++a)
      for (int b = a; b < 2; ++b)
        block.at(block.c.domain, 0, domain_component(2, a, b)) = a + b == 0 ? 4 * kCell * kCell : 0;
    block.split();  // halves at 5.9 and 7.9; blocks end half way between nodes, at 7.5
    CHECK(block.patch.points.count() == 1);
    REQUIRE(block.patch.outbox.keys.size() == 1);
    CHECK(block.patch.outbox.keys[0].i[0] == block.patch.key.i[0] + 1);
    CHECK(block.patch.outbox.other_level.size() == static_cast<std::size_t>(block.c.stride / 8));
    CHECK(block.patch.outbox.used == Outbox::kOtherLevel);
  }

  TEST_CASE("stretch: parts for finer cells have a quarter of the tensor") {
    Block block{2};
    block.levels.set({{{0, 0, 0}, 0}});
    const int whole = block.add({3, 3, 0}, 0.3);
    const DomainTensor M = domain_of(block.patch.points, block.c, 2, whole);
    Arrival point;
    block.patch.points.copy_out(whole, point.record);
    point.key = block.levels.block_at(point.record.data() + block.c.position / kLanes);
    std::vector<Arrival> parts;
    arrive(block.levels, block.c, block.size, 0, point, parts);
    REQUIRE(parts.size() == 4);
    for (const Arrival& part : parts) {
      const DomainTensor left = domain_tensor(2, [&](int k) {
        return part.record[static_cast<std::size_t>(block.c.domain / kLanes + k)];
      });
      CHECK((left - 0.25 * M).norm() < 1e-15);
    }
  }

  TEST_CASE("stretch: halves become one again, unless that would be cut again") {
    for (const double length : {0.37, 0.38}) {
      Block block{2};
      for (int n = 0; n < 3; ++n) {  // a crowd of light points, three of them in one bin
        const int i = block.add({3.1 + 0.1 * n, 3.2, 0}, 0.25, 0.3);
        for (int k = 0; k < block.c.stride / kLanes; ++k)
          if (k != block.c.position / kLanes && k > 0)
            block.at(kLanes * k, i) = block.at(kLanes * k, 0);
        block.at(block.c.position, i) = block.grid().min[0] + (3.1 + 0.1 * n) * kCell;
        block.at(block.c.position, i, 1) = block.grid().min[1] + 3.2 * kCell;
        const double own = length * length - 3 * (2.0 / 3) * 0.01;  // and 3 d^2 of the places
        for (int a = 0; a < 2; ++a)
          for (int b = a; b < 2; ++b)
            block.at(block.c.domain, i, domain_component(2, a, b)) =
                a != b ? 0 : (a == 0 ? own : 0.01) * kCell * kCell;
      }
      const Sums before = sums(block);
      const Merged merged =
          merge_points(block.patch, block.grid(), block.body, block.size, block.plan);
      CHECK(merged.points == (length < 0.375 ? 2 : 0));
      CHECK((sums(block).moments - before.moments).norm() < 1e-14 * before.mass * 10);
    }
  }
}
