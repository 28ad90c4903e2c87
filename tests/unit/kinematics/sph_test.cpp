// SPDX-License-Identifier: GPL-3.0-or-later
// Weights of particles, the correction of their gradients, and their lists.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "krater/kinematics/sph/correction.hpp"
#include "krater/kinematics/sph/neighbours.hpp"
#include "krater/kinematics/sph/weights.hpp"

namespace {

using namespace krater;

/// int W dV over spheres or circles, and the greatest error of W'/r against differences of W.
template <SphKernel Kind>
void check_weight(int dimension) {
  const double h = 0.7;
  const WeightScale scale = weight_scale<Kind>(dimension, h);
  const auto slope_at = [&](double r) {
    return weight_slope<Kind>(scale, r * r, inverse_distance(r * r));
  };
  double content = 0, worst = 0;
  const int steps = 4000;
  for (int k = 0; k < steps; ++k) {
    const double dr = 2.2 * h / steps, r = (k + 0.5) * dr, d = 1e-5 * h;
    const double w = weight<Kind>(scale, r * r);
    content += w * (dimension == 3 ? 4 * M_PI * r * r : 2 * M_PI * r) * dr;
    const double slope =
        (weight<Kind>(scale, (r + d) * (r + d)) - weight<Kind>(scale, (r - d) * (r - d))) / (2 * d);
    worst = std::max(worst, std::abs(slope / r - slope_at(r)));
  }
  CHECK(content == doctest::Approx(1).epsilon(1e-6));
  CHECK(worst < 1e-3 * std::abs(slope_at(h)));
  CHECK(weight<Kind>(scale, 4 * h * h) == 0);
  CHECK(std::abs(slope_at(2 * h)) < 1e-15 * std::abs(slope_at(h)));
  CHECK(slope_at(2.5 * h) == 0);
  CHECK(std::isfinite(slope_at(0)));
}

SymAxes<double, 3> diagonal(double a, double b, double c) { return {{a, b, c, 0, 0, 0}}; }

/// Records of motion of particles.
std::vector<double> records(const std::vector<std::array<double, 3>>& x) {
  std::vector<double> out(kMotion * x.size());
  for (std::size_t i = 0; i < x.size(); ++i) std::copy_n(x[i].data(), 3, out.data() + kMotion * i);
  return out;
}

std::vector<std::array<double, 3>> scattered(int count, int dim, unsigned seed) {
  std::mt19937 random{seed};
  std::uniform_real_distribution<double> place{0, 1};
  std::vector<std::array<double, 3>> out(static_cast<std::size_t>(count));
  for (auto& x : out)
    for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) x[a] = place(random);
  return out;
}

