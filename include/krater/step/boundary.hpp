// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file step/boundary.hpp
/// Domain planes. Each lies on a line of nodes; points beyond half a cell of it also see one ghost
/// node outside.
/// - symmetry (and the axis r = 0), sticky: the ghost's sums are folded onto its mirror node before
///   the momentum update, normal components odd, tangential even (sticky: all odd), the plane's own
///   odd components vanish. This is the shape function S(x - x_i) +- S(x + x_i): exact for every
///   shape, no special knots (theory 19).
/// - wall: unilateral. After the momentum update a column (ghost, plane, inner node) is in contact
///   if the wall would push,
///     J = -(2 m_g v_g + m_0 v_0) . n > 0,
///   and material touches the plane,
///     2 V_0 > (1 - kFillTolerance) (V_1 + V_g),
///   judged against the column's own fill, so that it also holds at the rim of a foot. Then the
///   column is folded as above with Coulomb friction |J_t| <= mu J_n; otherwise it is left alone
///   and the body flies off.
/// - velocity: plane and ghost nodes move as prescribed.
/// - open: nothing; points that leave are removed and accounted.
#include <array>
#include <vector>

#include "krater/grid/blocks.hpp"
#include "krater/step/options.hpp"

namespace krater {

using BoundaryConditions = std::array<std::array<Boundary, 2>, 3>;  ///< [axis][0 lower, 1 upper]

/// What the planes did in one step.
struct BoundaryWork {
  double work = 0;                  ///< change of the grid's kinetic energy [J]
  double force_correction = 0;      ///< change of the work of the nodal forces, part of `work` [J]
  std::array<double, 3> impulse{};  ///< on the points [N s]
  int columns_in_contact = 0;
};

class BoundarySet {
 public:
  /// `fixed_reference`: nodes are not where the material is. A wall then holds the columns that lie
  /// on it in the reference while their material is at the wall, see note_gaps(); what reaches the
  /// wall from elsewhere is held point by point (step/reference.hpp).
  BoundarySet(const GridGeometry& geometry, const BoundaryConditions& conditions,
              bool fixed_reference = false)
      : geometry_{geometry}, conditions_{conditions}, fixed_reference_{fixed_reference} {}

  /// Velocity fields that walls and moving planes leave alone (rigid bodies). Before relink().
  void set_rigid_fields(std::vector<bool> rigid) { rigid_ = std::move(rigid); }
  const BoundaryConditions& conditions() const { return conditions_; }
  /// Find the columns of nodes at each plane and mark their blocks; call after
  /// BlockGrid::rebuild().
  void relink(BlockGrid& grid);
  /// Fixed reference: nodes hold [m, sum S m x, ..]: how far the material of each wall column is
  /// from the wall.
  void note_gaps();
  /// symmetry, sticky: fold sums [m, p, f, V]; before the momentum update.
  void fold() const;
  /// wall, velocity: change v+ and dv of [v+, m, dv, V]; after the momentum update.
  BoundaryWork constrain() const;
  /// Give ghosts the mirrored values the gather reads.
  void mirror() const;
  /// Call call(ghost, inner node) for each column of the planes that are not open.
  template <class Call>
  void for_each_mirror(const Call& call) const {
    for (const Plane& plane : planes_)
      for (const Column& c : plane.columns) call(c.ghost, c.inner);
  }
  /// Some plane moves nodes by itself.
  bool drives() const;
  bool is_open(int axis, int side) const {
    return conditions_[static_cast<unsigned>(axis)][static_cast<unsigned>(side)].kind ==
           BoundaryKind::open;
  }

 private:
  struct Column {
    double *ghost, *plane, *inner;
    double gap;  ///< fixed reference: distance of the plane's material from the wall [m]
  };
  struct Plane {
    int axis;
    double inward;  ///< +1 lower, -1 upper
    const Boundary* condition;
    std::vector<Column> columns;
  };
  void add_columns(BlockGrid& grid, Plane& plane, int side) const;
  void constrain_wall(const Plane& plane, const Column& column, BoundaryWork& sum) const;
  void constrain_velocity(const Plane& plane, const Column& column, BoundaryWork& sum) const;

  GridGeometry geometry_;
  BoundaryConditions conditions_;
  bool fixed_reference_;
  std::vector<bool> rigid_;  ///< by field; beyond the list: no
  std::vector<Plane> planes_;
};

}  // namespace krater
