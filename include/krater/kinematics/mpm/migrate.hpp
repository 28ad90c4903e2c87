// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/migrate.hpp
/// Points that left their block move to the neighbour, the others stay where they are: a full sort
/// would cost as much as a step (theory 21). Order is fixed: holes are filled from the end of the
/// patch, arrivals are appended by neighbour (lexicographic), then by their old index; so the bits
/// do not depend on threads. Points that change the level of their cells go by lists of their own,
/// in the order of their patches.
#include "krater/contact/boundary.hpp"
#include "krater/distribute/distribution.hpp"
#include "krater/kinematics/audit.hpp"
#include "krater/kinematics/mpm/kernels.hpp"
#include "krater/kinematics/mpm/split.hpp"

namespace krater {

/// Move leaving points of one patch into its outbox, or out of the computation: through an open
/// side of the domain, or failed where the body's failure removes. `leavers`: lane mask per group.
Removed collect_leavers(Patch& patch, const Levels& levels, const BoundarySet& boundary,
                        const PointColumns& columns, const unsigned char* leavers);

/// All points of a patch that has no place in the levels any more, into its outbox.
void send_away(Patch& patch, const Levels& levels, const PointColumns& columns);

/// What the outboxes led to.
struct Delivered {
  bool changed = false;   ///< the topology: relink!
  double heat = 0;        ///< of points that changed their level (split.hpp) [J]
  double unfelt = 0;      ///< of it, in matter whose pressure does not know its energy
  double made = 0;        ///< points, by splitting
  double finer_rate = 0;  ///< 1/dt at CFL 1 that points may have among finer cells [1/s]
};
/// Hand the outboxes over; makes and drops patches as needed, and splits what comes among finer
/// cells, by the sizes of the bodies. Where patches are made, so are those that points will be in
/// after `ahead` [s]: patches without points change no bit of the rest.
Delivered deliver(BlockGrid& grid, const BoundarySet& boundary,
                  const std::vector<BodyKernelData>& bodies, std::vector<PointSize>& sizes,
                  double ahead = 0, Distribution* ranks = nullptr);

/// Points to the ranks that have their blocks; what comes here is in the order of its patches
/// again. Collective.
void route(std::vector<Arrival>& arrivals, const Distribution& ranks);

/// New points of `body`, records of stride/8 doubles, to the blocks of their positions; what lies
/// beyond an open side is removed at once. Relink afterwards.
Removed adopt(BlockGrid& grid, int body, const std::vector<double>& records,
              const BoundarySet& boundary, const PointColumns& columns);

/// Points of `body` to the blocks of their present positions, however far that is, and out of the
/// domain through its open sides; for a new reference configuration. Order: by id-preserving old
/// order, so the bits do not depend on threads. Relink afterwards.
Removed redistribute(BlockGrid& grid, int body, const BoundarySet& boundary,
                     const PointColumns& columns, const Distribution* ranks = nullptr);

/// Kinetic energy of a point (PointStore::point), affine part included (second moment h^2/4) [J].
inline double point_kinetic(const double* point, const PointColumns& c, const GridGeometry& grid) {
  double twice = 0;
  for (int a = 0; a < grid.dimension; ++a) {
    const double v = point[c.velocity + kLanes * a];
    twice += v * v;
  }
  for (int k = 0; c.affine >= 0 && k < grid.dimension * grid.dimension; ++k) {
    const double L = point[c.affine + kLanes * k];
    twice += Support::moment * grid.h * grid.h * L * L;
  }
  return 0.5 * point[c.mass] * twice;
}

}  // namespace krater
