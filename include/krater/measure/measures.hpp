// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file measure/measures.hpp
/// Numbers to compare with an experiment, from the points of bodies at one time. The kinds are
/// those of scene/measures.hpp; each has one function here.
///
/// - extent, max, min: of the body's surface (volume_fraction.hpp) along a grid axis, over all node
///   lines.
/// - diameter: 2 R at a height z0 on the last axis, R the mean over all directions about the body's
///   axis. Axisymmetric: the outermost r. 3d: the same after mapping each point to (r, z) with
///   A_p = V_p / (2 pi r_p c); c, the share of the revolution in the model, is 1, 1/2 or 1/4 by the
///   symmetry planes the body touches; elsewhere the axis is the centre of the section. Plane
///   strain: the width along x, doubled at a symmetry plane. largest_diameter: the largest of those
///   at heights a apart from end to end, or from the lower end to a height above it.
/// - mean_velocity, momentum, kinetic_energy (without the affine part of the velocity field),
///   internal_energy, mass, failed_mass, sound_mass, mean: sums over the points.
/// - maximum, minimum: the quantile of a field that a share of the mass lies beyond.
/// - removed_mass: mass at the start less mass now; mass_lost: removed and failed.
/// - deceleration, settling_time: of the mean velocity's history (measure_series.hpp).
/// - penetration_depth: from the target's face at the start (its outermost place on that side) to
///   the body's surface, into the target.
/// - crater_depth, crater_diameter, hole_diameter: measure/openings.hpp.
/// - debris_extent: between the quantiles (1 -+ s)/2 of the mass along an axis, each point reaching
///   half its initial spacing. Along r, and across a symmetry plane, twice the quantile s of the
///   distance: the cloud and its mirror image. Points, not surface: a cloud fills no cell.
/// - impulse, force: contact/impulses.hpp; the force is that of the time since the last row.
/// - angular_momentum, obliquity, yaw, tilt: measure/attitude.hpp.
/// - bulge: from the original face on a side to the outermost place of the surface there.
/// - fragments: pieces (measure/pieces.hpp) of at least `least_points` points.
///
/// Height of a diameter. Points in a band about z0 are weighted with the B-spline
/// K((z_p - z0) / b), b = 1.5 a (a is twice the initial point spacing), and the edge at z0 is that
/// of the straight line R(z) fitted to the edge under these weights. A mushroom foot leans,
/// R ~ R0 - k z: a mean over the band, or a kernel mirrored at the wall, lies 0.4 k b below R0; the
/// fit is exact for a lean, at a wall and at a free end alike. What is left is curvature,
/// -0.09 R'' b^2 at an end and +0.13 R'' b^2 inside.
///
/// Measured (unit/measure/measures) on mapped staggered lattices, 2 points per cell and
/// direction: feet 1.3 to 2.2 times the rod, k 0.3 to 1.5, stretch at the rim up to 3, compression
/// up to 3, exponential profile.
/// - Foot diameter, axisymmetric, rod radius of 10, 20, 40 cells: greatest error 0.84, 0.39 and
///   0.24 %, rms 0.34, 0.15 and 0.07 % (phi = 1/2 with the kernel mirrored at the wall, on a set of
///   148 such shapes: greatest 4.2, 2.2 and 1.1 %, rms 2.4, 1.2 and 0.6 %). 3d, 10 cells: 0.86 and
///   0.30 %. Points displaced at random by up to a tenth of their spacing: 1.5 and 0.5 % at 10
///   cells, 0.44 and 0.18 % at 20.
/// - Length: 0.02 cells axisymmetric, 0.05 in 3d or with displaced points; flat faces at any offset
///   0.02. A sharp rim higher than the middle is missed by up to its slope times one cell.
/// - Extent of a leaning foot along r: 0.25 cells; the diameter is the better measure there.
/// - Rods at rest: diameter within 0.01 cells inside, 0.07 at a free end; in 3d 0.06.
/// - Plates under five cells: 0.31 cells if nearer than a third of a cell to a wall, on which they
///   then count as lying.
///
/// Rarefied material. A point fills at most a cell of the measuring grid (filled_volume), a surface
/// lies within a of a point and in the domain, and is marked where that says little (rarefied).
/// Without the bound the content of points that have expanded a thousand times is taken for a
/// length: 679 mm in a box that ends at 300 (gas let out of a tube, 150 us).
///
/// Not a number: no point, or no material at z0 (more than a/2 beyond the body's end, as z0 = 0 is
/// once a body has rebounded from the wall: give the height from the lower end then).
#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "krater/contact/options.hpp"
#include "krater/geometry/frame.hpp"
#include "krater/scene/measures.hpp"

