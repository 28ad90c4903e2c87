// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/points/layout.hpp"

#include <doctest/doctest.h>

#include <stdexcept>
#include <string>

#include "krater/core/errors.hpp"
#include "krater/materials/law_state.hpp"

namespace {

using namespace krater;

/// Laws with history, one of them wrong.
struct Twice {
  static constexpr const char* name = "twice";
  using State = Columns<field::Distension, field::Distension>;
  std::array<double, 2> initial_state() const { return {1.0, 1.0}; }
};
struct Once {
  static constexpr const char* name = "once";
  using State = Columns<field::Distension>;
  std::array<double, 1> initial_state() const { return {1.0}; }
};

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("layout: a column exists once, in lane groups of eight, sized by the dimension") {
    for (const int dimension : {2, 3}) {
      Layout layout{dimension};
      const auto mass = layout.state<field::Mass>(0.0, "method");
      const auto x = layout.state<field::Position>(0.0, "method");
      const auto B = layout.state<field::AffineVelocity>(0.0, "method");
      const auto s = layout.state<field::DeviatoricStress>(0.0, "strength");
      const auto again = layout.input<field::Mass>("strength");
      CHECK(mass.offset == 0);
      CHECK(again.offset == mass.offset);
      CHECK(x.offset == 8);
      CHECK(B.offset == 8 + 8 * dimension);
      CHECK(s.offset == B.offset + 8 * dimension * dimension);
      CHECK(layout.stride() == s.offset + 8 * 6);
      CHECK(layout.columns().size() == 4);
      CHECK(layout.find("mass") != nullptr);
      CHECK(layout.find("temperature") == nullptr);
      CHECK(layout.local_stride() == 0);
      CHECK(layout.local_stride_or_one() == 1);
    }
  }

  TEST_CASE("layout: a field that is read must be written by somebody, before or after") {
    Layout layout{3};
    layout.input<field::SoundSpeed>("viscosity");
    layout.local_input<field::StepGradient>("kinematics");
    CHECK_THROWS_AS(layout.check(), InputError);
    layout.state<field::SoundSpeed>(5000.0, "eos");
    try {
      layout.check();
      FAIL("a local field without a writer was accepted");
    } catch (const InputError& error) {
      CHECK(std::string{error.what()}.find("kinematics reads the field 'step_gradient'") !=
            std::string::npos);
    }
    layout.local_output<field::StepGradient>("method");
    CHECK_NOTHROW(layout.check());
    CHECK(layout.find("sound_speed")->initial == 5000.0);
  }

  TEST_CASE("law state: a column has one owner, whoever declares it twice is named") {
    const auto said = [](auto make) {
      try {
        make();
      } catch (const std::logic_error& error) {
        return std::string{error.what()};
      }
      return std::string{};
    };
    Layout one{3}, two{3};
    const std::string own = said([&] { StateOf<Twice>{Twice{}, one}; });
    CHECK(own.find("twice: the column 'distension'") == 0);
    CHECK(said([&] { StateOf<Once>{Once{}, two}; }).empty());
    CHECK(said([&] { StateOf<Once>{Once{}, two}; }).find("once: the column 'distension'") == 0);
  }

  TEST_CASE("layout: optional fields are absent until declared; initial values do not contradict") {
    Layout layout{2};
    CHECK(layout.optional<field::Temperature>().offset == -1);
    CHECK(layout.local_optional<field::ExtraDilatation>().offset == -1);
    layout.state<field::Temperature>(294.0, "strength");
    layout.state<field::Temperature>(294.0, "heating");
    layout.state<field::Temperature>(0.0, "somebody who does not know");
    CHECK(layout.optional<field::Temperature>().offset == 0);
    CHECK(layout.find("temperature")->initial == 294.0);
    CHECK_THROWS_AS(layout.state<field::Temperature>(300.0, "other"), std::logic_error);
  }
}
