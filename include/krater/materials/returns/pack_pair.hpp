// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Two packs as one `Real`. The radial return is one long chain of dependent operations (power,
/// logarithm, division); solving two lane groups at a time keeps the arithmetic units busy. Same
/// bits as each pack alone.
#pragma once

#include "krater/core/lane_math.hpp"
#include "krater/core/simd_register.hpp"

namespace krater::inline KRATER_ISA {

/// Where a Pack takes two registers it is such a pair already, and two do not fit into sixteen.
inline constexpr bool kSolvesPairs = kRegisterParts == 1;

struct PackPair {
  Pack a, b;
  PackPair() = default;
  KRATER_FORCE_INLINE PackPair(double x) : a(x), b(x) {}
  KRATER_FORCE_INLINE PackPair(Pack first, Pack second) : a(first), b(second) {}
};
struct MaskPair {
  Mask a, b;
};
template <>
struct simd_detail::Traits<PackPair> {
  using MaskType = MaskPair;
  static constexpr int lanes = 2 * Pack::lanes;
};

#define KRATER_PAIR_1(name) \
  KRATER_FORCE_INLINE PackPair name(PackPair x) { return {name(x.a), name(x.b)}; }
#define KRATER_PAIR_2(name)                                   \
  KRATER_FORCE_INLINE PackPair name(PackPair x, PackPair y) { \
    return {name(x.a, y.a), name(x.b, y.b)};                  \
  }
#define KRATER_PAIR_3(name)                                               \
  KRATER_FORCE_INLINE PackPair name(PackPair x, PackPair y, PackPair z) { \
    return {name(x.a, y.a, z.a), name(x.b, y.b, z.b)};                    \
  }
#define KRATER_PAIR_COMPARE(op)                                      \
  KRATER_FORCE_INLINE MaskPair operator op(PackPair x, PackPair y) { \
    return {x.a op y.a, x.b op y.b};                                 \
  }
#define KRATER_PAIR_LOGIC(op)                                        \
  KRATER_FORCE_INLINE MaskPair operator op(MaskPair x, MaskPair y) { \
    return {x.a op y.a, x.b op y.b};                                 \
  }

KRATER_PAIR_2(operator+)
KRATER_PAIR_2(operator-)
KRATER_PAIR_2(operator*)
KRATER_PAIR_2(operator/)
KRATER_PAIR_1(operator-)
KRATER_PAIR_1(sqrt)
KRATER_PAIR_1(abs)
KRATER_PAIR_1(exp)
KRATER_PAIR_1(log)
KRATER_PAIR_1(rcbrt)
KRATER_PAIR_2(min)
KRATER_PAIR_2(max)
KRATER_PAIR_2(pow)
KRATER_PAIR_3(fma)
KRATER_PAIR_3(fms)
KRATER_PAIR_3(fnma)
KRATER_PAIR_3(clamp)
KRATER_PAIR_COMPARE(<)
KRATER_PAIR_COMPARE(<=)
KRATER_PAIR_COMPARE(>)
KRATER_PAIR_COMPARE(>=)
KRATER_PAIR_COMPARE(==)
KRATER_PAIR_COMPARE(!=)
KRATER_PAIR_LOGIC(&)
KRATER_PAIR_LOGIC(|)
KRATER_PAIR_LOGIC(^)

#undef KRATER_PAIR_1
#undef KRATER_PAIR_2
#undef KRATER_PAIR_3
#undef KRATER_PAIR_COMPARE
#undef KRATER_PAIR_LOGIC

KRATER_FORCE_INLINE MaskPair operator!(MaskPair m) { return {!m.a, !m.b}; }
KRATER_FORCE_INLINE bool any(MaskPair m) { return any(m.a | m.b); }
KRATER_FORCE_INLINE PackPair select(MaskPair m, PackPair x, PackPair y) {
  return {select(m.a, x.a, y.a), select(m.b, x.b, y.b)};
}

}  // namespace krater::inline KRATER_ISA
