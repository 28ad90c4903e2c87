// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/points/store.hpp"

namespace krater {

void PointStore::append(const double* point) {
  const int i = count_;
  resize(count_ + 1);
  for (int k = 0; k < stride_; k += kLanes) at(k, i) = point[k / kLanes];
}

void PointStore::copy(int from, int to) {
  for (int k = 0; k < stride_; k += kLanes) at(k, to) = at(k, from);
}

void PointStore::remove(const std::vector<int>& holes) {
  std::size_t first = 0, last = holes.size();
  while (first < last) {
    if (holes[last - 1] == count_ - 1) {
      --last;
    } else {
      copy(count_ - 1, holes[first]);
      ++first;
    }
    --count_;
  }
}

void PointStore::resize(int count) {
  count_ = count;
  records_.reserve(size());
}

void PointStore::pad(int mass) {
  for (int i = count_; i < kLanes * groups(); ++i) {
    copy(count_ - 1, i);
    at(mass, i) = 0;
  }
}

}  // namespace krater
