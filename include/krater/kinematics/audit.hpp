// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/audit.hpp
/// The account of energy (theory 11). The ledger (kinematics/mpm/ledger.hpp) makes heat of what the
/// motion of points loses in a step, so that
///   residual = kinetic + internal + removed - (start + work from outside)
/// is round-off: work of body forces, of driven rigid bodies and driven sides. What became heat is
/// known by its cause: contact, walls, and the transfer between points and grid, which also takes
/// heat back where it made motion. Heat that could not be taken back without cooling matter below
/// absolute zero is carried by its points as a debt, part of their internal energy.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "krater/core/batch_types.hpp"

namespace krater {

/// Points taken out of the computation in a step: through an open side of the domain, or failed.
struct Removed {
  double count = 0, mass = 0, kinetic = 0, internal = 0;
  std::array<double, 3> momentum{};
  double failed = 0;        ///< of these, removed by failure
  double reflections = 0;   ///< points put back at a closed side
  double penetrations = 0;  ///< of these, from further than round-off
  double deepest = 0;       ///< of the reflections [cells]
  double side_work = 0;     ///< of the sides in putting back [J]
  /// And their impulse, by side: 2 axis + (0 lower, 1 upper) [N s].
  std::array<std::array<double, 3>, 6> side_impulse{};

  Removed& operator+=(const Removed& o) {
    count += o.count;
    mass += o.mass;
    kinetic += o.kinetic;
    internal += o.internal;
    failed += o.failed;
    reflections += o.reflections;
    penetrations += o.penetrations;
    deepest = std::max(deepest, o.deepest);
    side_work += o.side_work;
    for (std::size_t a = 0; a < 3; ++a) momentum[a] += o.momentum[a];
    for (std::size_t s = 0; s < side_impulse.size(); ++s)
      for (std::size_t a = 0; a < 3; ++a) side_impulse[s][a] += o.side_impulse[s][a];
    return *this;
  }
};

struct Audit {
  double kinetic = 0, internal = 0;  ///< of the points, now [J]
  double initial_kinetic = 0, initial_internal = 0;
  /// Sums over cells and steps of what the ledger gave as heat, and took back (negative) [J];
  /// contact and walls apart.
  double transfer_loss = 0, transfer_gain = 0;
  double numerical_heat = 0;  ///< in matter whose pressure does not know its energy, find_unfelt()
  /// Of such matter: internal energy now, at the start, and what went with removed points; the
  /// stress power of its laws so far, and by how much that is ahead of the velocities [J].
  double unfelt = 0, unfelt_start = 0, unfelt_removed = 0, law_work = 0, law_lead = 0;
  double carried = 0;  ///< heat that could not be taken, owed by points now (negative) [J]
  double largest_carried = 0, carriers = 0;  ///< the most so far; cells and steps that came short
  double contact_heat = 0;   ///< what contact took from motion, friction included [J]
  double friction_work = 0;  ///< of tangential impulses, negative [J]
  double rigid_loss = 0;     ///< of turning rigid bodies, by the steps of their turn [J]
  double wall_heat = 0;      ///< what sides of the domain took from motion [J]
  double external_work = 0;  ///< of body forces, loads, damping and driven rigid bodies [J]
  double load_work = 0, damping_work = 0;  ///< of these, of loads on faces and of damping [J]
  double wall_work = 0;                    ///< of sides of the domain that move, from outside [J]
  double removed_energy = 0, removed_mass = 0, removed_points = 0;
  double removed_failed = 0;  ///< of the removed points, those removed by failure
  /// Momentum now is that at the start, less what was removed, plus impulses [N s]: of sides of the
  /// domain, and from outside (body forces, loads, damping, what drives rigid bodies).
  std::array<double, 3> removed_momentum{}, wall_impulse{}, external_impulse{};
  std::array<double, 3> load_impulse{}, damping_impulse{};  ///< of external_impulse
  double plastic_work = 0, viscous_work = 0, plastic_heating = 0;
  double sound_speed_floors = 0, hugoniot_poles = 0, reflections = 0, retries = 0;  ///< events
  double penetrations = 0;                          ///< reflections from further than round-off
  double deepest_reflection = 0;                    ///< [cells]
  double failures = 0, snap_backs = 0, spalls = 0;  ///< events
  double new_references = 0;                        ///< events
  double contact_pairs = 0;     ///< pairs of fields at nodes that pushed in the last step
  double wall_columns = 0;      ///< columns in contact in the last step
  double step_external = 0;     ///< work of body forces in the step under way [J]
  double peak_energy = 0;       ///< greatest kinetic + internal + removed energy so far [J]
  double peak_energy_time = 0;  ///< its integral over time [J s]
  double stabilisation = 0;     ///< heat of what holds zero-energy modes of particles [J]
  double conversion_heat = 0;   ///< of the motion of elements that became points [J]
  double level_heat = 0;        ///< of points that changed the level of their cells [J]
  double split_points = 0;      ///< points that splitting made
  double merged_points = 0;     ///< points that merging took away
  double most_folded = 0;       ///< folded elements, the most at a row of the history