std::vector<std::int32_t> listed(const Neighbours& lists, int i) {
  const NeighbourRows& rows = lists.rows()[i / 8];
  std::vector<std::int32_t> out;
  for (int k = 0; k < rows.count; ++k)
    if (rows.rows[8 * k + i % 8] != i) out.push_back(rows.rows[8 * k + i % 8]);
  std::sort(out.begin(), out.end());
  return out;
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("sph weights: content 1, slope that of the weight, nothing beyond 2h") {
    for (const int dimension : {2, 3}) {
      check_weight<SphKernel::cubic_spline>(dimension);
      check_weight<SphKernel::wendland_c2>(dimension);
      check_weight<SphKernel::quadratic>(dimension);
    }
  }

  TEST_CASE("sph correction: the inverse of sound moments, and continuous where they are flat") {
    bool flat = true;
    const SymAxes<double, 3> M{{1.1, 0.8, 1.3, 0.2, -0.3, 0.1}}, K = corrected(M, flat);
    CHECK(!flat);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        double sum = 0;
        for (int n = 0; n < 3; ++n) sum += K.at(a, n) * M.at(n, b);
        CHECK(sum == doctest::Approx(a == b ? 1 : 0).epsilon(1e-14));
      }
    double last = corrected(diagonal(1, 1, 1), flat).c[2], most = 0;
    const double step = 1.001;
    for (double thin = 1; thin > 1e-12; thin /= step) {
      const double now = corrected(diagonal(1, 1, thin), flat).c[2];
      // Nowhere steeper than the fall from 1/100 to 3/2 over a decade would ask, times ten.
      most = std::max(most, std::abs(now - last) / std::max(now, last));
      last = now;
    }
    CHECK(most < 0.05);
    CHECK(flat);
    CHECK(corrected(diagonal(1, 1, 0), flat).c[2] == doctest::Approx(1.5).epsilon(1e-12));
    CHECK(corrected(diagonal(1, 1, 0.05), flat).c[2] == doctest::Approx(20).epsilon(1e-12));
    CHECK(!flat);
    for (const double k : corrected(diagonal(0, 0, 0), flat).c) CHECK(k == 0);
    CHECK(flat);
  }

  TEST_CASE("sph neighbours: everyone within reach is listed, images included") {
    for (const int dim : {2, 3}) {
      CAPTURE(dim);
      const double support = 0.2, skin = 0.02, reach = support + skin;
      auto x = scattered(400, dim, 5);
      for (auto& y : x) y[0] -= 0.03;  // some have come across the plane
      const std::vector<Neighbours::Plane> planes{{0, 0.0, 1.0, 0}, {1, 1.0, -1.0, 0}};
      Neighbours lists{dim, support, skin, planes};
      std::vector<double> motion = records(x);
      lists.make(motion.data(), 400);
      motion.resize(kMotion * lists.records());
      lists.reflect_motion(motion.data());
      // By hand: all and their three reflections.
      for (std::size_t i = 0; i < x.size(); ++i) {
        std::multiset<double> expected, found;
        for (std::size_t j = 0; j < x.size(); ++j)
          for (const int flip : {0, 1, 2, 3}) {
            auto y = x[j];
            if (flip % 2 == 1) y[0] = -y[0];
            if (flip / 2 == 1) y[1] = 2 - y[1];
            if ((flip > 0 || i != j) && distance(x[i], y) < reach)
              expected.insert(distance(x[i], y));
          }
        for (const std::int32_t j : listed(lists, static_cast<int>(i))) {
          const double* y = motion.data() + kMotion * static_cast<std::size_t>(j);
          found.insert(distance(x[i], {y[0], y[1], y[2]}));
        }
        REQUIRE(found.size() == expected.size());
        CHECK(std::equal(found.begin(), found.end(), expected.begin(),
                         [](double a, double b) { return std::abs(a - b) < 1e-14; }));
      }
    }
  }

  TEST_CASE("sph neighbours: a slab thinner than the support has images of images") {
    // Two particles at 1/4 and 3/4 of a slab of 0.1: a lattice of 0.05 without an end.
    Neighbours lists{2, 0.3, 0, {{0, 0.0, 1.0, 0}, {0, 0.1, -1.0, 0}}};
    const std::vector<double> motion = records({{0.025, 0, 0}, {0.075, 0, 0}});
    lists.make(motion.data(), 2);
    CHECK(listed(lists, 0).size() == 10);  // at 0.05 k < 0.3
    CHECK(listed(lists, 1).size() == 10);
  }

  TEST_CASE("sph neighbours: a pair that may have come within the support makes lists old") {
    // Cells of 0.23; side by side, and with one between.
    for (const auto& [from, to, at] :
         {std::array{0.05, 0.285, 0.02}, std::array{0.22, 0.461, 0.023}}) {
      Neighbours lists{3, 0.2, 0.03, {}};
      lists.make(records({{from, 0, 0}, {to, 0, 0}}).data(), 2);
      CHECK(listed(lists, 0).empty());
      CHECK(lists.stale(records({{from + at, 0, 0}, {to - at, 0, 0}}).data()));
      CHECK(!lists.stale(records({{from + 0.01, 0, 0}, {to - 0.01, 0, 0}}).data()));
    }
  }

  TEST_CASE("sph neighbours: no pair comes within the support unseen, and flight is no news") {
    const double support = 0.2, skin = 0.03;
    auto x = scattered(500, 3, 11);
    Neighbours lists{3, support, skin, {}};
    std::vector<double> motion = records(x);
    lists.make(motion.data(), 500);
    for (auto& y : x) y[0] += 100;
    CHECK(!lists.stale(records(x).data()));
    std::mt19937 random{3};
    std::uniform_real_distribution<double> value{-1, 1};
    int stale = 0, fresh = 0;
    for (int trial = 0; trial < 60; ++trial) {  // linear fields, single runaways, counter-flows
      auto y = x;
      const double size = 0.05 * trial / 60;
      std::array<double, 9> B;
      for (double& b : B) b = value(random);
      for (auto& p : y)
        for (std::size_t a = 0; a < 3; ++a) {
          const auto from = p;
          p[a] += trial % 3 == 0   ? size * (B[3 * a] * (from[0] - 100) + B[3 * a + 1] * from[1])
                  : trial % 3 == 1 ? 0
                                   : (from[1] > 0.5 ? 1 : -1) * size * B[a] * 3;
        }
      if (trial % 3 == 1) y[static_cast<std::size_t>(trial)][0] += 20 * size;
      if (lists.stale(records(y).data())) {
        ++stale;
        continue;
      }
      ++fresh;
      for (int i = 0; i < 500; ++i) {
        const auto known = listed(lists, i);
        for (int j = 0; j < 500; ++j)
          if (i != j &&
              distance(y[static_cast<std::size_t>(i)], y[static_cast<std::size_t>(j)]) < support)
            REQUIRE(std::binary_search(known.begin(), known.end(), j));
      }
    }
    CHECK(stale > 10);
    CHECK(fresh > 10);
  }
}
