// SPDX-License-Identifier: GPL-3.0-or-later
// Files of surfaces, good and bad: every bad one is refused with its name and a reason.
#include <doctest/doctest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>

#include "geometry_cases.hpp"
#include "surface_cases.hpp"
#include "unit/scene/scene_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

std::string message_of_file(const std::string& file) {
  try {
    read_triangles(file, 1);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

std::string little(std::uint32_t x) {
  return {static_cast<char>(x), static_cast<char>(x >> 8), static_cast<char>(x >> 16),
          static_cast<char>(x >> 24)};
}

std::string single(float x, bool big = false) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &x, 4);
  std::string text = little(bits);
  return big ? std::string(text.rbegin(), text.rend()) : text;
}

std::string ascii_stl(const Triangles& t) {
  std::string text = "solid part\n";
  for (const auto& f : t.facets) {
    text += " facet normal 0 0 0\n  outer loop\n";
    for (const std::uint32_t c : f) {
      text += "   vertex";
      for (const double x : t.vertices[c]) text += " " + std::to_string(x);
      text += "\n";
    }
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid part\n";
}

std::string off(const Triangles& t) {
  std::string text = "OFF # with a comment\n" + std::to_string(t.vertices.size()) + " " +
                     std::to_string(t.facets.size()) + " 0\n";
  for (const auto& x : t.vertices) {
    for (const double v : x) text += std::to_string(v) + " ";
    text += "\n";
  }
  for (const auto& f : t.facets) {
    text += "3";
    for (const std::uint32_t c : f) text += " " + std::to_string(c);
    text += " 255 0 0\n";
  }
  return text;
}

std::string obj(const Triangles& t) {
  std::string text = "# part\nmtllib x.mtl\n";
  for (const auto& x : t.vertices) {
    text += "v";
    for (const double v : x) text += " " + std::to_string(v);
    text += "\n";
  }
  text += "vn 0 0 1\n";
  for (const auto& f : t.facets) {
    text += "f";
    for (const std::uint32_t c : f) text += " " + std::to_string(c + 1) + "/1/1";
    text += "\n";
  }
  return text;
}

std::string ply(const Triangles& t, const std::string& format) {
  std::string text = "ply\nformat " + format + " 1.0\ncomment made here\nelement vertex " +
                     std::to_string(t.vertices.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
                     "element face " +
                     std::to_string(t.facets.size()) +
                     "\nproperty list uchar int vertex_indices\nend_header\n";
  const bool ascii = format == "ascii", big = format == "binary_big_endian";
  for (const auto& x : t.vertices) {
    for (const double v : x) {
      text += ascii ? std::to_string(v) + " " : single(static_cast<float>(v), big);
    }
    text += ascii ? "7\n" : "\x07";
  }
  for (const auto& f : t.facets) {
    text += ascii ? "3" : "\x03";
    for (const std::uint32_t c : f) {
      std::string word = little(c);
      if (big) word.assign(word.rbegin(), word.rend());
      text += ascii ? " " + std::to_string(c) : word;
    }
    if (ascii) text += "\n";
  }
  return text;
}

struct BadFile {
  const char* name;
  std::string text;
  const char* says;
};

std::string stl_of(std::uint32_t count, std::size_t facets, const std::string& facet) {
  std::string text(80, ' ');
  text += little(count);
  for (std::size_t n = 0; n < facets; ++n) text += facet;
  return text;
}

std::vector<BadFile> bad_files() {
  const Triangles box = box_surface({{0, 0, 0}, {1, 1, 1}});
  const std::string good_stl = ascii_stl(box), good_off = off(box), good_ply = ply(box, "ascii");
  const std::string binary = ply(box, "binary_little_endian");
  const std::string facet(50, '\0');
  std::string nan_facet = facet;
  nan_facet.replace(16, 4, single(std::nanf("")));
  const auto with = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  return {
      {"empty.stl", "", "is empty"},
      {"short.stl", "sol", "neither"},
      {"random.stl", "hello world, this is no mesh", "neither"},
      {"header.stl", std::string(80, ' ') + "abcd", "cut short"},
      {"lie.stl", stl_of(0xffffffff, 3, facet), "214748364834 bytes, this one has 234"},
      {"two_gigabyte_lie.stl", stl_of(42949672, 1, facet), "cut short"},
      {"cut.stl", stl_of(4, 3, facet) + "half", "cut short"},
      {"tail.stl", stl_of(2, 3, facet), "follows the last facet"},
      {"no_facets.stl", stl_of(0, 0, facet), "has no facets"},
      {"nan.stl", stl_of(1, 1, nan_facet), "facet 1 (byte 84): a coordinate is not finite"},
      {"cut_text.stl", good_stl.substr(0, good_stl.size() / 2), "cut short"},
      {"no_end.stl", good_stl.substr(0, good_stl.size() - 14), "cut short"},
      {"nan_text.stl", with(good_stl, "vertex 0.0", "vertex nan 0.0"), "not finite"},
      {"inf_text.stl", with(good_stl, "vertex 0.0", "vertex 1e999 0.0"), "expected a number"},
      {"word.stl", with(good_stl, "vertex 0.0", "vertex zero 0.0"),
       ":4: expected a number, found 'zero'"},
      {"two.stl", good_stl + good_stl, "several solids"},
      {"quad.stl", with(good_stl, "  endloop", "   vertex 0 0 0\n  endloop"), "expected 'endloop'"},
      {"empty.off", "OFF\n", "whole number"},
      {"kind.off", "NOFF\n1 1 0\n", "begins with the word OFF"},
      {"lie.off", "OFF\n4000000000 12 0\n0 0 0\n", "promises 4000000000 vertices"},
      {"huge.off", "OFF\n99999999999999999999 12 0\n", "whole number"},
      {"negative.off", "OFF\n-8 12 0\n", "negative"},
      {"cut.off", good_off.substr(0, good_off.size() - 40), "expected"},
      {"index.off", with(good_off, "3 0 2 1", "3 0 2 8"), "names vertex 8 of 8"},
      {"below.off", with(good_off, "3 0 2 1", "3 0 -2 1"), "names vertex -2"},
      {"two_corners.off", with(good_off, "3 0 2 1", "2 0 2 1"), "fewer than three corners"},
      {"corners.off", with(good_off, "3 0 2 1", "3000000 0 2 1"), "corners of a face"},
      {"nan.off", with(good_off, "1.000000", "nan"), "not finite"},
      {"nothing.obj", "# only a comment\n", "has no facets"},
      {"index.obj", obj(box) + "f 1 2 9\n", "names vertex 8 of 8"},
      {"zero.obj", obj(box) + "f 0 1 2\n", "counted from 1"},
      {"below.obj", obj(box) + "f -9 1 2\n", "names vertex -1"},
      {"letters.obj", obj(box) + "f a b c\n", "whole number"},
      {"cut.obj", "v 0 0 0\nv 1 0\n", "expected a number"},
      {"header.ply", "ply\nformat ascii 1.0\nelement vertex 3\n", "ends within its header"},
      {"format.ply", with(good_ply, "ascii", "utf8"), "unknown format 'utf8'"},
      {"type.ply", with(good_ply, "float x", "real x"), "unknown type 'real'"},
      {"word.ply", with(good_ply, "comment", "remark"), "unknown word"},
      {"magic.ply", with(good_ply, "ply", "plx"), "expected 'ply'"},
      {"lie.ply", with(good_ply, "vertex 8", "vertex 4000000000"), "promises 4000000000"},
      {"lie2.ply", with(binary, "face 12", "face 2000000000"), "promises 2000000000"},
      {"cut.ply", binary.substr(0, binary.size() - 3), "cut short"},
      {"index.ply", with(good_ply, "3 0 2 1", "3 0 2 99"), "names vertex 99"},
      {"list.ply", with(good_ply, "3 0 2 1", "300000 0 2 1"), "a list longer than the file"},
      {"no_z.ply", with(good_ply, "property float z", "property float q"), "x, y and z"},
      {"folder.stl/x.obj", obj(box), ""},
      {"kind.step", "ISO-10303-21;", ".stl, .off, .obj and .ply"},
  };
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("mesh files: all formats give the same surface") {
    const ScratchFolder folder;
    const Triangles box = box_surface({{-1, -2, -3}, {1, 2, 3}});
    const std::vector<std::pair<const char*, std::string>> files{
        {"a.stl", ascii_stl(box)},
        {"a.off", off(box)},
        {"a.obj", obj(box)},
        {"a.ply", ply(box, "ascii")},
        {"b.PLY", ply(box, "binary_little_endian")},
        {"c.ply", ply(box, "binary_big_endian")}};
    for (const auto& file : files) {
      const auto& [name, text] = file;
      CAPTURE(file.first);
      const Triangles t = read_triangles(folder.write(name, text), 1e-3);
      CHECK(t.vertices.size() == 8);
      CHECK(t.facets.size() == 12);
      CHECK_FALSE(examine_surface(t).any());
      CHECK(make_surface_solid(t)->moments()->volume == doctest::Approx(48e-9).epsilon(1e-12));
    }
    // Faces with more corners are cut into triangles.
    const std::string cube =
        "OFF\n8 6 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n"
        "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";
    const Triangles quads = read_triangles(folder.write("q.off", cube), 1);
    CHECK(quads.facets.size() == 12);
    CHECK(make_surface_solid(quads)->moments()->volume == doctest::Approx(1));
  }

  TEST_CASE("mesh files: corners split at seams are one where they coincide") {
    const ScratchFolder folder;
    const Triangles box = box_surface({{-1, -2, -3}, {1, 2, 3}});
    Triangles split;  // every facet with corners of its own
    for (const auto& f : box.facets) {
      const auto n = static_cast<std::uint32_t>(split.vertices.size());
      for (const std::uint32_t c : f) split.vertices.push_back(box.vertices[c]);
      split.facets.push_back({n, n + 1, n + 2});
    }
    const std::vector<std::pair<const char*, std::string>> files{
        {"a.off", off(split)},
        {"a.obj", obj(split)},
        {"a.ply", ply(split, "ascii")},
        {"b.ply", ply(split, "binary_little_endian")}};
    for (const auto& file : files) {
      const auto& [name, text] = file;
      CAPTURE(file.first);
      const Triangles t = read_triangles(folder.write(name, text), 1);
      CHECK(t.vertices.size() == 8);
      CHECK_FALSE(examine_surface(t).any());
      CHECK(make_surface_solid(t)->moments()->volume == doctest::Approx(48).epsilon(1e-12));
    }
  }

  TEST_CASE("mesh files: parts that touch at an edge stay apart where their corners do") {
    const ScratchFolder folder;
    Triangles two = box_surface({{0, 0, 0}, {1, 1, 1}});
    const Triangles other = box_surface({{1, 1, 0}, {2, 2, 1}});
    const auto first = static_cast<std::uint32_t>(two.vertices.size());
    two.vertices.insert(two.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const auto& f : other.facets)
      two.facets.push_back({f[0] + first, f[1] + first, f[2] + first});
    CHECK(read_triangles(folder.write("two.obj", obj(two)), 1).vertices.size() == 16);
  }

  TEST_CASE("mesh files: ASCII STL in capitals, behind a byte order mark, blanks, with CRLF") {
    const ScratchFolder folder;
    const std::string plain = ascii_stl(box_surface({{-1, -2, -3}, {1, 2, 3}}));
    std::string capitals = plain, returns;
    for (char& c : capitals)
      if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 32);
    for (const char c : plain) returns += c == '\n' ? std::string{"\r\n"} : std::string{c};
    int number = 0;
    for (const std::string& text : {capitals, returns, "\xef\xbb\xbf" + plain, "  \n\t" + plain,
                                    "\xef\xbb\xbf \r\n" + capitals}) {
      CAPTURE(number);
      const Triangles t = read_triangles(folder.write(std::to_string(number++) + ".stl", text), 1);
      CHECK(t.vertices.size() == 8);
      CHECK(t.facets.size() == 12);
    }
    for (const char* name : {"mark.obj", "mark.off", "mark.ply"}) {
      const Triangles box = box_surface({{-1, -2, -3}, {1, 2, 3}});
      const std::string ending = std::string{name}.substr(5);
      const std::string text = ending == "obj"   ? obj(box)
                               : ending == "off" ? off(box)
                                                 : ply(box, "ascii");
      CHECK(read_triangles(folder.write(name, "\xef\xbb\xbf" + text), 1).facets.size() == 12);
    }
  }

  TEST_CASE("mesh files: a binary STL file whose header begins with 'solid' is binary") {
    const ScratchFolder folder;
    const std::string file = (folder.path() / "solid.stl").string();
    write_stl(box_surface({{-1, -2, -3}, {1, 2, 3}}), file, 1);
    std::ifstream stream(file, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    for (const char* start : {"solid part", "SOLID"}) {
      bytes.replace(0, std::string{start}.size(), start);
      CHECK(read_triangles(folder.write("s.stl", bytes), 1).vertices.size() == 8);
      const std::string cut = folder.write("cut.stl", bytes.substr(0, bytes.size() - 10));
      CHECK(message_of_file(cut).find("cut short") != std::string::npos);
    }
  }

  TEST_CASE("mesh files: every malformed file is refused with its name and the reason") {
    const ScratchFolder folder;
    for (const BadFile& bad : bad_files()) {
      const std::string file = folder.write(bad.name, bad.text);
      const std::string message = message_of_file(file);
      CAPTURE(message);
      CHECK_MESSAGE((bad.says[0] == '\0' || message.find(file) == 0), bad.name);
      CHECK_MESSAGE(message.find(bad.says) != std::string::npos, bad.name);
    }
    CHECK(message_of_file((folder.path() / "none.stl").string()).find("no such file") !=
          std::string::npos);
    CHECK(message_of_file((folder.path() / "folder.stl").string()).find("not a plain file") !=
          std::string::npos);
  }

  TEST_CASE("mesh files: files damaged at random are read or refused, nothing else") {
    const ScratchFolder folder;
    std::mt19937 random(9);
    const Triangles box = box_surface({{0, 0, 0}, {1, 1, 1}});
    std::string binary = stl_of(12, 0, "");
    for (std::size_t n = 0; n < 12; ++n) binary += std::string(50, '\0');
    const std::vector<std::pair<const char*, std::string>> files{
        {"a.stl", ascii_stl(box)},    {"b.stl", binary},
        {"a.off", off(box)},          {"a.obj", obj(box)},
        {"a.ply", ply(box, "ascii")}, {"b.ply", ply(box, "binary_little_endian")}};
    int read = 0, refused = 0;
    for (int n = 0; n < 1500; ++n) {
      auto [name, text] = files[static_cast<std::size_t>(n) % files.size()];
      for (int k = 0; k < 1 + n % 4; ++k) {
        const std::size_t at = random() % text.size();
        switch (random() % 3) {
          case 0:
            text[at] = static_cast<char>(random() % 256);
            break;
          case 1:
            text.erase(at, random() % 20);
            break;
          default:
            text.insert(at, text.substr(random() % text.size(), random() % 20));
        }
        if (text.empty()) text = "x";
      }
      (message_of_file(folder.write(name, text)).empty() ? read : refused) += 1;
    }
    CHECK(read > 50);
    CHECK(refused > 500);
  }
}
