// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file
/// Signals are heard between steps; where a step does not end, the third one ends the program.
#include <csignal>

namespace krater {

extern volatile std::sig_atomic_t interrupted;  ///< how many have come

/// Not before the set-up is done: until then a signal ends the program, and nothing is lost.
void listen_to_signals();
/// Of a rank that another one tells when to stop.
void ignore_signals();

}  // namespace krater
