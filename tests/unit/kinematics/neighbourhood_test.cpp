// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <random>

#include "krater/grid/neighbourhood.hpp"

namespace krater {
namespace {

BlockKey key(int i, int j, int level) { return {{i, j, 0}, level}; }

TEST_CASE("near on one level: no more than so many blocks apart along every axis") {
  const Neighbourhood around{{key(0, 0, 0), key(10, 3, 0)}, 2, 2};
  CHECK(around.holds(key(2, -2, 0)));
  CHECK_FALSE(around.holds(key(3, 0, 0)));
  CHECK_FALSE(around.holds(key(0, -3, 0)));
  CHECK(around.holds(key(12, 5, 0)));
}

TEST_CASE("near among levels: in blocks of the level above the coarser of the two") {
  const Neighbourhood of_fine{{key(17, 0, 2)}, 1, 2};  // in block 8 of level 1, 4 of level 0
  CHECK(of_fine.holds(key(19, 0, 2)));                 // 9 of level 1
  CHECK_FALSE(of_fine.holds(key(20, 0, 2)));           // 10
  CHECK(of_fine.holds(key(5, 0, 0)));
  CHECK_FALSE(of_fine.holds(key(6, 0, 0)));
  CHECK(of_fine.holds(key(11, 0, 1)));  // both counted on level 0: 5
  CHECK_FALSE(of_fine.holds(key(12, 0, 1)));
}

TEST_CASE("near is mutual") {
  std::mt19937 random{5};
  const auto any = [&random] {
    const int level = static_cast<int>(random() % 4), reach = 8 << level;
    const auto place = [&] {
      return static_cast<int>(random() % static_cast<unsigned>(reach)) - 3;
    };
    const int i = place();
    return key(i, place(), level);
  };
  int near = 0;
  for (int n = 0; n < 2000; ++n) {
    const BlockKey a = any(), b = any();
    const bool there = Neighbourhood{{a}, 1, 2}.holds(b);
    CHECK(there == Neighbourhood{{b}, 1, 2}.holds(a));
    near += there ? 1 : 0;
  }
  CHECK(near > 100);
  CHECK(near < 1900);
}

}  // namespace
}  // namespace krater
