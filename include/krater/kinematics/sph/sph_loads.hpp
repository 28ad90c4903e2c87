// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/sph/sph_loads.hpp
/// Loads on bodies of particles. As of material points (kinematics/mpm/node_loads.hpp) the surface
/// is what the sums themselves see of it: with a stress of one in place of sigma,
///   G_i = sum_j V_i V_j (S_i K_i + S_j K_j) grad W_ij,   S = 1, or (V/V0) F^-T,   sum_i G_i = 0,
/// is minus the outward area vector of particle i, so a body under pressure is in equilibrium with
/// its uniform stress -p to round-off, in any order of its particles, and with it a surface of any
/// shape. With N the outward normal of the load's face, s_i the particle's share in it:
///   pressure   f_i = p s_i G_i                all around, or on a face, f_i = p s_i (G_i . N) N
///   traction   f_i = -t s_i (G_i . N)
///   velocity   v+ = v(t) of the marked particles, before contact and sides
/// and on the masses kinematics/load_changes.hpp. Below a free face the layers of a lattice carry
/// 1.46, -0.42, -0.04 of its area (cubic spline, h = 1.2 dx): they are summed with their signs.
/// Since linear fields are exact, sum_i G_i x_i = - V: over a share that is linear between two
/// faces the sum is the area, however few layers lie there or in what order. Shares are given at
/// the start (sph_load_share), and kept.
#include <algorithm>
#include <map>

#include "krater/kinematics/load_changes.hpp"
#include "krater/kinematics/load_options.hpp"
#include "krater/kinematics/sph/sph_step.hpp"

namespace krater {

class SphLoads {
 public:
  SphLoads(const LoadOptions& options, Acceleration body_force, int dimension)
      : options_{options}, body_force_{std::move(body_force)}, dim_{dimension} {}

  bool any() const { return options_.any() || body_force_; }
  /// A pressure or traction acts on the body: its G are asked for.
  bool presses(int body) const;
  void set_time(double time) { time_ = time; }
  /// Adds to the changes of velocity of a step, which hold those of the stress.
  void add(SphStep::Particles& body, double dt);
  /// Works and impulses of the step, when all changes are final; returns the impulse [N s].
  Triple book(SphStep::Particles& body, Audit& audit) const;

 private:
  std::vector<std::size_t> loads_of(int body) const;  ///< in the order of its marks
  Triple push_of(const FaceLoad& load, const Triple& G) const;
  LoadChanges::Masses masses(SphStep::Particles& body) const;

  LoadOptions options_;
  Acceleration body_force_;
  int dim_;
  double time_ = 0;
  std::map<const SphStep::Particles*, LoadChanges> changes_;
};

/// Share in the face of a load of what lies `depth` below it [m] in a body as thick as `thickness`
/// there: all of it down to twice the support, as deep as sums of corrected gradients know of a
/// face, and less from there on to four times. In a thinner body it is linear.
inline double sph_load_share(const SphOptions& options, double depth, double thickness) {
  const double whole = 8 * options.length();
  if (thickness < whole) return std::max(0.0, 1 - depth / thickness);
  return std::min(1.0, std::max(0.0, 2 * (1 - depth / whole)));
}

}  // namespace krater
