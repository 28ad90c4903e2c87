// SPDX-License-Identifier: GPL-3.0-or-later
// Seeds of material points: a regular lattice of spacing s = cell / points_per_direction, aligned
// with the grid's origin, every lattice cell clipped exactly by the solid and the domain (theory
// 15). Sum of the seeds' measures = measure of the solid in the domain.
//
// Stagger: the columns along the last axis (z) whose index is odd (2D: i; 3D: i + j; counted from
// the grid's origin, so that the lattices of all bodies match) are shifted by +s/2 along z. A shock
// front along z then meets no regular rows: a plateau's noise fell from 2.5 to 0.65 %
// in a plane prototype. A mirror turns odd columns into even ones, so where a scene has a plane of
// symmetry they are counted outward from it (`LatticeOptions::mirror`): the lattice is then its own
// image, at the price of two like columns side by side there, and a quarter of a model has the
// points of the whole.
//
// Where a seed lies. Its z (and x, y) is the centroid weighted with the measure: the solid's mass
// centre is exact. Its r, in the axisymmetric frame, is the centroid of the *area*, which by Pappus
// is V / (2 pi A), and not the centroid of the volume, <r^2> / <r>. In a uniform state the nodal
// force -sum_p V_p (s dS/dr + s S/r_p) must equal -2 pi s int d(r S)/dr dA: with V_p / r_p = 2 pi
// A_p the sum is the midpoint rule of that integrand, the total hoop force sum V_p s_tt / r_p is
// exact, and A_p follows from the stored V_p and r_p. The volume's centroid makes V_p / r_p too
// small by s^2 / (12 r^2): 25 % in the column at the axis (r_p = 2/3 s instead of 1/2 s), where a
// rod under uniform pressure would not be in balance. Its one merit, an exact int r dm, is not a
// conserved quantity of this frame.
//
// Slivers (cells less than half full) are not points of their own: see `fill`. Where the centroid
// of a part falls outside of the solid (a cell cut by a hollow surface) the point is moved along
// the axis with the nearest material, a twentieth of a spacing into it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "krater/geometry/frame.hpp"
#include "krater/geometry/solids/box.hpp"
#include "krater/geometry/solids/solid.hpp"

namespace krater {

struct LatticeOptions {
  double cell = 0;                                   ///< grid spacing h, m
  std::array<int, 3> points_per_direction{2, 2, 2};  ///< lattice cells per grid cell, per grid axis
  std::array<double, 3> origin{};                    ///< a node of the grid, grid axes, m
  std::array<double, 3> spacing{};                   ///< m; where 0: cell / points_per_direction
  bool fit_to_body = false;  ///< see `fill_body`: lattice along the body's own axes instead
  bool stagger = true;       ///< shift odd columns by half a spacing along z
  /// Planes across the axes before the last from which columns are counted outward, m; NaN, or one
  /// that is no multiple of the spacing from the origin: counted from the origin. (About the middle
  /// of a column a lattice is its own image anyway.)
  std::array<double, 2> mirror{std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::quiet_NaN()};
  double jitter = 0;       ///< greatest random shift per axis, in spacings; measures stay
  std::uint64_t seed = 0;  ///< of the jitter
};

/// More points inside a box: `points_per_direction` there, one less per axis for every `falloff`
/// grid cells away from it, down to the lattice's own number.
struct RefinedZone {
  Box box;  ///< grid axes; moved out to the next grid nodes
  std::array<int, 3> points_per_direction{2, 2, 2};
  int falloff = 2;
};

struct SeedPoint {
  std::array<double, 3> x{};  ///< grid axes
  double measure = 0;         ///< m^3 (plane strain: per 1 m; axisymmetric: full revolution)
  /// Half the edges (m) of the clipped lattice cell with its share of merged slivers: for a box or
  /// rod aligned with the grid the seeds' domains x -+ half_width tile the body exactly.
  std::array<double, 3> half_width{};
};

/// Moments of the points as they move: lumps (rings, lines of 1 m of y) without extent of their
/// own.
VolumeMoments moments_of(const std::vector<SeedPoint>& points, Frame frame);

/// What came out. `count == 0`: nothing of the body is in the domain; `smallest_thickness_in_cells
/// < 1`: thinner than a grid cell. Neither throws here: the caller knows the scene's file and line.
struct FillReport {
  double measure_exact = 0;                ///< of the solid in the domain
  double measure_points = 0;               ///< sum over the seeds
  double smallest_thickness_in_cells = 0;  ///< least extent along the grid's axes, in grid cells
  std::size_t count = 0;
  std::size_t slivers_merged = 0;
  std::size_t slivers_kept = 0;  ///< with no fuller cell beside them: the body is thin there
};

/// Seeds of `solid` in `domain` (grid axes). Order: i slowest, then j, then along z; slivers that
/// stay points come last. The result depends on the arguments only.
///
/// A cell less than half full (by section) gives its measure and moments to the kept cells that
/// share the largest content with it: of those that touch one of its faces, the ones with the
/// largest product of shared fraction of the face and own content; near-equals (within 30 %) share
/// equally, which keeps symmetric bodies symmetric and masses even. Failing that, cells touching at
/// an edge or corner; failing that, the fullest slivers are kept themselves. Exactly half full
/// counts as kept: it is what staggering leaves at a body's end. Points that are still far lighter
/// than the body's others, as at a tip, go to the nearest heavier one (src/geometry/light_points).
///
/// Throws std::invalid_argument if the solid has no meaning in the frame, or for options that make
/// no lattice.
std::vector<SeedPoint> fill(const Solid& solid, Frame frame, const LatticeOptions& options,
                            const Box& domain, FillReport* report = nullptr);

/// As `fill`, with zones of more points, each piece of constant spacing filled for itself (slivers
/// do not cross its sides; points left light go to the nearest heavier one of any), and with
/// `fit_to_body`: the lattice then begins at a corner of the body's bounding box and its spacings
/// divide the edges of that evenly; in 3d it runs along the body's own axes before it was turned (a
/// body turned as a whole and not stretched), for which the domain must hold all of the body. Zones
/// and fit_to_body exclude each other. Throws std::invalid_argument.
std::vector<SeedPoint> fill_body(const Solid& solid, Frame frame, const LatticeOptions& options,
                                 const std::vector<RefinedZone>& zones, const Box& domain,
                                 FillReport* report = nullptr);

}  // namespace krater
