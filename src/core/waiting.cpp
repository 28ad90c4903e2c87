// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/core/waiting.hpp"

#include <cstdlib>

#if defined(__linux__)
#include <unistd.h>

#include <array>
#endif

namespace krater {

void wait_briefly(char** argv) {
#if defined(__linux__)
  if (std::getenv("GOMP_SPINCOUNT") != nullptr || std::getenv("OMP_WAIT_POLICY") != nullptr) return;
  std::array<char, 4096> path{};  // not the link itself: valgrind answers for it
  const auto length = readlink("/proc/self/exe", path.data(), path.size() - 1);
  if (length <= 0 || setenv("GOMP_SPINCOUNT", kLooks, 0) != 0) return;
  execv(path.data(), argv);
#else
  (void)argv;
#endif
}

}  // namespace krater
