// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/core/aligned.hpp"

#include <cstring>
#include <new>

namespace krater {

namespace {
constexpr std::align_val_t kLine{64};
}

void AlignedBuffer::Free::operator()(double* p) const { ::operator delete[](p, kLine); }

void AlignedBuffer::reserve(std::size_t n) {
  if (n <= size_) return;
  const std::size_t grown = size_ == 0 ? n : n + n / 4;
  auto* fresh = static_cast<double*>(::operator new[](grown * sizeof(double), kLine));
  if (size_ > 0) std::memcpy(fresh, data_.get(), size_ * sizeof(double));
  std::memset(fresh + size_, 0, (grown - size_) * sizeof(double));
  data_.reset(fresh);
  size_ = grown;
}

}  // namespace krater
