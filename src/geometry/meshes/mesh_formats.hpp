// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file geometry/meshes/mesh_formats.hpp
/// Readers of single formats, for read_mesh_file, and what they share.
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "geometry/surfaces/mesh_text.hpp"
#include "krater/geometry/meshes/mesh_file.hpp"

namespace krater {

MeshFile read_gmsh(const std::string& file, std::string_view data);
MeshFile read_abaqus(const std::string& file, std::string_view data);
MeshFile read_dyna(const std::string& file, std::string_view data);

/// Collects nodes, elements and parts in the order of the file; node numbers are looked up when
/// `resolve` is called, for elements may stand before their nodes.
class MeshFileMaker {
 public:
  explicit MeshFileMaker(const std::string& file) { out_.name = file; }

  [[noreturn]] void fail(std::size_t line, const std::string& what) const {
    throw std::invalid_argument(out_.name + ":" + std::to_string(line) + ": " + what);
  }
  void add_node(std::int64_t number, const Vector3& x, std::size_t line) {
    if (!index_.try_emplace(number, out_.nodes.size()).second)
      fail(line, "node " + std::to_string(number) + " is there twice");
    out_.nodes.push_back(x);
    out_.node_numbers.push_back(number);
  }
  std::size_t kind(const ElementKind& kind) {
    const auto [at, added] = kinds_.try_emplace(kind.name, out_.kinds.size());
    if (added) out_.kinds.push_back(kind);
    return at->second;
  }
  /// Index of the new element.
  std::size_t add_element(std::int64_t number, std::size_t line, std::size_t kind,
                          const std::vector<std::int64_t>& nodes) {
    out_.elements.push_back({number, line, wanted_.size(), nodes.size(), kind});
    wanted_.insert(wanted_.end(), nodes.begin(), nodes.end());
    return out_.elements.size() - 1;
  }
  /// `also`: its number, where it has a name.
  void add_to_part(const std::string& part, std::size_t element, const std::string& also = "") {
    const auto [at, added] = parts_.try_emplace(part, out_.parts.size());
    if (added) out_.parts.push_back({part, also, {}});
    std::vector<std::size_t>& list = out_.parts[at->second].elements;
    if (list.empty() || list.back() != element) list.push_back(element);
  }
  /// The nodes of all elements since the last call; numbers begin anew after it.
  void resolve() {
    for (; resolved_ < out_.elements.size(); ++resolved_) {
      const MeshFile::Element& e = out_.elements[resolved_];
      for (std::size_t k = e.first; k < e.first + e.count; ++k) {
        const auto found = index_.find(wanted_[k]);
        if (found == index_.end())
          fail(e.line, "element " + std::to_string(e.number) + " names node " +
                           std::to_string(wanted_[k]) + ", which the file does not have");
        out_.nodes_of.push_back(found->second);
      }
    }
    index_.clear();
  }
  MeshFile& file() { return out_; }

 private:
  MeshFile out_;
  std::unordered_map<std::int64_t, std::size_t> index_;
  std::map<std::string, std::size_t> kinds_, parts_;
  std::vector<std::int64_t> wanted_;
  std::size_t resolved_ = 0;
};

/// Why elements other than one-point bricks and quadrilaterals are refused.
inline constexpr const char* kSecondOrder =
    "of second order: make the mesh again with linear elements";
inline constexpr const char* kSimplex =
    "made of triangles or tetrahedra: make the mesh again with hexahedra (quadrilaterals in a "
    "plane), or fill the body's surface with points, kinematics: mpm";

/// A type by its dimension and number of corners: bricks and quadrilaterals are of use.
ElementKind plain_kind(const std::string& name, int dimension, std::size_t corners);

}  // namespace krater
