// SPDX-License-Identifier: GPL-3.0-or-later
// Measures of a scene as they are read: every key, and every way to get one wrong.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "scene_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

struct BadMeasure {
  const char* from;                ///< replaced in the small scene ...
  const char* to;                  ///< ... by this
  const char* line;                ///< the error names the first line with this text
  const char* path;                ///< and this path
  std::vector<const char*> parts;  ///< and says these things
};

const std::vector<BadMeasure> kBad{
    {"body: rod, axis",
     "body: [rod, bar], axis",
     "bar",
     "measures.length.body.1",
     {"unknown body 'bar'", "rod"}},
    {"body: rod, axis", "body: [rod, rod], axis", "[rod", "measures.length.body.1", {"twice"}},
    {"body: rod, axis", "body: [], axis", "[]", "measures.length.body", {"empty list"}},
    {"body: rod, axis: z}",
     "body: rod, axis: z, piece: big}",
     "big",
     "measures.length.piece",
     {"unknown value 'big'", "all, largest"}},
    {"body: rod, axis: z}",
     "body: rod, axis: z, least_points: 1.5}",
     "1.5",
     "measures.length.least_points",
     {"whole number"}},
    {"body: rod, axis: z}",
     "body: rod, axis: z, region: {z_min: 3 mm, z_max: 2 mm}}",
     "z_max: 2",
     "measures.length.region",
     {"empty", "z_max must lie beyond z_min"}},
    {"body: rod, axis: z}",
     "body: rod, axis: z, region: {y_min: 3 mm}}",
     "y_min",
     "measures.length.region.y_min",
     {"unknown key 'y_min'"}},
    {"body: rod, axis: z}",
     "body: rod, axis: z, region: {r_min: 1 mm, x_min: 1 mm}}",
     "x_min",
     "measures.length.region",
     {"same axis"}},
    {"body: rod, axis: z}",
     "body: rod, axis: z, keep: biggest}",
     "keep",
     "measures.length.keep",
     {"unknown value 'biggest'"}},
    {"kind: extent, body: rod, axis: z}",
     "kind: removed_mass, body: rod, piece: largest}",
     "piece",
     "measures.length.piece",
     {"unknown key 'piece'"}},
    {"kind: extent, body: rod, axis: z}",
     "kind: penetration_depth, body: rod, target: rod, face: z_min}",
     "target",
     "measures.length",
     {"cannot penetrate itself"}},
    {"kind: extent, body: rod, axis: z}",
     "kind: crater_depth, body: rod, face: r_max}",
     "r_max",
     "measures.length.face",
     {"unknown face 'r_max'", "z_min, z_max"}},
    {"kind: extent, body: rod, axis: z}",
     "kind: debris_extent, body: rod, axis: z, mass_share: 0}",
     "mass_share",
     "measures.length",
     {"mass_share must be positive"}},
    {"kind: extent, body: rod, axis: z}",
     "kind: maximum, body: rod, field: pressure, mass_share: 1.5}",
     "mass_share",
     "measures.length.mass_share",
     {"mass_share"}},
    {"kind: extent, body: rod, axis: z}",
     "kind: largest_diameter, body: rod, within: {from_lower_end: 0}}",
     "within",
     "measures.length.within.from_lower_end",
     {"positive"}},
    {"kind: extent, body: rod, axis: z}",
     "kind: largest_diameter, body: rod, within: {}}",
     "within",
     "measures.length.within",
     {"from_lower_end"}},
};

