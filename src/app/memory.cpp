// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

#include <sys/resource.h>
#include <unistd.h>

#include "krater/app/forecast.hpp"

namespace krater {

namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// The number after a key in a file of lines "key number", or alone in the file; NaN: none.
double number_in(const std::string& file, const std::string& key = "") {
  std::ifstream stream{file};
  std::string line;
  while (std::getline(stream, line)) {
    std::istringstream words{line};
    std::string word;
    double value = 0;
    if (!key.empty() && (!(words >> word) || word != key)) continue;
    if (words >> value) return value;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// What a limit of the process leaves; `used`: column of /proc/self/statm.
double left_of(decltype(RLIMIT_AS) which, std::size_t used) {
  rlimit limit{};
  if (getrlimit(which, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kNoLimit;
  std::ifstream stream{"/proc/self/statm"};
  std::array<double, 6> pages{};
  for (double& p : pages) stream >> p;
  return static_cast<double>(limit.rlim_cur) -
         pages.at(used) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// What the control groups leave that this process is in (cgroup v2, or the memory group of v1).
/// Pages of files count as free: the kernel drops them first.
double left_of_groups() {
  namespace fs = std::filesystem;
  double left = kNoLimit;
  std::ifstream groups{"/proc/self/cgroup"};
  for (std::string line; std::getline(groups, line);) {
    const bool second = line.starts_with("0::");
    const bool first = line.find(":memory:") != std::string::npos;
    if (!second && !first) continue;
    const fs::path top = second ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
    fs::path group = line.substr(line.rfind(':') + 1);
    // In a container the path may be that outside of it: the mount's own top counts too.
    for (bool at_top = false; !at_top; group = group.parent_path()) {
      at_top = !group.has_relative_path();
      const std::string folder = (top / group.relative_path()).string() + "/";
      const double most = number_in(folder + (second ? "memory.max" : "memory.limit_in_bytes"));
      const double used = number_in(folder + "memory.stat", second ? "anon" : "total_rss");
      if (most > 0 && used >= 0) left = std::min(left, most - used);
    }
  }
  return left;
}

}  // namespace

Memory memory() {
  const std::array<Memory, 4> limits{{{1024 * number_in("/proc/meminfo", "MemAvailable:"), "free"},
                                      {left_of(RLIMIT_AS, 0), "left by ulimit -v"},
                                      {left_of(RLIMIT_DATA, 5), "left by ulimit -d"},
                                      {left_of_groups(), "left by the control group"}}};
  Memory least{kNoLimit, ""};
  for (const Memory& limit : limits)
    if (limit.available < least.available) least = limit;
  least.available = std::max(least.available, 0.0);
  return least;
}

}  // namespace krater
