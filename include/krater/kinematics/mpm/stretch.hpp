// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/stretch.hpp
/// A point whose matter has become longer than 3/4 of a cell (kinematics/mpm/domain.hpp) is cut in
/// two along it, so that sheets, bars and jets go on sharing nodes: half-supports reach 2R - h, one
/// cell with linear functions, two with quadratic ones (simulation/torn_points.hpp), and two points
/// to a cell are cut at a stretch of 1.5. With e the longest axis and l its half length, the halves
/// lie at x -+ q, q = l e/2, with all of the point's state,
///   m_k = w_k m,   v_k = v + L (d_k - sum w d),   M' = M - 3 q q^T,   L'_ab - L'_ba as below;
/// w = 1/2, and about an axis as r_k, so that each has half of the section and the momentum of the
/// ring is kept (kinematics/mpm/split.hpp). Mass, momentum, volume, centre (about an axis that of
/// the section) and second moment are exact. What q x (L q) adds to the angular momentum the skew
/// part of L gives back, h^2/4 (dL_ba - dL_ab) = -[q_a (L q)_b - q_b (L q)_a]; about an axis there
/// is none. The kinetic energy with its affine part changes by m/2 (|L q|^2 + h^2/4 d|L|^2), which
/// is heat or a debt. Without an affine part the halves move alike and nothing changes.
///
/// Sound points only: what has failed bears no tension that a gap could lose, and its fragments
/// need not be more; nor do fluids. Down to 1/256 of the mass of a point of its cells, eight
/// halvings of a whole one. Looked for every `kRegridSteps` steps, after the points have moved;
/// numbers are given in the order of patches and points. A half beyond the edge of its block goes
/// on as a point that changes cells.
/// Sources: Ruggirello, Schumacher 2013 (A dynamic adaptation technique for the material point
/// method, Sandia) split points that have grown; Homel, Brannon, Guilkey 2016 domains that are cut.
#include <vector>

#include "krater/grid/blocks.hpp"
#include "krater/kinematics/mpm/split.hpp"

namespace krater {

/// Half the longest axis of a point that is not split, in cells.
inline constexpr double kLongestHalf = 0.375;
/// Of the mass of a point of its cells: lighter ones are split no more.
inline constexpr double kLightest = 1.0 / 256;

/// Points of a patch in cells of `g` that are too long, ascending.
std::vector<int> stretched_points(const Patch& patch, const GridGeometry& g,
                                  const PointColumns& columns, const PointSize& size);

/// These points in halves, in the patch or its outbox; returns what became heat [J].
double split_stretched_points(Patch& patch, const Levels& levels, const PointColumns& columns,
                              PointSize& size, const std::vector<int>& which);

}  // namespace krater
