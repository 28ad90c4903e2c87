// SPDX-License-Identifier: GPL-3.0-or-later
// The words for what became of a projectile, on made-up points and series.
#include <doctest/doctest.h>

#include <algorithm>

#include "krater/measure/outcome.hpp"
#include "unit/measure/point_sets_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

const MeasureContext kDomain = measuring_domain(Frame::plane_strain, 1, {-50, -50, 0}, {50, 50, 0});

BodyPoints block(double x, double z, double width, double height, const Triple& v) {
  BodyPoints out = lattice_points(kDomain, {x, z, 0}, {x + width, z + height, 0},
                                  [](const Triple&) { return true; });
  for (Triple& velocity : out.v) velocity = v;
  return out;
}

/// Of a projectile 4 x 4 above a plate 40 x 5 at z = -5 to 0, thrown down with 10.
OutcomeStart start() {
  return outcome_start(block(-2, 3, 4, 4, {0, -10, 0}), block(-20, -5, 40, 5, {}), kDomain);
}

Fate fate(const BodyPoints& points, const Triple& w, const Settling& settling) {
  const OutcomeStart s = start();
  return fate_of(outcome_state(points, kDomain, s), w, settling, s, 0.01);
}

}  // namespace

TEST_CASE("outcome: the face that is met, also by an oblique shot from far aside") {
  CHECK(start().axis == 1);
  CHECK(start().into == -1);
  CHECK(start().face == doctest::Approx(-0.25));
  CHECK(start().speed == doctest::Approx(10));
  const OutcomeStart oblique =
      outcome_start(block(-40, 12, 4, 4, {20, -5, 0}), block(-20, -5, 40, 5, {}), kDomain);
  CHECK(oblique.axis == 1);
}

TEST_CASE("outcome: words") {
  const Settling touched{true, false, false, 0, 0}, quiet{true, true, false, 0, 0},
      at_rest{true, true, true, 0, 0};
  CHECK(fate(block(-2, -14, 4, 4, {0, -5, 0}), {0, -5, 0}, touched) == Fate::perforated);
  CHECK(fate(block(-2, -14, 4, 4, {0, -5, 0}), {0, -5, 0}, {}) == Fate::missed);
  CHECK(fate(block(-2, -8, 4, 4, {0, -5, 0}), {0, -5, 0}, quiet) == Fate::moving);
  CHECK(fate(block(-2, 1, 4, 4, {5, 2, 0}), {5, 2, 0}, touched) == Fate::ricocheted);
  CHECK(fate(block(-2, -2, 4, 4, {0, 2, 0}), {0, 2, 0}, touched) == Fate::moving);
  CHECK(fate(block(-2, -2, 4, 4, {0, 2, 0}), {0, 2, 0}, quiet) == Fate::ricocheted);
  CHECK(fate(block(-2, -3, 4, 4, {}), {}, at_rest) == Fate::stopped);
}

TEST_CASE("outcome: broken up is where no piece holds half of the mass") {
  BodyPoints pieces = together(block(-20, -14, 4, 4, {0, -5, 0}), block(0, -14, 4, 4, {0, -7, 0}));
  CHECK_FALSE(outcome_state(pieces, kDomain, start()).broken());
  pieces = together(pieces, block(20, 1, 4, 4, {0, 3, 0}));
  const OutcomeState state = outcome_state(pieces, kDomain, start());
  CHECK(state.broken());
  CHECK(state.velocity[1] == doctest::Approx(-3));  // of all of it
  CHECK(state.through == doctest::Approx(2.0 / 3));
  CHECK(state.before == doctest::Approx(1.0 / 3));
}

TEST_CASE("outcome: quiet for a quarter of the time of the change, and not before") {
  const auto looks = [](double end) {
    std::vector<OutcomeLook> out;
    for (double t = 0; t <= end + 1e-9; t += 0.25) {
      const double v = t < 1 ? -10 : t < 9 ? -10 + (t - 1) : -2;
      out.push_back({t, {0, v, 0}, {0, v, 0}, static_cast<double>(Fate::perforated)});
    }
    return out;
  };
  CHECK_FALSE(settling_of(looks(0.75), start(), 0.01).touched);
  CHECK_FALSE(settled(looks(8), start(), 0.01));
  CHECK_FALSE(settled(looks(10.5), start(), 0.01));
  CHECK(settled(looks(11.25), start(), 0.01));
  CHECK(settling_of(looks(12), start(), 0.01).since == doctest::Approx(9));
  CHECK(settling_of(looks(12), start(), 0.01).drift == doctest::Approx(0));
}

TEST_CASE("outcome: a plate that bounces off is not at rest while it turns round") {
  const auto looks = [](double end, double last) {  // -10, then steadily to `last` at 12
    std::vector<OutcomeLook> out;
    for (double t = 0; t <= end + 1e-9; t += 0.25) {
      const double w = t < 1   ? -10
                       : t < 4 ? -10 + 3 * (t - 1)
                               : std::min(last, -1 + 0.25 * (t - 4));
      out.push_back({t, {0, w, 0}, {0, w, 0}, 0});
    }
    return out;
  };
  for (double end = 8; end < 14; end += 0.25)
    CHECK_FALSE(settling_of(looks(end, 1), start(), 0.01).stopped);
  CHECK(settling_of(looks(30, 0), start(), 0.01).stopped);
}