namespace krater {

struct BodyPoints;

/// Points that are gathered when a measure asks for them. What is handed out stays for a row.
class LayerSource {
 public:
  LayerSource() = default;
  LayerSource(const LayerSource&) = delete;
  LayerSource& operator=(const LayerSource&) = delete;
  virtual ~LayerSource() = default;
  /// Places, masses and densities of the points from `low` to `high` along an axis, in the order of
  /// all.
  virtual const BodyPoints& between(int axis, double low, double high) = 0;
  virtual const BodyPoints& all() = 0;
};

/// What the measures of one row share: each costs a pass over all points.
struct SurfaceMemo {
  /// Least and greatest coordinates of the points: of all, of those that stand for more than a cell
  /// of the measuring grid each. [axis][0 least, 1 greatest] [m]
  struct Bounds {
    std::array<std::array<double, 2>, 3> all, sparse;
  };
  std::optional<Bounds> bounds;
  std::array<std::optional<std::array<double, 2>>, 3> ends;  ///< [axis][0 lowest, 1 highest] [m]
  LayerSource* source = nullptr;  ///< has all the points, and `bounds` is known; null: none has
};

/// The points of one or several bodies; vectors along the grid axes, masses as in field::Mass.
struct BodyPoints {
  std::vector<Triple> x, v;  ///< v empty: no measure reads it
  std::vector<double> mass, density;
  std::map<std::string, std::vector<double>> scalars;
  std::vector<int> body;  ///< index in the scene; empty: one body
  /// 1 for rubble: failed and at less than half of the density at rest, so that nothing of it holds
  /// together; empty: none.
  std::vector<unsigned char> rubble;
  /// Of elements: the edges of their surface, which then is known; empty: points.
  std::vector<std::array<Triple, 2>> edges;
  /// Of points that change no more; none: every measure looks for itself.
  std::shared_ptr<SurfaceMemo> memo;

  std::size_t count() const { return x.size(); }
  bool empty() const { return x.empty() && !(memo && memo->source != nullptr); }
  int body_of(std::size_t p) const { return body.empty() ? 0 : body[p]; }
  bool is_rubble(std::size_t p) const { return !rubble.empty() && rubble[p] != 0; }
};

struct MeasureContext {
  Frame frame = Frame::cartesian_3d;
  double h = 0;  ///< cell [m]
  Triple min{}, max{};
  /// [axis][0 lower, 1 upper]; the axis r = 0 is a symmetry.
  std::array<std::array<BoundaryKind, 2>, 3> boundary{};
  int points_per_direction = 2;
  Triple impulse{};  ///< that the measure's partner gave its bodies so far [N s]
};

/// What a measure remembers of the start of the scene.
struct MeasureStart {
  double mass = 0;  ///< of its bodies [kg]
  double face = 0;  ///< position of the face along its axis [m]
};

/// The points that a measure asks for.
BodyPoints select(const MeasureSelection& selection, const BodyPoints& points,
                  const MeasureContext& context);

/// Position of a face on the surface of the points [m].
double face_position(const MeasureOptions& measure, const BodyPoints& points,
                     const MeasureContext& context);

/// Value in SI of points already selected; of deceleration and settling_time the mean velocity, of
/// force the impulse.
/// Not a number: nothing to measure. Throws InputError for a field that the points do not carry.
double evaluate(const MeasureOptions& measure, const BodyPoints& points,
                const MeasureContext& context, const MeasureStart& start = {});

}  // namespace krater
