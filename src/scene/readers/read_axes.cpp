// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/readers/read_axes.hpp"

#include <array>
#include <cmath>

namespace krater::scene {

namespace {

constexpr std::array<const char*, 2> kSides{"_min", "_max"};

}  // namespace

int axis_of(Frame frame, std::string_view word) {
  if (dimension(frame) == 2 && (word == "x" || word == "r")) return 0;
  return axis_from_name(frame, word).value_or(-1);
}

std::vector<std::string> axis_names(Frame frame) {
  std::vector<std::string> axes;
  for (int axis = 0; axis < dimension(frame); ++axis) axes.emplace_back(axis_name(frame, axis));
  return axes;
}

std::pair<int, int> side_of(Frame frame, std::string_view word) {
  for (int side = 0; side < 2; ++side)
    if (word.ends_with(kSides[static_cast<std::size_t>(side)]))
      return {axis_of(frame, word.substr(0, word.size() - 4)), side};
  return {-1, 0};
}

std::string side_name(Frame frame, int axis, int side) {
  return std::string{axis_name(frame, axis)} + kSides[static_cast<std::size_t>(side)];
}

int read_axis(Block& block, Reading& reading) {
  const Frame frame = reading.scene.frame;
  const std::vector<std::string> axes = axis_names(frame);
  const Node* node = block.require("axis", "one of " + join(axes));
  if (!node) return -1;
  const std::optional<std::string> word = read_word(*node, reading.problems);
  if (!word) return -1;
  const int axis = axis_of(frame, *word);
  if (axis < 0) {
    report_unknown(*node, "axis", *word, axes, reading.problems);
    return -1;
  }
  block.record("axis", string_node(std::string{axis_name(frame, axis)}));
  return axis;
}

void read_bounds(Block& block, std::array<std::array<double, 2>, 3>& region, Reading& reading) {
  const Frame frame = reading.scene.frame;
  for (const char* name : {"r", "x", "y", "z"}) {
    const int axis = axis_of(frame, name);
    if (axis < 0) continue;
    for (int side = 0; side < 2; ++side) {
      const std::string key = name + std::string{kSides[static_cast<std::size_t>(side)]};
      const std::optional<double> value = block.optional_number(key.c_str());
      if (!value) continue;
      auto& bounds = region[static_cast<std::size_t>(axis)];
      double& mine = bounds[static_cast<std::size_t>(side)];
      if (std::isfinite(mine)) block.fail("r and x are the same axis in this frame; give one");
      mine = *value;
      block.record(side_name(frame, axis, side), number_node(*value));
      if (!(bounds[0] < bounds[1]))
        block.fail("the region is empty: " + side_name(frame, axis, 1) + " must lie beyond " +
                   side_name(frame, axis, 0));
    }
  }
  if (region == MeasureSelection{}.region) block.fail("give at least one bound, z_min, ...");
}

std::pair<int, int> read_face_name(const Node& node, Reading& reading) {
  const Frame frame = reading.scene.frame;
  const std::optional<std::string> word = read_word(node, reading.problems);
  if (!word) return {-1, 0};
  const auto face = side_of(frame, *word);
  std::vector<std::string> faces;
  for (int axis = 0; axis < dimension(frame); ++axis)
    for (int side = 0; side < 2; ++side) faces.push_back(side_name(frame, axis, side));
  if (face.first < 0) report_unknown(node, "face", *word, faces, reading.problems);
  return face;
}

}  // namespace krater::scene
