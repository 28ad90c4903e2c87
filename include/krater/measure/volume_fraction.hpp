// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file measure/volume_fraction.hpp
/// The surface of a body made of points, by its volume fraction on a measuring grid
///
///     phi_i = sum_p S(x_i - x_p) A_p / (a_1 .. a_d),   A_p = V_p  (axisymmetric: V_p / (2 pi r_p))
///
/// S: the quadratic B-spline, folded at closed planes, so that phi = 1 inside right up to the axis
/// and the wall. Node spacing a: twice the initial spacing of the points.
///
/// Where the surface is. A node line along one axis meets the surface beside its outermost
/// phi = 1/2; linear interpolation there is wrong by up to 4 % of a, because phi is a smoothed
/// step, and more where the last row of points is an odd one. So the place is refined to Gibbs'
/// dividing surface: the sharp edge with the line's content,
///
///     e = x_c + a sum_{i beyond c} phi_i / f,
///
/// x_c = x_j + a/2 between nodes, f the mean phi just inside x_c.
///
/// As S is a partition of unity the sum is exactly the content beyond a smooth step about x_c: the
/// result does not depend on how the outermost points lie, only on their volume. Dividing by f
/// removes the beat between stretched columns and nodes (3 % at a spacing of 1.25 a). Where phi is
/// a symmetric step, e is the surface phi = 1/2.
///
/// Assumes points no further apart than about 1.5 a (stretch 3), and volumes right on the average
/// over a few cells. Gaps below a/2 inside a body are not seen. A part thinner than five nodes has
/// no inside to take f from: f = 1.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "krater/geometry/frame.hpp"

namespace krater {

/// Nodes of the measuring grid along one axis.
struct MeasuringAxis {
  double origin = 0, spacing = 1;  ///< position of node 0 [m], a [m]
  int count = 0;
  std::array<bool, 2> closed{};  ///< [0 lower, 1 upper]: the end node lies on a closed plane

  double node(int i) const { return origin + spacing * i; }
};

/// The three B-spline weights of a position and their nodes, folded at closed planes.
struct NodeWeights {
  std::array<int, 3> index;
  std::array<double, 3> weight;
};

/// Near the ends, where weights are folded or cut.
NodeWeights node_weights_at_end(const MeasuringAxis& axis, double u, int nearest);

/// Every history row pays for this once per point and axis.
inline NodeWeights node_weights(const MeasuringAxis& axis, double x) {
  const double u = (x - axis.origin) / axis.spacing;
  const int last = axis.count - 1;
  const int nearest = static_cast<int>(std::clamp(u, 0.0, static_cast<double>(last)) + 0.5);
  if (nearest <= 1 || nearest >= last - 1) return node_weights_at_end(axis, u, nearest);
  const double f = u - nearest;
  return {{nearest - 1, nearest, nearest + 1},
          {0.5 * (0.5 - f) * (0.5 - f), 0.75 - f * f, 0.5 * (0.5 + f) * (0.5 + f)}};
}

/// Quadratic B-spline of u = distance / width; integral 1, support |u| < 3/2.
double bspline(double u);

/// Axis from `lower` to `upper` (with room for the kernel) on nodes that closed planes of the
/// domain belong to.
MeasuringAxis measuring_axis(double spacing, std::array<double, 2> domain,
                             std::array<bool, 2> closed, std::array<double, 2> occupied);

/// phi along a node line, outwards. With `first` and `second`, the same sums weighted with u = (t_p
/// - t) / spacing and u^2 of another coordinate t, the edge is that *at* t of a straight line
/// fitted to the edge: exact for a surface that leans linearly, also where t is the end of the body
/// and all points lie on one side.
struct FractionLine {
  double spacing = 1;
  bool closed_inner = false, closed_outer = false;  ///< end nodes on closed planes
  double full = 1;                                  ///< phi where the line is full
  int trusted = 0;                                  ///< f is not taken from nodes before this one
  std::vector<double> phi, first, second;
};

struct LineEdge {
  double place;  ///< [m], outwards from node 0
  double fill;   ///< f / full
};

/// The outermost surface; nothing: no node with phi >= full / 2.
std::optional<LineEdge> outer_edge(const FractionLine& line);

/// Volume fraction on a dense array over the body's bounding box.
class VolumeFraction {
 public:
  /// `section[p]`: A_p.
  VolumeFraction(int dimension, const std::array<MeasuringAxis, 3>& axes,
                 const std::vector<std::array<double, 3>>& x, const std::vector<double>& section);

  double at(int i, int j, int k = 0) const { return phi_[offset({i, j, k})]; }
  const MeasuringAxis& axis(int d) const { return axes_[static_cast<std::size_t>(d)]; }

  /// [axis][side]: a closed plane is a wall, towards which a surface may flare (not a symmetry).
  using Walls = std::array<std::array<bool, 2>, 3>;

  /// The outermost place of a surface over all lines, NaN: none; over the well filled ones.
  struct Outermost {
    double of_any = std::numeric_limits<double>::quiet_NaN(), of_filled = of_any;
    double place() const { return std::isnan(of_filled) ? of_any : of_filled; }
  };

  /// Outermost surface over all lines along `axis` (over the well filled ones, if any); side 0: the
  /// lowest, 1: the highest. Edges of lines on a wall are extrapolated to it; elsewhere
  /// they are averaged with the lines beside them, which costs a/4 . a/R on a surface of radius R.
  Outermost outermost(int axis, int side, const Walls& walls) const;

  /// The edges of all lines along an axis, as positions.
  struct Surface {
    std::array<int, 3> lines{};  ///< nodes, 1 along the axis
    std::vector<std::optional<LineEdge>> edges;

    const std::optional<LineEdge>& at(const std::array<int, 3>& line) const {
      return edges[static_cast<std::size_t>((line[0] * lines[1] + line[1]) * lines[2] + line[2])];
    }
  };

  /// The outermost edges of all lines along `axis`, towards `side`.
  Surface surface(int axis, int side) const;

 private:
  template <int Dim>
  void add_points(const std::vector<std::array<double, 3>>& x, const std::vector<double>& section,
                  double cell);
  std::size_t offset(const std::array<int, 3>& i) const;
  std::optional<LineEdge> edge(int axis, int side, std::array<int, 3> node) const;
  double extrapolated(const Surface& surface, const std::array<int, 3>& line,
                      const Walls& walls) const;
  double smoothing(const Surface& surface, const std::array<int, 3>& line,
                   const Walls& walls) const;

  int dimension_;
  std::array<MeasuringAxis, 3> axes_;
  std::vector<double> phi_;
};

}  // namespace krater