  /// Heat of a step by its causes [J]; `given` and `taken` by the cells, contact and walls
  /// included.
  struct StepHeat {
    double given = 0, taken = 0, contact = 0, walls = 0;
    double carried = 0, carriers = 0;
  };
  void book_step(const StepHeat& heat);
  void book_events(const Ledger& ledger);
  /// What such matter holds beyond the work of its own laws: an elastic law can give back what was
  /// done on it and no more.
  void find_unfelt() {
    numerical_heat = (unfelt + unfelt_removed - unfelt_start) - (law_work - law_lead);
  }
  /// Work of these laws in a step, and how much of it lies ahead of the velocities; `others`: of
  /// what moved before in this step.
  void book_laws(double work, double share_ahead, double others) {
    law_work += work;
    law_lead = others + share_ahead * work;
  }
  /// Walls that acted as body forces on points (fixed reference) during dt; `alone`: no other body
  /// force did, so that their work can be told apart.
  void book_point_walls(const std::array<double, 3>& force, double dt, bool alone);
  double energy() const { return kinetic + internal + removed_energy; }  ///< what there is [J]
  /// Body forces on points, from outside, during dt.
  void book_body_force(const std::array<double, 3>& force, double dt) {
    for (std::size_t a = 0; a < 3; ++a) external_impulse[a] += force[a] * dt;
  }
  /// Motion of elements that became heat of the points they became; `unfelt`: by their pressure.
  void book_converted(double heat, bool is_unfelt) {
    conversion_heat += heat;
    kinetic -= heat;
    internal += heat;
    if (is_unfelt) unfelt += heat;
  }
  /// The same of points that came among other cells.
  void book_level(double heat, double unfelt_heat) {
    level_heat += heat;
    kinetic -= heat;
    internal += heat;
    unfelt += unfelt_heat;
  }
  /// Energy and momentum that left with removed points.
  void book_removed(const Removed& gone);

