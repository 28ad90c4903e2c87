// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/core/parallel.hpp"

#include <omp.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <vector>

#include "krater/core/parallel_account.hpp"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace krater {

namespace {

int thread_count = 1;
ParallelAccount* kept_account = nullptr;

/// The items that one thread begins with: the same in every step, so that what belongs to them
/// stays in its cache. Who has done his own takes from the others'.
struct alignas(128) Range {
  std::atomic<long> next;
  long end;

  template <class Work>
  void take(const Work& work) {
    while (next.load(std::memory_order_relaxed) < end) {
      const long i = next.fetch_add(1, std::memory_order_relaxed);
      if (i < end) work(i);
    }
  }
};

}  // namespace

int set_threads(int count) {
  thread_count = count > 0 ? count : omp_get_max_threads();
  return thread_count;
}

int threads() { return thread_count; }
int thread_index() { return omp_get_thread_num(); }

void flush_denormals() {
#if defined(__SSE2__)
  _mm_setcsr(_mm_getcsr() | 0x8040U);  // flush-to-zero and denormals-are-zero
#elif defined(__aarch64__)
  unsigned long fpcr;
  asm volatile("mrs %0, fpcr" : "=r"(fpcr));
  asm volatile("msr fpcr, %0" : : "r"(fpcr | (1UL << 24)));
#endif
}

namespace detail {

namespace {

void share(std::size_t count, std::size_t few, void (*call)(const void*, std::size_t),
           const void* context) {
  const auto n = static_cast<long>(count);
  if (thread_count == 1 || count <= few) {  // OpenMP asks for a lock per item even then
    flush_denormals();
    for (long i = 0; i < n; ++i) call(context, static_cast<std::size_t>(i));
    return;
  }
  // One error is kept, that of the first item that failed: none may leave the parallel region, and
  // one of each item would use up what the library holds ready for a lack of memory.
  std::atomic<long> failed{n};
  std::exception_ptr error;
  std::mutex guard;
  const auto work = [&](long i) {
    if (i > failed.load(std::memory_order_relaxed)) return;
    try {
      call(context, static_cast<std::size_t>(i));
    } catch (...) {
      const std::lock_guard<std::mutex> lock{guard};
      if (i >= failed) return;
      failed = i;
      error = std::current_exception();
    }
  };
  std::vector<Range> ranges(static_cast<std::size_t>(thread_count));
  for (std::size_t t = 0; t < ranges.size(); ++t) {
    ranges[t].next = n * static_cast<long>(t) / thread_count;
    ranges[t].end = n * static_cast<long>(t + 1) / thread_count;
  }
#pragma omp parallel num_threads(thread_count)  // always as many: libgomp ends those left over
  {
    flush_denormals();
    const auto own = static_cast<std::size_t>(omp_get_thread_num());
    for (std::size_t k = 0; k < ranges.size(); ++k) ranges[(own + k) % ranges.size()].take(work);
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace

void for_each(std::size_t count, std::size_t few, void (*call)(const void*, std::size_t),
              const void* context) {
  if (kept_account == nullptr) {
    share(count, few, call, context);
    return;
  }
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  share(count, few, call, context);
  ParallelAccount::Region& region = kept_account->by_items[count <= few ? 1 : count];
  region.calls += 1;
  region.seconds += std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace detail

void keep_account(ParallelAccount* account) { kept_account = account; }

}  // namespace krater
