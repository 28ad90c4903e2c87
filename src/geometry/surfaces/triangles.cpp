// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/geometry/surfaces/triangles.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <unordered_map>

#include "geometry/surfaces/file_text.hpp"
#include "geometry/surfaces/mesh_formats.hpp"
#include "geometry/surfaces/surface_topology.hpp"
#include "krater/geometry/solids/affine.hpp"

namespace krater {
namespace {

struct CellHash {
  std::size_t operator()(const std::array<std::int64_t, 3>& c) const {
    std::uint64_t h = 0;
    for (const std::int64_t x : c) {
      h = (h ^ static_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15ULL;
      h ^= h >> 29;
    }
    return static_cast<std::size_t>(h);
  }
};

using CellMap = std::unordered_map<std::array<std::int64_t, 3>, std::uint32_t, CellHash>;

std::array<std::int64_t, 3> bits_of(const Vector3& x) {
  std::array<std::int64_t, 3> bits{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double value = x[a] + 0.0;  // -0 is 0
    std::memcpy(&bits[a], &value, sizeof value);
  }
  return bits;
}

/// The vertex that stands for each: the first equal, or nearer than `distance`.
std::vector<std::uint32_t> representatives(const std::vector<Vector3>& vertices, double distance) {
  std::vector<std::uint32_t> same(vertices.size());
  CellMap cells;
  cells.reserve(distance > 0 ? vertices.size() : vertices.size() / 4);
  for (std::size_t n = 0; n < vertices.size(); ++n) {
    const auto own = static_cast<std::uint32_t>(n);
    if (!(distance > 0)) {
      same[n] = cells.try_emplace(bits_of(vertices[n]), own).first->second;
      continue;
    }
    std::array<std::int64_t, 3> c{};
    const std::array<std::int64_t, 3> bits = bits_of(vertices[n]);
    for (std::size_t a = 0; a < 3; ++a) {
      const double cell = std::floor(vertices[n][a] / distance);
      // Further out no two different numbers are so near.
      c[a] = std::abs(cell) < 0x1p53 ? static_cast<std::int64_t>(cell) : bits[a];
    }
    same[n] = own;
    for (int k = 0; k < 27 && same[n] == own; ++k) {
      const auto found = cells.find({c[0] + k % 3 - 1, c[1] + k / 3 % 3 - 1, c[2] + k / 9 - 1});
      if (found == cells.end()) continue;
      const Vector3 d = minus(vertices[n], vertices[found->second]);
      if (dot(d, d) < distance * distance) same[n] = found->second;
    }
    if (same[n] == own) cells.try_emplace(c, own);
  }
  return same;
}

/// Facets that are neighbours by the places of their corners only: split at seams of texture or
/// normals. Where the numbers of the corners close the surface they are believed, so that parts
/// which touch stay apart.
bool has_open_edges(const Triangles& triangles) {
  bool open = false;
  for_edges(triangles,
            [&open](const HalfEdge* first, const HalfEdge* last) { open |= last - first == 1; });
  return open;
}

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

}  // namespace

Triangles read_triangles(const std::string& file, double unit) {
  const std::string ending = file_ending(file);
  if (ending != "stl" && ending != "off" && ending != "obj" && ending != "ply") {
    throw std::invalid_argument(file + ": surfaces are read from .stl, .off, .obj and .ply files");
  }
  Triangles out;
  {
    const std::string bytes = file_text(file);
    if (bytes.empty()) throw std::invalid_argument(file + ": is empty");
    std::string_view data = bytes;
    if (ending == "stl") out = read_stl(file, data);
    if (data.starts_with(kByteOrderMark)) data.remove_prefix(kByteOrderMark.size());
    if (ending == "off") out = read_off(file, data);
    if (ending == "obj") out = read_obj(file, data);
    if (ending == "ply") out = read_ply(file, data);
  }
  if (out.facets.empty()) throw std::invalid_argument(file + ": has no facets");
  if (ending == "stl" || has_open_edges(out)) weld(out, 0);
  for (Vector3& x : out.vertices) {
    for (double& value : x) value *= unit;
  }
  return out;
}

std::size_t weld(Triangles& triangles, double distance) {
  constexpr std::uint32_t unused = 0xffffffff;
  const std::vector<std::uint32_t> same = representatives(triangles.vertices, distance);
  std::vector<std::uint32_t> number(triangles.vertices.size(), unused);
  std::vector<Vector3> kept;
  for (auto& facet : triangles.facets) {
    for (std::uint32_t& corner : facet) {
      std::uint32_t& n = number[same[corner]];
      if (n == unused) {
        n = static_cast<std::uint32_t>(kept.size());
        kept.push_back(triangles.vertices[same[corner]]);
      }
      corner = n;
    }
  }
  const std::size_t gone = triangles.vertices.size() - kept.size();
  kept.shrink_to_fit();
  triangles.vertices = std::move(kept);
  return gone;
}

void write_stl(const Triangles& triangles, const std::string& file, double unit) {
  std::string data(84 + 50 * triangles.facets.size(), '\0');
  data.replace(0, 6, "krater");
  const auto put = [&data](std::size_t at, std::uint32_t bits) {
    for (std::size_t n = 0; n < 4; ++n) data[at + n] = static_cast<char>((bits >> (8 * n)) & 255);
  };
  put(80, static_cast<std::uint32_t>(triangles.facets.size()));
  std::size_t at = 84;
  for (const auto& facet : triangles.facets) {
    std::size_t value = at + 12;
    for (const std::uint32_t corner : facet) {
      for (const double x : triangles.vertices[corner]) {
        const auto single = static_cast<float>(x / unit);
        std::uint32_t bits = 0;
        std::memcpy(&bits, &single, 4);
        put(value, bits);
        value += 4;
      }
    }
    at += 50;
  }
  std::ofstream stream(file, std::ios::binary);
  stream.write(data.data(), static_cast<std::streamsize>(data.size()));
  if (!stream.flush()) throw std::invalid_argument(file + ": cannot be written");
}

}  // namespace krater
