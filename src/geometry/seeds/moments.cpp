// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/geometry/seeds/moments.hpp"

#include <cmath>
#include <cstddef>

namespace krater {
namespace {

/// Components of the pairs xx yy zz yz xz xy.
constexpr std::array<std::size_t, 6> row{0, 1, 2, 1, 0, 0};
constexpr std::array<std::size_t, 6> column{0, 1, 2, 2, 2, 1};

}  // namespace

VolumeMoments& VolumeMoments::operator+=(const VolumeMoments& other) {
  volume += other.volume;
  for (std::size_t i = 0; i < 3; ++i) first[i] += other.first[i];
  for (std::size_t n = 0; n < 6; ++n) second[n] += other.second[n];
  return *this;
}

Vector3 VolumeMoments::centroid() const {
  return {first[0] / volume, first[1] / volume, first[2] / volume};
}

std::array<double, 6> VolumeMoments::inertia() const {
  const Vector3 c = centroid();
  std::array<double, 6> s{};
  for (std::size_t n = 0; n < 6; ++n) s[n] = second[n] - volume * c[row[n]] * c[column[n]];
  return {s[1] + s[2], s[2] + s[0], s[0] + s[1], -s[3], -s[4], -s[5]};
}

VolumeMoments VolumeMoments::mapped(const Affine& map) const {
  const double j = std::abs(map.determinant());
  const Vector3 turned = map.turn(first);
  const std::array<double, 9> s{second[0], second[5], second[4], second[5], second[1],
                                second[3], second[4], second[3], second[2]};
  VolumeMoments out;
  out.volume = j * volume;
  for (std::size_t i = 0; i < 3; ++i) out.first[i] = j * (turned[i] + volume * map.shift[i]);
  for (std::size_t n = 0; n < 6; ++n) {
    const std::size_t a = row[n], b = column[n];
    double sum = 0;
    for (std::size_t p = 0; p < 3; ++p) {
      for (std::size_t q = 0; q < 3; ++q) {
        sum += map.linear[3 * a + p] * s[3 * p + q] * map.linear[3 * b + q];
      }
    }
    sum +=
        turned[a] * map.shift[b] + map.shift[a] * turned[b] + volume * map.shift[a] * map.shift[b];
    out.second[n] = j * sum;
  }
  return out;
}

void add_point(VolumeMoments& sum, double volume, const Vector3& x) {
  sum.volume += volume;
  for (std::size_t i = 0; i < 3; ++i) sum.first[i] += volume * x[i];
  for (std::size_t n = 0; n < 6; ++n) sum.second[n] += volume * x[row[n]] * x[column[n]];
}

VolumeMoments tetrahedron_moments(const Vector3& a, const Vector3& b, const Vector3& c) {
  const double v = dot(a, cross(b, c)) / 6;
  VolumeMoments m;
  m.volume = v;
  for (std::size_t i = 0; i < 3; ++i) m.first[i] = v * (a[i] + b[i] + c[i]) / 4;
  for (std::size_t n = 0; n < 6; ++n) {
    const std::size_t i = row[n], j = column[n];
    m.second[n] =
        v / 20 *
        ((a[i] + b[i] + c[i]) * (a[j] + b[j] + c[j]) + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]);
  }
  return m;
}

}  // namespace krater
