// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/core/program.hpp"

#include <sys/auxv.h>

#include <system_error>

namespace krater {

std::filesystem::path program_path() {
  std::error_code error;
  std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) return program;
  const auto* started = reinterpret_cast<const char*>(getauxval(AT_EXECFN));
  if (started == nullptr) return {};
  program = std::filesystem::canonical(started, error);
  return error ? std::filesystem::path{} : program;
}

}  // namespace krater
