// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/contact/face_plane.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/LU>

namespace krater {

namespace {

constexpr double kMiss = 0.05;        // cells: what a face may miss a plane by
constexpr double kFaint = 0.02;       // weight of a filling of 0.005: fainter ones tell no distance
constexpr double kFlatSpread = 1e-4;  // cells^2d: nodes of one line, or fewer, make no plane

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

namespace {

/// z of a filling, straight between the entries of a table: within 2e-3 where it has any weight.
class ProbitTable {
 public:
  ProbitTable() {
    for (std::size_t i = 1; i < kParts; ++i) z_[i] = probit(static_cast<double>(i) / kParts);
    z_[0] = z_[1];
    z_[kParts] = z_[kParts - 1];
  }
  double operator()(double p) const {
    const double at = p * kParts;
    const auto i = static_cast<std::size_t>(at);
    return z_[i] + (at - static_cast<double>(i)) * (z_[i + 1] - z_[i]);
  }

 private:
  static constexpr std::size_t kParts = 1024;
  std::array<double, kParts + 1> z_{};
};

/// Weighted sums over the nodes of a window, of their places x and distances s.
struct FaceSums {
  double all = 0, s = 0, ss = 0;
  std::array<double, 3> x{}, xs{};
  std::array<double, 6> xx{};  ///< 00 11 22 01 02 12

  void add(double weight, double distance, double i, double j, double k) {
    const double ws = weight * distance, wi = weight * i, wj = weight * j, wk = weight * k;
    all += weight;
    s += ws;
    ss += ws * distance;
    x = {x[0] + wi, x[1] + wj, x[2] + wk};
    xs = {xs[0] + ws * i, xs[1] + ws * j, xs[2] + ws * k};
    xx = {xx[0] + wi * i, xx[1] + wj * j, xx[2] + wk * k,
          xx[3] + wi * j, xx[4] + wi * k, xx[5] + wj * k};
  }
};

}  // namespace

FacePlane fit_face(const FillingWindow& window, const std::array<double, 3>& guess, int radius,
                   const ShapeSpread& spread) {
  static const ProbitTable table;
  double fourth = 0;
  for (const double n : guess) fourth += n * n * n * n;
  const double bend = spread.excess * fourth / 24;
  FaceSums sums;
  each_node(window, radius, [&](double phi, int i, int j, int k) {
    const double weight = 4 * phi * (1 - phi) - kFaint;
    if (!(weight > 0)) return;
    const double z = table(phi);
    sums.add(weight, spread.deviation * z * (1 + bend * (z * z - 3)), i, j, k);
  });
  FacePlane face;
  if (!(sums.all > 0)) return face;
  // about the means: covariances of places, and of places with distances
  const double inverse = 1 / sums.all, s = sums.s * inverse;
  const Eigen::Vector3d x = inverse * Eigen::Vector3d{sums.x[0], sums.x[1], sums.x[2]};
  const auto& q = sums.xx;
  Eigen::Matrix3d spread_of;
  spread_of << q[0], q[3], q[4], q[3], q[1], q[5], q[4], q[5], q[2];
  spread_of = inverse * spread_of - x * x.transpose();
  const Eigen::Vector3d with =
      inverse * Eigen::Vector3d{sums.xs[0], sums.xs[1], sums.xs[2]} - s * x;
  if (window.dimension == 2) spread_of(2, 2) = 1;  // no such axis
  Eigen::Matrix3d inverted;
  bool invertible = false;
  spread_of.computeInverseWithCheck(inverted, invertible, kFlatSpread);
  if (!invertible) return face;
  Eigen::Vector3d normal = -(inverted * with);
  const double slope = normal.norm();
  if (!(slope > 0)) return face;
  normal /= slope;
  // of the unit slope, which the best one misses by what its scale is off
  const double miss =
      inverse * sums.ss - s * s + 2 * normal.dot(with) + normal.dot(spread_of * normal);
  const double q2 = std::max(miss, 0.0) / (kMiss * kMiss);
  face.trust = 1 / (1 + q2 * q2);
  face.reach = s + normal.dot(x);
  for (unsigned a = 0; a < 3; ++a) face.normal[a] = normal[static_cast<int>(a)];
  return face;
}

}  // namespace krater
