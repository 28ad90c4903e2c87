// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/progress.hpp
/// One line on stderr, renewed twice a second, only on a terminal.
#include <chrono>
#include <string>

#include "krater/app/simulation.hpp"

namespace krater {

/// A message on stderr. Never throws: a closed terminal or a full disk behind a log file must not
/// end a run.
void say(const std::string& line);

class Progress {
 public:
  Progress(const Simulation& sim, bool quiet);
  void show();             ///< when it is time
  void finish();           ///< ends the line
  double seconds() const;  ///< of wall clock since construction

 private:
  using Clock = std::chrono::steady_clock;
  const Simulation& sim_;
  bool active_;
  Clock::time_point start_, last_;
  double start_time_;
  std::int64_t start_steps_;
};

}  // namespace krater
