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

std::string attribute(const std::string& name, const std::string& type, const std::string& item) {
  return "        <Attribute Name=\"" + xml(name) + "\" AttributeType=\"" + type +
         "\" Center=\"Node\">" + item + "</Attribute>\n";
}

/// Column k of an array as a scalar: readers disagree about arrays that are no vector and no
/// tensor.
std::string column(int k, const std::string& points, const std::string& whole) {
  return "<DataItem ItemType=\"HyperSlab\" NumberType=\"Float\" Precision=\"8\" Dimensions=\"" +
         points + "\"><DataItem Format=\"XML\" NumberType=\"Int\" Dimensions=\"3 2\">0 " +
         std::to_string(k) + " 1 1 " + points + " 1</DataItem>" + whole + "</DataItem>";
}

std::string field_attributes(const FieldArray& field, const std::string& points,
                             const std::string& path) {
  const std::string sizes =
      field.components == 1 ? points : points + " " + std::to_string(field.components);
  const std::string item = data_item("Float", 8, sizes, path);
  switch (field.components) {
    case 1:
      return attribute(field.name, "Scalar", item);
    case 3:
      return attribute(field.name, "Vector", item);
    case 9:
      return attribute(field.name, "Tensor", item);
    default:
      break;
  }
  std::string result;
  for (int k = 0; k < field.components; ++k) {
    const auto index = static_cast<std::size_t>(k);
    const auto& names = field.component_names;
    const std::string name = index < names.size() ? names[index] : std::to_string(k);
    result += attribute(field.name + "_" + name, "Scalar", column(k, points, item));
  }
  return result;
}

std::string body_grid(const BodyFrame& body, const std::string& file) {
  const std::string points = std::to_string(body.points);
  const std::string root = file + ":/" + body.body + "/";
  // The cells are spelt out because only some readers number the points of a Polyvertex themselves.
  std::string result =
      "      <Grid Name=\"" + xml(body.body) + "\" GridType=\"Uniform\">\n" +
      "        <Topology TopologyType=\"Polyvertex\" NodesPerElement=\"1\" " +
      "NumberOfElements=\"" + points + "\">" + data_item("Int", 8, points, root + "cells") +
      "</Topology>\n" + "        <Geometry GeometryType=\"XYZ\">" +
      data_item("Float", 8, points + " 3", root + "coordinates") + "</Geometry>\n" +
      attribute("id", "Scalar", data_item("Int", 8, points, root + "id"));
  for (const auto& field : body.fields) {
    result += field_attributes(field, points, root + field.name);
  }
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
