// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The nodes and elements of one body, as mesh_step.hpp steps them.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "krater/kinematics/mesh/erosion.hpp"
#include "krater/kinematics/mesh/mesh_step.hpp"

namespace krater {

inline constexpr std::size_t kNode = 8, kChange = 4;  ///< doubles of a node and of its change

/// A body's nodes and elements.
struct MeshStep::Elements {
  ElementBody made_of;
  ElementColumns columns;
  PointStore elements;
  NodeCorners corners_of;
  std::vector<std::int32_t> corners;
  AlignedBuffer shares, forces, hourglass, hourglass_energy, remembered, nodes, changes, placed;
  std::vector<std::uint8_t> on_plane;  ///< bit per axis: a plane of symmetry holds the node
  std::size_t node_count = 0;
  mutable std::vector<std::array<std::int32_t, 2>> surface;  ///< found when it is asked for
  // Of a body that erodes:
  ElementNeighbours first;
  std::vector<double> orphaned;  ///< per node: mass of its eroded elements [kg]
  Eroded eroded;                 ///< or converted
  ConvertedPoints converted;     ///< in the last step
  bool erodes() const { return made_of.erosion.any(); }
  bool converts() const { return made_of.points.has_value(); }

  /// Of a reference that is kept; 0: none is.
  std::size_t placed_rows() const {
    if (made_of.reference == ElementReference::current) return 0;
    return static_cast<std::size_t>(made_of.mesh.dimension == 3 ? kPlaced<3> : kPlaced<2>);
  }
  std::size_t corner_count() const { return static_cast<std::size_t>(made_of.mesh.corners()); }
  /// What elements keep from step to step beside their columns, and its length.
  template <class Visit>
  void for_each_record(const Visit& visit) {
    visit_records(*this, visit);
  }
  template <class Visit>
  void for_each_record(const Visit& visit) const {
    visit_records(*this, visit);
  }
  /// Sum over the corners that it is, in order of elements [N].
  Triple force_on(std::size_t node) const {
    return made_of.mesh.dimension == 3 ? sum_of_corners<3>(node) : sum_of_corners<2>(node);
  }
  template <int Dim>
  Triple sum_of_corners(std::size_t node) const {
    constexpr std::size_t each = kForceDoubles<Dim>;
    std::array<double, each> f{};
    for (std::size_t k = corners_of.first[node]; k < corners_of.first[node + 1]; ++k) {
      const double* corner = forces.data() + each * corners_of.places[k];
      for (std::size_t a = 0; a < each; ++a) f[a] += corner[a];
    }
    return {f[0], f[1], Dim == 3 ? f[each - 2] : 0};
  }
  double* node(std::size_t n) { return nodes.data() + kNode * n; }
  double* change(std::size_t n) { return changes.data() + kChange * n; }

 private:
  template <class Self, class Visit>
  static void visit_records(Self& self, const Visit& visit) {
    const std::size_t groups = static_cast<std::size_t>(self.elements.groups()),
                      modes = self.made_of.mesh.dimension == 3 ? 12 : 2;
    visit(self.hourglass, groups * modes * kLanes);
    visit(self.hourglass_energy, groups * kLanes);
    visit(self.remembered, groups * kRemembered * kLanes);
    if (self.placed_rows() > 0) visit(self.placed, groups * self.placed_rows() * kLanes);
  }
};

/// Least j of each element of a lane group (mesh_health.hpp).
std::array<double, kLanes> least_corners(const MeshStep::Elements& body, std::size_t group);
/// The exposed faces of what there is now.
std::vector<std::array<std::int32_t, 4>> faces_of(const MeshStep::Elements& body);
/// Of these, those that were exposed at the start.
std::vector<std::array<std::int32_t, 4>> first_faces_of(const MeshStep::Elements& body);
/// Element i as points, among those `converted`.
void convert_element(MeshStep::Elements& body, int i, bool axisymmetric);
/// Which elements there are, and where, from their numbers, which were put back.
void find_again(MeshStep::Elements& body);

}  // namespace krater
