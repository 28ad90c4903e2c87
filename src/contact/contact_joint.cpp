// SPDX-License-Identifier: GPL-3.0-or-later
// Where the joint of two fields lies, which way it faces, and whether it is closed: from their
// fillings alone.
#include <algorithm>
#include <cmath>

#include "krater/contact/contact.hpp"
#include "krater/contact/face_plane.hpp"
#include "krater/contact/joint_profile.hpp"

namespace krater {

namespace {

// Gap, in cells, at which bodies touch. A third of it loses joints to the unevenness of the
// lattices (impulse between bars of different impedance 2.4 % low).
constexpr double kTouch = 0.05;
// Weight of a face by its trust: a corner on a face, of trust 0.1, has no say.
constexpr double kFlatter = 4;
constexpr double kHeld = 0.5;  // cells beyond a rigid body's face: half of what a node stands for
constexpr double kSame = 1 - 1e-9;  // fillings that differ by less are the same
double square(const double* v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

}  // namespace

/// As long as the central differences, and as far as the face is flat along its plane's normal.
ContactSet::Slope ContactSet::slope_at(const double* phi) const {
  const FillingWindow nodes{phi, {stride_[0], stride_[1], stride_[2]}, geometry_.dimension};
  Slope out{filling_gradient(nodes)};
  const double length = std::sqrt(square(out.gradient.data()));
  if (!(length > 0)) return out;
  std::array<double, 3> guess = out.gradient;
  for (double& n : guess) n /= length;
  std::array<double, 3> inward = guess;
  const ShapeSpread spread = shape_spread(linear_);
  // The wider one has the last word. Near edges of levels two nodes around a block are whole.
  const int widest = geometries_.size() > 1 ? 1 : window();
  for (int radius = 1; radius <= widest; ++radius) {
    const FacePlane face = fit_face(nodes, guess, radius, spread);
    for (unsigned a = 0; a < 3; ++a)
      inward[a] = (1 - face.trust) * inward[a] - face.trust * face.normal[a];
    out.trust += face.trust * (1 - out.trust);
  }
  const double blended = std::sqrt(square(inward.data()));
  if (!(blended > 0)) return out;
  for (unsigned a = 0; a < 3; ++a) out.gradient[a] = inward[a] * length / blended;
  return out;
}

/// Mean of the joint's nodes. Nodes beside each other mostly share one: what was found is kept.
ContactSet::Slope ContactSet::slope_at(Scratch& scratch, int field, const Joint& joint) const {
  Slope mean;
  for (int i = 0; i < joint.count; ++i) {
    const auto n =
        static_cast<std::size_t>(field * size_ + joint.nodes[static_cast<std::size_t>(i)]);
    Slope& one = scratch.slopes[n];
    if (one.of != scratch.fillings) one = slope_at(scratch.filling.data() + n);
    one.of = scratch.fillings;
    mean.trust += one.trust / joint.count;
    for (unsigned a = 0; a < 3; ++a) mean.gradient[a] += one.gradient[a] / joint.count;
  }
  return mean;
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

/// How far the node `at` lies beyond the face of the body that fills as phi, along its normal
/// [cells]: from the joint's nodes, beyond which the body reaches along the axis nearest to it.
double ContactSet::beyond(const double* phi, int at, const Joint& joint,
                          const std::array<double, 3>& outward) const {
  int axis = 0;
  for (int a = 1; a < geometry_.dimension; ++a)
    if (std::abs(outward[static_cast<unsigned>(a)]) >
        std::abs(outward[static_cast<unsigned>(axis)]))
      axis = a;
  const double along = outward[static_cast<unsigned>(axis)];
  const int s = along > 0 ? stride_[axis] : -stride_[axis];
  double mean = 0;
  for (int i = 0; i < joint.count; ++i) {
    const int n = joint.nodes[static_cast<std::size_t>(i)];
    const JointProfile face{phi[n - s], phi[n], phi[n + s]};
    double distance = face.before > face.beyond ? -std::abs(along) * face.reach() : 0;
    for (int a = geometry_.dimension - 1, p = at, q = n; a >= 0; --a, p /= padded_, q /= padded_)
      distance += outward[static_cast<unsigned>(a)] * (p % padded_ - q % padded_);
    mean += distance / joint.count;
  }
  return mean;
}

ContactSet::Joint ContactSet::joint_of(const Scratch& scratch, int at,
                                       const Contact& contact) const {
  return joint_near(scratch.filling.data() + contact.a * size_,
                    scratch.filling.data() + contact.b * size_, at);
}

bool ContactSet::find_contact(Scratch& scratch, int at, Contact& contact) const {
  const double* phi_a = scratch.filling.data() + contact.a * size_;
  const double* phi_b = scratch.filling.data() + contact.b * size_;
  const Joint joint = joint_near(phi_a, phi_b, at);
  double apart = 0;
  for (int i = 0; i < joint.count; ++i) {
    const int n = joint.nodes[static_cast<std::size_t>(i)];
    apart += gap(phi_a + n, phi_b + n) / joint.count;
  }
  if (apart > kTouch) return false;
  const Slope a_slope = slope_at(scratch, contact.a, joint),
              b_slope = slope_at(scratch, contact.b, joint);
  const double flat_a = std::pow(a_slope.trust, kFlatter),
               flat_b = std::pow(b_slope.trust, kFlatter), none = 1 - std::max(flat_a, flat_b);
  double weight_a = flat_a + none, weight_b = flat_b + none;
  if (contact.fluid[0] != contact.fluid[1]) {  // the points of a fluid lie anyhow
    weight_a = contact.fluid[1] ? 1 : 0;
    weight_b = 1 - weight_a;
  }
  contact.even = std::min(weight_a, weight_b) > 0.5 * std::max(weight_a, weight_b);
  const std::array<double, 3>&grad_a = a_slope.gradient, &grad_b = b_slope.gradient;
  for (unsigned a = 0; a < 3; ++a) contact.normal[a] = weight_b * grad_b[a] - weight_a * grad_a[a];
  const double length = std::sqrt(square(contact.normal.data()));
  if (!(length > 0)) return false;
  for (double& n : contact.normal) n /= length;
  if (!contact.rigid[0] && !contact.rigid[1]) return true;
  std::array<double, 3> outward = contact.normal;
  if (contact.rigid[1])
    for (double& n : outward) n = -n;
  return beyond(contact.rigid[0] ? phi_a : phi_b, at, joint, outward) <= kHeld;
}

}  // namespace krater
