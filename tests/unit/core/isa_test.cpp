// SPDX-License-Identifier: GPL-3.0-or-later
// The instruction-set levels give the same bits: digests of isa_digest.cpp, compiled once per
// level, are compared for the levels that this processor has.
#include <doctest/doctest.h>

extern "C" {
void krater_digest_isa_portable(unsigned long long out[4]);
void krater_digest_isa_v3(unsigned long long out[4]);
void krater_digest_isa_v4(unsigned long long out[4]);
}

namespace {

// By features, not by "x86-64-v4": clang 14 does not know the names of the levels.
[[maybe_unused]] bool has_v3() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
         __builtin_cpu_supports("bmi2");
}
[[maybe_unused]] bool has_v4() {
  return has_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512cd");
}

[[maybe_unused]] void check_against_portable(void (*level)(unsigned long long*)) {
  unsigned long long portable[4];
  unsigned long long other[4];
  krater_digest_isa_portable(portable);
  level(other);
  const char* const group[] = {"arithmetic", "exp", "log", "pow and rcbrt"};
  for (int i = 0; i < 4; ++i) {
    INFO(group[i]);
    CHECK(other[i] == portable[i]);
  }
}

}  // namespace

// What a sanitized build, which has no other level, and another processor are held to.
TEST_CASE("the portable level has the bits on record") {
  unsigned long long found[4];
  krater_digest_isa_portable(found);
  CHECK(found[0] == 0xed6c221cbeed43d5ULL);
  CHECK(found[1] == 0x93878ca8c43dbf7cULL);
  CHECK(found[2] == 0x52c20dbef375f686ULL);
  CHECK(found[3] == 0x1e70571b794037cdULL);
}

#ifdef KRATER_HAVE_V3
TEST_CASE("x86-64-v3 has the bits of the portable level") {
  if (has_v3())
    check_against_portable(krater_digest_isa_v3);
  else
    MESSAGE("not run: this processor has no AVX2");
}
#endif

#ifdef KRATER_HAVE_V4
TEST_CASE("x86-64-v4 has the bits of the portable level") {
  if (has_v4())
    check_against_portable(krater_digest_isa_v4);
  else
    MESSAGE("not run: this processor has no AVX-512");
}
#endif
