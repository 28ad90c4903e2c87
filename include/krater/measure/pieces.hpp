// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file measure/pieces.hpp
/// Connected pieces of bodies made of points: points of one body belong to one piece when their
/// grid cells of width h are the same or neighbours (faces, edges, corners). So points up to h
/// apart along every axis are always joined, points more than 2 h apart along one never: material
/// stretched to twice its length holds together, and two fragments are told apart once a gap of two
/// cells lies between them. Pieces never join points of different bodies.
///
/// Rubble (BodyPoints::rubble) holds nothing together: cells of nothing else are joined to
/// neighbours that hold, not to one another. What a spall plane opens parts so, although points of
/// it fill the gap; a failed point in a crowd at its density is joined as any other.
///
/// Cost: one look-up per change of cell from point to point, and 4 (2D) or 13 (3d) per cell. The
/// result does not depend on the order of the points but for the last bits of the sums.
#include <cstddef>
#include <vector>

#include "krater/measure/measures.hpp"

namespace krater {

/// Vectors along the grid axes.
struct Piece {
  int body = 0;    ///< index in the scene
  int number = 0;  ///< in its body: 0 the heaviest
  std::size_t points = 0;
  double mass = 0;              ///< [kg], as field::Mass
  Triple velocity{}, centre{};  ///< mean by mass [m/s], [m]
  Triple low{}, high{};         ///< range of the points' positions [m]
};

struct Pieces {
  std::vector<Piece> list;  ///< by mass, the heaviest first
  std::vector<int> of;      ///< of every point: index in `list`
};

Pieces connected_pieces(const BodyPoints& points, const MeasureContext& context);

}  // namespace krater
