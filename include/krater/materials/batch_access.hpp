// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Small helpers of the stages: tensors through views, sums and events into the ledger.
#pragma once

#include "krater/core/tensor.hpp"
#include "krater/points/batch.hpp"

namespace krater::inline KRATER_ISA {

template <class View>
KRATER_FORCE_INLINE Sym3<Pack> load_sym3(const View& v, int g) {
  return {v(g, 0), v(g, 1), v(g, 2), v(g, 3), v(g, 4), v(g, 5)};
}
KRATER_FORCE_INLINE void store_sym3(const WriteView& v, int g, const Sym3<Pack>& a) {
  v.set(g, 0, a.xx);
  v.set(g, 1, a.yy);
  v.set(g, 2, a.zz);
  v.set(g, 3, a.yz);
  v.set(g, 4, a.xz);
  v.set(g, 5, a.xy);
}
template <class View>
KRATER_FORCE_INLINE Mat3<Pack> load_mat3(const View& v, int g) {
  return {v(g, 0), v(g, 1), v(g, 2), v(g, 3), v(g, 4), v(g, 5), v(g, 6), v(g, 7), v(g, 8)};
}
KRATER_FORCE_INLINE void store_mat3(const WriteView& v, int g, const Mat3<Pack>& a) {
  v.set(g, 0, a.xx);
  v.set(g, 1, a.xy);
  v.set(g, 2, a.xz);
  v.set(g, 3, a.yx);
  v.set(g, 4, a.yy);
  v.set(g, 5, a.yz);
  v.set(g, 6, a.zx);
  v.set(g, 7, a.zy);
  v.set(g, 8, a.zz);
}

/// Points of group `g` in `lanes`, as a number to add to a counter of the ledger.
KRATER_FORCE_INLINE double count_points(const BatchData& batch, int g, Mask lanes) {
  return static_cast<double>(__builtin_popcount(bits(lanes & occupied(batch, g))));
}

}  // namespace krater::inline KRATER_ISA
