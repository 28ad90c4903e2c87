// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file measure/openings.hpp
/// Craters and holes: openings seen along the last axis, on the node lines of the measuring grid
/// (volume_fraction.hpp).
///
/// - crater_depth: largest distance of the outermost surface from the original face, over the lines
///   that the body fills. Not a number where the body is perforated (an empty line that the body
///   encloses).
/// - crater_diameter: of the opening about the deepest line at the height `level` below the
///   original face: where the fraction there is less than half of the largest at that height.
///   Axisymmetric: 2 r of its outer edge. Plane strain: its width, doubled at a symmetry plane.
///   3d: 2 sqrt(A/pi) of its area A, doubled at each symmetry plane it touches. 0: no line is that
///   deep. A lip above the face does not count.
/// - hole_diameter: axisymmetric: 2 r of the innermost surface. 3d: 2 sqrt(A / pi) of the area A
///   through which one sees along z, the largest fraction on the line below 1/2; of several holes
///   the largest. So the narrowest place counts. 0: not perforated.
///
/// Measured (tests/unit/measure/openings_test.cpp), 2 points per cell and direction, in cells:
/// crater_depth 0.1; crater_diameter 0.3 from a level of one cell downwards (nearer to the face the
/// rim of a 45 degree flank is rounded off, 0.7 too wide at half a cell); hole_diameter 0.1, in 3d
/// low by a^2 / (2 R) besides, for edges are chords of phi = 1/2. Assumes openings wider than 2
/// cells, and a plate that encloses its hole (or symmetry planes that do).
#include "krater/measure/measures.hpp"

namespace krater {

/// `face`: original place of the face [m]; side 1: its normal is along +z.
double crater_depth(const BodyPoints& body, const MeasureContext& context, int side, double face);
double crater_diameter(const BodyPoints& body, const MeasureContext& context, int side, double face,
                       double level);
double hole_diameter(const BodyPoints& body, const MeasureContext& context);

}  // namespace krater
