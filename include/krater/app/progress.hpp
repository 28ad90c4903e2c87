// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/progress.hpp
/// How far a run is. On a terminal one line on stderr, renewed twice a second; behind a pipe, and
/// for the log, a line after 10, 20, 40 ... seconds, at last every ten minutes.
#include <chrono>
#include <string>

#include "krater/simulation/simulation.hpp"

namespace krater {

/// A message on stderr. Never throws: a closed terminal or a full disk behind a log file must not
/// end a run.
void say(const std::string& line);

class Progress {
 public:
  Progress(const Simulation& sim, bool quiet);
  /// Renews the terminal's line when it is time. Returns a line that is due behind a pipe and for
  /// the log, else "".
  std::string show();
  bool on_terminal() const { return terminal_; }
  void finish();           ///< ends the terminal's line
  double seconds() const;  ///< of wall clock since construction

 private:
  using Clock = std::chrono::steady_clock;
  std::string line() const;
  const Simulation& sim_;
  bool terminal_;
  Clock::time_point start_, last_;
  double next_line_ = 10;  ///< [s] of wall clock
  double start_time_;
  std::int64_t start_steps_;
};

}  // namespace krater
