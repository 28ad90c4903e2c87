// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/schedule.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

using namespace krater;

namespace {

/// All times of a run that steps to each of them, restarted after every output where asked.
std::vector<double> times(double interval, double end, bool restarted = false) {
  std::vector<double> out;
  Schedule schedule{interval, end, 0};
  for (double now = 0; now < end && out.size() < 100000;) {
    now = schedule.next();
    CHECK(schedule.due(now));
    out.push_back(now);
    schedule.advance(now);
    if (restarted) schedule = Schedule{interval, end, now};
  }
  return out;
}

}  // namespace

TEST_CASE("schedule: an end at a multiple of the interval comes once, whatever the rounding") {
  for (const double interval : {1e-6, 0.1e-6, 0.3e-6, 0.7e-6, 1.1e-6, 3e-9, 1. / 3})
    for (const int count : {1, 2, 3, 5, 7, 10, 25, 30, 49, 99, 1000, 4097})
      for (const double end : {count * interval, std::nextafter(count * interval, 0.),
                               std::nextafter(count * interval, 1e9)}) {
        const std::vector<double> t = times(interval, end);
        CAPTURE(interval);
        CAPTURE(count);
        REQUIRE(t.size() == static_cast<std::size_t>(count));
        for (int k = 1; k < count; ++k) CHECK(t[static_cast<std::size_t>(k) - 1] == k * interval);
        CHECK(t.back() == end);
        CHECK(times(interval, end, true) == t);
      }
}

TEST_CASE("schedule: an end between two multiples has its own output") {
  CHECK(times(1, 2.5) == std::vector<double>{1, 2, 2.5});
  CHECK(times(3, 2) == std::vector<double>{2});
  CHECK(times(0, 2) == std::vector<double>{2});
}

TEST_CASE("schedule: an interval that nobody can count means every step and cuts none") {
  for (const double interval : {1e-30, 1e-300, 1e-307}) {
    Schedule schedule{interval, 2e-6, 0};
    CHECK(schedule.next() == 2e-6);
    CHECK(schedule.due(1e-12));
    schedule.advance(1e-12);
    CHECK(schedule.due(1e-12));
    CHECK(schedule.next() == 2e-6);
  }
}

TEST_CASE("schedule: a multiple that another output hit from below is due") {
  Schedule schedule{1e-7, 1, 24e-7};
  CHECK(schedule.due(25 * 1e-7));
  CHECK(schedule.due(2.5e-6));
  CHECK_FALSE(schedule.due(2.49e-6));
}
