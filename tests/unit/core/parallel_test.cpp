// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of parallel work: one is kept, that of the first item that failed.
#include "krater/core/parallel.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <stdexcept>
#include <string>

using namespace krater;

TEST_SUITE("unit") {
  TEST_CASE("parallel: the error of the first item that failed reaches the caller") {
    for (const int count : {1, 2, 4}) {
      set_threads(count);
      CAPTURE(count);
      std::string what;
      std::atomic<int> done{0};
      try {
        for_each(1000, [&](std::size_t i) {
          if (i >= 300) throw std::runtime_error(std::to_string(i));
          ++done;
        });
      } catch (const std::runtime_error& error) {
        what = error.what();
      }
      CHECK(what == "300");
      CHECK(done == 300);
      done = 0;
      for_each(1000, [&](std::size_t) { ++done; });
      CHECK(done == 1000);
    }
    set_threads(1);
  }
}
