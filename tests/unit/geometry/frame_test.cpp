// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "krater/geometry/frame.hpp"

using namespace krater;

TEST_SUITE("unit") {
  TEST_CASE("frames: names, axes and tensor components") {
    for (Frame frame : all_frames) {
      CHECK(frame_from_name(name(frame)) == frame);
      for (int axis = 0; axis < dimension(frame); ++axis) {
        CHECK(axis_from_name(frame, axis_name(frame, axis)) == axis);
      }
    }
    CHECK(name(Frame::cartesian_3d) == "3d");
    CHECK_FALSE(frame_from_name("3D").has_value());
    CHECK(dimension(Frame::axisymmetric) == 2);
    CHECK(axis_name(Frame::axisymmetric, 0) == "r");
    CHECK(axis_name(Frame::plane_strain, 1) == "z");
    CHECK(axis_name(Frame::cartesian_3d, 1) == "y");
    CHECK_FALSE(axis_from_name(Frame::axisymmetric, "x").has_value());
    CHECK(tensor_axis(Frame::axisymmetric, 1) == 2);
    CHECK(tensor_axis(Frame::plane_strain, 0) == 0);
    CHECK(tensor_axis(Frame::cartesian_3d, 1) == 1);
    CHECK(to_space(Frame::plane_strain, {1, 2, 0}) == std::array<double, 3>{1, 0, 2});
  }
}
