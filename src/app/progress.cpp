// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/progress.hpp"

#include <cstdint>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace krater {

namespace {

std::string clock_text(double s) {
  if (!(s < 1e9)) return "?";
  const auto whole = static_cast<std::int64_t>(s + 0.5);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02d} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02d} min", whole / 3600, whole / 60 % 60);
}

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
      active_{!quiet && isatty(STDERR_FILENO) != 0},
      start_{Clock::now()},
      last_{start_},
      start_time_{sim.time()},
      start_steps_{sim.steps()} {}

double Progress::seconds() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

void Progress::show() {
  if (!active_) return;
  const auto now = Clock::now();
  if (now - last_ < std::chrono::milliseconds(500)) return;
  last_ = now;
  const double elapsed = seconds(), end = sim_.scene().time.end;
  const double share = (sim_.time() - start_time_) / (end - start_time_);
  const double rate = static_cast<double>(sim_.steps() - start_steps_) *
                      static_cast<double>(sim_.point_count()) / elapsed;
  const std::string eta = share > 0 ? clock_text(elapsed * (1 - share) / share) : "?";
  const std::string line = fmt::format(
      "{:5.1f} %  {} left  t = {:.3e} s  step {}  dt = {:.2e} s ({})  energy error {:+.2f} %  "
      "{:.2f} M point-steps/s",
      100 * sim_.time() / end, eta, sim_.time(), sim_.steps(), sim_.dt(), sim_.limiter(),
      100 * sim_.audit().error_fraction(), 1e-6 * rate);
  std::fputs((std::string{kRenew} + kNoWrap + line + kWrap).c_str(), stderr);
  std::fflush(stderr);
}

void Progress::finish() {
  if (active_) std::fputs(kRenew, stderr);
}

}  // namespace krater
