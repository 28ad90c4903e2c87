// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/outcomes.hpp
/// What a scene asks of a projectile's fate, and when it has its answer (measure/outcome.hpp).
#include <string>

namespace krater {

struct OutcomeOptions {
  std::string name, where;
  int projectile = -1;      ///< body
  int target = -1;          ///< body; -1: none, only when the velocity settles is told
  double tolerance = 0.01;  ///< of the change of velocity: what counts as no change any more
  double every = 0;         ///< [s] between looks; 0: after every step
  std::string identity;     ///< the options as text: a memory belongs to one of the same
};

/// The run ends when its answer is there.
struct StopOptions {
  enum class When { never, settled, perforated, energy, expression };
  When when = When::never;
  int outcome = -1;        ///< settled, perforated: index in Scene::outcomes
  double share = 0;        ///< energy: kinetic, of that at the start
  std::string expression;  ///< of columns of the history
  std::string text, where;
};

}  // namespace krater
