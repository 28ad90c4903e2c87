// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/xdmf.hpp"

#include <cmath>
#include <cstdio>

#include "output/format.hpp"

namespace krater::output {
namespace {

constexpr std::string_view kFrameEnd = "\n    </Grid>\n";  // no body's grid ends so

std::string xml(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string data_item(const std::string& type, int precision, const std::string& sizes,
                      const std::string& path) {
  return "<DataItem Format=\"HDF\" NumberType=\"" + type + "\" Precision=\"" +
         std::to_string(precision) + "\" Dimensions=\"" + sizes + "\">" + xml(path) + "</DataItem>";
}

/// Fields of one kind: on points and nodes, or on cells.
struct Centring {
  std::string name, rows, root;  ///< as XDMF calls it; how many; where the arrays are

  std::string attribute(const std::string& field, const std::string& type,
                        const std::string& item) const {
    return "        <Attribute Name=\"" + xml(field) + "\" AttributeType=\"" + type +
           "\" Center=\"" + name + "\">" + item + "</Attribute>\n";
  }
};

/// Column k of an array as a scalar: readers disagree about arrays that are no vector and no
/// tensor.
std::string column(int k, const std::string& points, const std::string& whole) {
  return "<DataItem ItemType=\"HyperSlab\" NumberType=\"Float\" Precision=\"8\" Dimensions=\"" +
         points + "\"><DataItem Format=\"XML\" NumberType=\"Int\" Dimensions=\"3 2\">0 " +
         std::to_string(k) + " 1 1 " + points + " 1</DataItem>" + whole + "</DataItem>";
}

std::string field_attributes(const FieldArray& field, const Centring& at) {
  const std::string sizes =
      field.components == 1 ? at.rows : at.rows + " " + std::to_string(field.components);
  const std::string item = data_item("Float", 8, sizes, at.root + field.name);
  switch (field.components) {
    case 1:
      return at.attribute(field.name, "Scalar", item);
    case 3:
      return at.attribute(field.name, "Vector", item);
    case 9:
      return at.attribute(field.name, "Tensor", item);
    default:
      break;
  }
  std::string result;
  for (int k = 0; k < field.components; ++k) {
    const auto index = static_cast<std::size_t>(k);
    const auto& names = field.component_names;
    const std::string name = index < names.size() ? names[index] : std::to_string(k);
    result += at.attribute(field.name + "_" + name, "Scalar", column(k, at.rows, item));
  }
  return result;
}

/// The cells are spelt out because only some readers number the points of a Polyvertex themselves.
std::string topology(const BodyFrame& body, const std::string& root) {
  const std::string cells = std::to_string(body.points);
  if (!body.mesh)
    return "<Topology TopologyType=\"Polyvertex\" NodesPerElement=\"1\" NumberOfElements=\"" +
           cells + "\">" + data_item("Int", 8, cells, root + "cells");
  const std::string kind = body.mesh->corners == 8 ? "Hexahedron" : "Quadrilateral";
  return "<Topology TopologyType=\"" + kind + "\" NumberOfElements=\"" + cells + "\">" +
         data_item("Int", 8, cells + " " + std::to_string(body.mesh->corners),
                   root + "connectivity");
}

std::string body_grid(const BodyFrame& body, const std::string& file) {
  const std::string root = file + ":/" + body.body + "/";
  const Centring points{body.mesh ? "Cell" : "Node", std::to_string(body.points), root};
  const Centring corners =
      body.mesh ? Centring{"Node", std::to_string(body.mesh->nodes), root + "nodes/"} : points;
  std::string result =
      "      <Grid Name=\"" + xml(body.body) + "\" GridType=\"Uniform\">\n        " +
      topology(body, root) + "</Topology>\n" + "        <Geometry GeometryType=\"XYZ\">" +
      data_item("Float", 8, corners.rows + " 3", corners.root + "coordinates") + "</Geometry>\n" +
      points.attribute("id", "Scalar", data_item("Int", 8, points.rows, root + "id"));
  for (const auto& field : body.fields) result += field_attributes(field, points);
  if (body.mesh)
    for (const auto& field : body.mesh->fields) result += field_attributes(field, corners);
  return result + "      </Grid>\n";
}

}  // namespace

std::string frame_grid(const OutputFrame& frame, const std::string& file) {
  std::string result = "    <Grid Name=\"frame " + std::to_string(frame.number) +
                       "\" GridType=\"Collection\" CollectionType=\"Spatial\">\n" +
                       "      <Time Value=\"" + exact(frame.time) + "\"/>\n";
  for (const auto& body : frame.bodies) {
    if (body.points > 0) result += body_grid(body, file);  // readers stumble over empty grids
  }
  result.pop_back();  // the end begins with its line break
  return result.append(kFrameEnd);
}

std::vector<ListedFrame> listed_frames(const std::string& document) {
  std::vector<ListedFrame> list;
  if (!document.starts_with(kXdmfHead)) return list;
  ListedFrame next;
  for (next.begin = kXdmfHead.size();; next.begin = next.end) {
    const std::size_t close = document.find(kFrameEnd, next.begin);
    if (close == std::string::npos) return list;
    next.end = close + kFrameEnd.size();
    const std::string grid = document.substr(next.begin, next.end - next.begin);
    const std::size_t time = grid.find("<Time Value=\"");
    if (std::sscanf(grid.c_str(), "    <Grid Name=\"frame %9d\"", &next.number) != 1 ||
        time == std::string::npos || next.number < 0 ||
        std::sscanf(grid.c_str() + time, "<Time Value=\"%lf\"", &next.time) != 1 ||
        !std::isfinite(next.time))
      return list;
    list.push_back(next);
  }
}

}  // namespace krater::output
