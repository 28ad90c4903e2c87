// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file measure/outcome.hpp
/// The fate of a projectile, from looks at it one after the other.
///
/// v is the velocity of its main piece (the heaviest, where it holds half of the mass; else of
/// all), w that less the mean velocity of the target, w_0 that at the start. The face that it meets
/// is that of the target's box at the start which it enters last, so an oblique shot at a plate
/// meets the plate's face. Depths are counted from there, into the target, whose thickness is T.
///
/// - perforated: the whole main piece is deeper than T and goes on, w_n > 2 tol |w_0|;
/// - missed: the same, but its velocity never changed;
/// - ricocheted: it leaves, w_n < -2 tol |w_0|, and all of it is before the face again, or its
///   velocity no longer changes;
/// - stopped: in either half of the last third of the time since v began to change (five looks or
///   more) the mean of w is below 2 tol |w_0|, and none is above 0.15 |w_0|: projectile and target
///   may ring, and do not pass each other;
/// - moving: none of these yet.
/// Broken up: no piece holds half of the mass; the fate is then that of all of it.
///
/// Its velocity is quiet, without a scale of time of its own, when from t_s on v stayed within tol
/// of its whole change of its last value, and that for a quarter of the time that the change had
/// taken, at least three looks. Before v has changed by 1e-3 |w_0| nothing is quiet. Settled:
/// quiet, and no longer moving.
/// Drift: the largest departure of v from its last value since t_s.
#include <vector>

#include "krater/measure/pieces.hpp"

namespace krater {

enum class Fate { moving, perforated, stopped, ricocheted, missed };
const char* name_of(Fate fate);

/// What is known of projectile and target at the start.
struct OutcomeStart {
  double speed = 0;  ///< |w_0|, or of a body at rest the fastest body's [m/s]
  double mass = 0;   ///< of the projectile [kg]
  bool has_target = false;
  int axis = 0;          ///< grid axis across the face that is met
  double into = 1;       ///< sense into the target along it
  double face = 0;       ///< its place [m]
  double thickness = 0;  ///< T [m]
  /// Components across planes of symmetry that cut the projectile: no motion of its own.
  std::array<bool, 3> mirrored{};
};

/// One look.
struct OutcomeLook {
  double time = 0;
  Triple v{}, w{};  ///< of the main piece; less that of the target [m/s]
  double fate = 0;
};

/// The box of points along the grid axes.
struct PointBox {
  Triple low, high;
};
PointBox box_of(const BodyPoints& points);

/// `speed` is 0 where the two do not approach each other.
OutcomeStart outcome_start(const BodyPoints& projectile, const BodyPoints& target,
                           const MeasureContext& context);

/// Where the projectile is now.
struct OutcomeState {
  double mass = 0, main = 0;       ///< [kg]; share of the main piece
  double through = 0, before = 0;  ///< shares of the mass beyond the target's back, before its face
  Triple velocity{};               ///< of the main piece, or of all [m/s]
  double rear = 0, front = 0;      ///< depths of the main piece, or of all [m]
  bool broken() const { return main < 0.5; }
};
OutcomeState outcome_state(const BodyPoints& projectile, const MeasureContext& context,
                           const OutcomeStart& start);

/// Of a series of looks: whether v has changed at all, has ended, and from when on it is quiet.
struct Settling {
  bool touched = false, quiet = false, stopped = false;
  double since = 0;  ///< t_s, where it is quiet; else when the last tenth of the looks began [s]
  double drift = 0;  ///< [m/s] since then
};
Settling settling_of(const std::vector<OutcomeLook>& looks, const OutcomeStart& start,
                     double tolerance);

Fate fate_of(const OutcomeState& state, const Triple& w, const Settling& settling,
             const OutcomeStart& start, double tolerance);

/// The answer is there: the last look's fate is one, and the velocity is quiet.
bool settled(const std::vector<OutcomeLook>& looks, const OutcomeStart& start, double tolerance);

/// When the last look's fate began [s].
double fate_since(const std::vector<OutcomeLook>& looks);

}  // namespace krater
