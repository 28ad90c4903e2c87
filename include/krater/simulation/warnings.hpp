// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file simulation/warnings.hpp
/// What a run must tell about its results: each kind once when it is met, again at the end, in
/// `summary.json`, and as exit code 5 under --strict. A warning says that the results may not be
/// those of the scene (points that left, a law beyond its range, energy that is not kept). What the
/// scene asked for (failure, spall, removal of failed points) and what was only filled in are
/// notes, not warnings. Part of the checkpoint, so that a restart ends with the same list.
#include <string>
#include <vector>

#include "krater/output/results.hpp"

namespace krater {

class Simulation;

struct Warning {
  std::string kind;       ///< a word for programs, e.g. points_left
  std::string text;       ///< for the user, without the time
  double count = 0;       ///< how often so far
  double first_time = 0;  ///< [s]
  bool said = false;
};

class Warnings {
 public:
  /// One more of a kind; the text of its first stays.
  void add(const std::string& kind, double time, const std::string& text);
  /// An event that is counted elsewhere: `count` so far. 0: nothing to tell.
  void count(const std::string& kind, double count, double time, const std::string& text);
  /// A state that may pass: told at the end only, with the time since when it has lasted.
  void judge(const std::string& kind, bool wrong, double time, const std::string& text);

  const std::vector<Warning>& all() const { return list_; }
  std::vector<std::string> unsaid();  ///< those to be told now; each is handed out once
  Json json() const;

  void save(Checkpoint& checkpoint) const;
  void restore(const Checkpoint& checkpoint);

 private:
  Warning* find(const std::string& kind);
  std::vector<Warning> list_;  ///< in the order of their first time
};

/// "12 of 3000 points left ... (from 1.2e-06 s)".
std::string sentence(const Warning& warning);

/// What the audit of a simulation says by now; called after every step.
void watch(const Simulation& sim, Warnings& warnings);
/// What the points say, as last looked at: those that have lost each other.
void watch_points(const Simulation& sim, Warnings& warnings);
/// What the elements say, as last looked at: folded ones, and energy that only holds hourglasses.
void watch_elements(const Simulation& sim, Warnings& warnings);

}  // namespace krater
