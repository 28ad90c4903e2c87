// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/simulation/warnings.hpp"

#include <doctest/doctest.h>

using namespace krater;

TEST_CASE("warnings: a kind is told once and counted") {
  Warnings warnings;
  warnings.count("left", 0, 1, "nothing");
  CHECK(warnings.all().empty());
  warnings.count("left", 2, 1, "2 points left");
  warnings.add("odd", 2, "something odd");
  CHECK(warnings.unsaid().size() == 2);
  warnings.count("left", 5, 3, "5 points left");
  warnings.add("odd", 4, "something else");
  CHECK(warnings.unsaid().empty());
  REQUIRE(warnings.all().size() == 2);
  CHECK(warnings.all()[0].count == 5);
  CHECK(warnings.all()[0].first_time == 1);
  CHECK(warnings.all()[0].text == "5 points left");
  CHECK(warnings.all()[1].count == 2);
  CHECK(warnings.all()[1].text == "something odd");
}

TEST_CASE("warnings: a state that passes is forgotten, one that lasts is told since when") {
  Warnings warnings;
  warnings.judge("energy", true, 1, "high");
  warnings.judge("energy", false, 2, "");
  CHECK(warnings.all().empty());
  warnings.judge("energy", true, 3, "high");
  warnings.judge("energy", true, 4, "higher");
  REQUIRE(warnings.all().size() == 1);
  CHECK(warnings.all()[0].first_time == 3);
  CHECK(warnings.all()[0].text == "higher");
  CHECK(warnings.unsaid().empty());
}

TEST_CASE("warnings: a checkpoint keeps them, said or not") {
  Warnings warnings;
  warnings.add("said", 1e-6, "was said");
  warnings.unsaid();
  warnings.count("new", 3, 2e-6, "not yet");
  Checkpoint checkpoint;
  warnings.save(checkpoint);
  Warnings restored;
  restored.add("other", 0, "is forgotten");
  restored.restore(checkpoint);
  CHECK(to_text(restored.json()) == to_text(warnings.json()));
  CHECK(restored.unsaid() == std::vector<std::string>{"not yet (from 2e-06 s)"});
}
