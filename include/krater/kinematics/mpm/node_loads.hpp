// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/node_loads.hpp
/// Loads on the surface of bodies, and damping, as forces on nodes (theory 2).
///
/// The weak form of a load t on the surface is f_i = int S_i t dA. The surface is that of the
/// volumes of the points: by Gauss
///   g_i = sum_p V_p grad S_i(x_p) = int_body grad S_i dV = int S_i n dA
/// is the area vector of node i, outward, zero inside, about the axis with the hoop term V S/r. It
/// is scattered by the kernel that scatters the stress, with a pressure of one in its place: the
/// force of a pressure on all of a body and that of its uniform stress -p are the same sum, so a
/// body under pressure is in equilibrium to round-off, in every frame, shape and reference.
///   pressure   f_i = -p s_i g_i             all around, or on a face with normal N, g_i . N > 0:
///              f_i = -p s_i (g_i . N) N
///   traction   f_i = t s_i (g_i . N)        on such a face; per area of the face as it is now
///   velocity   v+_i = v(t) where s_i > 1/2  (components given), before contact and sides
///   damping    f_i = -eta m_i (v-_i + v+_i)/2, so that no step of eta dt overshoots
/// s_i = sum S m s_p / m_i is the share of the loaded points in the node's mass. Points are marked
/// (s_p = 1) at the start, kLoadedDepth cells deep below the face, and carry the mark with them: a
/// face that moves, turns or wears away stays loaded.
///
/// Work. The ledger counts every change of a node's velocity with vbar = v+ - dv/2, so that of a
/// load is dt sum f_i . vbar_i, whatever contact and sides did after it; kinetic + internal - work
/// stays constant to round-off. Its impulse is dt sum f_i of all nodes; what planes of symmetry
/// fold of it is theirs.
#include <functional>

#include "krater/contact/boundary.hpp"
#include "krater/distribute/distribution.hpp"
#include "krater/grid/overlaps.hpp"
#include "krater/kinematics/load_options.hpp"
#include "krater/kinematics/mpm/kernels.hpp"

namespace krater {

/// The nodes that hold a face see points to three cells below it; one more for compression. A
/// prescribed velocity takes one cell.
inline constexpr double kLoadedDepth = 4, kDrivenDepth = 1;

/// Where a loaded body keeps its marks and its unit of pressure; -1: it is not loaded.
struct LoadColumns {
  int share = -1, unit = -1;
};

/// Works [J] and impulses [N s] of one step.
struct LoadWork {
  double faces = 0, damping = 0;
  Triple face_impulse{}, damping_impulse{};
};

class NodeLoads {
 public:
  /// Without loads it does nothing. `rigid[b]`: the body is moved as a whole, and not damped.
  NodeLoads(const LoadOptions& options, BlockGrid& grid, const std::vector<BodyKernelData>& bodies,
            std::vector<LoadColumns> columns, std::vector<bool> rigid);

  bool any() const { return options_.any(); }
  /// Loads are those of this time [s].
  void set_time(double time) { time_ = time; }
  /// Areas and shares of the loaded bodies; before the tiles are scattered, which it uses.
  void collect(const Kernels& kernels, std::vector<SweepSettings> by_level,
               const std::function<SweepScratch()>& scratch, const Distribution* ranks = nullptr);
  /// Forces of pressures, tractions and damping; nodes hold [m, p, f, V], nothing folded yet.
  void add_forces(double dt, double smallest_mass);  ///< lighter nodes feel none [kg]
  /// Prescribed velocities; nodes hold [v+, m, dv, V].
  void drive(double dt);
  /// When v+ is final.
  LoadWork work(double dt) const;

 private:
  using Record = std::array<double, kNodeDoubles>;
  double* force_of(std::size_t block) {
    return forces_.data() + block * static_cast<std::size_t>(kBlockNodes) * kForces;
  }
  bool marked(const Patch& patch) const;
  bool sum_areas(const NodeBlock& block, int body, std::array<Record, kBlockNodes>& out) const;
  void load_node(const Record& area, int body, double* force) const;
  void damp(NodeBlock& block, double dt, double smallest_mass, double* force) const;

  static constexpr int kForces = 6;  ///< per node: of faces, of damping [N]

  LoadOptions options_;
  BlockGrid& grid_;
  std::vector<LoadColumns> columns_;
  std::vector<bool> rigid_;
  std::vector<BodyKernelData> areas_;      ///< the bodies as the scatter of areas sees them
  std::vector<std::vector<int>> of_body_;  ///< loads of each body, in the order of its marks
  Overlaps overlaps_;
  double time_ = 0;
  std::vector<std::array<double, 3>> now_;  ///< values of the loads at the time
  std::vector<AlignedBuffer> tiles_;        ///< by patch: areas and shares
  std::vector<char> loaded_;                ///< by patch: its tile holds them
  AlignedBuffer forces_;
};

}  // namespace krater
