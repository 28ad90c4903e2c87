// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "krater/materials/catalogue.hpp"
#include "scene_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

bool same_boundary(const Boundary& a, const Boundary& b) {
  return a.kind == b.kind && a.friction == b.friction && a.velocity == b.velocity;
}

bool same_law(const std::optional<LawChoice>& a, const std::optional<LawChoice>& b) {
  if (a.has_value() != b.has_value()) return false;
  return !a || (a->law == b->law && a->name == b->name && a->values == b->values);
}

bool same_field(const std::shared_ptr<const FieldFunction>& a,
                const std::shared_ptr<const FieldFunction>& b) {
  if (!a || !b) return !a && !b;
  const Triple x{1.5e-3, 2.5e-3, 3.5e-3}, X{4.5e-3, 5.5e-3, 6.5e-3};
  return (*a)(x, X, 0.3) == (*b)(x, X, 0.3) && a->depends_on_time() == b->depends_on_time();
}

/// Everything but where it was written.
void check_same(const Scene& a, const Scene& b) {
  CHECK(a.title == b.title);
  CHECK(a.frame == b.frame);
  CHECK(a.grid.cell == b.grid.cell);
  CHECK(a.grid.min == b.grid.min);
  CHECK(a.grid.max == b.grid.max);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t side = 0; side < 2; ++side) {
      CHECK(same_boundary(a.grid.boundary[axis][side], b.grid.boundary[axis][side]));
    }
  }
  CHECK(a.time.end == b.time.end);
  CHECK(a.time.cfl == b.time.cfl);
  CHECK(a.method.transfer == b.method.transfer);
  CHECK(a.method.xpic_order == b.method.xpic_order);
  CHECK(a.method.jitter == b.method.jitter);
  REQUIRE(a.materials.size() == b.materials.size());
  for (std::size_t i = 0; i < a.materials.size(); ++i) {
    CHECK(a.materials[i].name == b.materials[i].name);
    CHECK(a.materials[i].density == b.materials[i].density);
    CHECK(a.materials[i].shear_modulus == b.materials[i].shear_modulus);
    CHECK(a.materials[i].initial_temperature == b.materials[i].initial_temperature);
    CHECK(same_law(a.materials[i].eos, b.materials[i].eos));
    CHECK(same_law(a.materials[i].strength, b.materials[i].strength));
    CHECK(same_law(a.materials[i].viscosity, b.materials[i].viscosity));
    CHECK(same_law(a.materials[i].heating, b.materials[i].heating));
  }
  REQUIRE(a.bodies.size() == b.bodies.size());
  const Box domain{a.grid.min, a.grid.max};
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    CHECK(a.bodies[i].name == b.bodies[i].name);
    CHECK(a.bodies[i].material == b.bodies[i].material);
    CHECK(a.bodies[i].solid->measure(a.frame, domain) ==
          b.bodies[i].solid->measure(a.frame, domain));
    CHECK(same_field(a.bodies[i].velocity, b.bodies[i].velocity));
  }
  CHECK(same_field(a.body_force, b.body_force));
  REQUIRE(a.measures.size() == b.measures.size());
  for (std::size_t i = 0; i < a.measures.size(); ++i) {
    CHECK(a.measures[i].name == b.measures[i].name);
    CHECK(a.measures[i].kind == b.measures[i].kind);
    CHECK(a.measures[i].axis == b.measures[i].axis);
    CHECK(a.measures[i].at == b.measures[i].at);
    CHECK(a.measures[i].at_from_end == b.measures[i].at_from_end);
    CHECK(a.measures[i].field == b.measures[i].field);
    CHECK(a.measures[i].reference == b.measures[i].reference);
    CHECK(a.measures[i].reference_source == b.measures[i].reference_source);
  }
  CHECK(a.output.frames == b.output.frames);
  CHECK(a.output.history == b.output.history);
  CHECK(a.output.fields == b.output.fields);
}

/// The text below its first line, which names the file.
std::string body_of(const std::string& resolved) { return resolved.substr(resolved.find('\n')); }

void check_fixed_point(const Scene& scene, const ScratchFolder& folder) {
  const std::string file = folder.write("resolved.yaml", scene.resolved);
  const Scene again = read_scene(file);
  check_same(scene, again);
  CHECK(body_of(scene.resolved) == body_of(again.resolved));
}

double value_of(const Scene& scene, const std::optional<LawChoice>& law, const std::string& key) {
  REQUIRE(law.has_value());
  const auto& parameters = catalogue()[static_cast<std::size_t>(law->law)].parameters;
  const auto found = std::find_if(parameters.begin(), parameters.end(),
                                  [&](const ParameterInfo& info) { return key == info.key; });
  REQUIRE_MESSAGE(found != parameters.end(), scene.file);
  return law->values[static_cast<std::size_t>(found - parameters.begin())];
}

