// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/kernels.hpp
/// The hot loops of the step behind one virtual call per block. An implementation exists for each
/// frame, shape and instruction-set level (mpm/kernels_*_hot.cpp); everything that crosses this
/// line is plain data.
///
/// Node record, 8 doubles. After the scatter: [m, p_0, p_1, p_2, f_0, f_1, f_2, V]; after the
/// momentum update: [v+_0, v+_1, v+_2, m, dv_0, dv_1, dv_2, V] with dv = v+ - v-; for the gather
/// the work k of the step (kinematics/mpm/ledger.hpp) takes the place of V. Two-dimensional frames
/// leave index 2 unused.
#include <array>
#include <vector>

#include "krater/grid/blocks.hpp"
#include "krater/kinematics/mpm/pressure_nodes.hpp"
#include "krater/materials/stage.hpp"
#include "krater/points/columns.hpp"

namespace krater {

/// One body as the kernels see it.
struct BodyKernelData {
  PointColumns columns;
  const Stage* const* stages = nullptr;
  int stage_count = 0;
  const Stage* heat_floor = nullptr;  ///< none: the pressure does not know the energy
};

inline std::vector<PointColumns> columns_of(const std::vector<BodyKernelData>& bodies) {
  std::vector<PointColumns> out;
  for (const BodyKernelData& body : bodies) out.push_back(body.columns);
  return out;
}

/// A side that folds cuts the cells about its plane: what is beyond is the image of what is inside.
struct CutCells {
  int cell = -1;     ///< their index along the axis, storage numbering; -1: the side does not fold
  unsigned odd = 0;  ///< bit per component that changes its sign in the image
};

/// What all blocks of a sweep share.
struct SweepSettings {
  const GridGeometry* geometry = nullptr;
  double dt = 0;
  double alpha = 1;            ///< share of the old velocity residual kept: FLIP 1, APIC 0
  double gamma = 0;            ///< share of its mean over the cell that is given back
  double energy_alpha = 0.5;   ///< of the stages: BatchData
  bool moments = false;        ///< none is: the ledger takes the loss pair by pair
  bool may_sleep = false;      ///< blocks at rest may be passed over
  bool average_cells = false;  ///< theory 18
  const double* pressure_nodes = nullptr;  ///< second records of all node blocks; none: no fluid
  std::array<double, 3> first{}, last{};   ///< where the domain ends [knots]
  std::array<std::array<CutCells, 2>, 3> cut{};  ///< [axis][0 lower, 1 upper]
};

/// Nodes that hold at least this share of a cell's volume count for the change of velocity that
/// bounds |L| dt.
inline constexpr double kFilledNode = 0.01;

struct MomentumSettings {
  double dt_force = 0;        ///< time step, 0: no forces [s]
  double smallest_mass = 0;   ///< nodes up to it feel no force [kg]
  double cell_volume = 1;     ///< h^dim
  double flush_velocity = 0;  ///< slower nodes are at rest [m/s]
};

/// Of each cell volume, dilatation, that of the mean gradient, and the record of the ledger.
inline constexpr std::size_t kCellDoubles = 11 * kBlockNodes;

/// A tile by cells along the last axis, three records each (mpm/node_sums.hpp): doubles of a row of
/// cells, and of all rows.
constexpr int quadratic_row(int dimension) { return 3 * block_edge(dimension) * kNodeDoubles; }
constexpr int quadratic_doubles(int dimension) {
  return tile_nodes(dimension) / tile_edge(dimension) * quadratic_row(dimension);
}

/// Memory of one thread.
struct SweepScratch {
  double* halo;            ///< tile_nodes * kNodeDoubles
  double* quadratics;      ///< the same by cells along the last axis: quadratic_doubles()
  double* pressure_halo;   ///< the same, of the second records
  double* local;           ///< groups of a patch * local stride
  double* cells;           ///< kCellDoubles: sums and means of each cell
  double* pressures;       ///< 8 per group: the cell of each point, to look its mean up
  unsigned char* leavers;  ///< 1 per group: lanes that left the block or the domain
  const double* zeros;
};

/// Which parts of grid_to_particles run; usl does all at once, musl and usf in two passes.
enum class GatherPart : int {
  all,            ///< usl: velocity, position, stress
  velocity_only,  ///< musl, first pass: velocity; interpolated grid velocity kept for the move
  strain_move,    ///< musl, second pass: stress, then move with the kept velocity
  strain_only,    ///< usf, first pass: stress
  velocity_move,  ///< usf, second pass: velocity and position
  keep_only,      ///< xpic: interpolated grid velocity kept, nothing else
  filter_move,    ///< xpic: velocity from the filtered grid velocity, mean-velocity move, stress
};

class Kernels {
 public:
  Kernels() = default;
  Kernels(const Kernels&) = delete;
  Kernels& operator=(const Kernels&) = delete;
  virtual ~Kernels();
  /// m_i, p_i, f_i, V_i of one patch into its tile; also its cells' beta.
  virtual void scatter(Patch& patch, const BodyKernelData& body, const SweepSettings& s,
                       const SweepScratch& w) const = 0;
  /// Sum the tiles over one node block.
  virtual void sum_tiles(const BlockGrid& grid, NodeBlock& block) const = 0;
  /// v- = p/m, dv = dt_force f/m, v+ = v- + dv, and the sums of the audit.
  virtual void momentum(NodeBlock& block, const MomentumSettings& s) const = 0;
  /// k of each node in place of its volume, when v+ is final (kinematics/mpm/ledger.hpp);
  /// with `moments` k + |v-|^2.
  virtual void work(NodeBlock& block, bool moments) const = 0;
  /// Velocities, positions, stresses of one patch from the nodes.
  virtual void gather(Patch& patch, const BlockGrid& grid, const BodyKernelData& body,
                      const SweepSettings& s, const SweepScratch& w, GatherPart part) const = 0;
  /// Pressure of a fluid on the grid: one sweep over a patch, from the nodes into its second tile.
  virtual void pressure(Patch& patch, const BlockGrid& grid, const BodyKernelData& body,
                        const SweepSettings& s, const SweepScratch& w, PressurePart part) const = 0;
};

enum class KernelShape : int { quadratic_bspline, gimp, linear };
enum class KernelFrame : int { axisymmetric, plane, space };

/// Which kernels. A fixed reference knows GatherPart::all only (update usl, no xpic).
struct KernelChoice {
  KernelFrame frame;
  KernelShape shape;
  bool affine;  ///< momentum carries L (TFLIP, APIC)
  bool fixed_reference = false;
};

/// Ownership passes to the caller; nullptr never.
struct KernelFactory {
  Kernels* (*make)(const KernelChoice& choice);
};

}  // namespace krater
