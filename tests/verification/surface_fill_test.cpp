// SPDX-License-Identifier: GPL-3.0-or-later
// The size a user may bring: a surface of a million triangles, read, examined and made into ten
// million points on two cores within a minute and within 2.5 times the memory of the points.
#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <string>

#include "krater/core/parallel.hpp"
#include "unit/geometry/geometry_cases.hpp"
#include "unit/geometry/surface_cases.hpp"
#include "unit/scene/scene_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

/// MiB of resident memory: now (VmRSS) or at most so far (VmHWM); 0 where the system does not say.
double memory(const std::string& what) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kib = 0;
    if (word == what + ":" && status >> kib) return kib / 1024;
  }
  return 0;
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("surface: a million triangles into ten million points, fast and lean") {
    const ScratchFolder folder;
    const std::string file = (folder.path() / "wavy.stl").string();
    write_stl(wavy_ball(500, 1), file, 1);
    set_threads(2);
    std::ofstream("/proc/self/clear_refs") << 5;  // the peak counts from here
    const double before = memory("VmRSS");
    const auto start = std::chrono::steady_clock::now();
    Triangles triangles = read_triangles(file, 1);
    CHECK(triangles.facets.size() > 990'000);
    CHECK_FALSE(examine_surface(triangles).any());
    const auto solid = make_surface_solid(std::move(triangles));
    const double volume = solid->moments()->volume;
    LatticeOptions options;
    options.cell = 2 * std::cbrt(volume / 1e7);
    const auto points = fill(*solid, Frame::cartesian_3d, options, everywhere);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    const double peak = memory("VmHWM") - before;
    set_threads(1);
    const double own = static_cast<double>(points.size() * sizeof(SeedPoint)) / (1 << 20);
    MESSAGE(points.size() << " points in " << seconds.count() << " s; peak " << peak << " MiB, "
                          << peak / own << " times the points' own");
    CHECK(points.size() > 9'900'000);
    CHECK(seconds.count() < 60);
    CHECK(peak < 2.5 * own);
    double sum = 0;
    long outside = 0;
    for (std::size_t n = 0; n < points.size(); ++n) {
      sum += points[n].measure;
      if (n % 101 == 0) outside += !solid->contains(Frame::cartesian_3d, points[n].x);
    }
    CHECK(std::abs(sum / volume - 1) < 1e-5);
    CHECK(outside == 0);
  }
}
