// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file core/simd_register.hpp
/// One register of the machine: a Pack, or half of one where a Pack takes two (AVX2). What keeps
/// many packs at once, as sums over the nodes of a point do, goes over them register by register:
/// sixteen registers hold eight packs, and the rest would go through memory. Same bits as the
/// operations of a Pack.
#include "krater/core/simd.hpp"

namespace krater::inline KRATER_ISA {

#if defined(__AVX2__) && defined(__FMA__) && \
    !(defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__))

struct Register {
  __m256d v;
  Register() = default;
  KRATER_FORCE_INLINE Register(double a) : v(_mm256_set1_pd(a)) {}
  KRATER_FORCE_INLINE explicit Register(__m256d a) : v(a) {}
};
inline constexpr int kRegisterLanes = 4;

KRATER_FORCE_INLINE Register load_register(const double* from) {
  return Register(_mm256_load_pd(from));
}
KRATER_FORCE_INLINE void store(double* to, Register a) { _mm256_store_pd(to, a.v); }
KRATER_FORCE_INLINE Register operator*(Register a, Register b) {
  return Register(_mm256_mul_pd(a.v, b.v));
}
KRATER_FORCE_INLINE Register fma(Register a, Register b, Register c) {
  return Register(_mm256_fmadd_pd(a.v, b.v, c.v));
}
/// Register `Part` of a Pack.
template <int Part>
KRATER_FORCE_INLINE Register part_of(const Pack& a) {
  return Register(Part == 0 ? a.lo : a.hi);
}
/// Register `Part` of a Pack of four times `low` and four times `high`.
template <int Part>
KRATER_FORCE_INLINE Register part_of_halves(double low, double high) {
  return Register(Part == 0 ? low : high);
}
template <int Part>
KRATER_FORCE_INLINE void set_part(Pack& a, Register part) {
  (Part == 0 ? a.lo : a.hi) = part.v;
}

#else

using Register = Pack;
inline constexpr int kRegisterLanes = Pack::lanes;

KRATER_FORCE_INLINE Register load_register(const double* from) { return load(from); }
template <int Part>
KRATER_FORCE_INLINE Register part_of(const Pack& a) {
  return a;
}
template <int Part>
KRATER_FORCE_INLINE Register part_of_halves(double low, double high) {
  return blend_low<4>(Pack(low), Pack(high));
}
template <int Part>
KRATER_FORCE_INLINE void set_part(Pack& a, Register part) {
  a = part;
}

#endif

/// Registers of a Pack.
inline constexpr int kRegisterParts = Pack::lanes / kRegisterLanes;

}  // namespace krater::inline KRATER_ISA
