// SPDX-License-Identifier: GPL-3.0-or-later
// Damaged scenes: reading must succeed or throw InputError, whatever the bytes.
#include <doctest/doctest.h>

#include <cstddef>
#include <filesystem>
#include <random>
#include <string>

#include "krater/core/errors.hpp"
#include "krater/scene/point.hpp"
#include "scene_support.hpp"

using namespace krater::test;

namespace {

/// Delete, duplicate, replace or insert a few bytes or whole lines.
std::string damaged(std::string text, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  const std::string special = "[]{}:,#&*!|>'\"%@`-?\t\n .0159eEx<=/\\~\xc3\xff";
  for (std::size_t change = 0, changes = 1 + below(3); change < changes && !text.empty();
       ++change) {
    const std::size_t at = below(text.size());
    const std::size_t length = 1 + below(below(4) == 0 ? 40 : 3);
    const std::size_t line = text.find('\n', at);
    switch (below(6)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, text.substr(at, length));
        break;
      case 2:
        text[at] = special[below(special.size())];
        break;
      case 3:
        text[at] = static_cast<char>(below(256));
        break;
      case 4:
        text.insert(at, 1, special[below(special.size())]);
        break;
      default:
        if (line != std::string::npos) text.erase(line, text.find('\n', line + 1) - line);
        break;
    }
  }
  return text;
}

/// Reads 2000 damaged copies of `good`; each reads, or fails as InputError with its file's name.
template <class Read>
void check_damaged(const std::string& good, const Read& read) {
  const ScratchFolder folder;
  folder.write("materials/ofhc_copper.yaml",
               slurp(source_path("inputs/materials/ofhc_copper.yaml")));
  std::mt19937 random{12345};  // mt19937 is the same everywhere; distributions are not
  int failures = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::string text = damaged(good, random);
    const std::string file = folder.write("scene.yaml", text);
    try {
      read(file);
    } catch (const krater::InputError& error) {
      ++failures;
      const std::string message = error.what();
      CHECK_MESSAGE(message.find(".yaml") != std::string::npos, message);
    } catch (const std::exception& error) {
      FAIL_CHECK("not an InputError: ", error.what(), "\n", text);
    }
  }
  CHECK(failures > 500);
  CHECK(failures < 2000);
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("scene: 2000 damaged scenes read or fail as InputError with their file's name") {
    check_damaged(slurp(source_path("inputs/taylor_copper.yaml")),
                  [](const std::string& file) { krater::read_scene(file); });
  }

  TEST_CASE("point: 2000 damaged point files read or fail as InputError with their file's name") {
    check_damaged(
        "materials:\n  copper: {card: ofhc_copper}\npoint:\n  path:\n    stretch:\n"
        "      F: [[1 + 1e3*t, 2*sin(t), 0], [0, 1, 0], [0, 0, 1]]\n      time: 1 ms\n"
        "  steps: 500\n  every: 2\n  temperature: 300 K\n  length: 1 mm\n",
        [](const std::string& file) { krater::read_point(file); });
  }
}
