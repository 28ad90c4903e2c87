// SPDX-License-Identifier: GPL-3.0-or-later
// Affine maps of 3D space, x -> L x + s: what moves, turns and scales a solid.
#pragma once

#include <array>

#include "krater/geometry/seeds/line.hpp"

namespace krater {

struct Affine {
  std::array<double, 9> linear{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< L by rows
  Vector3 shift{};

  static Affine move(const Vector3& by);
  /// Right-handed, by `angle` (rad) about the line through `about` along `axis`. Quarter turns are
  /// exact. Throws std::invalid_argument for a zero axis.
  static Affine rotate(const Vector3& axis, double angle, const Vector3& about = {});
  /// By positive factors along x, y, z; `about` stays. Throws std::invalid_argument.
  static Affine scale(const Vector3& factors, const Vector3& about = {});

  Vector3 turn(const Vector3& v) const;  ///< L v
  Vector3 apply(const Vector3& x) const;
  Vector3 transpose_turn(const Vector3& v) const;  ///< L^T v
  double determinant() const;
  Affine inverse() const;
  /// L^T L is a multiple of the unit tensor: lengths keep their ratios. Then *factor is the scale.
  bool is_similarity(double* factor = nullptr) const;
};

/// First `b`, then `a`.
Affine operator*(const Affine& a, const Affine& b);

inline double dot(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Vector3 minus(const Vector3& a, const Vector3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vector3 plus(const Vector3& a, double t, const Vector3& b) {
  return {a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]};
}

}  // namespace krater
