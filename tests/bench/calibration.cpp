// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/calibration.hpp"

#include <algorithm>
#include <chrono>

namespace krater::bench {

namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

unsigned long long ticks() {
#if defined(__x86_64__)
  return __builtin_ia32_rdtsc();
#else
  return static_cast<unsigned long long>(
      std::chrono::steady_clock::now().time_since_epoch().count());
#endif
}

double seconds_per_tick() {
  static const double value = [] {
    const double start = now();
    const unsigned long long first = ticks();
    while (now() - start < 0.05) continue;
    return (now() - start) / static_cast<double>(ticks() - first);
  }();
  return value;
}

double clock_rate() {
  double best = 0;
  for (int repeat = 0; repeat < 20; ++repeat) {
    constexpr long additions = 1000000;
    // A register, unknown to the compiler: some processors do additions of small constants for
    // free.
    unsigned long x = 0, one = 1;
    asm volatile("" : "+r"(one));
    const unsigned long long start = ticks();
    for (long i = 0; i < additions; i += 8) {
      // The empty statements keep the compiler from adding 8 at once.
#pragma GCC unroll 8
      for (int k = 0; k < 8; ++k) {
        x += one;
        asm volatile("" : "+r"(x));
      }
    }
    const double seconds = static_cast<double>(ticks() - start) * seconds_per_tick();
    best = std::max(best, static_cast<double>(additions) / seconds);
  }
  return best;
}

}  // namespace krater::bench
