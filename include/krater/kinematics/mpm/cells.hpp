// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/cells.hpp
/// Cell averages against volumetric locking (theory 18). Over the points of a cell (their common
/// base node):
///   tr_c = sum V tr L / sum V,  P_c = sum V (p + q) / sum V,
/// the stress update sees tr L + beta (tr_c - tr L), the force sees (1 - beta)(p + q) + beta P_c.
/// One beta for both keeps the internal force and the dilatation adjoint, so the averages do no
/// work. beta fades from 1 to 0 where the last update saw |tr D| h / c between 0.001 and 0.005: in
/// shocks the averages would smear. It is 0 in a cell that holds a failed point, which would pull
/// with the tension of its sound neighbours.
#include "krater/kinematics/mpm/weights.hpp"

namespace krater::inline KRATER_ISA {

inline constexpr double kShockOn = 0.005, kShockOff = 0.001;

/// Sums of the 64 cells of a block; `value` holds V times the averaged quantity, then the average;
/// `mean_rate` likewise a second one.
struct CellSums {
  double* volume;
  double* value;
  double* mean_rate = nullptr;
  KRATER_FORCE_INLINE void clear() const {
    for (int c = 0; c < kBlockNodes; c += kLanes) {
      store(volume + c, Pack(0.0));
      store(value + c, Pack(0.0));
    }
  }
  KRATER_FORCE_INLINE void add(const double* cells, Pack V, Pack quantity) const {
    alignas(64) double v[8], vq[8];
    store(v, V);
    store(vq, V * quantity);
    for (int l = 0; l < kLanes; ++l) {
      const int c = static_cast<int>(cells[l]);
      volume[c] += v[l];
      value[c] += vq[l];
    }
  }
  KRATER_FORCE_INLINE void divide() const {
    for (int c = 0; c < kBlockNodes; c += kLanes) {
      const Pack V = load(volume + c);
      store(value + c, select(V > Pack(0.0), load(value + c) / V, Pack(0.0)));
    }
  }
  /// The same with `mean_rate` for `value`.
  KRATER_FORCE_INLINE CellSums second() const { return {volume, mean_rate}; }
  /// V and V times both quantities, with one look at where each point lies.
  KRATER_FORCE_INLINE void add(const double* cells, Pack V, Pack quantity, Pack rate) const {
    alignas(64) double v[8], vq[8], vr[8];
    store(v, V);
    store(vq, V * quantity);
    store(vr, V * rate);
    for (int l = 0; l < kLanes; ++l) {
      const int c = static_cast<int>(cells[l]);
      volume[c] += v[l];
      value[c] += vq[l];
      mean_rate[c] += vr[l];
    }
  }
};

/// Table look-up per lane.
KRATER_FORCE_INLINE Pack look_up(const double* table, const double* cells) {
  alignas(64) double out[8];
  for (int l = 0; l < kLanes; ++l) out[l] = table[static_cast<int>(cells[l])];
  return load(out);
}

/// Zero the table of a block's cells.
KRATER_FORCE_INLINE void clear_cells(double* table) {
  for (int c = 0; c < kBlockNodes; c += kLanes) store(table + c, Pack(0.0));
}

/// Largest shock indicator of the points of each cell ...
KRATER_FORCE_INLINE void note_shock(const double* cells, Pack indicator, double* largest) {
  alignas(64) double shock[8];
  store(shock, indicator);
  for (int l = 0; l < kLanes; ++l) {
    double& b = largest[static_cast<int>(cells[l])];
    b = shock[l] > b ? shock[l] : b;
  }
}
/// ... and beta from it, in place.
KRATER_FORCE_INLINE void shock_switch(double* beta) {
  for (int c = 0; c < kBlockNodes; c += kLanes)
    store(beta + c,
          clamp((kShockOn - load(beta + c)) * (1 / (kShockOn - kShockOff)), Pack(0.0), Pack(1.0)));
}

}  // namespace krater::inline KRATER_ISA
