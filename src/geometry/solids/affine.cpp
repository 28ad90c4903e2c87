// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/geometry/solids/affine.hpp"

#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace krater {
namespace {

/// Sines and cosines of quarter turns are off by the round-off of pi.
double snapped(double x) { return std::abs(x - std::round(x)) < 1e-15 ? std::round(x) : x; }

/// The map about a point that leaves it in place.
Affine about_point(const std::array<double, 9>& linear, const Vector3& about) {
  Affine map;
  map.linear = linear;
  map.shift = minus(about, map.turn(about));
  return map;
}

}  // namespace

Affine Affine::move(const Vector3& by) {
  Affine map;
  map.shift = by;
  return map;
}

Affine Affine::rotate(const Vector3& axis, double angle, const Vector3& about) {
  const double length = std::sqrt(dot(axis, axis));
  if (!(length > 0) || !std::isfinite(length) || !std::isfinite(angle)) {
    throw std::invalid_argument("a rotation needs an axis of some length and a finite angle");
  }
  const Vector3 n{axis[0] / length, axis[1] / length, axis[2] / length};
  const double c = snapped(std::cos(angle)), s = snapped(std::sin(angle)), d = 1 - c;
  return about_point({c + d * n[0] * n[0], d * n[0] * n[1] - s * n[2], d * n[0] * n[2] + s * n[1],
                      d * n[1] * n[0] + s * n[2], c + d * n[1] * n[1], d * n[1] * n[2] - s * n[0],
                      d * n[2] * n[0] - s * n[1], d * n[2] * n[1] + s * n[0], c + d * n[2] * n[2]},
                     about);
}

Affine Affine::scale(const Vector3& factors, const Vector3& about) {
  for (const double f : factors) {
    if (!(f > 0) || !std::isfinite(f)) {
      throw std::invalid_argument("factors of a scaling must be positive and finite");
    }
  }
  return about_point({factors[0], 0, 0, 0, factors[1], 0, 0, 0, factors[2]}, about);
}

Vector3 Affine::turn(const Vector3& v) const {
  return {linear[0] * v[0] + linear[1] * v[1] + linear[2] * v[2],
          linear[3] * v[0] + linear[4] * v[1] + linear[5] * v[2],
          linear[6] * v[0] + linear[7] * v[1] + linear[8] * v[2]};
}

Vector3 Affine::apply(const Vector3& x) const { return plus(turn(x), 1, shift); }

Vector3 Affine::transpose_turn(const Vector3& v) const {
  return {linear[0] * v[0] + linear[3] * v[1] + linear[6] * v[2],
          linear[1] * v[0] + linear[4] * v[1] + linear[7] * v[2],
          linear[2] * v[0] + linear[5] * v[1] + linear[8] * v[2]};
}

double Affine::determinant() const {
  return dot({linear[0], linear[1], linear[2]},
             cross({linear[3], linear[4], linear[5]}, {linear[6], linear[7], linear[8]}));
}

Affine Affine::inverse() const {
  const Vector3 a{linear[0], linear[1], linear[2]}, b{linear[3], linear[4], linear[5]},
      c{linear[6], linear[7], linear[8]};
  const Vector3 bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const double d = determinant();
  Affine map;
  for (std::size_t i = 0; i < 3; ++i) {
    map.linear[3 * i] = bc[i] / d;
    map.linear[3 * i + 1] = ca[i] / d;
    map.linear[3 * i + 2] = ab[i] / d;
  }
  const Vector3 back = map.turn(shift);
  for (std::size_t i = 0; i < 3; ++i) map.shift[i] = -back[i];
  return map;
}

bool Affine::is_similarity(double* factor) const {
  const Vector3 x = turn({1, 0, 0}), y = turn({0, 1, 0}), z = turn({0, 0, 1});
  const double s = dot(x, x);
  const double off = std::abs(dot(y, y) - s) + std::abs(dot(z, z) - s) + std::abs(dot(x, y)) +
                     std::abs(dot(y, z)) + std::abs(dot(z, x));
  if (factor != nullptr) *factor = std::sqrt(s);
  return off <= 1e-12 * s;
}

Affine operator*(const Affine& a, const Affine& b) {
  Affine map;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      map.linear[3 * i + j] = a.linear[3 * i] * b.linear[j] +
                              a.linear[3 * i + 1] * b.linear[3 + j] +
                              a.linear[3 * i + 2] * b.linear[6 + j];
    }
  }
  map.shift = a.apply(b.shift);
  return map;
}

}  // namespace krater
