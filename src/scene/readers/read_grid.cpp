// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>
#include <cstdint>

#include "scene/readers/read_boundary.hpp"
#include "scene/readers/readers.hpp"

namespace krater::scene {

namespace {

/// Of a side that carries a condition, in cells: what rounding of decimal input leaves.
constexpr double kOnNodeLine = 1e-6;
/// Blocks are addressed by 32-bit numbers in all directions together.
constexpr double kMostCells = 1e6;

std::string length_text(double metres) { return number_text(metres) + " m"; }

/// The box as given, one entry per component.
struct GivenBox {
  const Node* node = nullptr;
  std::vector<double> min, max;
  bool revolve = false;  ///< two components in 3d
};

std::vector<double> read_corner(const Node& node, Reading& reading) {
  std::vector<double> corner;
  if (node.kind != Node::Kind::list) {
    reading.problems.add(node.file, node.line, node.path,
                         "expected a list of lengths, found " + node.kind_name());
    return {};
  }
  for (const Node& item : node.items) {
    if (const auto value = read_number(item, "m", Range::any, reading.problems))
      corner.push_back(*value);
  }
  return corner.size() == node.items.size() ? corner : std::vector<double>{};
}

GivenBox read_box(Block& grid, Reading& reading) {
  GivenBox box;
  const Frame frame = reading.scene.frame;
  box.node = grid.require("box", "{min: [r or x, z], max: [r or x, z]}");
  if (!box.node) return box;
  Block block{box_block(), box.node, box.node->path, grid.place(), reading.problems};
  const Node* min = block.require("min");
  const Node* max = block.require("max");
  if (min) box.min = read_corner(*min, reading);
  if (max) box.max = read_corner(*max, reading);
  block.finish();
  if (box.min.empty() || box.max.empty()) return {};
  if (box.min.size() != box.max.size()) {
    block.fail("min and max have different numbers of components");
    return {};
  }
  const std::size_t size = box.min.size();
  if (size != 2 && !(size == 3 && frame == Frame::cartesian_3d)) {
    block.fail("expected 2" + std::string{frame == Frame::cartesian_3d ? " or 3" : ""} +
               " components where the frame is " + std::string{name(frame)} + ", found " +
               std::to_string(size));
    return {};
  }
  for (std::size_t k = 0; k < size; ++k) {
    if (!(box.max[k] > box.min[k])) {
      block.fail("max must lie beyond min along every axis");
      return {};
    }
  }
  if (frame == Frame::axisymmetric && box.min[0] < 0) block.fail("the lower side lies at r < 0");
  box.revolve = size == 2 && frame == Frame::cartesian_3d;
  if (box.revolve && box.min[0] != 0) {
    block.fail(
        "only a box that begins at the axis (min: [0, z]) can be revolved for 3d; give three "
        "components");
  }
  return box;
}

/// The domain along one axis, its upper condition and the axis's name.
struct Extent {
  double min, max;
  BoundaryKind upper;
  std::string side;
};

/// Number of cells between the sides; the upper side moves out to a node line if it is open.
std::int64_t count_cells(const Extent& extent, double cell, Block& grid, const Node& box) {
  const auto [min, max, upper, side] = extent;
  const double exact = (max - min) / cell;
  if (!(exact < kMostCells)) {
    grid.fail(box, "more than a million cells along an axis");
    return 1;
  }
  const double nearest = std::round(exact);
  if (nearest >= 1 && std::abs(exact - nearest) <= kOnNodeLine)
    return static_cast<std::int64_t>(nearest);
  const double below = std::floor(exact);
  if (upper != BoundaryKind::open) {
    grid.fail(box, "the upper " + side + " side carries a condition and must lie on a node line: " +
                       length_text(max) + " is " + number_text(exact) +
                       " cells from the lower side; use " +
                       (below >= 1 ? length_text(min + below * cell) + " or " : "") +
                       length_text(min + (below + 1) * cell) + ", or cell " +
                       length_text((max - min) / (below + 1)));
  }
  return static_cast<std::int64_t>(below) + 1;
}

void place_box(const GivenBox& box, Block& block, Reading& reading) {
  GridOptions& grid = reading.scene.grid;
  const Frame frame = reading.scene.frame;
  const auto dim = static_cast<std::size_t>(dimension(frame));
  for (std::size_t axis = 0; axis < dim; ++axis) {
    const bool radial = box.revolve && axis < 2;
    const std::size_t given = box.revolve ? (radial ? 0 : 1) : axis;
    const std::string side =
        box.revolve && radial ? "r" : std::string{axis_name(frame, static_cast<int>(axis))};
    if (box.revolve && axis == 1) {
      grid.min[1] = grid.min[0];
      grid.max[1] = grid.max[0];
      continue;
    }
    const std::int64_t cells =
        count_cells({box.min[given], box.max[given], grid.boundary[axis][1].kind, side}, grid.cell,
                    block, *box.node);
    const double length = static_cast<double>(cells) * grid.cell;
    grid.min[axis] = radial ? -length : box.min[given];
    // The axis is a node line and both sides are equally far from it.
    grid.max[axis] = radial ? length : box.min[given] + length;
  }
}

}  // namespace

Node read_grid(const Node* node, Reading& reading) {
  Block block{grid_block(), node, "grid", reading.root, reading.problems};
  GridOptions& grid = reading.scene.grid;
  const Frame frame = reading.scene.frame;
  grid.cell = block.number("cell");
  grid.where = (block.find("cell") ? *block.find("cell") : block.place()).where();
  const GivenBox box = read_box(block, reading);
  const BoxInfo info{box.min.empty() ? 0.0 : box.min[0], box.revolve, !box.min.empty()};
  const Node boundary = read_boundary(block.find("boundary"), info, block, reading);
  if (!reading.problems.any()) place_box(box, block, reading);
  Node corners;
  add_member(corners, "min", vector_node(frame, grid.min));
  add_member(corners, "max", vector_node(frame, grid.max));
  block.record("box", corners);
  block.record("boundary", boundary);
  read_refine(block, reading);
  return block.finish();
}

}  // namespace krater::scene
