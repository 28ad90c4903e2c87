// SPDX-License-Identifier: GPL-3.0-or-later
// Contents of the cells of a column by quadrature over lines along the last axis (z).
//
// A line's part in each cell is exact, so the sum over a column needs quadrature across it only:
// Simpson's rule on nested halves of its cross-section, x outside and y inside, until the length in
// the solid and its first moment agree between two levels to 5e-5 of the column's greatest length,
// or 14 levels (2D frames, where lines are few: 1e-8, 30). Smooth surfaces take 25 lines; where a
// line's length jumps (a wall along z) the levels close in on the jump. All cells of the column
// share the lines: what one cell loses to round-off or to a kink its neighbour gains, and the
// column's content is that of the quadrature. Features thinner than a quarter of the column,
// between its first lines, may go unseen.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "krater/geometry/solids/solid.hpp"

namespace krater {

/// Lines with weights (m^2 of cross-section, m in 2D) that stand for a column.
struct ColumnLines {
  struct Sample {
    double x, y, weight;
    std::uint32_t first, count;  ///< in `spans`
  };
  std::vector<Sample> lines;
  Spans spans;
};

/// Lines of the column whose cross-section is that of `column` (grid axes, within the frame), spans
/// cut to its extent along z. `reference`: a length, m, whose 5e-5 is small even where the solid is
/// thin (a cell's height).
void sample_column(const Solid& solid, Frame frame, const Box& column, double reference,
                   ColumnLines& out);

/// Volume moments of the part of a solid in a domain: full revolution, or 1 m of y, in the 2D
/// frames. Exact where the domain encloses a solid that knows its moments and the frame is not
/// plane strain; else by quadrature. `exact` says which.
VolumeMoments moments_in(const Solid& solid, Frame frame, const Box& domain, bool* exact = nullptr);

}  // namespace krater
