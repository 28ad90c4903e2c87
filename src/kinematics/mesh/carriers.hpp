// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the parts of mesh_contact.hpp share.
#include <cmath>
#include <cstddef>

#include "kinematics/mesh/elements.hpp"
#include "krater/kinematics/mesh/mesh_contact.hpp"

namespace krater {

inline constexpr std::size_t kMass = 3, kVelocity = 4, kHeat = 7;  ///< in the record of a node

inline void add_to(Triple& sum, double k, const Triple& x) {
  for (std::size_t a = 0; a < 3; ++a) sum[a] += k * x[a];
}
inline double length_of(const Triple& a) { return std::sqrt(dot(a, a)); }

/// The image of a vector in planes of symmetry across the axes of `flips`.
inline Triple reflected(Triple x, unsigned flips) {
  for (std::size_t a = 0; flips >> a != 0; ++a)
    if ((flips >> a & 1U) != 0) x[a] = -x[a];
  return x;
}

/// S of a carrier at the nodes it reaches, in their order.
template <class Carrier>
double weight_at(const Carrier& q, int dim, std::size_t n) {
  if (dim == 2) return q.weight[0][n / 3] * q.weight[1][n % 3];
  return q.weight[0][n / 9] * q.weight[1][n / 3 % 3] * q.weight[2][n % 3];
}

template <class Visit>
void MeshContact::for_each_link(const Carrier& q, const Visit& visit) {
  for (std::size_t k = q.first_link; k < q.last_link; ++k) {
    const Link& link = links_[k];
    visit(link, meetings_[link.meeting].side[link.side]);
  }
}

}  // namespace krater
