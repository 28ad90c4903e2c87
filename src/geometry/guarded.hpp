// SPDX-License-Identifier: GPL-3.0-or-later
// Parallel work that may throw (no memory, a solid that cannot answer): the error of the first item
// that failed is thrown again by the caller's thread.
#pragma once

#include <cstddef>
#include <exception>
#include <vector>

#include "krater/core/parallel.hpp"

namespace krater {

template <class Work>
void for_each_guarded(std::size_t count, const Work& work) {
  std::vector<std::exception_ptr> errors(count);
  for_each(count, [&](std::size_t n) {
    try {
      work(n);
    } catch (...) {
      errors[n] = std::current_exception();
    }
  });
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace krater
