// SPDX-License-Identifier: GPL-3.0-or-later
// Files of elements, good and bad: every bad one is refused with its line or element and a reason.
#include <doctest/doctest.h>

#include <stdexcept>

#include "element_cases.hpp"
#include "krater/geometry/meshes/mesh_solid.hpp"
#include "krater/kinematics/mesh/mesh.hpp"
#include "unit/scene/scene_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

PartMesh read_part(const std::string& file, Frame frame, const PartOptions& options) {
  return part_mesh(read_mesh_file(file), frame, options);
}

std::string message_of_part(const std::string& file, Frame frame, const PartOptions& options) {
  try {
    read_part(file, frame, options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

/// The text with its first `from` replaced.
std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE_MESSAGE(at != std::string::npos, from);
  return text.replace(at, from.size(), to);
}

std::vector<std::pair<const char*, std::string>> all_formats(const SmallMesh& mesh) {
  const bool plane = mesh.plane;
  return {{"a.msh", as_gmsh2(mesh)},
          {"b.msh", as_gmsh4(mesh)},
          {"c.inp", as_abaqus(mesh, plane ? "CPE4R" : "C3D8R")},
          {"d.INP", as_abaqus(mesh, plane ? "CPE4" : "C3D8", true)},
          {"e.k", as_dyna(mesh, 13)},
          {"f.key", as_dyna(mesh, 13, true)}};
}

struct BadFile {
  const char* name;
  std::string text, part;
  std::vector<std::string> says;
};

std::vector<BadFile> bad_bricks() {
  const SmallMesh good = small_bricks();
  const std::string inp = as_abaqus(good, "C3D8R"), msh = as_gmsh2(good), k = as_dyna(good),
                    msh4 = as_gmsh4(good);
  const std::string first = "1, 1, 2, 3, 4, 5, 6, 7, 8\n";
  const auto changed = [&](const std::string& to) { return with(inp, first, to); };
  const std::string more_nodes = "20, -4, 4, -0.5\n";
  return {
      {"empty.inp", "", "", {"is empty"}},
      {"nothing.inp", "*Heading\n", "", {"has no elements"}},
      {"mesh.vtk", "x", "", {".msh (Gmsh), .inp (Abaqus) and .k"}},
      {"part.inp", inp, "bolt", {"has no part 'bolt'", "rod (2 elements), plate (1 elements)"}},
      {"which.inp", inp, "", {"several parts", "rod (2", "plate (1"}},
      {"which.k", k, "", {"several parts", "rod or 1 (2", "plate or 2 (1"}},
      {"tet.inp",
       with(inp, "C3D8R, elset=rod\n1, 1, 2, 3, 4, 5, 6, 7, 8\n",
            "C3D4, elset=rod\n1, 1, 2, 3, 5\n*Element, type=C3D8R, elset=rod\n"),
       "rod",
       {"element 1 (C3D4)", "tetrahedra", "again with hexahedra"}},
      {"second.inp",
       with(inp, "C3D8R, elset=rod\n1, 1, 2, 3, 4, 5, 6, 7, 8\n",
            "C3D20R, elset=rod\n1, 1, 2, 3, 4, 5, 6, 7, 8,\n 9, 10, 11, 12, 13, 14, 15, 16, 17, "
            "18, 19, 20\n*Element, type=C3D8R, elset=rod\n"),
       "rod",
       {"element 1 (C3D20R)", "second order"}},
      {"unknown.inp",
       with(inp, "C3D8R, elset=rod", "U1, elset=rod"),
       "rod",
       {"(U1)", "does not know"}},
      {"family.inp",
       with(inp, "C3D8R, elset=rod", "C3D99, elset=rod"),
       "rod",
       {"(C3D99)", "does not know"}},
      {"shell.inp",
       with(inp, "C3D8R, elset=rod", "SC8R, elset=rod"),
       "rod",
       {"(SC8R)", "no solid element"}},
      {"type.msh", with(msh, "3 5 2 1 7", "3 99 2 1 7"), "rod", {"(type 99)", "does not know"}},
      {"prism.msh",
       with(msh, "3 5 2 1 7 1 2 3 4 5 6 7 8", "3 6 2 1 7 1 2 3 5 6 7"),
       "rod",
       {"(prism)", "tetrahedra"}},
      {"short.msh", with(msh, "1 2 3 4 5 6 7 8", "1 2 3 4 5 6 7"), "rod", {"has 7 nodes"}},
      {"node.inp",
       changed("1, 1, 2, 3, 4, 5, 6, 7, 88\n"),
       "rod",
       {":26: element 1 names node 88"}},
      {"wedge.inp",
       changed("1, 1, 2, 3, 3, 5, 6, 7, 7\n"),
       "rod",
       {"element 1 (C3D8R) names node 3 twice", "wedge"}},
      {"wedge.k",
       with(k, "       1       2       3       4       5       6       7       8",
            "       1       2       3       3       5       6       7       7"),
       "1",
       {"element 1 (solid) names node 3 twice"}},
      {"inverted.inp",
       changed("1, 5, 6, 7, 8, 1, 2, 3, 4\n"),
       "rod",
       {"element 1 (C3D8R) is inside out", "counter-clockwise"}},
      {"folded.inp",
       changed("1, 1, 2, 3, 4, 5, 7, 6, 8\n"),
       "rod",
       {"element 1 (C3D8R) is folded"}},
      {"flat.inp",
       with(inp, "1, 0, 0, 0\n2, 2, 0, 0\n3, 2, 1, 0\n4, 0, 1, 0\n",
            "1, 0, 0, 1\n2, 2, 0, 1\n3, 2, 1, 1\n4, 0, 1, 1\n"),
       "rod",
       {"element 1 (C3D8R)", "flat"}},
      {"twice.inp",
       changed(first + "7, 1, 2, 3, 4, 5, 6, 7, 8\n"),
       "rod",
       {"element 7", "lies on the same side", "element 1"}},
      {"same_number.inp", changed(first + first), "rod", {"element 1 is there twice"}},
      {"doubled.inp",
       with(with(inp, more_nodes,
                 more_nodes + "25, 0, 0, 1\n26, 2, 0, 1\n27, 2, 1, 1\n28, 0, 1, 1\n"),
            "2, 5, 6, 7, 8, 9", "2, 25, 26, 27, 28, 9"),
       "rod",
       {"element 1", "node 5 and node 25 lie in the same place", "merge_nodes"}},
      {"hanging.inp",
       with(with(inp, more_nodes,
                 more_nodes + "25, 0, 0, 1\n26, 1, 0, 1\n27, 1, 1, 1\n28, 0, 1, 1\n29, 0, 0, "
                              "2\n30, 1, 0, 2\n31, 1, 1, 2\n32, 0, 1, 2\n"),
            "2, 5, 6, 7, 8, 9, 10, 11, 12", "2, 25, 26, 27, 28, 29, 30, 31, 32"),
       "rod",
       {"element 1"}},
      {"overlap.inp",
       with(with(inp, more_nodes,
                 more_nodes +
                     "25, 0.5, 0.2, 0.5\n26, 1, 0.2, 0.5\n27, 1, 0.8, 0.5\n28, 0.5, 0.8, 0.5\n29, "
                     "0.5, 0.2, 2\n30, 1, 0.2, 2\n31, 1, 0.8, 2\n32, 0.5, 0.8, 2\n"),
            "2, 5, 6, 7, 8, 9, 10, 11, 12", "2, 25, 26, 27, 28, 29, 30, 31, 32"),
       "rod",
       {"element 1", "lies in it", "overlap"}},
      {"word.inp",
       changed("1, 1, 2, 3, four, 5, 6, 7, 8\n"),
       "rod",
       {":26: expected a whole number, found 'four'"}},
      {"cut.inp",
       changed("1, 1, 2, 3, 4, 5,\n*Element, type=C3D8R, elset=rod\n"),
       "rod",
       {"element 1, a C3D8R, has 5 nodes"}},
      {"include.inp", "*Include, input=x.inp\n" + inp, "rod", {":1: *INCLUDE is not read"}},
      {"instance.inp",
       with(as_abaqus(good, "C3D8R", true), "part=rod\n", "part=rod\n 1., 0., 0.\n"),
       "rod",
       {"places its part elsewhere", "move"}},
      {"set.inp", inp + "*Elset, elset=x\n 99\n", "rod", {"set x names element 99"}},
      {"node_twice.inp",
       with(inp, "2, 2, 0, 0\n", "1, 2, 0, 0\n"),
       "rod",
       {"node 1 is there twice"}},
      {"version.msh", with(msh, "2.2 0 8", "4 0 8"), "rod", {"version 4 of the format", "msh41"}},
      {"binary.msh", with(msh, "2.2 0 8", "2.2 1 8"), "rod", {"is binary", "msh41"}},
      {"head.msh",
       with(msh, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", ""),
       "rod",
       {"begins with $MeshFormat"}},
      {"lie.msh", with(msh, "$Nodes\n20", "$Nodes\n20000000"), "rod", {"promises 20000000"}},
      {"lie4.msh",
       with(msh4, "$Nodes\n1 20 1 20\n3 11 0 20", "$Nodes\n1 20 1 20\n3 11 0 99999999"),
       "rod",
       {"promises 99999999"}},
      {"cut.msh", msh.substr(0, msh.size() / 2), "rod", {"found"}},
      {"number.msh",
       with(msh, "2 2 0 0\n", "2 2 zero 0\n"),
       "rod",
       {"expected a number, found 'zero'"}},
      {"cut.k", with(k, "       5       6       7       8\n", "\n"), "rod", {"8 nodes"}},
      {"long.k", with(k, "*KEYWORD", "*KEYWORD LONG=Y"), "rod", {":1: the long format"}},
      {"include.k", with(k, "*NODE", "*INCLUDE\nx.k\n*NODE"), "rod", {"*INCLUDE is not read"}},
      {"ortho.k",
       with(k, "*ELEMENT_SOLID", "*ELEMENT_SOLID_ORTHO"),
       "rod",
       {"has cards that are not read"}},
  };
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("element files: all formats give the same bodies") {
    const ScratchFolder folder;
    const SmallMesh bricks = small_bricks(), plane = small_quadrilaterals();
    for (const SmallMesh* small : {&bricks, &plane})
      for (const auto& file_and_text : all_formats(*small)) {
        const auto& [name, text] = file_and_text;
        CAPTURE(file_and_text.first);
        const std::string file = folder.write(name, text);
        const Frame frame = small->plane ? Frame::plane_strain : Frame::cartesian_3d;
        const PartMesh rod = read_part(file, frame, {"rod", 1e-3, 0}),
                       plate = read_part(file, frame, {"plate", 1e-3, 0});
        std::vector<std::int32_t> corners;
        for (std::size_t e = 0; e < 2; ++e)
          for (const int n : small->elements[e]) corners.push_back(n - 1);
        CHECK(rod.mesh.elements == corners);
        REQUIRE(rod.mesh.nodes.size() == (small->plane ? 6 : 12));
        for (std::size_t n = 0; n < rod.mesh.nodes.size(); ++n)
          for (std::size_t a = 0; a < 3; ++a)
            CHECK(rod.mesh.nodes[n][a] ==
                  doctest::Approx(1e-3 * small->nodes[n][a]).epsilon(1e-12));
        CHECK(rod.numbers.size() == 2);
        CHECK(plate.mesh.element_count() == 1);
        const double volume =
            make_mesh_solid(plate.mesh, frame)->part(frame, {{-1, -1, -1}, {1, 1, 1}}).measure;
        CHECK(volume == doctest::Approx(small->plane ? 3e-6 : 160e-9).epsilon(1e-12));
      }
  }

  TEST_CASE(
      "element files: parts by number, by name in any case where the format has none, alone") {
    const ScratchFolder folder;
    const Frame frame = Frame::cartesian_3d;
    const SmallMesh small = small_bricks();
    const std::string k = folder.write("a.k", as_dyna(small)),
                      inp = folder.write("a.inp", as_abaqus(small, "C3D8R")),
                      set = folder.write("b.inp", as_abaqus(small, "C3D8R", true)),
                      msh = folder.write("a.msh", as_gmsh4(small));
    CHECK(read_part(k, frame, {"2", 1, 0}).mesh.element_count() == 1);
    CHECK(read_part(msh, frame, {"1", 1, 0}).mesh.element_count() == 2);
    CHECK(read_part(inp, frame, {"ROD", 1, 0}).mesh.element_count() == 2);
    CHECK(read_part(set, frame, {"rod.all", 1, 0}).mesh.element_count() == 2);
    CHECK(message_of_part(msh, frame, {"ROD", 1, 0}).find("has no part 'ROD'") !=
          std::string::npos);
    SmallMesh one = small;
    one.elements.pop_back();
    one.parts.pop_back();
    const std::string alone = folder.write("c.inp", as_abaqus(one, "C3D8R"));
    CHECK(read_part(alone, frame, {std::nullopt, 1, 0}).mesh.element_count() == 2);
  }

  TEST_CASE(
      "element files: plane elements turn, keep to their frame and to their side of the axis") {
    const ScratchFolder folder;
    SmallMesh small = small_quadrilaterals();
    const std::string text = as_abaqus(small, "CAX4R");
    const std::string file = folder.write("a.inp", text);
    CHECK(message_of_part(file, Frame::plane_strain, {"rod", 1, 0})
              .find("meant for the frame axisymmetric") != std::string::npos);
    CHECK(message_of_part(file, Frame::cartesian_3d, {"rod", 1, 0})
              .find("element 1 (CAX4R) of part 'rod' is no 8-node hexahedron") !=
          std::string::npos);
    const std::string left = folder.write("b.inp", with(text, "1, 0, 0\n", "1, -0.5, 0\n"));
    CHECK(message_of_part(left, Frame::axisymmetric, {"rod", 1, 0})
              .find("node 1 lies at r = -0.5 m") != std::string::npos);
    CHECK(
        message_of_part(folder.write("c.k", as_dyna(small, 2)), Frame::axisymmetric, {"rod", 1, 0})
            .find("elform 13") != std::string::npos);
    CHECK(read_part(folder.write("d.k", as_dyna(small, 15)), Frame::axisymmetric, {"rod", 1, 0})
              .mesh.element_count() == 2);
    const std::string stress = folder.write("e.inp", as_abaqus(small, "CPS4R"));
    CHECK(message_of_part(stress, Frame::plane_strain, {"rod", 1, 0}).find("plane stress") !=
          std::string::npos);
    const Mesh right = read_part(file, Frame::axisymmetric, {"rod", 1, 0}).mesh;
    for (auto& e : small.elements) std::swap(e[1], e[3]);
    for (Vector3& x : small.nodes) x = {x[0], 7, x[1]};  // clockwise, in a plane y = const
    const PartMesh turned =
        read_part(folder.write("f.msh", as_gmsh2(small)), Frame::axisymmetric, {"rod", 1, 0});
    CHECK(turned.mesh.elements == right.elements);
    CHECK(turned.mesh.nodes == right.nodes);
    REQUIRE(turned.notes.size() == 1);
    CHECK(turned.notes[0].find("2 of 2 quadrilaterals run clockwise") == 0);
  }

  TEST_CASE("element files: doubled nodes are merged where the scene says so") {
    const ScratchFolder folder;
    std::string text = as_abaqus(small_bricks(), "C3D8R");
    text = with(text, "20, -4, 4, -0.5\n",
                "20, -4, 4, -0.5\n25, 0, 0, 1\n26, 2, 0, 1\n27, 2, 1, 1.0000001\n28, 0, 1, 1\n");
    text = with(text, "2, 5, 6, 7, 8, 9", "2, 25, 26, 27, 28, 9");
    const std::string file = folder.write("a.inp", text);
    const Frame frame = Frame::cartesian_3d;
    const PartMesh merged = read_part(file, frame, {"rod", 1, 1e-4});
    CHECK(merged.mesh.nodes.size() == 12);
    CHECK(exposed_faces(merged.mesh).size() == 10);
    REQUIRE(merged.notes.size() == 1);
    CHECK(merged.notes[0].find("4 nodes merged") == 0);
  }

  TEST_CASE("element files: bad ones are refused by element or line") {
    const ScratchFolder folder;
    for (const BadFile& bad : bad_bricks()) {
      CAPTURE(bad.name);
      const std::string file = folder.write(bad.name, bad.text);
      PartOptions options{std::nullopt, 1, 0};
      if (!bad.part.empty()) options.part = bad.part;
      const std::string message = message_of_part(file, Frame::cartesian_3d, options);
      CHECK_MESSAGE(message.find(bad.name) != std::string::npos, message);
      for (const std::string& word : bad.says)
        CHECK_MESSAGE(message.find(word) != std::string::npos, "'" << word << "' in: " << message);
    }
    CHECK(message_of_part((folder.path() / "none.inp").string(), Frame::cartesian_3d, {})
              .find("no such file") != std::string::npos);
  }
}
