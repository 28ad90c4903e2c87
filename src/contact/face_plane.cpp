// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/contact/face_plane.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace krater {

namespace {

constexpr double kMiss = 0.05;   // cells: what a face may miss a plane by
constexpr double kFaint = 0.02;  // weight of a filling of 0.005: fainter ones tell no distance

template <class Visit>
void each_node(const FillingWindow& w, int radius, const Visit& visit) {
  const int depth = w.dimension == 3 ? radius : 0;
  for (int i = -radius; i <= radius; ++i)
    for (int j = -radius; j <= radius; ++j)
      for (int k = -depth; k <= depth; ++k)
        visit(w.middle[i * w.stride[0] + j * w.stride[1] + k * w.stride[2]], i, j, k);
}

}  // namespace

ShapeSpread shape_spread(bool linear) {
  const double uniforms = linear ? 2 : 3, lump = 0.5;
  const double variance = (uniforms - lump * lump) / 12;
  const double fourth = -(uniforms - lump * lump * lump * lump) / 120;
  return {std::sqrt(variance), fourth / (variance * variance)};
}

double probit(double p) {
  const double q = p - 0.5;
  if (std::abs(q) <= 0.425) {
    const double r = 0.180625 - q * q;
    return q * (((59.109374720 * r + 159.29113202) * r + 50.434271938) * r + 3.3871327179) /
           (((67.187563600 * r + 78.757757664) * r + 17.895169469) * r + 1);
  }
  const double t = std::sqrt(-std::log(std::min(p, 1 - p))) - 1.6;
  const double z = (((0.17023821103 * t + 1.3067284816) * t + 2.7568153900) * t + 1.4234372777) /
                   ((0.12021132975 * t + 0.73700164250) * t + 1);
  return q < 0 ? -z : z;
}

std::array<double, 3> filling_gradient(const FillingWindow& w) {
  std::array<double, 3> out{};
  for (int a = 0; a < w.dimension; ++a) {
    const auto along = static_cast<unsigned>(a);
    const int t = w.stride[(along + 1) % static_cast<unsigned>(w.dimension)];
    const int u = w.dimension == 3 ? w.stride[(along + 2) % 3] : 0;
    double slope = 0;
    for (int i = -1; i <= 1; ++i)
      for (int j = w.dimension == 3 ? -1 : 0; j <= (w.dimension == 3 ? 1 : 0); ++j) {
        const int across = i * t + j * u;
        slope += (2 - std::abs(i)) * (2 - std::abs(j)) *
                 (w.middle[across + w.stride[along]] - w.middle[across - w.stride[along]]);
      }
    out[along] = slope / (w.dimension == 3 ? 32 : 16);
  }
  return out;
}

FacePlane fit_face(const FillingWindow& window, const std::array<double, 3>& guess, int radius,
                   const ShapeSpread& spread) {
  double fourth = 0;
  for (const double n : guess) fourth += n * n * n * n;
  const double bend = spread.excess * fourth / 24;
  Eigen::Matrix4d sums = Eigen::Matrix4d::Zero();
  Eigen::Vector4d moments = Eigen::Vector4d::Zero();
  double squares = 0;
  each_node(window, radius, [&](double phi, int i, int j, int k) {
    const double weight = 4 * phi * (1 - phi) - kFaint;
    if (!(weight > 0)) return;
    const double z = probit(phi);
    const double s = spread.deviation * z * (1 + bend * (z * z - 3));
    const Eigen::Vector4d at{1, -double(i), -double(j), -double(k)};
    sums.noalias() += weight * at * at.transpose();
    moments += weight * s * at;
    squares += weight * s * s;
  });
  FacePlane face;
  const double all = sums(0, 0);
  for (int a = window.dimension; a < 3; ++a) sums(a + 1, a + 1) = 1;  // no such axis
  const Eigen::LDLT<Eigen::Matrix4d> solver(sums);
  if (!(all > 0) || !(solver.vectorD().minCoeff() > 1e-3 * all)) return face;
  Eigen::Vector4d plane = solver.solve(moments);
  const double slope = plane.tail<3>().norm();
  if (!(slope > 0)) return face;
  plane /= slope;
  // of the unit slope, which the best one misses by what its scale is off
  const double miss = squares - 2 * plane.dot(moments) + plane.dot(sums * plane);
  const double q2 = std::max(miss, 0.0) / all / (kMiss * kMiss);
  face.trust = 1 / (1 + q2 * q2);
  face.reach = plane[0];
  for (unsigned a = 0; a < 3; ++a) face.normal[a] = plane[static_cast<int>(a) + 1];
  return face;
}

}  // namespace krater
