// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file points/store.hpp
/// Points of one body in lane groups of 8 (points/layout.hpp). Component k of a field whose column
/// starts at `offset` lies, for point i, at
///   record(i / 8) + offset + 8 k + i % 8,
/// and this file is the only place that says so. `place` below is offset + 8 k.
/// Lanes past the last point are padding: copies of the last point with mass 0, see pad().
#include <vector>

#include "krater/core/aligned.hpp"
#include "krater/core/isa.hpp"
#include "krater/points/layout.hpp"

namespace krater {

class PointStore {
 public:
  PointStore() = default;
  explicit PointStore(int stride) : stride_{stride} {}  ///< doubles per lane group

  KRATER_FORCE_INLINE int count() const { return count_; }
  KRATER_FORCE_INLINE int groups() const { return (count_ + kLanes - 1) / kLanes; }
  KRATER_FORCE_INLINE int stride() const { return stride_; }
  bool empty() const { return count_ == 0; }
  std::size_t size() const {  ///< doubles in use
    return static_cast<std::size_t>(groups()) * static_cast<std::size_t>(stride_);
  }
  std::size_t capacity() const { return records_.size(); }  ///< doubles

  /// Records of all lane groups, one after the other.
  KRATER_FORCE_INLINE double* data() { return records_.data(); }
  KRATER_FORCE_INLINE const double* data() const { return records_.data(); }

  KRATER_FORCE_INLINE double& at(int place, int i) { return records_.data()[index(place, i)]; }
  KRATER_FORCE_INLINE const double& at(int place, int i) const {
    return records_.data()[index(place, i)];
  }

  /// Point i by places: point(i)[place], for loops over many.
  KRATER_FORCE_INLINE const double* point(int i) const { return records_.data() + index(0, i); }

  /// One point as stride/8 doubles; pad() afterwards.
  void append(const double* point);
  /// The same handed out: stride/8 doubles at the end of `out`.
  template <class Vector>
  void copy_out(int i, Vector& out) const {
    for (int k = 0; k < stride_; k += kLanes) out.push_back(at(k, i));
  }
  /// Overwrite point `to` by point `from`.
  void copy(int from, int to);
  void truncate(int count) { count_ = count; }
  /// Drop points, by ascending numbers: the last that stays moves into the first hole.
  void remove(const std::vector<int>& holes);
  /// Room for `count` points, whose values the caller writes.
  void resize(int count);
  /// Make the padding lanes of the last group copies of the last point; `mass`: its column.
  void pad(int mass);

 private:
  KRATER_FORCE_INLINE std::size_t index(int place, int i) const {
    return static_cast<std::size_t>(i / kLanes) * static_cast<std::size_t>(stride_) +
           static_cast<std::size_t>(place + i % kLanes);
  }

  AlignedBuffer records_;
  int count_ = 0, stride_ = 0;
};

/// Some of the points of a body: what output, measures and checkpoints walk.
struct PointSet {
  int body;
  const PointStore* points;
  int count() const { return points->count(); }
};

}  // namespace krater
