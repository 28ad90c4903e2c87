// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/machine.hpp"

#include <fstream>
#include <string>

namespace krater {

std::int64_t peak_resident_bytes() {
  std::ifstream status{"/proc/self/status"};
  for (std::string key; status >> key; status.ignore(1000, '\n')) {
    std::int64_t kilobytes = 0;
    if (key == "VmHWM:" && status >> kilobytes) return 1024 * kilobytes;
  }
  return 0;
}

}  // namespace krater
