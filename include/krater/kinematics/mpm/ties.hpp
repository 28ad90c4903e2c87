// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/ties.hpp
/// Nodes at the edge of a level follow from those of the level above (grid/levels.hpp). With the
/// weights P_nJ of the two-scale relation, sum_J P_nJ = 1, sum_J P_nJ x_J = x_n, after the sums
/// over tiles and before the gather
///   restrict:  m_J += sum_n P_nJ m_n,  f_J += sum_n P_nJ f_n,
///              p_J += sum_n P_nJ [p_n + m_n G_n (x_J - x_n)]
///   prolong:   v_n = sum_J P_nJ v_J,  and dv_n, k_n
/// One is the transpose of the other, so power, momentum and the ledger of energy
/// (kinematics/mpm/ledger.hpp) are what they are on one level:
///   sum_n m_n k_n = sum_J m_J k_J  over the masses that points scattered.
///
/// Slope. The lumped centre of a truncated function is not its node, so that a linear field of
/// velocity would come back a fifth too weak. G_n is grad v at the tied node, of the raw sums,
///   G_n e_a = [m_+ (v_+ - v_n) + m_- (v_n - v_-)] / [h (m_+ + m_-)],   +-: its neighbours along a;
/// it is exact for a linear field, and sum_J P_nJ (x_J - x_n) = 0 keeps it out of the momentum.
///
/// Sharpening. Lumped masses D_J of truncated functions reflect waves; the tied grid's own mass is
/// M = own + P^T m P. Two Jacobi sweeps on the change of velocity of the masters,
///   dv <- dv_0 + A(dv)/D,   A_J = sum_n P_nJ m_n (dv_J - dv_n),   dv_0 = dt f/D,
/// halve the reflection. Eigenvalues of M/D lie in [0, 1], so nothing can grow, and sum_J A_J = 0.
/// What it takes from motion is heat: k of a master counts dt f . vbar, as the xpic filter's does.
///
/// apic and xpic add |v-|^2 to k, whose sum must be that of v- . p over what was scattered; a
/// master then counts |v-|^2 - v- . g/D, g what slopes added to its momentum.
///
/// Contact looks for where bodies meet in the volumes of nodes, and there a node must have what a
/// uniform grid of its level would see: coarse nodes that of all their children, free ones too,
/// tied nodes their own and their share of the coarse points, V_n = V_raw + W_n sum_J P_nJ V_J/W_J,
/// with W the volume that a function covers.
///
/// Masters pull their sums in the order of the tied nodes: the bits do not depend on threads.
#include <array>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "krater/contact/boundary.hpp"
#include "krater/grid/blocks.hpp"
#include "krater/kinematics/mpm/kernels.hpp"

namespace krater {

/// The volume that the function of a node covers in the domain, by its storage index.
using WholeVolume = std::function<double(const GridGeometry&, const std::array<int, 3>&)>;

class Ties {
 public:
  /// `whole_volume`: none without contact.
  Ties(BlockGrid& grid, const BoundarySet& boundary, WholeVolume whole_volume)
      : grid_{grid}, boundary_{boundary}, whole_volume_{std::move(whole_volume)} {}

  /// Find tied nodes and masters, and mark their blocks; after BlockGrid::rebuild().
  void relink();
  bool any() const { return !tied_.empty(); }
  /// Sums [m, p, f, V] of the tied nodes of a level to their masters; they are zero then. The
  /// ghosts of their level are folded before.
  void restrict(int level);
  /// Changes dv and v+ of the masters, which hold [v+, m, dv, V], and the sums of their blocks.
  void sharpen(const std::vector<MomentumSettings>& by_level);
  /// The step was shortened after sharpen().
  void shorten(double share);
  /// Volumes as contact reads them; while nodes hold [v+, m, dv, V].
  void complete_volumes();
  /// v+, dv and the mass that points see, of the tied nodes of a level; the ghosts of the level
  /// above are mirrored before.
  void prolong(int level);
  /// When nodes hold k: that of masters and then of tied nodes, all levels.
  void finish_work(bool moments);

 private:
  struct Tied {
    std::int32_t node = 0;                ///< in the memory of all nodes
    std::array<std::int32_t, 8> masters;  ///< by corner: bit a set: (n>>1) + 1 along axis a
    unsigned odd = 0;                     ///< bit a: n is odd along axis a
    /// Along each axis, lower and upper: node, -1: none, -2: its own image in a plane that folds.
    std::array<std::int32_t, 6> beside;
    std::array<double, 8> sums;  ///< raw, of the step
    std::array<double, 9> slope;
    Triple change;     ///< dv in a sweep
    double whole = 1;  ///< W
  };
  struct Share {
    std::int32_t tied;
    std::int32_t corner;
  };
  struct Master {
    std::int32_t node = 0, level = 0;
    std::int32_t first = 0, count = 0;           ///< of shares_
    double own = 0, own_volume = 0;              ///< before the restriction [kg], [m^3]
    double whole = 1;                            ///< W
    Triple from_slopes{}, lumped{}, residual{};  ///< g; dv_0; A
  };
  /// A block with finer ones in its space.
  struct Parent {
    std::size_t block;
    std::array<std::int32_t, 27> finer;  ///< at 2 key + {-1, 0, 1}^dim, -1: none
  };
  struct Range {
    std::size_t first = 0, end = 0;
  };

  double* record(std::int32_t node) { return grid_.nodes() + kNodeDoubles * node; }
  double weight(const Tied& tied, int corner) const {  ///< P_nJ
    return weights_[tied.odd][static_cast<std::size_t>(corner)];
  }
  struct Places;
  void add_tied(const NodeBlock& block, int node, const Places& places);
  void link_masters();
  void link_parents();
  void add_children(const Parent& parent);
  void find_slope(Tied& tied, double h);
  void pull(Master& master, double h);
  void sweep(Range masters, double smallest_mass, int level);
  void fold_residuals(int level);
  void apply_changes(Range masters, const MomentumSettings& s);
  void sum_block(NodeBlock& block, const MomentumSettings& s);
  Range tied_of(int level) const { return tied_ranges_[static_cast<std::size_t>(level)]; }
  Range masters_of(int level) const { return master_ranges_[static_cast<std::size_t>(level)]; }

  BlockGrid& grid_;
  const BoundarySet& boundary_;
  WholeVolume whole_volume_;
  std::array<std::array<double, 8>, 8> weights_{};  ///< by odd axes and corner
  std::vector<Tied> tied_;                          ///< by level, block, node
  std::vector<Master> masters_;                     ///< by level, block, node
  std::vector<Share> shares_;
  std::vector<std::int32_t> master_at_;  ///< by node in memory: index in masters_, -1
  std::vector<Range> tied_ranges_, master_ranges_;
  std::vector<std::size_t> tied_blocks_, master_blocks_;
  std::vector<Parent> parents_;  ///< finest first; of contact only
};

}  // namespace krater
