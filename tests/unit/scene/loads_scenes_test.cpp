// SPDX-License-Identifier: GPL-3.0-or-later
// Loads and damping of a scene: what is read, and what is refused by name.
#include <doctest/doctest.h>

#include "scene_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

std::string problem(const std::string& block, const std::string& from = "",
                    const std::string& to = "") {
  const ScratchFolder folder;
  std::string text = small_scene() + block;
  if (!from.empty()) text = replaced(text, from, to);
  return message_of(folder.write("a.yaml", text));
}

std::string push(const std::string& keys) { return "loads: {push: {body: rod, " + keys + "}}\n"; }

}  // namespace

TEST_CASE("loads: values, expressions and tables of time") {
  const ScratchFolder folder;
  const auto value = [&](const std::string& text, double t) {
    const Scene scene =
        read_scene(folder.write("a.yaml", small_scene() + push("face: z_max, pressure: " + text)));
    REQUIRE(scene.loads.faces.size() == 1);
    CHECK(scene.loads.faces[0].axis == 1);
    CHECK(scene.loads.faces[0].side == 1);
    const Scene again = read_scene(folder.write("b.yaml", scene.resolved));
    CHECK(again.loads.faces[0].value[0](t) == scene.loads.faces[0].value[0](t));
    return scene.loads.faces[0].value[0](t);
  };
  CHECK(value("1 GPa", 3) == 1e9);
  CHECK(value("\"1e9*exp(-t/1e-6)\"", 0) == 1e9);
  const std::string table = "{table: [[1 us, 0], [2 us, 4 MPa]]}";
  CHECK(value(table, 0) == 0);
  CHECK(value(table, 1.25e-6) == doctest::Approx(1e6));
  CHECK(value(table, 9) == 4e6);
}

TEST_CASE("loads: a pressure on a side of the box acts on the bodies that reach it") {
  const ScratchFolder folder;
  const std::string side = "    z_min: {pressure: 3 MPa}";
  const Scene scene =
      read_scene(folder.write("a.yaml", replaced(small_scene(), "    z_min: wall", side)));
  REQUIRE(scene.loads.faces.size() == 1);
  CHECK(scene.loads.faces[0].bodies == std::vector<int>{0});
  CHECK(scene.loads.faces[0].value[0](0) == 3e6);
  CHECK(scene.grid.boundary[1][0].kind == BoundaryKind::open);
  CHECK(read_scene(folder.write("b.yaml", scene.resolved)).loads.faces.size() == 1);
  CHECK(problem("", "    z_min: wall", "    z_max: {pressure: 3 MPa}")
            .find("no body reaches this side") != std::string::npos);
}

TEST_CASE("loads: damping") {
  const ScratchFolder folder;
  CHECK(read_scene(folder.write("a.yaml", small_scene() + "damping: {mass: 2e3 1/s}\n"))
            .loads.damping == 2000);
  CHECK(problem("damping: {mass: 2e3 m/s}\n").find("wrong dimension") != std::string::npos);
  CHECK(problem("damping: {mass: -1}\n").find("must be positive") != std::string::npos);
  CHECK(problem("damping: {}\n").find("missing key 'mass'") != std::string::npos);
  CHECK(problem("damping: {mass: 1}\n", "transfer: tflip", "transfer: xpic").find("xpic") !=
        std::string::npos);
}

TEST_CASE("loads: what has no meaning is refused by name") {
  const auto says = [](const std::string& block, const char* part) {
    const std::string text = problem(block);
    CHECK_MESSAGE(text.find(part) != std::string::npos, block, ": ", text);
    CHECK_MESSAGE(text.find("loads") != std::string::npos, text);
  };
  says("loads: {push: {body: rot, face: z_max, pressure: 1 MPa}}\n", "did you mean rod");
  says(push("face: z_top, pressure: 1 MPa"), "known: r_min");
  says(push("face: z_max"), "expected one of pressure, traction and velocity");
  says(push("face: z_max, pressure: 1 MPa, traction: [0, 1 MPa]"), "expected one of pressure");
  says(push("face: z_max, pressure: 1 m/s"), "wrong dimension");
  says(push("face: z_max, pressure: \"3*q\""), "unknown variable 'q'");
  says(push("face: z_max, pressure: {table: [[1 us, 0], [0 us, 1 MPa]]}"), "goes back in time");
  says(push("face: z_max, pressure: {table: [[1 us]]}"), "rows of two");
  says(push("face: z_max, pressure: {table: []}"), "expected rows");
  says(push("face: z_max, pressure: {rows: 3}"), "expected {table");
  says(push("traction: [0, 1 MPa]"), "needs its face");
  says(push("face: z_max, traction: [0, 1 MPa, 0]"), "expected 2 components");
  says(push("face: z_max, velocity: [free, 1 MPa]"), "wrong dimension");
  says(push("face: z_max, where: {}, pressure: 1 MPa"), "give at least one bound");
  says(
      "loads: {a: {body: rod, pressure: 1}, b: {body: rod, pressure: 1}, c: {body: rod, pressure: "
      "1}}\n",
      "more loads than the frame has axes");
}
