// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/core/isa_level.hpp"

#include <cstdlib>
#include <string>
#include <string_view>

#include "krater/core/errors.hpp"

namespace krater {

const char* name_of(IsaLevel level) {
  switch (level) {
    case IsaLevel::v4:
      return "v4 (AVX-512)";
    case IsaLevel::v3:
      return "v3 (AVX2)";
    case IsaLevel::portable:
      break;
  }
  return "portable";
}

namespace {

bool is_built(IsaLevel level) {
#if defined(KRATER_HAVE_V3)
  if (level == IsaLevel::v3) return true;
#endif
#if defined(KRATER_HAVE_V4)
  if (level == IsaLevel::v4) return true;
#endif
  return level == IsaLevel::portable;
}

}  // namespace

IsaLevel best_isa_level() {
  IsaLevel best = IsaLevel::portable;
#if defined(KRATER_HAVE_V3)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) best = IsaLevel::v3;
#endif
#if defined(KRATER_HAVE_V4)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512cd"))
    best = IsaLevel::v4;
#endif
  const char* wish = std::getenv("KRATER_ISA");
  if (wish == nullptr) return best;
  const std::string_view name{wish};
  const IsaLevel asked = name == "portable" ? IsaLevel::portable
                         : name == "v3"     ? IsaLevel::v3
                                            : IsaLevel::v4;
  if (name != "portable" && name != "v3" && name != "v4")
    throw InputError("KRATER_ISA=" + std::string{name} +
                     " in the environment: known are portable, v3, v4");
  if (asked > best || !is_built(asked))
    throw InputError("KRATER_ISA=" + std::string{name} +
                     ": this processor or build does not have it");
  return asked;
}

}  // namespace krater
