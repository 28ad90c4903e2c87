// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/signals.hpp"

namespace krater {

volatile std::sig_atomic_t interrupted = 0;

namespace {

extern "C" void on_signal(int number) {
  interrupted = interrupted + 1;
  if (interrupted < 3) return;
  std::signal(number, SIG_DFL);
  std::raise(number);
}

}  // namespace

void listen_to_signals() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  if (std::signal(SIGHUP, on_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // nohup
}

void ignore_signals() {
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_IGN);
}

}  // namespace krater
