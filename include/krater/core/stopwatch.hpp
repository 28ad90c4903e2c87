// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file core/stopwatch.hpp
/// Wall-clock seconds spent in a few named phases; a reading costs some 20 ns, so phases are whole
/// sweeps.
#include <array>
#include <chrono>
#include <cstddef>

namespace krater {

template <std::size_t Phases>
class Stopwatch {
 public:
  /// The time since the last call belongs to `phase`.
  void lap(std::size_t phase) {
    const auto now = Clock::now();
    seconds_[phase] += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }
  void start() { last_ = Clock::now(); }
  /// Book `seconds` of phase `from` as phase `to`: work done in the sweep of another.
  void move(std::size_t from, std::size_t to, double seconds) {
    seconds_[from] -= seconds;
    seconds_[to] += seconds;
  }
  double seconds(std::size_t phase) const { return seconds_[phase]; }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
  std::array<double, Phases> seconds_{};
};

}  // namespace krater
