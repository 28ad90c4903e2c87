// SPDX-License-Identifier: GPL-3.0-or-later
// Where the joint of two fields lies, which way it faces, and whether it is closed: from their
// fillings alone.
#include <algorithm>
#include <cmath>

#include "krater/contact/contact.hpp"
#include "krater/contact/joint_profile.hpp"

namespace krater {

namespace {

// Gap, in cells, at which bodies touch. A third of it loses joints to the unevenness of the
// lattices (impulse between bars of different impedance 2.4 % low).
constexpr double kTouch = 0.05;
// At 10 the corners of a block on a base still plough: 1.3 % too much friction at 20 cells, 0.4 %
// at 40; without friction it lost 0.03 % of its speed, and now 0.001 %.
constexpr double kSteeper = 40;
constexpr double kSame = 1 - 1e-9;  // fillings that differ by less are the same
double square(const double* v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

}  // namespace

/// Central differences, smoothed across by (1 2 1)/4 along each other axis; in units of 1/cell.
std::array<double, 3> ContactSet::gradient(const double* phi) const {
  std::array<double, 3> out{};
  const int dimension = geometry_.dimension;
  for (int a = 0; a < dimension; ++a) {
    const int t = stride_[(a + 1) % dimension], u = dimension == 3 ? stride_[(a + 2) % 3] : 0;
    double slope = 0;
    for (int i = -1; i <= 1; ++i)
      for (int j = dimension == 3 ? -1 : 0; j <= (dimension == 3 ? 1 : 0); ++j) {
        const int across = i * t + j * u;
        slope += (2 - std::abs(i)) * (2 - std::abs(j)) *
                 (phi[across + stride_[a]] - phi[across - stride_[a]]);
      }
    out[static_cast<unsigned>(a)] = slope / (dimension == 3 ? 32 : 16);
  }
  return out;
}

/// Of the nodes around `at` those that both bodies fill best, and of these the nearest: there lies
/// the joint. A joint in the middle of its cells, or seen from beyond a rim, has several that are
/// equal but for round-off; the first of them would make the answer one of the order of nodes.
ContactSet::Joint ContactSet::joint_near(const double* phi_a, const double* phi_b, int at) const {
  const int depth = geometry_.dimension == 3 ? 1 : 0;
  const auto each = [&](const auto& visit) {
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        for (int k = -depth; k <= depth; ++k) {
          const int n = at + i * stride_[0] + j * stride_[1] + k * stride_[2];
          visit(n, std::min(phi_a[n], phi_b[n]), i * i + j * j + k * k);
        }
  };
  double best = 0;
  each([&](int, double filled, int) { best = std::max(best, filled); });
  Joint joint{};
  int nearest = 4;
  each([&](int n, double filled, int distance) {
    if (filled < kSame * best || distance > nearest) return;
    if (distance < nearest) joint.count = 0;
    nearest = distance;
    joint.nodes[static_cast<std::size_t>(joint.count++)] = n;
  });
  return joint;
}

/// The widest gap along the axes that have A on one side of the joint and B on the other [cells].
double ContactSet::gap(const double* phi_a, const double* phi_b) const {
  double widest = -1;
  for (int axis = 0; axis < geometry_.dimension; ++axis) {
    const int s = phi_a[-stride_[axis]] > phi_a[stride_[axis]] ? stride_[axis] : -stride_[axis];
    const JointProfile a{phi_a[-s], phi_a[0], phi_a[s]}, b{phi_b[s], phi_b[0], phi_b[-s]};
    if (a.ends() && b.ends()) widest = std::max(widest, -a.reach() - b.reach());
  }
  return widest;
}

ContactSet::Joint ContactSet::joint_of(const Scratch& scratch, int at,
                                       const Contact& contact) const {
  return joint_near(scratch.filling.data() + contact.a * size_,
                    scratch.filling.data() + contact.b * size_, at);
}

bool ContactSet::find_contact(const Scratch& scratch, int at, Contact& contact) const {
  const double* phi_a = scratch.filling.data() + contact.a * size_;
  const double* phi_b = scratch.filling.data() + contact.b * size_;
  const Joint joint = joint_near(phi_a, phi_b, at);
  double apart = 0;
  std::array<double, 3> grad_a{}, grad_b{};
  for (int i = 0; i < joint.count; ++i) {
    const int n = joint.nodes[static_cast<std::size_t>(i)];
    apart += gap(phi_a + n, phi_b + n) / joint.count;
    const std::array<double, 3> a = gradient(phi_a + n), b = gradient(phi_b + n);
    for (unsigned k = 0; k < 3; ++k) {
      grad_a[k] += a[k];
      grad_b[k] += b[k];
    }
  }
  if (apart > kTouch) return false;
  // The body with the steeper filling is the wider one there: at the edge of a punch its normal is
  // that of the plate. Equal ones are averaged.
  const double a2 = square(grad_a.data()), b2 = square(grad_b.data());
  double lesser = std::pow(std::min(a2, b2) / std::max(a2, b2), kSteeper);
  bool a_decides = a2 >= b2;
  if (contact.fluid[0] != contact.fluid[1]) {  // the points of a fluid lie anyhow
    a_decides = contact.fluid[1];
    lesser = 0;
  }
  const double weight_a = a_decides ? 1 : lesser, weight_b = a_decides ? lesser : 1;
  contact.even = lesser > 0.5;
  for (unsigned a = 0; a < 3; ++a) contact.normal[a] = weight_b * grad_b[a] - weight_a * grad_a[a];
  const double length = std::sqrt(square(contact.normal.data()));
  for (double& n : contact.normal) n /= length;
  return length > 0;
}

}  // namespace krater