bool noted(const Scene& scene, const std::string& part) {
  return std::any_of(scene.notes.begin(), scene.notes.end(),
                     [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE(
      "scene: every scene of inputs/ reads in the frames it is meant for, and resolves to a fixed "
      "point") {
    const ScratchFolder folder;
    int scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator{source_path("inputs")}) {
      if (entry.path().extension() != ".yaml") continue;
      ++scenes;
      const std::string file = entry.path().string();
      CAPTURE(file);
      check_fixed_point(read_scene(file), folder);
      const std::string stem = entry.path().stem().string();
      // No axis; square bars; a square plate held at two edges; a quarter of particles.
      if (stem == "two_discs" || stem == "ccf_two_bars" || stem == "spear_plate") continue;
      if (stem == "taylor_copper_sph") continue;
      if (stem == "round_nosed_rod") continue;  // its file holds axisymmetric elements
      const bool hole = stem == "ccf_plugging" || stem == "hiermaier_al";
      for (Frame frame : all_frames) {
        if (hole && frame == Frame::plane_strain) continue;  // there a hole is a slot
        CAPTURE(std::string{name(frame)});
        const Scene scene = read_scene(file, {"frame=" + std::string{name(frame)}});
        CHECK(scene.frame == frame);
        check_fixed_point(scene, folder);
      }
    }
    CHECK(scenes >= 4);
  }

  TEST_CASE("scene: the Taylor scene holds the numbers of its sources, bit for bit") {
    const Scene scene = read_scene(source_path("inputs/taylor_copper.yaml"));
    CHECK(scene.grid.cell == 0.381e-3);
    CHECK(scene.time.end == 80e-6);
    CHECK(scene.grid.min == Triple{0, 0, 0});
    CHECK(scene.grid.max[0] == 32 * 0.381e-3);  // 12 mm, out to the next node line
    CHECK(scene.grid.max[1] == 71 * 0.381e-3);
    CHECK(scene.grid.boundary[0][0].kind == BoundaryKind::symmetry);
    CHECK(scene.grid.boundary[0][1].kind == BoundaryKind::open);
    CHECK(scene.grid.boundary[1][0].kind == BoundaryKind::wall);
    REQUIRE(scene.materials.size() == 1);
    const MaterialOptions& copper = scene.materials[0];
    CHECK(copper.density == 8960);
    CHECK(copper.shear_modulus == 46e9);
    CHECK(value_of(scene, copper.eos, "c0") == 3940);
    CHECK(value_of(scene, copper.eos, "S1") == 1.489);
    CHECK(value_of(scene, copper.strength, "A") == 90e6);
    CHECK(value_of(scene, copper.strength, "T_melt") == 1356);
    CHECK(value_of(scene, copper.heating, "cp") == 383);
    REQUIRE(scene.bodies.size() == 1);
    CHECK((*scene.bodies[0].velocity)({}, {}, 0) == Triple{0, -190, 0});
    REQUIRE(scene.measures.size() == 4);
    CHECK(scene.measures[0].reference == 16.205e-3);
    CHECK(scene.measures[1].level == 2.54e-3);
    CHECK(scene.measures[3].at == 5.08e-3);
    CHECK(scene.measures[3].at_from_end);
    CHECK(scene.notes.empty());
  }

  TEST_CASE("scene: in 3d the box is revolved about a node line and r sides become four") {
    const ScratchFolder folder;
    const std::string text =
        replaced(small_scene(), "r_min: axis", "r_min: axis\n    r_max: {wall: {friction: 0.2}}");
    const Scene scene = read_scene(folder.write("a.yaml", text), {"frame=3d"});
    CHECK(scene.grid.min == Triple{-0.01, -0.01, 0});
    CHECK(scene.grid.max == Triple{0.01, 0.01, 0.02});
    for (std::size_t axis = 0; axis < 2; ++axis) {
      for (const Boundary& side : scene.grid.boundary[axis]) {
        CHECK(side.kind == BoundaryKind::wall);
        CHECK(side.friction == 0.2);
      }
    }
    CHECK(scene.grid.boundary[2][0].kind == BoundaryKind::wall);
    CHECK(noted(scene, "a.yaml:8: grid.boundary.r_min: passed over in 3d"));
    CHECK((*scene.bodies[0].velocity)({}, {}, 0) == Triple{0, 0, -100});
    CHECK(scene.measures[0].axis == 2);
    check_fixed_point(scene, folder);
    const Scene plane = read_scene((folder.path() / "a.yaml").string(), {"frame=plane_strain"});
    CHECK(plane.grid.boundary[0][0].kind == BoundaryKind::symmetry);
    CHECK(plane.measures[0].axis == 1);
    const std::string file =
        folder.write("b.yaml", replaced(small_scene(), "[0, -100 m/s]", "[5 m/s, 0]"));
    CHECK(message_of(file) == "");
    CHECK(message_of(file, {"frame=3d"}).find("could mean x as well as r") != std::string::npos);
    CHECK(message_of(file, {"frame=3d", "grid.box={min: [1 mm, 0], max: [2 mm, 1 mm]}"})
              .find("can be revolved") != std::string::npos);
  }

  TEST_CASE("scene: a quarter model in 3d") {
    const ScratchFolder folder;
    std::string text = replaced(small_scene(), "axisymmetric", "3d");
    text = replaced(text, "{min: [0, 0], max: [10 mm, 20 mm]}",
                    "{min: [0, 0, 0], max: [10 mm, 10 mm, 20 mm]}");
    text =
        replaced(text, "r_min: axis",
                 "x_min: symmetry\n    y_min: symmetry\n    y_max: {velocity: [1, -2, 3 m/s]}\n    "
                 "x_max: {velocity: {of: [-1 m/s, 0, 0], friction: 0.2}}");
    const Scene scene = read_scene(folder.write("quarter.yaml", text));
    CHECK(scene.grid.boundary[0][0].kind == BoundaryKind::symmetry);
    CHECK(scene.grid.boundary[1][0].kind == BoundaryKind::symmetry);
    CHECK(scene.grid.boundary[1][1].kind == BoundaryKind::velocity);
    CHECK(scene.grid.boundary[1][1].velocity == Triple{1, -2, 3});
    CHECK(std::isinf(scene.grid.boundary[1][1].friction));  // sticks
    CHECK(scene.grid.boundary[0][1].velocity == Triple{-1, 0, 0});
    CHECK(scene.grid.boundary[0][1].friction == 0.2);
    check_fixed_point(scene, folder);
  }

  TEST_CASE("scene: --set reaches any path and errors name it") {
    const ScratchFolder folder;
    const std::string file = folder.write("s.yaml", small_scene());
    const Scene scene = read_scene(
        file, {"grid.cell=0.5 mm", "method.transfer=flip", "bodies.rod.velocity=[0,-200 m/s]",
               "output.frames=2 us",
               "materials.steel.strength.johnson_cook={A: 1 MPa, B: 2 MPa, n: 1, C: 0, m: 1, "
               "T_ref: 290, T_melt: 1800}",
               "materials.steel.viscosity=none", "grid.boundary.z_min={wall: {friction: 0.1}}"});
    CHECK(scene.grid.cell == 0.5e-3);
    CHECK(scene.method.transfer == Transfer::flip);
    CHECK((*scene.bodies[0].velocity)({}, {}, 0) == Triple{0, -200, 0});
    CHECK(scene.output.frames == 2e-6);
    CHECK(scene.output.fields == std::vector<std::string>{"pressure"});
    CHECK(scene.materials[0].strength->name == "johnson_cook");
    CHECK_FALSE(scene.materials[0].viscosity.has_value());
    CHECK(scene.grid.boundary[1][0].friction == 0.1);
    CHECK(noted(scene, "johnson_cook without heating"));
    const Scene named = read_scene(
        folder.write("named.yaml", replaced(small_scene(), "viscosity: {q_lin: 0.3}",
                                            "viscosity: {linear_quadratic: {q_quad: 1}}")));
    REQUIRE(named.materials[0].viscosity.has_value());
    CHECK(named.materials[0].viscosity->values.back() == 1);
    CHECK(message_of(file, {"grid.cel=1 mm"})
              .find("--set grid.cel=1 mm: grid.cel: unknown key 'cel'") != std::string::npos);
    CHECK(message_of(file, {"grid.cell=1 kg"})
              .find("--set grid.cell=1 kg: grid.cell: '1 kg' has the wrong") != std::string::npos);
    CHECK(
        message_of(file, {"grid.cell=[1"}).find("--set grid.cell=[1: grid.cell: not valid YAML") !=
        std::string::npos);
    CHECK(message_of(file, {"grid.cell"}).find("expected path=value") != std::string::npos);
    CHECK(message_of(file, {"=3"}).find("expected path=value") != std::string::npos);
    CHECK(message_of(file, {"grid..cell=3"}).find("empty step") != std::string::npos);
    CHECK(message_of(file, {"grid.cell="}).find("has no value") != std::string::npos);
  }

  TEST_CASE("scene: none takes levels and rigidity away again") {
    const std::string file = source_path("inputs/snl/penetration.yaml");
    const Scene as_it_is = read_scene(file);
    CHECK(as_it_is.grid.refine.size() == 1);
    CHECK(as_it_is.bodies[0].rigid());
    const Scene without =
        read_scene(file, {"grid.refine=none", "bodies.projectile.rigid=none",
                          "materials.steel={youngs_modulus: 200 GPa, poisson_ratio: 0.3, strength: "
                          "elastic, eos: linear}"});
    CHECK(without.grid.refine.empty());
    CHECK_FALSE(without.bodies[0].rigid());
  }

  TEST_CASE("scene: cards, and keys laid over them") {
    const ScratchFolder folder;
    folder.write("materials/mild.yaml",
                 "density: 7800\nshear_modulus: 80 GPa\neos: {linear: {K: 160 GPa}}\n"
                 "strength: {von_mises: {Y: 300 MPa, H: 10 MPa}}\nviscosity: {q_lin: 0.1}\n");
    std::string text = small_scene();
    const std::size_t from = text.find("    density");
    text.replace(from, text.find("bodies:") - from,
                 "    card: mild\n    density: 7850\n    strength: {von_mises: {Y: 500 MPa}}\n");
    const std::string file = folder.write("scene.yaml", text);
    const Scene scene = read_scene(file);
    const MaterialOptions& steel = scene.materials[0];
    CHECK(steel.density == 7850);
    CHECK(value_of(scene, steel.strength, "Y") == 500e6);
    CHECK(value_of(scene, steel.strength, "H") == 10e6);
    CHECK(value_of(scene, steel.viscosity, "q_lin") == 0.1);
    CHECK(value_of(scene, steel.viscosity, "q_quad") == 2.0);
    check_fixed_point(scene, folder);
    const Scene other = read_scene(
        file, {"materials.steel.strength=elastic", "materials.steel.card=materials/mild.yaml"});
    CHECK(other.materials[0].strength->name == "elastic");
    const Scene without = read_scene(file, {"materials.steel.strength=none"});
    CHECK_FALSE(without.materials[0].strength.has_value());
    folder.write("materials/mild.yaml", "density: 7800\neos: {linear: {K: 160 MPA}}\n");
    CHECK(message_of(file).find("mild.yaml:2: materials.steel.eos.linear.K: '160 MPA'") !=
          std::string::npos);
    CHECK(message_of(file, {"materials.steel.card=mils"}).find("did you mean mild?") !=
          std::string::npos);
  }

  TEST_CASE("scene: elastic constants give what the laws need") {
    const ScratchFolder folder;
    std::string text = replaced(small_scene(), "shear_modulus: 80 GPa",
                                "youngs_modulus: 200 GPa\n    poisson_ratio: 0.25");
    text = replaced(text, "{linear: {bulk_modulus: 160 GPa}}", "linear");
    const Scene scene = read_scene(folder.write("e.yaml", text));
    CHECK(scene.materials[0].shear_modulus == doctest::Approx(80e9));
    CHECK(value_of(scene, scene.materials[0].eos, "bulk_modulus") == doctest::Approx(200e9 / 1.5));
    check_fixed_point(scene, folder);
    text = replaced(text, "    eos: linear\n", "");
    text = replaced(text, "von_mises: {Y: 400 MPa, H: 100 MPa}", "neo_hookean: {}");
    const Scene rubber = read_scene(folder.write("n.yaml", text));
    CHECK(value_of(rubber, rubber.materials[0].strength, "lame_lambda") == doctest::Approx(80e9));
    check_fixed_point(rubber, folder);
  }

  TEST_CASE("scene: fields by expression survive resolving") {
    const ScratchFolder folder;
    std::string text = replaced(small_scene(), "[0, -100 m/s]", "[10*r, \"z < 0.01 ? -100 : 0\"]");
    text = replaced(text, "bodies:", "body_force: [0, -9.81*t]\nbodies:");
    text = replaced(text, "transfer: tflip", "transfer: {xpic: {order: 4}}\n  jitter: 0.1");
    const Scene scene = read_scene(folder.write("f.yaml", text));
    CHECK((*scene.bodies[0].velocity)({0.5, 0, 0}, {}, 0) == Triple{5, -100, 0});
    CHECK(scene.body_force->depends_on_time());
    CHECK(scene.method.xpic_order == 4);
    check_fixed_point(scene, folder);
  }

  TEST_CASE("scene: titles and sources of any kind survive resolving") {
    const ScratchFolder folder;
    for (const char* title : {"\"a \\\"quoted\\\" back\\\\slash # : {x}\"", "'tab\there'",
                              "\"two\\nlines\"", "\xc3\xa9t\xc3\xa9", "12", "true", "''"}) {
      const Scene scene = read_scene(folder.write(
          "t.yaml", replaced(small_scene(), "title: small", std::string{"title: "} + title)));
      check_fixed_point(scene, folder);
    }
  }
}
