// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file points/batch.hpp
/// A batch: consecutive lane groups of one material in one block, the unit of constitutive work.
/// Stages see columns only through handles; absent optional columns read as zeros (stride 0), so no
/// stage tests for presence in a loop.
#include "krater/core/batch_types.hpp"
#include "krater/core/isa.hpp"
#include "krater/core/simd.hpp"
#include "krater/points/layout.hpp"

namespace krater::inline KRATER_ISA {

/// One field over the groups of a batch: load/store component `k` of group `g`.
struct ReadView {
  const double* base;
  int stride;
  KRATER_FORCE_INLINE Pack operator()(int g, int k = 0) const {
    return load(base + g * stride + 8 * k);
  }
};
struct WriteView {
  double* base;
  int stride;
  KRATER_FORCE_INLINE Pack operator()(int g, int k = 0) const {
    return load(base + g * stride + 8 * k);
  }
  KRATER_FORCE_INLINE void set(int g, Pack value) const { store(base + g * stride, value); }
  KRATER_FORCE_INLINE void set(int g, int k, Pack value) const {
    store(base + g * stride + 8 * k, value);
  }
};

template <class F>
KRATER_FORCE_INLINE ReadView view(const BatchData& b, Input<F> h) {
  return {b.state + h.offset, b.state_stride};
}
template <class F>
KRATER_FORCE_INLINE WriteView view(const BatchData& b, State<F> h) {
  return {b.state + h.offset, b.state_stride};
}
template <class F>
KRATER_FORCE_INLINE ReadView view(const BatchData& b, LocalInput<F> h) {
  return {b.local + h.offset, b.local_stride};
}
template <class F>
KRATER_FORCE_INLINE WriteView view(const BatchData& b, LocalOutput<F> h) {
  return {b.local + h.offset, b.local_stride};
}
template <class F>
KRATER_FORCE_INLINE ReadView view(const BatchData& b, Optional<F> h) {
  return h.offset < 0 ? ReadView{b.zeros, 0} : ReadView{b.state + h.offset, b.state_stride};
}
template <class F>
KRATER_FORCE_INLINE ReadView view(const BatchData& b, LocalOptional<F> h) {
  return h.offset < 0 ? ReadView{b.zeros, 0} : ReadView{b.local + h.offset, b.local_stride};
}

KRATER_FORCE_INLINE ReadView lengths(const BatchData& b) { return {b.length, b.length_stride}; }

/// Lanes of group `g` that hold points.
KRATER_FORCE_INLINE Mask occupied(const BatchData& b, int g) {
  return first_lanes(b.count - kLanes * g);
}

/// Remember the first fault of the patch.
KRATER_FORCE_INLINE void report(const BatchData& b, FaultKind kind, int g, Mask lanes) {
  const unsigned hit = bits(lanes & occupied(b, g));
  if (hit != 0 && b.fault->kind == FaultKind::none) *b.fault = {kind, b.first_group + g, hit};
}

}  // namespace krater::inline KRATER_ISA
