// SPDX-License-Identifier: GPL-3.0-or-later
/// \file core/simd_rows.hpp
/// Four columns of eight rows that lie anywhere in memory. Rows meet in the registers as they are
/// loaded, half a register each, which leaves 8 shuffles for 4 columns; transpose8() of rows loaded
/// whole takes 24 for 8. Moves bits only: the same in every back end.
#pragma once

#include "krater/core/simd.hpp"

namespace krater::inline KRATER_ISA {

/// out[c] = column `column` + c, for row l what row(l) points to. `column` is a multiple of 4, and
/// rows begin at multiples of 32 bytes.
template <class Row>
KRATER_FORCE_INLINE void load_columns(const Row& row, int column, Pack* out) {
#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
  __m512d a[4], t[4];
#pragma GCC unroll 4
  for (int l = 0; l < 4; ++l)
    a[l] = _mm512_maskz_insertf64x4(simd_detail::every_lane,
                                    _mm512_castpd256_pd512(_mm256_load_pd(row(l) + column)),
                                    _mm256_load_pd(row(l + 4) + column), 1);
#pragma GCC unroll 2
  for (int l = 0; l < 4; l += 2) {
    t[l] = _mm512_maskz_unpacklo_pd(simd_detail::every_lane, a[l], a[l + 1]);
    t[l + 1] = _mm512_maskz_unpackhi_pd(simd_detail::every_lane, a[l], a[l + 1]);
  }
  const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
  const __m512i high = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
  out[0] = Pack(_mm512_permutex2var_pd(t[0], low, t[2]));
  out[1] = Pack(_mm512_permutex2var_pd(t[1], low, t[3]));
  out[2] = Pack(_mm512_permutex2var_pd(t[0], high, t[2]));
  out[3] = Pack(_mm512_permutex2var_pd(t[1], high, t[3]));
#elif defined(__AVX2__) && defined(__FMA__)
  for (int l = 0; l < 4; ++l)
    out[l] = {_mm256_load_pd(row(l) + column), _mm256_load_pd(row(l + 4) + column)};
  simd_detail::transpose4(out[0].lo, out[1].lo, out[2].lo, out[3].lo);
  simd_detail::transpose4(out[0].hi, out[1].hi, out[2].hi, out[3].hi);
#else
  for (int c = 0; c < 4; ++c)
    for (int l = 0; l < 8; ++l) set(out[c], l, row(l)[column + c]);
#endif
}

/// All eight columns of eight rows.
template <class Row>
KRATER_FORCE_INLINE void load_rows(const Row& row, Pack (&out)[8]) {
  load_columns(row, 0, out);
  load_columns(row, 4, out + 4);
}

}  // namespace krater::inline KRATER_ISA
