// SPDX-License-Identifier: GPL-3.0-or-later
// The frame of a scene: which axes the grid has, and where they lie in 3D space and in a 3x3
// tensor. It is decided here once, so that no other file asks "how many dimensions?" more than
// once.
//
//   axisymmetric   grid (r, z); the half section y = 0, x = r >= 0 of a body of revolution about z;
//                  measure 2 pi int r dA
//   plane_strain   grid (x, z); the section y = 0, extruded over 1 m of y; measure int dA x 1 m
//   3d             grid (x, y, z); measure int dV
//
// Tensors are always 3D; in the 2D frames component 1 is the hoop or the out-of-plane direction.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace krater {

enum class Frame { axisymmetric, plane_strain, cartesian_3d };

inline constexpr std::array<Frame, 3> all_frames{Frame::axisymmetric, Frame::plane_strain,
                                                 Frame::cartesian_3d};

/// Number of grid axes.
constexpr int dimension(Frame frame) { return frame == Frame::cartesian_3d ? 3 : 2; }

/// The name used in scenes and files.
constexpr std::string_view name(Frame frame) {
  switch (frame) {
    case Frame::axisymmetric:
      return "axisymmetric";
    case Frame::plane_strain:
      return "plane_strain";
    case Frame::cartesian_3d:
      return "3d";
  }
  return "";
}

/// The frame of that name, or nothing: the caller knows the file and line of the error.
constexpr std::optional<Frame> frame_from_name(std::string_view text) {
  for (Frame frame : all_frames) {
    if (name(frame) == text) return frame;
  }
  return std::nullopt;
}

/// Row and column, in the 3x3 tensors and in 3D space, of a grid axis.
constexpr int tensor_axis(Frame frame, int grid_axis) {
  return (dimension(frame) == 2 && grid_axis == 1) ? 2 : grid_axis;
}

/// "r", "z" / "x", "z" / "x", "y", "z".
constexpr std::string_view axis_name(Frame frame, int grid_axis) {
  constexpr std::array<std::string_view, 3> space{"x", "y", "z"};
  if (frame == Frame::axisymmetric && grid_axis == 0) return "r";
  return space[static_cast<std::size_t>(tensor_axis(frame, grid_axis))];
}

/// The grid axis of that name, or nothing.
constexpr std::optional<int> axis_from_name(Frame frame, std::string_view text) {
  for (int axis = 0; axis < dimension(frame); ++axis) {
    if (axis_name(frame, axis) == text) return axis;
  }
  return std::nullopt;
}

/// A grid vector as a vector of 3D space; the missing component is zero.
constexpr std::array<double, 3> to_space(Frame frame, const std::array<double, 3>& grid_vector) {
  if (dimension(frame) == 3) return grid_vector;
  return {grid_vector[0], 0.0, grid_vector[1]};
}

}  // namespace krater
