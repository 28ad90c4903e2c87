// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/split.hpp
/// A point that comes among finer cells is too large for them: one of spacing s in cells of s/2 is
/// noise. Where its mass is more than 1.4^dim that of a point of its level and place,
///   m_l = rho_0 prod_a (h_l/n_a),   n_a points along axis a of a cell (times 2 pi r),
/// it becomes 2^dim points at x + d, d_a = -+s_a/4, with its state, its L and
///   m_c = w_c m,   v_c = v + L (d_c - sum w d),   w_c = 1/2^dim, about an axis as r_c,
/// so mass, momentum, the heat in it and the motion about its centre are kept, and about an axis
/// every part keeps its share of the section. By mass and not by volume: matter that has expanded
/// needs no more points. By size and not by level: a part that lands among the coarse cells stays
/// what it is. s is that of the point's volume; where the body keeps its deformation F, d is F d_0,
/// up to half a cell of the level above. Parts stay inside the sides of the domain.
///
/// Stagger. The parts of a staggered lattice (geometry/seeds/lattice.hpp) stand in plain rows: its
/// odd columns are shifted by s/2, one spacing of the parts. A front along the last axis z meets
/// rows then. So inside a body (kinematics/mpm/interior.hpp) d_z is s/8 less for the parts of even
/// columns and s/8 more for the odd ones (of their place in the parent: i, in 3D i + j), and
/// columns of parts are staggered everywhere; a surface would be as rough, and parts at one stay in
/// rows.
/// The skew part of L then takes up what the shift has changed of the angular momentum,
///   h^2/4 (L_ba - L_ab) + sum w [d_a (L d)_b - d_b (L d)_a]:
/// it is what it would be without.
///
/// Of a tensor of the domain (kinematics/mpm/domain.hpp) each part has a quarter.
///
/// Kinetic energy with its affine part (h_l^2/4 per axis, as all sums count it) is one of the
/// level. Where a point changes it, whole or in parts,
///   -dT = m/2 L:L (h_from^2 - h_to^2)/4 - m/2 sum w |L (d - sum w d)|^2
/// becomes its heat: the coarser cells would have made heat of it when L fades. What is missing on
/// the way to coarser cells is a debt (kinematics/mpm/ledger.hpp), and taken at once from matter
/// whose pressure does not know its energy.
#include <array>
#include <vector>

#include "krater/contact/options.hpp"
#include "krater/grid/levels.hpp"
#include "krater/kinematics/mpm/domain.hpp"
#include "krater/points/columns.hpp"

namespace krater {

/// What points of a body are made like.
struct PointSize {
  double density = 0;                         ///< of the undeformed material [kg/m^3]
  std::array<int, 3> per_direction{2, 2, 2};  ///< points in a cell, per grid axis
  bool hoop = false;                          ///< masses are those of the full revolution
  bool stagger = false;                       ///< of the lattice
  double next_id = 0;                         ///< of the next point that splitting makes
  bool halves = false;                        ///< long points are cut (kinematics/mpm/stretch.hpp)
  double mass(const GridGeometry& geometry, double r) const;
};

/// One point as stride/8 doubles, at the level where it is now.
struct Arrival {
  BlockKey key;
  int body = 0;
  std::vector<double> record;
  bool inside = false;  ///< matter is all around
  int source = 0;       ///< patch that it comes from
};

/// A point that came from cells of the level `from` is too large where it is.
bool will_split(const Levels& levels, const PointColumns& columns, const PointSize& size, int from,
                const Arrival& point);

/// Adds the parts of a point that lies in cells of `level` and came from those of `from`, or the
/// point itself; returns what became heat [J]. `half_width`: of
/// the space that the point fills, at the start, when nothing becomes heat; by its size otherwise.
double arrive(const Levels& levels, const PointColumns& columns, PointSize& size, int from,
              Arrival point, std::vector<Arrival>& out, const Triple* half_width = nullptr);

/// Adds the two halves of a point in cells of `g`, cut across the axis of which `half` is half, as
/// kinematics/mpm/stretch.hpp says; returns what became heat [J].
double halve(const GridGeometry& g, const PointColumns& columns, PointSize& size,
             const Arrival& whole, const Triple& half, std::vector<Arrival>& out);

}  // namespace krater
