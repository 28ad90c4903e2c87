// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/progress.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include "krater/app/readable.hpp"

namespace krater {

namespace {

std::string clock_text(double s) {
  if (!(s < 1e9)) return "?";
  const auto whole = static_cast<std::int64_t>(s + 0.5);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02d} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02d} min", whole / 3600, whole / 60 % 60);
}

constexpr std::chrono::milliseconds kRenewal{500};
constexpr double kLongestSilence = 600;  // [s]

// Start of the line, cleared; and no wrapping meanwhile: a narrow terminal cuts the end off, where
// a wrapped line would scroll with every renewal.
constexpr const char *kRenew = "\r\033[K", *kNoWrap = "\033[?7l", *kWrap = "\033[?7h";

}  // namespace

void say(const std::string& line) {
  std::fputs((line + "\n").c_str(), stderr);
  std::fflush(stderr);
}

Progress::Progress(const Simulation& sim, bool quiet)
    : sim_{sim},
      terminal_{!quiet && isatty(STDERR_FILENO) != 0},
      start_{Clock::now()},
      last_{start_},
      start_time_{sim.time()},
      start_steps_{sim.steps()} {}

double Progress::seconds() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

std::string Progress::line() const {
  const double elapsed = seconds(), end = sim_.scene().time.end;
  const double share = (sim_.time() - start_time_) / (end - start_time_);
  const double rate = static_cast<double>(sim_.steps() - start_steps_) *
                      static_cast<double>(sim_.point_count()) / elapsed;
  const std::string eta = share > 0 ? clock_text(elapsed * (1 - share) / share) : "?";
  return fmt::format(
      "{:5.1f} %  {} left  t = {}  step {}  dt = {} ({})  energy error {:+.2f} %  "
      "{:.2f} M point-steps/s",
      100 * sim_.time() / end, eta, readable(sim_.time(), "s"), sim_.steps(),
      readable(sim_.dt(), "s", 3), sim_.limiter(), 100 * sim_.audit().error_fraction(),
      1e-6 * rate);
}

std::string Progress::show() {
  const auto now = Clock::now();
  if (terminal_ && now - last_ >= kRenewal) {
    last_ = now;
    std::fputs((std::string{kRenew} + kNoWrap + line() + kWrap).c_str(), stderr);
    std::fflush(stderr);
  }
  const double elapsed = seconds();
  if (elapsed < next_line_) return "";
  next_line_ = elapsed + std::min(elapsed, kLongestSilence);
  return line();
}

void Progress::finish() {
  if (terminal_) std::fputs(kRenew, stderr);
}

}  // namespace krater
