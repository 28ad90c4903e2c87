// SPDX-License-Identifier: GPL-3.0-or-later
// ASCII STL, OFF, OBJ; binary STL.
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/surfaces/mesh_formats.hpp"
#include "geometry/surfaces/mesh_text.hpp"

namespace krater {
namespace {

/// Counts of a header are believed as far as the file could hold them.
void believe(const MeshText& text, const char* what, std::int64_t count, std::size_t least_bytes) {
  if (count < 0) text.fail(std::string("the number of ") + what + " is negative");
  if (static_cast<std::uint64_t>(count) > text.left() / least_bytes) {
    text.fail("the header promises " + std::to_string(count) + " " + what + ", but only " +
              std::to_string(text.left()) + " bytes follow");
  }
  if (count > 0xfffffff0) text.fail(std::string("more than 4e9 ") + what);
}

Triangles read_ascii_stl(const std::string& file, std::string_view data) {
  if (data.starts_with("\xef\xbb\xbf")) data.remove_prefix(3);
  MeshText text(file, data);
  text.expect("solid");
  text.next_line();
  Triangles out;
  for (std::string_view word = text.word(); !MeshText::same(word, "endsolid"); word = text.word()) {
    if (word.empty()) text.fail("the file ends before 'endsolid': it is cut short");
    if (!MeshText::same(word, "facet")) {
      text.fail("expected 'facet' or 'endsolid', found " + MeshText::shown(word));
    }
    text.expect("normal");
    for (int k = 0; k < 3; ++k) text.word();  // often wrong; the order of the corners counts
    text.expect("outer");
    text.expect("loop");
    std::array<std::uint32_t, 3> facet{};
    for (std::uint32_t& corner : facet) {
      text.expect("vertex");
      corner = static_cast<std::uint32_t>(out.vertices.size());
      const double x = text.number(), y = text.number();
      out.vertices.push_back({x, y, text.number()});
    }
    text.expect("endloop");
    text.expect("endfacet");
    out.facets.push_back(facet);
  }
  text.next_line();
  if (!text.at_end()) text.fail("text after 'endsolid' (several solids in one file: split them)");
  return out;
}

std::uint32_t little_endian(const char* at) {
  const auto byte = [at](int n) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(at[n])) << (8 * n);
  };
  return byte(0) | byte(1) | byte(2) | byte(3);
}

Triangles read_binary_stl(const std::string& file, std::string_view data, std::size_t count) {
  Triangles out;
  out.vertices.reserve(3 * count);
  out.facets.reserve(count);
  for (std::size_t n = 0; n < count; ++n) {
    const char* at = data.data() + 84 + 50 * n + 12;  // past the normal
    std::array<std::uint32_t, 3> facet{};
    for (std::uint32_t& corner : facet) {
      corner = static_cast<std::uint32_t>(out.vertices.size());
      Vector3 x{};
      for (double& value : x) {
        const std::uint32_t bits = little_endian(at);
        float single = 0;
        std::memcpy(&single, &bits, 4);
        value = static_cast<double>(single);
        at += 4;
        if (!std::isfinite(value)) {
          throw std::invalid_argument(file + ": facet " + std::to_string(n + 1) + " (byte " +
                                      std::to_string(84 + 50 * n) +
                                      "): a coordinate is not finite");
        }
      }
      out.vertices.push_back(x);
    }
    out.facets.push_back(facet);
  }
  return out;
}

/// The text behind a byte order mark and blanks, when it begins with "solid" as ASCII STL does.
/// Binary files may begin so too, but hold zeros.
std::string_view stl_text(std::string_view data) {
  if (data.starts_with("\xef\xbb\xbf")) data.remove_prefix(3);
  data.remove_prefix(std::min(data.find_first_not_of(" \t\r\n"), data.size()));
  const bool text = MeshText::same(data.substr(0, 5), "solid") &&
                    data.substr(0, 2000).find('\0') == std::string_view::npos;
  return text ? data : std::string_view{};
}

}  // namespace

Triangles read_stl(const std::string& file, std::string_view data) {
  const std::uint64_t count = data.size() >= 84 ? little_endian(data.data() + 80) : 0;
  if (data.size() >= 84 && data.size() == 84 + 50 * count)
    return read_binary_stl(file, data, count);
  if (!stl_text(data).empty()) return read_ascii_stl(file, data);
  if (data.size() < 84)
    throw std::invalid_argument(file +
                                ": neither an ASCII STL file ('solid ...') nor a binary one");
  throw std::invalid_argument(
      file + ": a binary STL file of " + std::to_string(count) + " facets has " +
      std::to_string(84 + 50 * count) + " bytes, this one has " + std::to_string(data.size()) +
      (data.size() < 84 + 50 * count ? ": it is cut short, or no STL file"
                                     : ": something follows the last facet"));
}

Triangles read_off(const std::string& file, std::string_view data) {
  MeshText text(file, data);
  if (text.word(true) != "OFF") {
    text.fail(
        "an OFF file begins with the word OFF (variants with normals or colours are not read)");
  }
  const std::int64_t vertices = text.integer(text.word(true));
  const std::int64_t faces = text.integer(text.word(true));
  text.integer(text.word(true));  // edges: often 0
  believe(text, "vertices", vertices, 6);
  believe(text, "faces", faces, 7);
  Triangles out;
  out.vertices.reserve(static_cast<std::size_t>(vertices));
  for (std::int64_t n = 0; n < vertices; ++n) {
    const double x = text.number(true), y = text.number(true);
    out.vertices.push_back({x, y, text.number(true)});
  }
  std::vector<std::int64_t> corners;
  for (std::int64_t n = 0; n < faces; ++n) {
    const std::int64_t count = text.integer(text.word(true));
    believe(text, "corners of a face", count, 2);
    corners.clear();
    for (std::int64_t k = 0; k < count; ++k) corners.push_back(text.integer(text.word(true)));
    try {
      add_face(corners, out.vertices.size(), out);
    } catch (const std::invalid_argument& error) {
      text.fail(error.what());
    }
    text.next_line();  // colours
  }
  return out;
}

Triangles read_obj(const std::string& file, std::string_view data) {
  MeshText text(file, data);
  Triangles out;
  std::vector<std::int64_t> corners;
  while (!text.at_end()) {
    const std::string_view key = text.word_on_line();
    if (key == "v") {
      const double x = text.number(), y = text.number();
      out.vertices.push_back({x, y, text.number()});
    } else if (key == "f") {
      corners.clear();
      for (std::string_view w = text.word_on_line(true); !w.empty(); w = text.word_on_line(true)) {
        const std::int64_t n = text.integer(w.substr(0, w.find('/')));
        if (n == 0) text.fail("vertices of OBJ files are counted from 1, found 0");
        corners.push_back(n > 0 ? n - 1 : n + static_cast<std::int64_t>(out.vertices.size()));
      }
      try {
        add_face(corners, out.vertices.size(), out);
      } catch (const std::invalid_argument& error) {
        text.fail(error.what());
      }
    }
    text.next_line();
  }
  return out;
}

}  // namespace krater
