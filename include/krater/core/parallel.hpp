// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file core/parallel.hpp
/// The only OpenMP in the program. Work items are independent; nothing may depend on which thread
/// runs an item or in which order: results are combined by the caller in item order, so any number
/// of threads gives the same bits.
#include <cstddef>

namespace krater {

/// Threads used by for_each from now on; 0: as many as OpenMP offers. Returns the number in force.
int set_threads(int count);
int threads();
int thread_index();  ///< 0 .. threads()-1 inside a work item

namespace detail {
void for_each(std::size_t count, std::size_t few, void (*call)(const void*, std::size_t),
              const void* context);
}

/// Call work(i) for i in [0, count): every thread has a range of its own, and helps the others when
/// it is done. Up to `few` items one does alone: the others wake in some 5 us. Where work
/// throws (no memory left), the error of the first item that failed is thrown again here; items
/// after it may be left out. Denormals are flushed to zero in every thread: the scheme's own tails
/// (weights near the edge of a support) make them, they cost 100x.
template <class Work>
void for_each(std::size_t count, const Work& work, std::size_t few = 1) {
  detail::for_each(
      count, few,
      [](const void* context, std::size_t i) { (*static_cast<const Work*>(context))(i); }, &work);
}

void flush_denormals();  ///< in the calling thread

}  // namespace krater
