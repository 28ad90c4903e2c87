// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/contact/contact_regression.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace krater {

namespace {

constexpr double kReach = 1.5;    // cells: the support of a node
constexpr double kBeside = 0.25;  // cells: half the distance of two points
constexpr double kAcross = 1;     // cells to each side: what lies beyond has 2 % of the weight
constexpr double kRidge = 5e-4;
constexpr double kSharp = 4;  // |w| at the start: the labels blend over half a cell
constexpr int kIterations = 15;
constexpr double kTolerance = 1e-5;

using Weights = Eigen::Vector4d;  // w_0, w_1, w_2, b

/// Points of a body around the node as (xi, 1), with their label and weight.
struct Sample {
  Weights at;
  double label, weight;
};

/// Quadratic B-spline.
double spline(double x) {
  const double d = std::abs(x), tail = std::max(0.0, kReach - d);
  return d < 0.5 ? 0.75 - d * d : 0.5 * tail * tail;
}

void collect(const BlockGrid& grid, const PointColumns& columns, int body,
             const std::array<double, 3>& node, double label, std::vector<Sample>& samples) {
  const GridGeometry& geometry = grid.geometry();
  const int dimension = geometry.dimension;
  const auto corner = [&](double sign) {
    double at[3]{};
    for (int a = 0; a < dimension; ++a)
      at[a] = node[static_cast<unsigned>(a)] + sign * kReach * geometry.h;
    return block_of(geometry, at);
  };
  const BlockKey first = corner(-1), last = corner(1);
  for (BlockKey key = first; key.i[0] <= last.i[0]; ++key.i[0])
    for (key.i[1] = first.i[1]; key.i[1] <= last.i[1]; ++key.i[1])
      for (key.i[2] = first.i[2]; key.i[2] <= last.i[2]; ++key.i[2]) {
        const int p = grid.find_patch(key, body);
        if (p < 0) continue;
        const PointStore& points = grid.patches()[static_cast<std::size_t>(p)].points;
        for (int i = 0; i < points.count(); ++i) {
          const double volume = points.at(columns.mass, i) / points.at(columns.density, i);
          Sample s{{0, 0, 0, 1}, label, volume};
          for (int a = 0; a < dimension; ++a) {
            const double x = points.at(columns.position + kLanes * a, i);
            s.at[a] = (x - node[static_cast<unsigned>(a)]) * geometry.inv_h;
            s.weight *= spline(s.at[a]);
          }
          if (s.weight > 0) samples.push_back(s);
        }
      }
}

/// Keeps of both bodies what faces the other one, seen along the first guess: beyond a corner one
/// body stands alone, and the plane would lean there. A point counts with the part of its width
/// that does. False where they do not face each other to both sides of the node.
bool face(const std::array<double, 3>& normal, int dimension, std::vector<Sample>& samples) {
  const Eigen::Vector3d n{normal[0], normal[1], normal[2]};
  std::array<Eigen::Vector3d, 2> along{Eigen::Vector3d{-n[1], n[0], 0}, Eigen::Vector3d::Zero()};
  if (dimension == 3) {
    along[0] = n.unitOrthogonal();
    along[1] = n.cross(along[0]);
  }
  for (int k = 0; k < dimension - 1; ++k) {
    const Eigen::Vector3d& t = along[static_cast<unsigned>(k)];
    double first = -2 * kReach, last = 2 * kReach;
    for (const double label : {-1.0, 1.0}) {
      double low = kReach, high = -kReach;
      for (const Sample& s : samples) {
        if (s.label != label) continue;
        low = std::min(low, t.dot(s.at.head<3>()));
        high = std::max(high, t.dot(s.at.head<3>()));
      }
      first = std::max(first, low - kBeside);
      last = std::min(last, high + kBeside);
    }
    if (first > -kAcross || last < kAcross) return false;
    for (Sample& s : samples) {
      const double at = t.dot(s.at.head<3>());
      const double low = std::max(at - kBeside, first), high = std::min(at + kBeside, last);
      s.weight *= std::max(0.0, high - low) / (2 * kBeside);
    }
  }
  return true;
}

/// Both bodies have the same weight in all.
void balance(std::vector<Sample>& samples) {
  std::array<double, 2> sum{};
  for (const Sample& s : samples) sum[s.label > 0] += s.weight;
  for (Sample& s : samples) s.weight /= sum[s.label > 0];
}

}  // namespace

void regress_normal(const BlockGrid& grid, const std::vector<PointColumns>& columns, int body_a,
                    int body_b, const std::array<double, 3>& node, std::array<double, 3>& normal) {
  thread_local std::vector<Sample> samples;
  samples.clear();
  collect(grid, columns[static_cast<unsigned>(body_a)], body_a, node, -1, samples);
  collect(grid, columns[static_cast<unsigned>(body_b)], body_b, node, 1, samples);
  if (!face(normal, grid.geometry().dimension, samples)) return;
  balance(samples);
  Weights w{kSharp * normal[0], kSharp * normal[1], kSharp * normal[2], 0};
  for (int k = 0; k < kIterations; ++k) {
    Eigen::Matrix4d hessian = Eigen::Matrix4d::Zero();
    hessian.diagonal() << kRidge, kRidge, kRidge, 1e-6;
    Weights slope = hessian.diagonal().cwiseProduct(w);
    for (const Sample& s : samples) {
      const double miss =
          1 / (1 + std::exp(s.label * w.dot(s.at)));  // probability of the other label
      slope -= s.weight * s.label * miss * s.at;
      hessian += s.weight * miss * (1 - miss) * s.at * s.at.transpose();
    }
    Weights step = hessian.ldlt().solve(slope);
    const double length = step.norm();
    if (!(length < 1e3)) return;
    if (length > kSharp) step *= kSharp / length;  // far from the minimum Newton may overshoot
    w -= step;
    if (length < kTolerance * w.norm()) break;
  }
  const double length = w.head<3>().norm();
  if (!(length > 0) || w[0] * normal[0] + w[1] * normal[1] + w[2] * normal[2] <= 0) return;
  for (int a = 0; a < 3; ++a) normal[static_cast<unsigned>(a)] = w[a] / length;
}

}  // namespace krater
