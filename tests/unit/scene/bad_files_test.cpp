// SPDX-License-Identifier: GPL-3.0-or-later
// Files that are no scenes at all, and how many problems one message tells.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "scene_support.hpp"

using namespace krater::test;

TEST_SUITE("unit") {
  TEST_CASE("scene: files that are no scenes") {
    const ScratchFolder folder;
    const auto check = [&](const std::string& text, const std::vector<const char*>& parts) {
      const std::string message = message_of(folder.write("file.yaml", text));
      CAPTURE(text);
      CAPTURE(message);
      CHECK(message.find("file.yaml") != std::string::npos);
      for (const char* part : parts) CHECK_MESSAGE(message.find(part) != std::string::npos, part);
    };
    CHECK(message_of((folder.path() / "none.yaml").string()).find("none.yaml: no such file") !=
          std::string::npos);
    CHECK(message_of(folder.path().string()).find("is a folder") != std::string::npos);
    check("", {"is empty"});
    check("# only a remark\n", {"is empty"});
    check("- a\n- b\n", {"expected a block of keys, found a list"});
    check("just words", {"expected a block of keys, found 'just words'"});
    check(std::string{"\x89HDF\r\n\x1a\n\0\0", 10}, {"not a text file"});
    check("title: a\nframe: [\n", {"file.yaml:", "not valid YAML"});
    check("title: a\ngrid:\n\tcell: 1\n",
          {"file.yaml:3", "not valid YAML", "line 3 is indented by a tab"});
    check("a: *nowhere\n", {"file.yaml:1", "not valid YAML"});
    check("a: 1\n---\nb: 2\n", {"second YAML document"});
    check("a: &x [*x]\n", {"file.yaml"});
    // Anchors that unfold to 9^8 elements.
    std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x]\n";
    for (int i = 1; i < 8; ++i) {
      const std::string before = "*a" + std::to_string(i - 1);
      const std::string name = "a" + std::to_string(i);
      bomb += name + ": &" + name + " [";
      for (int k = 0; k < 9; ++k) bomb += (k > 0 ? ", " : "") + before;
      bomb += "]\n";
    }
    check(bomb, {"too large"});
    check(std::string(5000, '['), {"file.yaml"});
    check(std::string(100000, '{'), {"file.yaml"});
  }

  TEST_CASE("scene: several problems are listed at once, in the order of the file, at most ten") {
    const ScratchFolder folder;
    std::string text = replaced(small_scene(), "cell: 1 mm", "cell: 1 kg");
    text = replaced(text, "density: 7850", "density: -3");
    text = replaced(text, "references:\n", "references:\n  a: {}\n  b: {}\n");
    const std::string message = message_of(folder.write("many.yaml", text));
    CAPTURE(message);
    const std::size_t cell = message.find("grid.cell");
    const std::size_t density = message.find("steel.density");
    const std::size_t a = message.find("references.a");
    REQUIRE(a != std::string::npos);
    CHECK(cell < density);
    CHECK(density < a);
    std::string flood = "frame: 3d\ngrid: {}\ntime: {}\nmaterials: {}\nbodies: {}\n";
    for (char c = 'a'; c <= 'z'; ++c) flood += "unknown_" + std::string(1, c) + ": 1\n";
    const std::string long_message = message_of(folder.write("flood.yaml", flood));
    CHECK(std::count(long_message.begin(), long_message.end(), '\n') == 10);
    CHECK(long_message.find("there may be more") != std::string::npos);
  }
}