/// The small scene with one measure more.
std::string with_measure(const std::string& measure) {
  return replaced(small_scene(), "references:", "  more: {" + measure + "}\nreferences:");
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("scene measures: every mistake is named with file, line, path, reason and remedy") {
    const ScratchFolder folder;
    for (const BadMeasure& bad : kBad) {
      CAPTURE(bad.to);
      const std::string text = replaced(small_scene(), bad.from, bad.to);
      const std::string file = folder.write("bad.yaml", text);
      const std::string message = message_of(file);
      const std::string place =
          file + ":" + std::to_string(line_of(text, bad.line)) + ": " + bad.path + ": ";
      CAPTURE(message);
      CHECK_MESSAGE(message.find(place) != std::string::npos, "expected ", place);
      for (const char* part : bad.parts)
        CHECK_MESSAGE(message.find(part) != std::string::npos, part);
    }
  }

  TEST_CASE("scene measures: a hole is refused in plane strain only") {
    const ScratchFolder folder;
    const std::string file = folder.write("a.yaml", with_measure("kind: hole_diameter, body: rod"));
    CHECK(message_of(file) == "");
    CHECK(message_of(file, {"frame=3d"}) == "");
    const std::string message = message_of(file, {"frame=plane_strain"});
    CHECK(message.find("measures.more: hole_diameter is not defined in plane_strain") !=
          std::string::npos);
    CHECK(message.find("use axisymmetric or 3d") != std::string::npos);
  }

  TEST_CASE("scene measures: selections, faces and defaults are read and survive resolving") {
    const ScratchFolder folder;
    const std::string second =
        "bodies:\n  plate:\n    material: steel\n    shape: {cylinder: {radius: 8 mm, height: 2 "
        "mm, "
        "base: [0, 14 mm]}}\n";
    const auto read = [&](const std::string& measure, const std::string& frame) {
      const std::string text = replaced(with_measure(measure), "bodies:\n", second);
      const Scene scene = read_scene(folder.write("a.yaml", text), {"frame=" + frame});
      const Scene again = read_scene(folder.write("b.yaml", scene.resolved));
      const MeasureOptions &a = scene.measures.back(), &b = again.measures.back();
      CHECK(a.selection == b.selection);
      CHECK(a.kind == b.kind);
      CHECK(a.axis == b.axis);
      CHECK(a.target == b.target);
      CHECK(a.side == b.side);
      CHECK(a.level == b.level);
      CHECK(a.mass_share == b.mass_share);
      CHECK(a.keep == b.keep);
      CHECK(a.in_history == b.in_history);
      return a;
    };
    MeasureOptions m = read(
        "kind: debris_extent, body: [rod, plate], axis: x, mass_share: 0.9, piece: largest, "
        "region: {z_min: 2 mm, x_max: 3 mm}, keep: largest",
        "axisymmetric");
    CHECK(m.selection.bodies == std::vector<int>{1, 0});
    CHECK(m.selection.largest_piece);
    CHECK(m.selection.region[0][1] == 3e-3);
    CHECK(m.selection.region[1][0] == 2e-3);
    CHECK(m.keep == Keep::largest);
    CHECK(m.mass_share == 0.9);
    m = read("kind: penetration_depth, body: rod, target: plate, face: z_min", "3d");
    CHECK(m.target == 0);
    CHECK(m.axis == 2);
    CHECK(m.side == 0);
    CHECK(!m.selection.largest_piece);
    CHECK(m.in_history);
    m = read("kind: crater_diameter, body: plate, face: z_max", "plane_strain");
    CHECK(m.side == 1);
    CHECK(m.axis == 1);
    CHECK(m.selection.largest_piece);
    CHECK(m.level == 1e-3);
    CHECK(!m.in_history);
    m = read("kind: crater_diameter, body: plate, face: z_max, keep: largest, piece: all", "3d");
    CHECK(m.in_history);
    CHECK(!m.selection.largest_piece);
    m = read("kind: largest_diameter, body: rod, within: {from_lower_end: 3 mm}", "3d");
    CHECK(m.level == 3e-3);
    CHECK(read("kind: largest_diameter, body: rod", "3d").level == 0);
    CHECK(read("kind: maximum, body: rod, field: pressure", "3d").mass_share == kExtremeShare);
    CHECK(read("kind: minimum, body: rod, field: pressure, mass_share: 0", "3d").mass_share == 0);
    CHECK(read("kind: fragments, body: rod", "3d").selection.least_points == 64);
    CHECK(read("kind: fragments, body: rod", "axisymmetric").selection.least_points == 16);
    CHECK(read("kind: fragments, body: rod, least_points: 3", "3d").selection.least_points == 3);
    CHECK(std::string{unit_of(read("kind: momentum, body: rod, axis: z", "3d"))} == "kg m/s");
    CHECK(std::string{unit_of(read("kind: mean, body: rod, field: pressure", "3d"))} == "Pa");
  }
}
