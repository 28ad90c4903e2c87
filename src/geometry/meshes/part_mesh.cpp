// SPDX-License-Identifier: GPL-3.0-or-later
// One part of a file as a mesh.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "geometry/meshes/mesh_examine.hpp"
#include "geometry/meshes/mesh_formats.hpp"
#include "geometry/meshes/mesh_lines.hpp"

namespace krater {
namespace {

using Indices = std::vector<std::size_t>;

/// What a frame's elements are called.
const char* wanted_of(Frame frame) {
  return dimension(frame) == 3 ? "8-node hexahedra" : "4-node quadrilaterals";
}

const char* one_of(Frame frame) {
  return dimension(frame) == 3 ? "8-node hexahedron" : "4-node quadrilateral";
}

Indices of_dimension(const MeshFile& file, const Indices& all, int dim) {
  Indices out;
  for (const std::size_t e : all)
    if (const int d = file.kinds[file.elements[e].kind].dimension; d == dim || d < 0)
      out.push_back(e);
  return out;
}

std::string list_of(const MeshFile& file, int dim) {
  std::string out;
  for (const MeshFile::Part& part : file.parts)
    if (const std::size_t n = of_dimension(file, part.elements, dim).size(); n > 0)
      out += fmt::format("{}{}{} ({} elements)", out.empty() ? "" : ", ", part.name,
                         part.also.empty() || part.also == part.name ? "" : " or " + part.also, n);
  return out.empty() ? "none that it names" : out;
}

/// "file:line: element 12 (C3D8R)".
std::string name_of(const MeshFile& file, std::size_t element) {
  const MeshFile::Element& e = file.elements[element];
  return fmt::format("{}:{}: element {} ({})", file.name, e.line, e.number,
                     file.kinds[e.kind].name);
}

/// The elements of the part asked for, or of the only one.
Indices select(const MeshFile& file, Frame frame, const std::optional<std::string>& name,
               std::string& told) {
  const int dim = dimension(frame);
  const auto called = [&](const std::string& own) {
    return !own.empty() && (file.any_case ? upper(own) == upper(*name) : own == *name);
  };
  if (name) {
    for (const MeshFile::Part& part : file.parts)
      if (called(part.name) || called(part.also)) {
        told = part.name;
        Indices out = of_dimension(file, part.elements, dim);
        std::sort(out.begin(), out.end());
        out.erase(std::unique(out.begin(), out.end()), out.end());
        if (!out.empty()) return out;
        if (!part.elements.empty())
          throw std::invalid_argument(fmt::format(
              "{} of part '{}' is no {}, nor are the others: a body in the frame {} is made of {}",
              name_of(file, part.elements.front()), *name, one_of(frame), krater::name(frame),
              wanted_of(frame)));
      }
    throw std::invalid_argument(fmt::format("{}: has no part '{}' of {}; there are: {}", file.name,
                                            *name, wanted_of(frame), list_of(file, dim)));
  }
  Indices all(file.elements.size());
  for (std::size_t e = 0; e < all.size(); ++e) all[e] = e;
  all = of_dimension(file, all, dim);
  if (all.empty())
    throw std::invalid_argument(
        fmt::format("{}: has no {}, of which a body in the frame {} is made", file.name,
                    wanted_of(frame), krater::name(frame)));
  std::size_t parts = 0;
  bool whole = false;
  for (const MeshFile::Part& part : file.parts) {
    const std::size_t n = of_dimension(file, part.elements, dim).size();
    parts += n > 0 ? 1 : 0;
    whole = whole || n == all.size();
  }
  if (parts > 1 && !whole)
    throw std::invalid_argument(
        fmt::format("{}: holds several parts, so part: must name one; "
                    "there are: {}",
                    file.name, list_of(file, dim)));
  return all;
}

void require_kind(const MeshFile& file, std::size_t element, Frame frame) {
  const ElementKind& kind = file.kinds[file.elements[element].kind];
  if (!kind.refusal.empty())
    throw std::invalid_argument(name_of(file, element) + " is " + kind.refusal);
  if (kind.frame && *kind.frame != frame)
    throw std::invalid_argument(fmt::format("{} is meant for the frame {}, and the scene has {}",
                                            name_of(file, element), krater::name(*kind.frame),
                                            krater::name(frame)));
  const MeshFile::Element& e = file.elements[element];
  for (std::size_t a = e.first; a < e.first + e.count; ++a)
    for (std::size_t b = e.first; b < a; ++b)
      if (file.nodes_of[a] == file.nodes_of[b])
        throw std::invalid_argument(fmt::format(
            "{} names node {} twice: it is a wedge, pyramid, tetrahedron or triangle; make the "
            "mesh again with {} only",
            name_of(file, element), file.node_numbers[file.nodes_of[a]], wanted_of(frame)));
}

/// Which two coordinates of the file are the plane's.
std::array<std::size_t, 2> plane_of(const MeshFile& file, const Indices& elements) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  Vector3 low{inf, inf, inf}, high{-inf, -inf, -inf};
  for (const std::size_t e : elements) {
    const MeshFile::Element& element = file.elements[e];
    for (std::size_t k = element.first; k < element.first + element.count; ++k)
      for (std::size_t a = 0; a < 3; ++a) {
        low[a] = std::min(low[a], file.nodes[file.nodes_of[k]][a]);
        high[a] = std::max(high[a], file.nodes[file.nodes_of[k]][a]);
      }
  }
  const double size = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  if (high[2] - low[2] <= 1e-9 * size) return {0, 1};
  if (high[1] - low[1] <= 1e-9 * size) return {0, 2};
  throw std::invalid_argument(file.name +
                              ": its quadrilaterals lie neither in a plane z = const nor y = const "
                              "of the file: they are shells, or the plane must be turned");
}

Mesh build(const MeshFile& file, const Indices& elements, Frame frame, double unit,
           std::vector<std::size_t>& node_of) {
  const int dim = dimension(frame);
  Mesh mesh{dim, {}, {}};
  const std::array<std::size_t, 2> plane =
      dim == 2 ? plane_of(file, elements) : std::array<std::size_t, 2>{0, 1};
  constexpr std::int32_t none = -1;
  std::vector<std::int32_t> number(file.nodes.size(), none);
  for (const std::size_t e : elements)
    for (std::size_t k = 0; k < file.elements[e].count; ++k)
      number[file.nodes_of[file.elements[e].first + k]] = 0;
  for (std::size_t n = 0; n < number.size(); ++n) {
    if (number[n] == none) continue;
    number[n] = static_cast<std::int32_t>(node_of.size());
    node_of.push_back(n);
    const Vector3& x = file.nodes[n];
    mesh.nodes.push_back(dim == 3 ? Vector3{unit * x[0], unit * x[1], unit * x[2]}
                                  : Vector3{unit * x[plane[0]], unit * x[plane[1]], 0});
  }
  for (const std::size_t e : elements)
    for (std::size_t k = 0; k < file.elements[e].count; ++k)
      mesh.elements.push_back(number[file.nodes_of[file.elements[e].first + k]]);
  return mesh;
}

}  // namespace

