// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file core/aligned.hpp
/// A growable array of doubles on a cache-line boundary; new memory is zero. Growth keeps the old
/// content.
#include <cstddef>
#include <memory>

namespace krater {

class AlignedBuffer {
 public:
  AlignedBuffer() = default;
  double* data() { return data_.get(); }
  const double* data() const { return data_.get(); }
  std::size_t size() const { return size_; }  ///< doubles available
  /// At least `n` doubles; grows by a quarter more than asked so that appending is amortised.
  void reserve(std::size_t n);

 private:
  struct Free {
    void operator()(double* p) const;
  };
  std::unique_ptr<double[], Free> data_;
  std::size_t size_ = 0;
};

}  // namespace krater
