// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/geometry/seeds/line.hpp"

#include <algorithm>
#include <limits>

namespace krater {

void combine(SetOperation operation, const Spans& a, const Spans& b, Spans& out) {
  out.clear();
  const auto inside = [operation](bool in_a, bool in_b) {
    switch (operation) {
      case SetOperation::unite:
        return in_a || in_b;
      case SetOperation::intersect:
        return in_a && in_b;
      case SetOperation::subtract:
        break;
    }
    return in_a && !in_b;
  };
  constexpr double never = std::numeric_limits<double>::infinity();
  const auto end = [](const Spans& s, std::size_t i) {
    if (i >= 2 * s.size()) return never;
    return i % 2 == 0 ? s[i / 2].low : s[i / 2].high;
  };
  std::size_t i = 0, j = 0;  // ends passed; odd: inside
  bool in = false;
  double low = 0;
  while (i < 2 * a.size() || j < 2 * b.size()) {
    const double next = std::min(end(a, i), end(b, j));
    while (i < 2 * a.size() && end(a, i) <= next) ++i;
    while (j < 2 * b.size() && end(b, j) <= next) ++j;
    const bool now = inside(i % 2 == 1, j % 2 == 1);
    if (now && !in) low = next;
    if (!now && in && next > low) out.push_back({low, next});
    in = now;
  }
}

}  // namespace krater
