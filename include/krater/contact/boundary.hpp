// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file contact/boundary.hpp
/// Domain planes. A column is the three node lines nearest to the plane: ghost (outside), plane,
/// inner; points beyond half a cell of a side also see the ghost.
///
/// Planes that fold - symmetry (and the axis r = 0), sticky: the ghost's sums are folded onto its
/// mirror node before the momentum update, normal components odd, tangential even (sticky: all
/// odd); the plane's own odd components vanish. This is the shape function S(x - x_i) +- S(x +
/// x_i): exact for every shape, no special knots (theory 19). With m_g, p_g, f_g of the ghost and
/// p_0, f_0 of the plane as scattered, odd components only, the points receive
///   J = -2 (m_g dv_1 + dt f_g) - dt f_0 - (1 - alpha) [2 (p_g + m_g v-_1) + p_0],
/// where alpha is the share that they keep of the mean residual of their cell (FLIP and TFLIP 1:
/// the fold of v- then never reaches them). These planes do no work.
///
/// Planes that push - wall, velocity: unilateral, after the momentum update. The plane may lie
/// beside its node line, which is then delta cells beyond it, |delta| <= 1/2. Held, a column moves
/// linearly about the plane: with u = v - v_plane
///   u_i = c_i u_1,  c = {-(1 + delta), -delta, 1 - delta}/(1 - delta)  (ghost, plane, inner),
///   u_1 = sum c_i m_i u_i / sum c_i^2 m_i   (the motion nearest to the free one by mass),
/// so that at the plane u = 0 for every shape, and at delta = 0 this is the fold above. It is held
/// while that pushes, J = sum m_i (c_i u_1 - u_i) . inward > 0, and material touches the plane: the
/// volume criterion of theory 19 against the material's own fill, so that it also holds at the rim
/// of a foot; over (1 2 1)/4 of the columns, for one column tells no gap from a lattice. Then
/// Coulomb friction |J_t| <= mu J_n against the slip; infinite: sticks. A plane with a velocity
/// travels with it from its side inwards. v- stays as scattered. The work of a side is
/// J.v_plane; what a column loses beyond it is heat of its three nodes (contact/impulse_heat.hpp).
///
/// On a level of the grid whose planes are knots (grid/geometry.hpp) no node lies on a plane: the
/// column is a pair, ghost and inner node, with c = {-1, 1} held as above; material touches while
///   V_ghost + V_inner > 5/6 V_next     (V_next: of the node beyond the inner one),
/// which closes gaps below 0.16 cells, as 1/4 does at a node (0.19). A plane that travels is
/// anywhere between nodes on every level.
///
/// open: nothing; points that leave are removed and accounted.
#include <array>
#include <span>
#include <vector>

#include "krater/contact/impulse_heat.hpp"
#include "krater/contact/impulses.hpp"
#include "krater/contact/options.hpp"
#include "krater/grid/blocks.hpp"

namespace krater {

using BoundaryConditions = std::array<std::array<Boundary, 2>, 3>;  ///< [axis][0 lower, 1 upper]

/// What the planes did in one step.
struct BoundaryWork {
  double change = 0;                ///< of the grid's kinetic energy [J]
  double work = 0;                  ///< of the sides, from outside [J]
  std::array<double, 3> impulse{};  ///< on the points [N s]
  int columns_in_contact = 0;
};

class BoundarySet {
 public:
  /// `fixed_reference`: nodes are not where the material is. A wall then holds the columns that lie
  /// on it in the reference while their material is at the wall, see note_gaps(); what reaches the
  /// wall from elsewhere is held point by point (mpm/reference.hpp).
  BoundarySet(const GridGeometry& geometry, const BoundaryConditions& conditions,
              bool fixed_reference = false)
      : geometry_{geometry}, conditions_{conditions}, fixed_reference_{fixed_reference} {}

