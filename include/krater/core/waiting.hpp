// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file core/waiting.hpp
/// How a thread waits for the others at the end of a parallel loop. libgomp lets it look for some
/// ten milliseconds before it sleeps. Where another program has the core that a thread needs, the
/// others burn theirs meanwhile, in every loop: two runs side by side were ten times as slow as one
/// after the other. It reads its settings once, as the program is loaded.

namespace krater {

/// Looks before a thread sleeps: tens of microseconds, some ten times what waking it takes.
inline constexpr const char* kLooks = "1000";

/// First thing in main: load this program again with GOMP_SPINCOUNT set, unless it or
/// OMP_WAIT_POLICY is. Comes back where nothing is to be set, or where loading fails (all is then
/// as it was).
void wait_briefly(char** argv);

}  // namespace krater