PartMesh part_mesh(const MeshFile& file, Frame frame, const PartOptions& options) {
  PartMesh out;
  const Indices elements = select(file, frame, options.part, out.part);
  for (const std::size_t e : elements) require_kind(file, e, frame);
  std::vector<std::size_t> node_of;
  out.mesh = build(file, elements, frame, options.unit, node_of);
  for (const std::size_t e : elements) out.numbers.push_back(file.elements[e].number);
  const MeshNames names{
      [&](std::size_t e) { return name_of(file, elements[e]); },
      [&](std::size_t n) { return std::to_string(file.node_numbers[node_of[n]]); }};
  if (options.merge_nodes > 0) {
    const std::size_t gone = merge_nodes(out.mesh, options.merge_nodes, node_of);
    out.notes.push_back(
        fmt::format("{} nodes merged with others within {:g} m", gone, options.merge_nodes));
  }
  if (frame != Frame::cartesian_3d)
    if (const std::size_t turned = turn_clockwise(out.mesh); turned > 0)
      out.notes.push_back(fmt::format("{} of {} quadrilaterals run clockwise and are turned",
                                      turned, elements.size()));
  if (frame == Frame::axisymmetric)
    for (std::size_t n = 0; n < out.mesh.nodes.size(); ++n)
      if (out.mesh.nodes[n][0] < 0)
        throw std::invalid_argument(fmt::format("{}: node {} lies at r = {:g} m, beyond the axis",
                                                file.name, names.node(n), out.mesh.nodes[n][0]));
  examine_elements(out.mesh, names);
  examine_joints(out.mesh, names);
  return out;
}

}  // namespace krater
