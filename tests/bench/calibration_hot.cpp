// SPDX-License-Identifier: GPL-3.0-or-later
// The rate of fused multiply-adds, once per instruction-set level.
#include "bench/calibration.hpp"
#include "krater/core/simd.hpp"

namespace krater::inline KRATER_ISA {

namespace {

/// Enough independent chains to hide the latency, few enough to stay in registers.
#if defined(__AVX512F__)
constexpr int kChains = 10;
#else
constexpr int kChains = 5;
#endif

double measured_rate() {
  double best = 0;
  for (int repeat = 0; repeat < 20; ++repeat) {
    constexpr int rounds = 20000;
    Pack sums[kChains];
    for (int k = 0; k < kChains; ++k) sums[k] = Pack(1.0 + k);
    const Pack factor = Pack(0.999), term = Pack(1e-3);
    const unsigned long long start = bench::ticks();
    for (int i = 0; i < rounds; ++i) {
#pragma GCC unroll 10
      for (int k = 0; k < kChains; ++k) sums[k] = fma(sums[k], factor, term);
    }
    const double seconds = static_cast<double>(bench::ticks() - start) * bench::seconds_per_tick();
    double total = 0;
    for (int k = 0; k < kChains; ++k) total += sum(sums[k]);
    const double rate = 2.0 * 8.0 * kChains * rounds / seconds;
    if (total > 0 && rate > best) best = rate;
  }
  return best;
}

}  // namespace

}  // namespace krater::inline KRATER_ISA

namespace krater::bench {

double KRATER_CONCAT(fma_rate_, KRATER_ISA)() { return measured_rate(); }

}  // namespace krater::bench
