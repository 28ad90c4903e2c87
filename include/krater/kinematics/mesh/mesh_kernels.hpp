// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mesh/mesh_kernels.hpp
/// The sweeps over elements, compiled for every instruction-set level and frame, and the plain data
/// that they work on. Elements lie in lane groups of 8 as points do (points/store.hpp); what a
/// group has beside its columns lies in arrays of `groups` records:
///   corners [corner][8 lanes]          shares, the mass of each corner [corner][8]
///   Q of the hourglass [component][8]  forces [8][corner][kForceDoubles]: nodes sum them
///   energy of the hourglass [8]        G, tr D of the last step, 1/dt of the next [3][8]
///   references [kPlaced][8]
/// Nodes: x, m, v, heat per mass of the step (8 doubles), and the change of velocity of the step.
#include <cstdint>

#include "krater/core/isa_level.hpp"
#include "krater/kinematics/mesh/options.hpp"
#include "krater/kinematics/sweep_result.hpp"
#include "krater/materials/stage.hpp"

namespace krater {

/// Offsets in the record of a group; -1: absent.
struct ElementColumns {
  int id, position, velocity, mass, density, stress, pressure, viscous, energy, sound_speed;
  int plastic, failed;
  int local_gradient, local_extra, local_rate, local_shear;
  int stride, local_stride;
};

struct ElementData {
  double* elements;
  int count, groups;
  const std::int32_t* corners;
  const double* shares;
  double *forces, *hourglass, *hourglass_energy, *remembered;
  double* nodes;    ///< 8 each
  double* changes;  ///< 4 each
  double* placed;   ///< references other than the current one
  ElementColumns columns;
  const Stage* const* stages;
  int stage_count;
  double q_lin, q_quad;
  HourglassOptions held;
  ElementReference reference;
  double refresh_strain;  ///< of an adaptive reference
};

struct ElementScratch {
  double* local;   ///< kElementGroups records
  double* length;  ///< 8 each
  double* kept;    ///< kKeptPacks packs each
  const double* zeros;
};
inline constexpr int kElementGroups = 8;  ///< groups that a stage works on at once
inline constexpr int kKeptPacks = 84;
inline constexpr int kRemembered = 3;
/// Rows of a reference: places of the corners, and its volume by theirs (placed_element.hpp).
template <int Dim>
inline constexpr int kPlaced = (Dim == 3 ? 8 : 4) * Dim + 1;
/// Doubles of the force on a corner: its components, and padding.
template <int Dim>
inline constexpr int kForceDoubles = Dim == 3 ? 4 : 2;

struct ElementResult : SweepResult {
  double hourglass = 0, hourglass_before = 0;  ///< [J]
  int renewed = 0;                             ///< references
};

class MeshKernels {
 public:
  MeshKernels() = default;
  MeshKernels(const MeshKernels&) = delete;
  MeshKernels& operator=(const MeshKernels&) = delete;
  virtual ~MeshKernels();
  /// Forces of the corners where the nodes are, and what the state allows of a step.
  virtual void forces(const ElementData& data, int first, int last, ElementResult& out) const = 0;
  /// Work, strain and stages of a step dt of the nodes' velocities v + dv, and the forces of the
  /// next; nodes have not moved.
  virtual void strain(const ElementData& data, const ElementScratch& scratch, double dt, int first,
                      int last, ElementResult& out) const = 0;
};

enum class MeshFrame : int { axisymmetric, plane, space };
struct MeshKernelFactory {
  MeshKernels* (*make)(MeshFrame frame);  ///< ownership passes to the caller
};
const MeshKernelFactory& mesh_kernel_factory(IsaLevel level);
const MeshKernelFactory* mesh_kernel_factory_isa_portable();
const MeshKernelFactory* mesh_kernel_factory_isa_v3();
const MeshKernelFactory* mesh_kernel_factory_isa_v4();

}  // namespace krater
