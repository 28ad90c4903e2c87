// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/xdmf.hpp"

#include "output/format.hpp"

namespace krater::output {
namespace {

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
  const std::string points = std::to_string(body.ids.size());
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
    if (!body.ids.empty()) result += body_grid(body, file);  // readers stumble over empty grids
  }
  return result + "    </Grid>\n";
}

std::string xdmf_document(const std::map<int, std::string>& grids) {
  std::string result =
      "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n"
      "  <Grid Name=\"frames\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (const auto& [number, grid] : grids) result += grid;
  return result + "  </Grid>\n  </Domain>\n</Xdmf>\n";
}

}  // namespace krater::output
