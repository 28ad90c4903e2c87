// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/scene/yaml/expression.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "krater/core/errors.hpp"

using krater::Frame;
using krater::make_expression_field;
using krater::Triple;

TEST_SUITE("unit") {
  TEST_CASE("expression: variables are positions now and at the start, and time, in every frame") {
    const auto space =
        make_expression_field(Frame::cartesian_3d, {"x + 10*y", "z + 10*r", "X + t*R"});
    const Triple in_space = (*space)({3, 4, 7}, {6, 8, 1}, 2);
    CHECK(in_space[0] == 43);
    CHECK(in_space[1] == 57);
    CHECK(in_space[2] == 26);
    for (Frame frame : {Frame::axisymmetric, Frame::plane_strain}) {
      const auto section = make_expression_field(frame, {"x + 10*r + 100*y", "z + 10*Z"});
      const Triple value = (*section)({3, 7, 0}, {3, 5, 0}, 0);
      CHECK(value[0] == 33);
      CHECK(value[1] == 57);
    }
    const auto wave =
        make_expression_field(Frame::plane_strain, {"0", "0.1*cos(pi*x)*sin(2*pi*t)"});
    CHECK((*wave)({0.25, 0, 0}, {}, 0.2)[1] ==
          0.1 * std::cos(std::numbers::pi * 0.25) * std::sin(2 * std::numbers::pi * 0.2));
  }

  TEST_CASE("expression: whether it depends on time") {
    CHECK(make_expression_field(Frame::plane_strain, {"x", "t"})->depends_on_time());
    CHECK_FALSE(make_expression_field(Frame::plane_strain, {"x", "tan(z)"})->depends_on_time());
    CHECK_FALSE(krater::make_constant_field({1, 2, 3})->depends_on_time());
    CHECK((*krater::make_constant_field({1, 2, 3}))({}, {}, 5) == Triple{1, 2, 3});
  }

  TEST_CASE("expression: what is not one is refused") {
    for (const char* bad : {"", "x +", "x = 3", "x += 3", "1, 2", "q", "sin", "sin()", "((x)",
                            "foo(x)", "x y", "\"text\""}) {
      CAPTURE(std::string{bad});
      CHECK_THROWS_AS(make_expression_field(Frame::plane_strain, {bad, "0"}), krater::InputError);
    }
    CHECK_THROWS_AS(make_expression_field(Frame::plane_strain, {std::string(3000, '('), "0"}),
                    krater::InputError);
    CHECK_NOTHROW(make_expression_field(Frame::plane_strain, {"x <= 0.5 && z != 1 ? 1 : -1", "0"}));
  }
}