  /// (KE + IE now) - (at the start) + everything booked as gone or come: zero but for round-off
  /// [J].
  double residual(double measured_kinetic, double measured_internal) const {
    return (measured_kinetic + measured_internal) - (initial_kinetic + initial_internal) -
           external_work - wall_work + removed_energy + rigid_loss;
  }
  /// What is not physical: energy that is missing or came from nowhere, heat that the pressure of
  /// its matter cannot feel (but for friction between bodies), heat that is owed, and the steps of
  /// turning rigid bodies. Heat of transfer, contact and walls in matter that knows its energy is
  /// none of it: behind a shock the balances of mass, momentum and energy say how much there must
  /// be, however it was made.
  std::array<double, 4> unphysical() const {
    const double useless =
        numerical_heat > 0 ? std::max(0.0, numerical_heat + friction_work) : numerical_heat;
    return {residual(kinetic, internal), useless, carried, rigid_loss};
  }
  /// All of it as magnitudes, by the greatest energy that was in the scene so far: at the start, or
  /// brought by loads and sides.
  double error_fraction() const {
    double sum = 0;
    for (const double part : unphysical()) sum += std::abs(part);
    return peak_energy > 0 ? sum / peak_energy : 0.0;
  }
};

/// The later part of them.
template <class Account, class Visit>
constexpr void for_each_event(Account& a, const Visit& visit) {
  visit("sound_speed_floors", a.sound_speed_floors);
  visit("hugoniot_poles", a.hugoniot_poles);
  visit("reflections", a.reflections);
  visit("retries", a.retries);
  visit("penetrations", a.penetrations);
  visit("deepest_reflection", a.deepest_reflection);
  visit("failures", a.failures);
  visit("snap_backs", a.snap_backs);
  visit("spalls", a.spalls);
  visit("new_references", a.new_references);
  visit("contact_pairs", a.contact_pairs);
  visit("wall_columns", a.wall_columns);
  visit("step_external", a.step_external);
  visit("peak_energy", a.peak_energy);
  visit("peak_energy_time", a.peak_energy_time);
  visit("stabilisation", a.stabilisation);
  visit("conversion_heat", a.conversion_heat);
  visit("level_heat", a.level_heat);
  visit("split_points", a.split_points);
  visit("merged_points", a.merged_points);
  visit("most_folded", a.most_folded);
}

/// visit(name, entry) of all entries in the order of their memory: what a checkpoint keeps, and
/// what must be a number.
template <class Account, class Visit>
constexpr void for_each_entry(Account& a, const Visit& visit) {
  const auto axes = [&visit](const std::array<const char*, 3>& names, auto& vector) {
    for (std::size_t k = 0; k < 3; ++k) visit(names[k], vector[k]);
  };
  visit("kinetic", a.kinetic);
  visit("internal", a.internal);
  visit("initial_kinetic", a.initial_kinetic);
  visit("initial_internal", a.initial_internal);
  visit("transfer_loss", a.transfer_loss);
  visit("transfer_gain", a.transfer_gain);
  visit("numerical_heat", a.numerical_heat);
  visit("unfelt", a.unfelt);
  visit("unfelt_start", a.unfelt_start);
  visit("unfelt_removed", a.unfelt_removed);
  visit("law_work", a.law_work);
  visit("law_lead", a.law_lead);
  visit("carried", a.carried);
  visit("largest_carried", a.largest_carried);
  visit("carriers", a.carriers);
  visit("contact_heat", a.contact_heat);
  visit("friction_work", a.friction_work);
  visit("rigid_loss", a.rigid_loss);
  visit("wall_heat", a.wall_heat);
  visit("external_work", a.external_work);
  visit("load_work", a.load_work);
  visit("damping_work", a.damping_work);
  visit("wall_work", a.wall_work);
  visit("removed_energy", a.removed_energy);
  visit("removed_mass", a.removed_mass);
  visit("removed_points", a.removed_points);
  visit("removed_failed", a.removed_failed);
  axes({"removed_momentum_0", "removed_momentum_1", "removed_momentum_2"}, a.removed_momentum);
  axes({"wall_impulse_0", "wall_impulse_1", "wall_impulse_2"}, a.wall_impulse);
  axes({"external_impulse_0", "external_impulse_1", "external_impulse_2"}, a.external_impulse);
  axes({"load_impulse_0", "load_impulse_1", "load_impulse_2"}, a.load_impulse);
  axes({"damping_impulse_0", "damping_impulse_1", "damping_impulse_2"}, a.damping_impulse);
  visit("plastic_work", a.plastic_work);
  visit("viscous_work", a.viscous_work);
  visit("plastic_heating", a.plastic_heating);
  for_each_event(a, visit);
}

/// None is forgotten.
constexpr std::size_t audit_entries() {
  std::size_t n = 0;
  Audit audit;
  for_each_entry(audit, [&n](const char*, double&) { ++n; });
  return n;
}
static_assert(sizeof(Audit) == audit_entries() * sizeof(double));

}  // namespace krater
