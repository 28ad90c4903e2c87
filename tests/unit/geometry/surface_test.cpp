// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <stdexcept>

#include "geometry_cases.hpp"
#include "krater/geometry/solids/csg.hpp"
#include "krater/geometry/solids/shapes.hpp"
#include "surface_cases.hpp"
#include "unit/scene/scene_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

bool says(const SurfaceDefects& defects, const std::string& words) {
  return defects.text(1, "m").find(words) != std::string::npos;
}

std::vector<SeedPoint> points_of(const Solid& solid, double cell) {
  LatticeOptions options;
  options.cell = cell;
  options.origin = {0.011, 0.007, 0.003};
  return fill(solid, Frame::cartesian_3d, options, everywhere);
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE(
      "surface: a bolt made by a boolean and the same from an STL file give the same points") {
    const Ring shank = polygon_ring(24, 1, 0.5), head = polygon_ring(6, 4, 1.0);
    const double z1 = 2.0, z2 = 2.75;
    std::vector<std::array<double, 2>> hexagon;
    for (std::size_t k = 0; k < 6; ++k) hexagon.push_back(head[4 * k]);
    const auto bolt = make_boolean(
        Boolean::unite,
        {make_extrusion(polygon_profile(shank), z1),
         transformed(make_extrusion(polygon_profile(hexagon), z2 - z1), Affine::move({0, 0, z1}))});
    const ScratchFolder folder;
    const std::string file = (folder.path() / "bolt.stl").string();
    write_stl(loft({shank, shank, head, head}, {0, z1, z1, z2}), file, 1);
    const Triangles read = read_triangles(file, 1);
    CHECK(read.facets.size() == 24 * 8);
    CHECK(examine_surface(read).text(1, "m") == "");
    const auto surface = make_surface_solid(read);
    // STL rounds the vertices on the edges of the head: the shapes agree to single precision.
    CHECK(surface->moments()->volume ==
          doctest::Approx(bolt->part(Frame::cartesian_3d, everywhere).measure).epsilon(1e-5));
    const auto a = points_of(*bolt, 0.17), b = points_of(*surface, 0.17);
    REQUIRE(a.size() == b.size());
    CHECK(a.size() > 1000);
    double away = 0, mass = 0;
    for (std::size_t n = 0; n < a.size(); ++n) {
      for (std::size_t k = 0; k < 3; ++k) away = std::max(away, std::abs(a[n].x[k] - b[n].x[k]));
      mass = std::max(mass, std::abs(a[n].measure / b[n].measure - 1));
    }
    CHECK(away < 1e-5);
    CHECK(mass < 2e-3);
  }

  TEST_CASE("surface: moments, spans along all axes and membership of a wavy ball") {
    const auto surface = make_surface_solid(wavy_ball(40, 1));
    const VolumeMoments m = *surface->moments();
    CHECK(std::abs(m.centroid()[2]) < 1e-12);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> u(-1.1, 1.1);
    Spans found;
    long wrong = 0, inside = 0;
    for (int n = 0; n < 4000; ++n) {
      const Vector3 p{u(random), u(random), u(random)};
      const bool in = surface->contains(p[0], p[1], p[2]);
      inside += in;
      for (int axis = 0; axis < 3; ++axis) {
        surface->spans(along_axis(p, axis), found);
        const double t = p[static_cast<std::size_t>(axis)];
        wrong += in != std::any_of(found.begin(), found.end(),
                                   [t](const Span& s) { return s.low <= t && t <= s.high; });
      }
    }
    CHECK(wrong == 0);
    CHECK(static_cast<double>(inside) * 2.2 * 2.2 * 2.2 / 4000 ==
          doctest::Approx(m.volume).epsilon(0.05));
    // Turned: the vertices are, and lines along the axes are all that is asked.
    const auto turned = transformed(surface, Affine::rotate({1, 1, 0}, 0.4));
    double sum = 0;
    for (const SeedPoint& p : points_of(*turned, 0.2)) sum += p.measure;
    CHECK(sum == doctest::Approx(m.volume).epsilon(1e-4));
    CHECK_THROWS_AS(surface->require(Frame::axisymmetric), std::invalid_argument);
  }

  TEST_CASE("surface: lines through edges, vertices and along walls count every crossing once") {
    // All lines of the lattice meet edges, vertices or walls of this box; its exact twin is a box.
    const Box box{{-1, -1, -1}, {1, 1, 1}};
    const auto surface = make_surface_solid(box_surface(box));
    Spans found;
    for (int i = -4; i <= 4; ++i) {
      for (int j = -4; j <= 4; ++j) {
        for (int axis = 0; axis < 3; ++axis) {
          Vector3 p{};
          p[static_cast<std::size_t>((axis + 1) % 3)] = 0.5 * i;
          p[static_cast<std::size_t>((axis + 2) % 3)] = 0.5 * j;
          surface->spans(along_axis(p, axis), found);
          // A foot on a lower side is moved in, on an upper side out.
          const bool in = i >= -2 && i < 2 && j >= -2 && j < 2;
          REQUIRE(found.size() == (in ? 1 : 0));
          if (in) CHECK((found[0].low == -1 && found[0].high == 1));
        }
      }
    }
    CHECK(surface->contains(1, 0.3, 0.2) == false);  // a foot on the upper side: beside it
    CHECK(surface->contains(0.3, 0.2, 1));           // on a facet
    CHECK(surface->contains(0, 0, 0));
    CHECK_FALSE(surface->contains(0.3, 0.2, std::nextafter(1.0, 2.0)));
  }

  TEST_CASE("surface: a shell with a cavity holds no points inside") {
    Triangles t = wavy_ball(16, 1);
    append(t, wavy_ball(12, 0.6), true);
    CHECK(examine_surface(t).text(1, "m") == "");
    const auto shell = make_surface_solid(t);
    CHECK_FALSE(shell->contains(0, 0, 0));
    CHECK(shell->contains(0, 0, 0.8));
    double sum = 0;
    long outside = 0;
    for (const SeedPoint& p : points_of(*shell, 0.15)) {
      sum += p.measure;
      outside += !shell->contains(Frame::cartesian_3d, p.x);
    }
    CHECK(sum == doctest::Approx(shell->moments()->volume).epsilon(2e-4));
    CHECK(outside == 0);
  }

  TEST_CASE("surface: where the winding number is two the solid is still there once") {
    Triangles t = box_surface({{0, 0, 0}, {2, 2, 2}});
    append(t, box_surface({{0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}}));
    const auto twice = make_surface_solid(t);
    Spans found;
    twice->spans(along_axis({1.1, 0.9, 0}, 2), found);
    REQUIRE(found.size() == 1);
    CHECK(found[0].low == 0);
    CHECK(found[0].high == 2);
    CHECK(twice->contains(1, 1, 1));
  }

  TEST_CASE("surface: what has no facet left is refused before it is turned") {
    Triangles flat{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, {{0, 1, 2}, {1, 2, 3}}};
    RepairOptions repair;
    repair.drop_facets = repair.orient = true;
    repair.close_holes = 1;
    CHECK_THROWS_WITH_AS(repair_surface(flat, repair), doctest::Contains("facets has an area"),
                         std::invalid_argument);
  }

  TEST_CASE("surface: vertices far out of any part are merged where they are equal") {
    const double far = -1e40;
    Triangles t{{{far, 0, 0}, {1, 0, 0}, {0, 1, 0}, {far, 0, 0}, {far, 1e-7, 0}, {-far, 0, 0}},
                {{0, 1, 2}, {3, 2, 1}, {4, 1, 2}, {5, 1, 2}}};
    CHECK(weld(t, 1e-6) == 2);  // the equal one, and one nearer than the distance
    CHECK(t.vertices.size() == 4);
  }

  TEST_CASE("surface: every defect is found, counted and placed; what can be mended is") {
    const Box unit{{0, 0, 0}, {1, 1, 1}};
    const Triangles sound = box_surface(unit);
    CHECK_FALSE(examine_surface(sound).any());

    Triangles open = sound;
    open.facets.pop_back();
    SurfaceDefects found = examine_surface(open);
    CHECK(says(found, "3 open edges"));
    CHECK(says(found, "(1, 0.5, 1)"));
    RepairOptions small, large;
    small.close_holes = 0.1;
    large.close_holes = 2;
    Triangles left = open;
    CHECK(repair_surface(left, small).back().find("1 holes left open") == 0);
    CHECK(examine_surface(left).any());
    CHECK(repair_surface(open, large).back() == "1 holes closed");
    CHECK_FALSE(examine_surface(open).any());
    CHECK(make_surface_solid(open)->moments()->volume == doctest::Approx(1));

    RepairOptions orient, drop, merge;
    orient.orient = drop.drop_facets = true;
    merge.merge_vertices = 1e-3;
    Triangles inverted = sound;
    for (auto& f : inverted.facets) std::swap(f[1], f[2]);
    CHECK(says(examine_surface(inverted), "1 parts turned inside out"));
    repair_surface(inverted, orient);
    CHECK_FALSE(examine_surface(inverted).any());

    Triangles mixed = sound;
    std::swap(mixed.facets[4][1], mixed.facets[4][2]);
    CHECK(says(examine_surface(mixed), "3 edges whose facets are turned differently"));
    repair_surface(mixed, orient);
    CHECK_FALSE(examine_surface(mixed).any());
    CHECK(make_surface_solid(mixed)->moments()->volume == doctest::Approx(1));

    Triangles nested = wavy_ball(12, 1);
    append(nested, wavy_ball(8, 0.5));
    CHECK(says(examine_surface(nested), "nested the same way round"));
    repair_surface(nested, orient);
    CHECK_FALSE(examine_surface(nested).any());
    CHECK_FALSE(make_surface_solid(nested)->contains(0, 0, 0));

    Triangles doubled = sound;
    doubled.facets.push_back(doubled.facets[3]);
    doubled.facets.push_back({0, 0, 3});
    found = examine_surface(doubled);
    CHECK(says(found, "1 duplicate facets"));
    CHECK(says(found, "1 zero-area facets"));
    repair_surface(doubled, drop);
    CHECK_FALSE(examine_surface(doubled).any());

    Triangles crossing = sound;
    append(crossing, box_surface({{0.5, 0.4, 0.3}, {1.5, 1.4, 1.3}}));
    CHECK(examine_surface(crossing).any());
    Triangles pierced = box_surface({{0, 0, 0}, {1, 1, 1}});
    pierced.vertices[7] = {-0.5, -0.5, 0.4};  // pulled through the opposite sides
    CHECK(says(examine_surface(pierced), "pairs of facets that cross"));

    // Two boxes that share one corner bound a volume; crossings elsewhere are still seen.
    Triangles pinch = sound;
    append(pinch, box_surface({{1, 1, 1}, {2, 2, 2}}));
    weld(pinch, 0);
    CHECK(pinch.vertices.size() == 15);
    CHECK(examine_surface(pinch).text(1, "m") == "");
    CHECK(make_surface_solid(pinch)->moments()->volume == doctest::Approx(2));
    append(pinch, box_surface({{1.9, 1.2, 1.3}, {3, 1.8, 1.7}}));
    CHECK(examine_surface(pinch).any());

    Triangles crowded = sound;
    crowded.vertices.push_back({2, 2, 2});
    crowded.facets.push_back({0, 1, 8});
    CHECK(says(examine_surface(crowded), "edges with more than two facets"));

    Triangles apart;  // every facet with corners of its own, a little off
    for (const auto& f : sound.facets) {
      for (const std::uint32_t corner : f) {
        Vector3 x = sound.vertices[corner];
        x[0] += 1e-5 * static_cast<double>(apart.vertices.size() % 7);
        apart.vertices.push_back(x);
      }
      const auto n = static_cast<std::uint32_t>(apart.vertices.size());
      apart.facets.push_back({n - 3, n - 2, n - 1});
    }
    CHECK(says(examine_surface(apart), "36 open edges"));
    CHECK(repair_surface(apart, merge).front() == "28 vertices merged");
    CHECK_FALSE(examine_surface(apart).any());
  }
}
