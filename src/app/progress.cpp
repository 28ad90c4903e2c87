// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/progress.hpp"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace krater {

namespace {

std::string clock_text(double s) {
  if (s < 60) return fmt::format("{:.0f} s", s);
  if (s < 3600)
    return fmt::format("{:.0f} min {:02.0f} s", s / 60 - 0.5, s - 60 * static_cast<int>(s / 60));
  return fmt::format("{} h {:02d} min", static_cast<int>(s / 3600), static_cast<int>(s / 60) % 60);
}

}  // namespace

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
  fmt::print(stderr,
             "\r\033[K{:5.1f} %  t = {:.3e} s  step {}  dt = {:.2e} s ({})  energy error {:+.2f} % "
             " {:.2f} M point-steps/s  {} left",
             100 * sim_.time() / end, sim_.time(), sim_.steps(), sim_.dt(), sim_.limiter(),
             100 * sim_.audit().error_fraction(), 1e-6 * rate, eta);
  std::fflush(stderr);
}

void Progress::finish() {
  if (active_) fmt::print(stderr, "\r\033[K");
}

}  // namespace krater
