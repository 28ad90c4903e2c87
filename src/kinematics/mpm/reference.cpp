// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mpm/reference.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "krater/core/parallel.hpp"
#include "krater/core/ranks.hpp"
#include "krater/kinematics/frames.hpp"

namespace krater {

namespace {

// Share of a penetration that is undone in one step: all of it at once would throw the point back.
constexpr double kReturn = 0.01;

// Cells from a wall on the reference within which the grid itself holds the material (columns of
// contact/boundary.hpp).
constexpr double kHeldByGrid = 1.5;

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, 3, 3>;

Matrix read_matrix(const PointStore& points, int offset, int dimension, int i) {
  Matrix out(dimension, dimension);
  for (int k = 0; k < dimension * dimension; ++k)
    out(k / dimension, k % dimension) = points.at(offset + kLanes * k, i);
  return out;
}

void write_matrix(PointStore& points, int offset, const Matrix& m, int i) {
  for (int k = 0; k < m.size(); ++k)
    points.at(offset + kLanes * k, i) = m(k / m.rows(), k % m.cols());
}

/// Tensor of the squared half-widths, M <- F M F^T (mpm/gather.hpp).
void renew_domain(PointStore& points, const PointColumns& c, const Matrix& F, int i) {
  const int dimension = static_cast<int>(F.rows()), step = dimension == 2 ? 2 : 1;
  const auto value = [&](int a, int b) -> double& {
    return points.at(c.domain + kLanes * voigt(step * a, step * b), i);
  };
  Matrix M(dimension, dimension);
  for (int a = 0; a < dimension; ++a)
    for (int b = 0; b < dimension; ++b) M(a, b) = value(a, b);
  M = F * M * F.transpose();
  for (int a = 0; a < dimension; ++a) {
    for (int b = 0; b < dimension; ++b) value(a, b) = M(a, b);
    points.at(c.half_width + kLanes * a, i) = std::sqrt(M(a, a));
  }
}

/// One point onto its current configuration.
void renew_point(PointStore& points, const PointColumns& c, int dimension, int i) {
  const Matrix F = read_matrix(points, c.map, dimension, i);
  if (c.affine >= 0) {
    const Matrix L = read_matrix(points, c.affine, dimension, i);
    write_matrix(points, c.affine, L * F.inverse(), i);
  }
  for (int a = 0; a < dimension; ++a) {
    points.at(c.grid_position + kLanes * a, i) = points.at(c.position + kLanes * a, i);
  }
  if (c.half_width >= 0) renew_domain(points, c, F, i);
  write_matrix(points, c.map, Matrix::Identity(dimension, dimension), i);
}

struct Wall {
  int axis;
  double position, inward, friction, held;
};

std::vector<Wall> walls_of(const GridGeometry& geometry, const BoundarySet& boundary) {
  std::vector<Wall> walls;
  for (int a = 0; a < geometry.dimension; ++a)
    for (std::size_t side = 0; side < 2; ++side) {
      const Boundary& b = boundary.conditions()[static_cast<unsigned>(a)][side];
      if (b.kind != BoundaryKind::wall) continue;
      const double at = side == 0 ? geometry.min[static_cast<unsigned>(a)] : geometry.upper(a);
      walls.push_back({a, at, side == 0 ? 1.0 : -1.0, b.friction, kHeldByGrid * geometry.h});
    }
  return walls;
}

/// Acceleration of one point by one wall [m/s^2].
Triple push(Patch& patch, const PointColumns& c, const Wall& wall, int dimension, double spacing,
            double dt, int i) {
  Triple out{};
  const int n = wall.axis;
  const double X = patch.points.at(c.grid_position + kLanes * n, i);
  if (wall.inward * (X - wall.position) < wall.held) return out;
  double stretch = 0;
  for (int a = 0; a < dimension; ++a) {
    const double F = patch.points.at(c.map + kLanes * (dimension * n + a), i);
    stretch += F * F;
  }
  const double x = patch.points.at(c.position + kLanes * n, i);
  const double v = wall.inward * patch.points.at(c.grid_velocity + kLanes * n, i);
  const double gap = wall.inward * (x - wall.position) - 0.5 * spacing * std::sqrt(stretch);
  const double change = (gap > 0 ? -gap : -kReturn * gap) / dt - v;
  if (!(change > 0)) return out;
  out[static_cast<unsigned>(n)] = wall.inward * change / dt;
  double slip = 0;
  for (int a = 0; a < dimension; ++a)
    if (a != n) slip = std::hypot(slip, patch.points.at(c.grid_velocity + kLanes * a, i));
  if (slip <= 0) return out;
  const double loss = std::min(wall.friction * change, slip) / slip;
  for (int a = 0; a < dimension; ++a)
    if (a != n)
      out[static_cast<unsigned>(a)] = -loss * patch.points.at(c.grid_velocity + kLanes * a, i) / dt;
  return out;
}

}  // namespace

double largest_strain(const BlockGrid& grid, int body) {
  double largest = 0;
  for (const Patch& p : grid.patches())
    if (p.body == body) largest = std::max(largest, 0.5 * p.result.stretch);
  return largest;
}

Removed renew_reference(BlockGrid& grid, int body, const BoundarySet& boundary,
                        const PointColumns& columns, const Distribution* ranks, double& heat) {
  ReproducibleSum sum;
  for (Patch& patch : grid.patches()) {
    if (patch.body != body) continue;
    for (int i = 0; i < patch.points.count(); ++i) {
      const double before = point_kinetic(patch.points.point(i), columns, grid.geometry());
      renew_point(patch.points, columns, grid.geometry().dimension, i);
      const double lost = before - point_kinetic(patch.points.point(i), columns, grid.geometry());
      patch.points.at(columns.energy, i) += lost / patch.points.at(columns.mass, i);
      sum += lost;
    }
  }
  ranks::sum({&sum, 1});
  heat = sum.value();
  return redistribute(grid, body, boundary, columns, ranks);
}

std::array<double, 3> push_from_walls(BlockGrid& grid, const std::vector<BodyKernelData>& bodies,
                                      const BoundarySet& boundary, double spacing, double dt) {
  const GridGeometry& geometry = grid.geometry();
  const std::vector<Wall> walls = walls_of(geometry, boundary);
  std::vector<std::array<double, 3>> force(grid.patches().size());
  for_each(grid.patches().size(), [&](std::size_t p) {
    Patch& patch = grid.patches()[p];
    const PointColumns& c = bodies[static_cast<unsigned>(patch.body)].columns;
    for (int i = 0; i < patch.points.count(); ++i)
      for (const Wall& wall : walls) {
        const Triple b = push(patch, c, wall, geometry.dimension, spacing, dt, i);
        for (int a = 0; a < geometry.dimension; ++a) {
          const auto k = static_cast<unsigned>(a);
          patch.points.at(c.body_acceleration + kLanes * a, i) += b[k];
          force[p][k] += patch.points.at(c.mass, i) * b[k];
        }
      }
    patch.points.pad(c.mass);
  });
  ReproducibleSums<3> sums;
  for (const auto& f : force) sums.add(f.data());
  ranks::sum(sums.all);
  std::array<double, 3> total{};
  sums.read(total.data());
  return total;
}

}  // namespace krater
