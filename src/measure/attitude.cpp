// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/measure/attitude.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Eigenvalues>

#include "krater/measure/measure_surface.hpp"

namespace krater {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
// Eigenvalues of a sphere of 8 cells differ by 1e-3, those of a cylinder as long as wide by 0.3.
constexpr double kAlike = 0.02;

Vector3d vector(const Triple& x) { return {x[0], x[1], x[2]}; }

struct Flight {
  Vector3d centre = Vector3d::Zero(), velocity = Vector3d::Zero();
  std::array<bool, 3> cut{};  ///< by a plane of symmetry across the axis
};

Flight flight(const BodyPoints& body, const MeasureContext& context) {
  Flight out;
  double mass = 0;
  for (std::size_t p = 0; p < body.count(); ++p) {
    mass += body.mass[p];
    out.centre += body.mass[p] * vector(body.x[p]);
    out.velocity += body.mass[p] * vector(body.v[p]);
  }
  out.centre /= mass;
  out.velocity /= mass;
  for (int a = 0; a < dimension(context.frame); ++a) {
    const auto k = static_cast<std::size_t>(a);
    const std::optional<int> side = cut_side(body, context, a);
    if (!side) continue;
    out.cut[k] = true;
    out.centre[a] = *side == 0 ? context.min[k] : context.max[k];
    out.velocity[a] = 0;
  }
  return out;
}

std::optional<Vector3d> long_axis(const BodyPoints& body, const MeasureContext& context,
                                  const Flight& f) {
  Matrix3d Q = Matrix3d::Zero();
  for (std::size_t p = 0; p < body.count(); ++p) {
    const Vector3d r = vector(body.x[p]) - f.centre;
    Q += body.mass[p] * r * r.transpose();
  }
  for (int a = 0; a < 3; ++a)  // with the image the mixed moments cancel
    for (int b = 0; b < 3; ++b)
      if (a != b && (f.cut[static_cast<unsigned>(a)] || f.cut[static_cast<unsigned>(b)]))
        Q(a, b) = 0;
  const int n = dimension(context.frame);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver{Q.topLeftCorner(n, n)};
  const Eigen::VectorXd& q = solver.eigenvalues();  // ascending
  const double low = n == 3 ? q[1] - q[0] : 0, high = q[n - 1] - q[n - 2];
  if (!(std::max(low, high) > kAlike * q[n - 1])) return std::nullopt;
  Vector3d d = Vector3d::Zero();
  d.head(n) = solver.eigenvectors().col(high >= low ? n - 1 : 0);
  return d;
}

double angle(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

}  // namespace

double angular_momentum(const BodyPoints& body, const MeasureContext& context,
                        const Triple& direction) {
  const Flight f = flight(body, context);
  Vector3d L = Vector3d::Zero();
  for (std::size_t p = 0; p < body.count(); ++p)
    L += body.mass[p] * (vector(body.x[p]) - f.centre).cross(vector(body.v[p]));
  // Axes 0, 1 of the section are x and z: the turn from x to z is about -y.
  return context.frame == Frame::cartesian_3d ? L.dot(vector(direction)) : -L[2];
}

double obliquity(const BodyPoints& body, const MeasureContext& context, const Triple& line) {
  const Flight f = flight(body, context);
  return f.velocity.norm() > 0 ? angle(f.velocity, vector(line)) : kNothing;
}

double yaw(const BodyPoints& body, const MeasureContext& context) {
  const Flight f = flight(body, context);
  const std::optional<Vector3d> d = long_axis(body, context, f);
  return d && f.velocity.norm() > 0 ? angle(*d, f.velocity) : kNothing;
}

double tilt(const BodyPoints& body, const MeasureContext& context, const Triple& line) {
  const std::optional<Vector3d> d = long_axis(body, context, flight(body, context));
  return d ? angle(*d, vector(line)) : kNothing;
}

}  // namespace krater
