// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/measures.hpp
/// Numbers to compare with an experiment, from the points of one body at one time.
///
/// - extent, max, min: of the body's surface (volume_fraction.hpp) along a grid axis, over all node
///   lines.
/// - diameter: 2 R at a height z0 on the last axis, R the mean over all directions about the body's
///   axis. Axisymmetric: the outermost r. 3d: the same after mapping each point to (r, z) with
///   A_p = V_p / (2 pi r_p c); c, the share of the revolution in the model, is 1, 1/2 or 1/4 by the
///   symmetry planes the body touches; elsewhere the axis is the centre of the section. Plane
///   strain: the width along x, doubled at a symmetry plane.
/// - mean_velocity: sum m v / sum m along a grid axis.
/// - mean, maximum: of a scalar field, sum m q / sum m, largest q.
///
/// Height of a diameter. Points in a band about z0 are weighted with the B-spline K((z_p - z0) /
/// b), b = 1.5 a (a is twice the initial point spacing), and the edge at z0 is that of the straight
/// line R(z) fitted to the edge under these weights. A mushroom foot leans, R ~ R0 - k z: a mean
/// over the band, or a kernel mirrored at the wall, lies 0.4 k b below R0; the fit is exact for a
/// lean, at a wall and at a free end alike. What is left is curvature, -0.09 R'' b^2 at an end and
/// +0.13 R'' b^2 inside.
///
/// Measured (tests/unit/app/measures_test.cpp) on mapped staggered lattices, 2 points per cell and
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
/// Not a number: no point, or no material at z0 (more than a/2 beyond the body's end, as z0 = 0 is
/// once a body has rebounded from the wall: give the height from the lower end then).
#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "krater/geometry/frame.hpp"
#include "krater/scene/scene.hpp"
#include "krater/step/options.hpp"

namespace krater {

/// The points of one body; vectors along the grid axes, masses as in field::Mass.
struct BodyPoints {
  std::vector<Triple> x, v;
  std::vector<double> mass, density;
  std::map<std::string, std::vector<double>> scalars;

  std::size_t count() const { return x.size(); }
};

struct MeasureContext {
  Frame frame = Frame::cartesian_3d;
  double h = 0;  ///< cell [m]
  Triple min{}, max{};
  /// [axis][0 lower, 1 upper]; the axis r = 0 is a symmetry.
  std::array<std::array<BoundaryKind, 2>, 3> boundary{};
  int points_per_direction = 2;
};

/// Value in SI. Throws InputError for a field that the points do not carry.
double evaluate(const MeasureOptions& measure, const BodyPoints& body,
                const MeasureContext& context);

}  // namespace krater