  /// Velocity fields that pushing planes leave alone and whose folds move no point (rigid bodies).
  /// Before relink().
  void set_rigid_fields(std::vector<bool> rigid) { rigid_ = std::move(rigid); }
  const BoundaryConditions& conditions() const { return conditions_; }
  /// Find the columns of nodes at each plane and mark their blocks; call after
  /// BlockGrid::rebuild(), and when set_time() says so.
  void relink(BlockGrid& grid);
  /// Planes that travel go to where they are at `time`; true when one reached other node lines.
  bool set_time(double time);
  /// Where the plane of a side is `later` seconds after the time set [m].
  double position(int axis, int side, double later = 0) const;
  /// Points that have moved for `dt` are judged by the planes at the end of the step.
  void set_step(double dt) { step_ = dt; }
  double step() const { return step_; }
  /// Where the plane is at the end of the step: as a knot coordinate of a level, and whether x is
  /// beyond.
  double last_knots(int axis, int side, int level = 0) const;
  /// Distance that a point keeps from a lower plane of symmetry [cells]: on the axis itself
  /// sigma_tt/r and v_r/r would not be numbers.
  static constexpr double kClearance = 1e-9;
  double clearance(int axis) const;
  bool beyond(int axis, int side, double x) const;
  /// Fixed reference: nodes hold [m, sum S m x, ..]: how far the material of each wall column is
  /// from the wall.
  void note_gaps();
  /// Fold sums [m, p, f, V] of a level; before the momentum update.
  void fold(int level = 0);
  /// Planes that push: change v+ and dv of [v+, m, dv, V]; after the momentum update.
  BoundaryWork constrain();
  /// What they took becomes heat of the nodes, which hold k; returns it [J]. After mirror(), when
  /// every v+ is final.
  double heat();
  /// Ghosts get the k of what they mirror: heat() does it, and whoever gives nodes heat after it.
  void mirror_work() const;
  /// Give ghosts of a level the mirrored values the gather reads.
  void mirror(int level = 0) const;
  /// call(ghost, plane, inner, odd) for each column of planes that fold; plane: nullptr on levels
  /// without nodes there; odd: bit per component that changes its sign.
  template <class Call>
  void for_each_fold(int level, const Call& call) const {
    for (const Plane& plane : planes_) {
      if (plane.geometry.level != level || !plane.condition->folds()) continue;
      unsigned odd = 0;
      for (int a = 0; a < 3; ++a) odd |= plane.odd(a) ? 1U << a : 0U;
      for (const Column& c : plane.columns) call(c.ghost, c.plane, c.inner, odd);
    }
  }
  /// Call call(ghost, inner node) for each column of the planes that are not open.
  template <class Call>
  void for_each_mirror(const Call& call) const {
    for (const Plane& plane : planes_)
      for (const Column& c : plane.columns) call(c.ghost, c.inner);
  }
  /// What the folds did to points that keep the share `alpha` of their residual; after mirror().
  BoundaryWork folded(double dt, double alpha) const;
  void note_impulses() { notes_ = true; }  ///< from now on
  /// What planes that push gave each velocity field in the last constrain(), if it was noted.
  const std::vector<ImpulseSum>& given() const { return given_; }
  /// Some plane moves nodes by itself.
  bool drives() const;
  bool is_open(int axis, int side) const {
    return !conditions_[static_cast<unsigned>(axis)][static_cast<unsigned>(side)].closed();
  }

 private:
  /// Sums of the odd components as scattered, of a plane that folds.
  struct Folded {
    double ghost_mass = 0;
    std::array<double, 3> ghost_momentum{}, ghost_force{}, plane_momentum{}, plane_force{};
  };
  struct Column {
    double *ghost, *plane, *inner;  ///< plane: nullptr where it is a knot ...
    const double* next;             ///< ... and there the node beyond the inner one, if any
    FieldId field;
    bool counted;                     ///< in the sums of this rank
    bool moves_points;                ///< the field is not that of a rigid body
    std::array<std::size_t, 3> held;  ///< of a plane that pushes: its nodes in held_
    std::size_t held_count;
    double gap;  ///< fixed reference: distance of the plane's material from the wall [m]
    Folded folded;
    std::array<const double*, 4> beside;  ///< like nodes of the columns next to it ...
    std::array<int, 4> columns_beside;    ///< ... and their columns, -1: none
    std::array<double, 2> fill;  ///< volume at the plane and beside it, smoothed along the plane
    double* anchor() const { return plane != nullptr ? plane : inner; }
    std::span<const std::size_t> held_nodes() const { return {held.data(), held_count}; }
  };
  struct Plane {
    int axis, side;
    double inward;  ///< +1 lower, -1 upper
    const Boundary* condition;
    GridGeometry geometry;  ///< of its level
    bool on_knot = false;
    int line = 0;       ///< storage index of the plane's node line; on a knot of the inner nodes
    double beyond = 0;  ///< delta: how far that line lies outside the plane [cells]
    std::vector<Column> columns;
    bool odd(int component) const {
      return component == axis || condition->kind == BoundaryKind::sticky;
    }
  };
  /// A node that pushing planes may change, and what it held before they did.
  struct Held {
    double* node;
    std::array<double, kNodeDoubles> before;
    std::array<double, 3> last;  ///< v+ before the plane under way
    unsigned folded;             ///< bit per component that a plane that folds holds at rest
    bool counted;                ///< in the sums of this rank
  };
  void place(Plane& plane) const;
  void add_columns(BlockGrid& grid, Plane& plane) const;
  void add_column(BlockGrid& grid, Plane& plane, NodeBlock& block,
                  const std::array<int, 3>& index) const;
  static void link_columns(Plane& plane);
  void list_held_nodes(const BlockGrid& grid);
  void keep_folded(const Column& column);
  static void note_fills(Plane& plane);
  static void fold_ghost(const Plane& plane, Column& column);
  static void clear_plane(const Plane& plane, Column& column);
  bool touches(const Plane& plane, const Column& column) const;
  bool hold(const Plane& plane, const Column& column) const;
  /// What planes did, in sums that are those of all ranks in the end.
  struct Sums;
  static BoundaryWork together(Sums& sums);
  void note_push(const Plane& plane, const Column& column, Sums& sums);

  GridGeometry geometry_;
  BoundaryConditions conditions_;
  bool fixed_reference_;
  double time_ = 0, step_ = 0;
  std::vector<bool> rigid_;  ///< by field; beyond the list: no
  std::vector<Plane> planes_;
  std::vector<Held> held_;  ///< each node once, in the order of memory
  ImpulseHeat heat_;
  bool notes_ = false;
  std::vector<ImpulseSum> given_;
};

}  // namespace krater
