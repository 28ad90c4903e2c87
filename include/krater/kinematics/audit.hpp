// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/audit.hpp
/// The telescopic energy audit (theory 11). Each step's entries are measured from their own two
/// sides:
///   transfer_in   = KE_points - 1/2 sum m_I |v-|^2
///   work of internal forces, body forces, walls: their sum is the grid's change of kinetic energy
///   transfer_out  = 1/2 sum m_I |v+|^2 - KE_points,new
///   time_centring = - W_int - dIE,   dIE = sum m de
///   residual      = d(KE + IE) + transfer_in + transfer_out + time_centring
///                   - W_ext - W_wall - W_contact + removed
/// The residual is an arithmetic check (round-off); the quality figure is energy_error_fraction.
#include <array>
#include <cmath>

#include "krater/core/batch_types.hpp"

namespace krater {

/// Points taken out of the computation in a step: through an open side of the domain, or failed.
struct Removed {
  double count = 0, mass = 0, kinetic = 0, internal = 0;
  std::array<double, 3> momentum{};
  double failed = 0;                     ///< of these, removed by failure
  double reflections = 0;                ///< points put back at a closed side
  double penetrations = 0;               ///< of these, from further than round-off
  double deepest = 0;                    ///< of the reflections [cells]
  double side_work = 0;                  ///< of the sides in putting back [J]
  std::array<double, 3> side_impulse{};  ///< and their impulse [N s]
};

struct Audit {
  double kinetic = 0, internal = 0;  ///< of the points, now [J]
  double initial_kinetic = 0, initial_internal = 0;
  double transfer_in = 0, transfer_out = 0, time_centring = 0;  ///< sums over all steps [J]
  double internal_work = 0, external_work = 0, wall_work = 0;
  double contact_work = 0;   ///< normal and friction [J]
  double friction_work = 0;  ///< part of contact_work [J]
  double removed_energy = 0, removed_mass = 0, removed_points = 0;
  double removed_failed = 0;  ///< of the removed points, those removed by failure
  std::array<double, 3> removed_momentum{}, wall_impulse{};
  double plastic_work = 0, viscous_work = 0, plastic_heating = 0;
  double sound_speed_floors = 0, hugoniot_poles = 0, reflections = 0, retries = 0;  ///< events
  double penetrations = 0;                          ///< reflections from further than round-off
  double deepest_reflection = 0;                    ///< [cells]
  double failures = 0, snap_backs = 0, spalls = 0;  ///< events
  double new_references = 0;                        ///< events
  double contact_pairs = 0;  ///< pairs of fields at nodes that pushed in the last step
  double wall_columns = 0;   ///< columns in contact in the last step
  double step_external = 0;  ///< work of body forces in the step under way [J]
  double peak_energy = 0;    ///< greatest kinetic + internal + removed energy so far [J]

  /// Energies at the start of a step: points' kinetic and internal, grid's kinetic before and after
  /// the forces [J].
  struct StepEnergies {
    double kinetic, internal, grid_before, grid_after;
  };
  /// Change of the grid's kinetic energy by planes or contact [J], of which `correction` belongs to
  /// the forces: their power is taken with the velocity that the points see.
  struct Constraint {
    double work = 0, correction = 0;
  };
  /// Book a step whose new kinetic and internal energy are already in place.
  void book_step(const StepEnergies& e, const Constraint& walls, const Constraint& contact);
  void book_events(const Ledger& ledger);
  /// Walls that acted as body forces on points (fixed reference) during dt; `alone`: no other body
  /// force did, so that their work can be told apart.
  void book_point_walls(const std::array<double, 3>& force, double dt, bool alone);
  double energy() const { return kinetic + internal + removed_energy; }  ///< what there is [J]
  /// Energy and momentum that left with removed points.
  void book_removed(const Removed& gone);

  /// (KE + IE now) - (at the start) + everything booked as gone or come: zero but for round-off
  /// [J].
  double residual(double measured_kinetic, double measured_internal) const {
    return (measured_kinetic + measured_internal) - (initial_kinetic + initial_internal) +
           transfer_in + transfer_out + time_centring - external_work - wall_work - contact_work +
           removed_energy;
  }
  /// (sum of transfers + time centring) / E_0, signed: what the scheme itself lost (positive) or
  /// gained. E_0 is the energy at the start, or the work of loads and sides where a scene starts
  /// without any.
  double error_fraction() const {
    const double start = initial_kinetic + initial_internal;
    const double scale = start > 0 ? start : std::abs(external_work) + std::abs(wall_work);
    return scale != 0 ? (transfer_in + transfer_out + time_centring) / scale : 0.0;
  }
};

}  // namespace krater
