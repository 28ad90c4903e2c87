// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/calibration.hpp"

#include <algorithm>
#include <chrono>
#include <string_view>

#include "krater/core/aligned.hpp"
#include "krater/core/parallel.hpp"

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

double fma_rate_of(const char* name) {
  const std::string_view level = name;
#if defined(KRATER_HAVE_V3)
  if (level == "v3") return fma_rate_isa_v3();
#endif
#if defined(KRATER_HAVE_V4)
  if (level == "v4") return fma_rate_isa_v4();
#endif
  return level == "portable" ? fma_rate_isa_portable() : 0;
}

double triad_rate(int threads) {
  constexpr std::size_t parts = 64, part = 1 << 19;  // 3 arrays of 268 MB
  const int before = krater::threads();
  set_threads(threads);
  AlignedBuffer a, b, c;
  for (AlignedBuffer* buffer : {&a, &b, &c}) buffer->reserve(parts * part);
  double best = 0;
  for (int repeat = 0; repeat < 5; ++repeat) {
    const double start = now();
    for_each(parts, [&](std::size_t p) {
      double* to = a.data() + p * part;
      const double *from = b.data() + p * part, *other = c.data() + p * part;
      for (std::size_t i = 0; i < part; ++i) to[i] = from[i] + 3.0 * other[i];
    });
    best = std::max(best, 24.0 * static_cast<double>(parts * part) / (now() - start));
  }
  set_threads(before);
  return best;
}

}  // namespace krater::bench
