// SPDX-License-Identifier: GPL-3.0-or-later
#include "element_cases.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace krater::test {

namespace {

int part_number(const SmallMesh& mesh, const std::string& part) {
  return part == mesh.parts.front() ? 1 : 2;
}

std::string joined(const std::vector<int>& numbers, const char* between) {
  std::string out;
  for (const int n : numbers) out += (out.empty() ? "" : between) + std::to_string(n);
  return out;
}

}  // namespace

SmallMesh small_bricks() {
  SmallMesh out;
  for (const double z : {0.0, 1.0, 2.5})
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {2.0, 0.0}, {2.0, 1.0}, {0.0, 1.0}})
      out.nodes.push_back({x, y, z});
  for (const double z : {-3.0, -0.5})
    for (const auto& [x, y] : {std::pair{-4.0, -4.0}, {4.0, -4.0}, {4.0, 4.0}, {-4.0, 4.0}})
      out.nodes.push_back({x, y, z});
  out.elements = {
      {1, 2, 3, 4, 5, 6, 7, 8}, {5, 6, 7, 8, 9, 10, 11, 12}, {13, 14, 15, 16, 17, 18, 19, 20}};
  out.parts = {"rod", "rod", "plate"};
  return out;
}

SmallMesh small_quadrilaterals() {
  SmallMesh out;
  out.plane = true;
  out.nodes = {{0, 0, 0},   {1, 0, 0},  {2.5, 0, 0}, {0, 1, 0},  {1, 1, 0},
               {2.5, 1, 0}, {0, -2, 0}, {3, -2, 0},  {3, -1, 0}, {0, -1, 0}};
  out.elements = {{1, 2, 5, 4}, {2, 3, 6, 5}, {7, 8, 9, 10}};
  out.parts = {"rod", "rod", "plate"};
  return out;
}

std::string as_gmsh2(const SmallMesh& mesh) {
  const int dim = mesh.plane ? 2 : 3;
  std::string out = fmt::format(
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n{0} 1 \"rod\"\n{0} 2 \"plate\"\n"
      "$EndPhysicalNames\n$Nodes\n{1}\n",
      dim, mesh.nodes.size());
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    out +=
        fmt::format("{} {} {} {}\n", n + 1, mesh.nodes[n][0], mesh.nodes[n][1], mesh.nodes[n][2]);
  // Gmsh writes what lies on boundaries too.
  out += fmt::format("$EndNodes\n$Elements\n{}\n1 15 2 0 1 1\n2 1 2 0 1 1 2\n",
                     mesh.elements.size() + 2);
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    out += fmt::format("{} {} 2 {} 7 {}\n", e + 3, mesh.plane ? 3 : 5,
                       part_number(mesh, mesh.parts[e]), joined(mesh.elements[e], " "));
  return out + "$EndElements\n";
}

std::string as_gmsh4(const SmallMesh& mesh) {
  const int dim = mesh.plane ? 2 : 3;
  const std::size_t count = mesh.nodes.size();
  std::string out = fmt::format(
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n{0} 1 \"rod\"\n{0} 2 \"plate\"\n"
      "$EndPhysicalNames\n$Entities\n1 0 {1} {2}\n1 0 0 0 0\n"
      "11 0 0 0 1 1 1 1 1 0\n12 0 0 0 1 1 1 1 2 0\n$EndEntities\n$Nodes\n1 {3} 1 {3}\n{0} 11 0 "
      "{3}\n",
      dim, mesh.plane ? 2 : 0, mesh.plane ? 0 : 2, count);
  for (std::size_t n = 0; n < count; ++n) out += fmt::format("{}\n", n + 1);
  for (const Vector3& x : mesh.nodes) out += fmt::format("{} {} {}\n", x[0], x[1], x[2]);
  out += "$EndNodes\n$Elements\n3 4 1 4\n0 1 15 1\n9 1\n";
  std::size_t first = 0;
  for (const int part : {1, 2}) {
    std::string lines;
    std::size_t here = 0;
    for (std::size_t e = first; e < mesh.elements.size(); ++e)
      if (part_number(mesh, mesh.parts[e]) == part) {
        lines += fmt::format("{} {}\n", e + 1, joined(mesh.elements[e], " "));
        ++here;
      }
    out += fmt::format("{} {} {} {}\n{}", dim, 10 + part, mesh.plane ? 3 : 5, here, lines);
    first += here;
  }
  return out + "$EndElements\n$Periodic\n0\n$EndPeriodic\n";
}

std::string as_abaqus(const SmallMesh& mesh, const std::string& type, bool parts) {
  std::string nodes = "*Node\n";
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    nodes += mesh.plane ? fmt::format("{}, {}, {}\n", n + 1, mesh.nodes[n][0], mesh.nodes[n][1])
                        : fmt::format("{}, {}, {}, {}\n", n + 1, mesh.nodes[n][0], mesh.nodes[n][1],
                                      mesh.nodes[n][2]);
  std::string out = "*Heading\n small mesh\n** a comment\n" + (parts ? "" : nodes);
  for (const char* part : {"rod", "plate"}) {
    std::string set;
    out += parts ? fmt::format("*Part, name={}\n{}*Element, type={}\n", part, nodes, type)
                 : fmt::format("*Element, type={}, elset={}\n", type, part);
    for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
      if (mesh.parts[e] != part) continue;
      out += fmt::format("{}, {}\n", e + 1, joined(mesh.elements[e], ", "));
      set += fmt::format("{}, ", e + 1);
    }
    if (parts)
      out +=
          "*Elset, elset=all\n" + set + "\n*Solid section, elset=all, material=m\n,\n*End part\n";
  }
  if (parts)
    out += "*Assembly, name=a\n*Instance, name=i, part=rod\n*End instance\n*End assembly\n";
  return out + "*Material, name=m\n*Density\n 1000.,\n";
}

std::string as_dyna(const SmallMesh& mesh, int form, bool commas) {
  std::string out =
      "*KEYWORD\n$ small mesh\n*PART\nrod\n         1         5         1\nplate\n"
      "         2         5         1\n";
  if (mesh.plane)
    out += fmt::format("*SECTION_SHELL\n{:10}{:10}\n       1.0       1.0       1.0       1.0\n", 5,
                       form);
  out += "*NODE\n$#   nid               x               y               z\n";
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    out += commas ? fmt::format("{},{},{},{}\n", n + 1, mesh.nodes[n][0], mesh.nodes[n][1],
                                mesh.nodes[n][2])
                  : fmt::format("{:8}{:16.9e}{:16.9e}{:16.9e}       0       0\n", n + 1,
                                mesh.nodes[n][0], mesh.nodes[n][1], mesh.nodes[n][2]);
  out += mesh.plane ? "*ELEMENT_SHELL\n" : "*ELEMENT_SOLID\n";
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    const int part = part_number(mesh, mesh.parts[e]);
    out += commas ? fmt::format("{},{},{}", e + 1, part, joined(mesh.elements[e], ","))
                  : fmt::format("{:8}{:8}", e + 1, part);
    for (const int n : mesh.elements[e]) out += commas ? "" : fmt::format("{:8}", n);
    out += "\n";
  }
  return out + "*END\n";
}

}  // namespace krater::test
