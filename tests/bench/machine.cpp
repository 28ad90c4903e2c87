// SPDX-License-Identifier: GPL-3.0-or-later
// What the machine can do at this moment: clock, fused multiply-adds, memory bandwidth.
#include <cstdio>
#include <cstdlib>

#include "bench/calibration.hpp"
#include "krater/core/parallel.hpp"
#include "krater/kinematics/mpm/kernel_levels.hpp"

/// krater_bench_machine [THREADS]: JSON on stdout.
int main(int argc, char** argv) {
  using namespace krater;
  const int many = set_threads(argc > 1 ? std::atoi(argv[1]) : 0);
  std::printf("{\"clock_hz\": %.4g, \"fma_flops\": {", bench::clock_rate());
  const char* names[] = {"portable", "v3", "v4"};
  for (int i = 0; i <= static_cast<int>(best_isa_level()); ++i)
    std::printf("%s\"%s\": %.4g", i == 0 ? "" : ", ", names[i], bench::fma_rate_of(names[i]));
  std::printf("}, \"triad_bytes_per_s\": {\"1\": %.4g", bench::triad_rate(1));
  if (many > 1) std::printf(", \"%d\": %.4g", many, bench::triad_rate(many));
  std::printf("}}\n");
  return 0;
}
