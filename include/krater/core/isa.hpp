// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Instruction-set levels and the one-definition rule.
///
/// The kernels are compiled several times, once per x86-64 level, and one copy is chosen at run
/// time. An inline function compiled with AVX-512 in one object and without it in another would be
/// ONE symbol to the linker, which keeps an arbitrary copy: the program then dies of an illegal
/// instruction on an older machine. So everything that is compiled per level lives in
///
///     namespace krater::inline KRATER_ISA { ... }
///
/// and the build passes -DKRATER_ISA=isa_v3 with -march=x86-64-v3, or =isa_v4 with
/// -march=x86-64-v4. Sources name nothing of this: inside one object `krater::Pack` is the Pack of
/// its level. Templates of the standard library instantiated in such an object are NOT protected:
/// hot headers avoid them.
#pragma once

#ifndef KRATER_ISA
#define KRATER_ISA isa_portable
#endif

#define KRATER_CONCAT_EXPANDED(a, b) a##b
#define KRATER_CONCAT(a, b) KRATER_CONCAT_EXPANDED(a, b)

#define KRATER_LEVEL_OF_isa_portable 1
#define KRATER_LEVEL_OF_isa_v3 3
#define KRATER_LEVEL_OF_isa_v4 4
/// 1, 3 or 4, usable in #if; 0 for a name that is not in the list above.
#define KRATER_ISA_LEVEL KRATER_CONCAT(KRATER_LEVEL_OF_, KRATER_ISA)

#if KRATER_ISA_LEVEL == 0
#error "KRATER_ISA must be isa_portable, isa_v3 or isa_v4"
#endif
#if KRATER_ISA_LEVEL == 3 && !(defined(__AVX2__) && defined(__FMA__))
#error "KRATER_ISA=isa_v3 needs -march=x86-64-v3"
#endif
#if KRATER_ISA_LEVEL == 4 && \
    !(defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__))
#error "KRATER_ISA=isa_v4 needs -march=x86-64-v4"
#endif

#if defined(_MSC_VER) && !defined(__clang__)
#define KRATER_FORCE_INLINE __forceinline
#else
/// For functions of a few instructions whose call would cost more than their work.
#define KRATER_FORCE_INLINE inline __attribute__((always_inline))
#endif
