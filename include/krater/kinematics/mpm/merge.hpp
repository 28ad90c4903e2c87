// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/merge.hpp
/// Points that have come from finer cells are more than their cells need, four or eight times as
/// many a level. Where a block holds more than 2.5 times the points that its mass is worth
/// (kinematics/mpm/split.hpp: m_l), and no node near it is tied to another level, those that lie in
/// one bin of a point's spacing and are light, m < 0.6 m_l, become one when they are together 0.6
/// to 1.5 of m_l; a bin that holds more is halved across its longest side. With w = m/M, M = sum m,
///   x = sum w x_p,   v = sum w v_p,   L = sum w L_p + K,   e = sum w e_p + heat,
///   V = sum m_p/rho_p,   s = sum V_p s_p / V   (stresses, pressures),
/// and all else by mass, F then stretched to det F = sum w det F_p. About an axis r is the mean by
/// section, sum (m/r) r_p / sum (m/r): splitting shared sections. The skew K keeps the angular
/// momentum, h^2/4 a point and axis for its own turn:
///   h^2/2 K_ba = sum w (d_a c_b - d_b c_a),   d = x_p - x,   c = v_p - v,   K_ab = -K_ba;
/// about an axis there is none to keep. Kinetic energy with its affine part becomes heat; what is
/// missing is a debt, as where points split.
///
/// Tensors of domains sum up by the theorem of parallel axes (kinematics/mpm/domain.hpp); where
/// long points are split (kinematics/mpm/stretch.hpp), none become one that would be split again.
///
/// The points' histories must be close: their spread up to a tenth of the greatest in the group,
/// and a twentieth of the greatest in the block; 0.05 more where a history counts from 0 to 1
/// (plastic strain, damage, `failed`). Points of one lattice that was split are; across a shear
/// band they are not.
///
/// It saves time, and costs smoothness: rows of merged points are less even than rows that never
/// split, so a scene asks for it (grid.merge).
#include <vector>

#include "krater/grid/blocks.hpp"
#include "krater/kinematics/mpm/kernels.hpp"
#include "krater/kinematics/mpm/split.hpp"

namespace krater {

/// How a body's columns, component by component, become those of one point.
struct MergePlan {
  struct Entry {
    int place;            ///< PointStore::at
    double absolute = 0;  ///< spread of a history that never stands in the way
    bool by_volume = false;
    bool history = false;  ///< must be close
  };
  std::vector<Entry> entries;  ///< without what merge.hpp has rules of its own for
  bool possible = false;       ///< not: rigid bodies, bodies with loads on their faces
};
MergePlan plan_merging(const Layout& layout, const PointColumns& columns);

/// What merging did in one patch.
struct Merged {
  double points = 0;            ///< fewer
  double heat = 0, unfelt = 0;  ///< [J]; unfelt: in matter whose pressure does not know its energy
};
/// Of the points of a patch in cells of `geometry`.
Merged merge_points(Patch& patch, const GridGeometry& geometry, const BodyKernelData& body,
                    const PointSize& size, const MergePlan& plan);

}  // namespace krater
