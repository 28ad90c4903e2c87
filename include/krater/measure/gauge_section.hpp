// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file measure/gauge_section.hpp
/// What passes a plane section of a body, n.x = d. Of a quantity q per volume
///   Q = int_A q dA = sum_p V_p q_p w((n.x_p - d)/h)/h,   w(s) = max(0, 1 - |s|):
///   area            q = 1
///   force_a         q = (sigma n)_a, artificial viscosity included: what the side that n points to
///                   does to the other one; along n positive in tension
///   mass_flux       q = rho (v.n - c), towards n; c is the plane's own speed
///   momentum_flux_a q = rho v_a (v.n - c)
/// so that the momentum beyond the plane changes by momentum_flux - force. w is the slope of what
/// the B-splines of all nodes beyond the plane add up to, phi' = w/h where d lies half-way between
/// two rows of nodes: there the sum is the very force between the two halves of the grid, but for
/// cell averages. Of all other fields the section tells the mean over its area. A cell of material
/// on either side of the plane is needed; nearer to a free end the area is only what w sees.
/// Areas and forces are those of the full revolution, or of one metre of depth.
#include <string_view>

#include "krater/measure/gauge_fields.hpp"

namespace krater {

/// The field's kind and component, if it is one of a section and the body carries what it needs.
bool find_section_field(const Body& body, Frame frame, std::string_view name, GaugeField& out);

struct SectionPlane {
  double at = 0, speed = 0;  ///< n.x [m] and its rate [m/s]
};

class SectionReader {
 public:
  SectionReader(const Simulation& sim, const Body& body, const Triple& normal);
  SectionPlane through(int set, int point) const;
  /// Share of the point in the section [m^2].
  double area(const SectionPlane& plane, int set, int point) const;
  /// q at a point.
  double value(const SectionPlane& plane, const GaugeField& field, int set, int point) const;

 private:
  double along(int slot, int set, int point) const;
  double traction(int axis, int set, int point) const;

  const Simulation& sim_;
  Triple normal_;
  int x_, v_, m_, rho_, s_, p_, q_;  ///< slots
};

}  // namespace krater
