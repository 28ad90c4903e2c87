// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the machine can do at this moment, printed beside every figure of a benchmark.
#pragma once

namespace krater::bench {

/// Time stamps of small cost, in ticks; seconds_per_tick() is measured once against the clock.
unsigned long long ticks();
double seconds_per_tick();

/// Clock of the core by a chain of dependent additions, one per cycle [Hz].
double clock_rate();

/// Fused multiply-adds of one core, two operations each, compiled for a level [flop/s].
double fma_rate_isa_portable();
double fma_rate_isa_v3();
double fma_rate_isa_v4();

/// FMA rate of a level by its name, "portable", "v3" or "v4" [flop/s].
double fma_rate_of(const char* level);

/// STREAM triad a = b + s c over arrays far larger than the caches, 24 bytes counted per element
/// (McCalpin 1995), by `threads` threads [byte/s].
double triad_rate(int threads);

}  // namespace krater::bench
