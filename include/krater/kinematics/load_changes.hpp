// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/load_changes.hpp
/// What loads give the masses of a body that are moved themselves, nodes of elements and smoothed
/// particles, in a step:
///   body force   dv = dt b(x, X, t)
///   damping      dv = -eta dt (v- + v+)/2, so that no step of eta dt overshoots
/// beside what loads on faces give, and the work of it all with the mean velocity,
///   W = sum m dv . (v- + v+)/2,
/// whatever contact and sides do after.
#include <cstddef>
#include <functional>
#include <vector>

#include "krater/contact/options.hpp"
#include "krater/kinematics/audit.hpp"
#include "krater/kinematics/loads.hpp"

namespace krater {

/// One of the masses. `change`: of its velocity in the step so far.
struct LoadedMass {
  double mass;
  Triple x, X, v;
  double* change;
};

class LoadChanges {
 public:
  struct Masses {
    std::size_t count;
    int dimension;
    std::function<LoadedMass(std::size_t)> at;
  };

  void begin(std::size_t count) { given_.assign(kGiven * count, 0.0); }
  /// A load on a face gives mass n, whose change is `change`, dv along an axis.
  void give(std::size_t n, std::size_t axis, double* change, double dv) {
    change[axis] += dv;
    given_[kGiven * n + axis] += dv;
  }
  /// The body force (empty: none), and damping of what the step is with it.
  void push(const Masses& masses, const Acceleration& body_force, double damping, double time,
            double dt);
  /// Works and impulses of the step, when all changes are final; returns the impulse of all [N s].
  Triple book(const Masses& masses, Audit& audit) const;

 private:
  static constexpr std::size_t kGiven = 9;  ///< of faces, of damping, of the body force
  std::vector<double> given_;
};

}  // namespace krater
