// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file core/reproducible_sum.hpp
/// A sum whose bits do not depend on the order of its terms, nor on how they were dealt out among
/// sums that are added up in the end: what several ranks find of one step is what one rank finds.
///
/// Every term is cut at multiples of 2^32, as a number is into digits, and the digits are added as
/// integers, which loses nothing. Kept are the four digits below the largest exponent met so far;
/// what a term has beneath them, less than 2^-84 of the largest term, is dropped, and it is dropped
/// of every term alike, whenever it came. Room for 2^31 terms. (Demmel and Nguyen, Parallel
/// Reproducible Summation, IEEE Trans. Comput. 64, 2015, have the idea with bins of doubles; Neal,
/// Fast exact summation using small and large superaccumulators, 2015, the integer digits.)
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace krater {

class ReproducibleSum {
 public:
  ReproducibleSum& operator+=(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const int exponent = static_cast<int>(bits >> 52U & 0x7FFU);
    if (exponent == 0) return *this;  // zero; what is smaller than all normal numbers is flushed
    if (exponent == 0x7FF) {
      infinite_ += 1;
      return *this;
    }
    const std::uint64_t mantissa = (bits & ((1ULL << 52U) - 1)) | 1ULL << 52U;
    const int shift = exponent % kBits;
    const std::uint64_t low = mantissa << static_cast<unsigned>(shift),
                        high = mantissa >> static_cast<unsigned>(63 - shift) >> 1U;
    const std::array<std::uint64_t, 3> three{low & kMask, low >> 32U, high};
    raise(exponent / kBits + 2);
    const std::int64_t sign = (bits >> 63U) != 0 ? -1 : 1;
    const int below = top_ - exponent / kBits;  // place of the lowest of its three digits
    for (int k = 0; k < 3; ++k)
      if (below - k < kDigits)
        digits_[static_cast<std::size_t>(below - k)] +=
            sign * static_cast<std::int64_t>(three[static_cast<std::size_t>(k)]);
    return *this;
  }
  ReproducibleSum& operator-=(double x) { return *this += -x; }
  ReproducibleSum& operator+=(const ReproducibleSum& other) {
    infinite_ += other.infinite_;
    if (other.top_ < 0) return *this;
    raise(other.top_);
    for (int k = top_ - other.top_; k < kDigits; ++k)
      digits_[static_cast<std::size_t>(k)] +=
          other.digits_[static_cast<std::size_t>(k - (top_ - other.top_))];
    return *this;
  }
  /// A single term comes back as it was; NaN where a term was not finite.
  double value() const {
    if (infinite_ > 0) return std::numeric_limits<double>::quiet_NaN();
    if (top_ < 0) return 0;
    std::array<std::int64_t, kDigits> d = digits_;
    for (std::size_t k = kDigits - 1; k > 0; --k) {  // all but the first in 0 .. 2^32 - 1
      const std::int64_t carry = d[k] >> kBits;      // rounds down
      d[k - 1] += carry;
      d[k] -= carry * (std::int64_t{1} << kBits);
    }
    const bool negative = d[0] < 0;
    if (negative) {  // -(d0, d1, ..) in the same form, so that a sum and its negative are the same
      for (std::int64_t& digit : d) digit = -digit;
      for (std::size_t k = kDigits - 1; k > 0; --k) {
        const std::int64_t carry = d[k] >> kBits;
        d[k - 1] += carry;
        d[k] -= carry * (std::int64_t{1} << kBits);
      }
    }
    double sum = 0;
    for (int k = 0; k < kDigits; ++k)
      sum += std::ldexp(static_cast<double>(d[static_cast<std::size_t>(k)]),
                        kBits * (top_ - k) - kLeast);
    return negative ? -sum : sum;
  }

 private:
  static constexpr int kDigits = 4, kBits = 32;
  static constexpr std::uint64_t kMask = 0xFFFFFFFFU;
  static constexpr int kLeast = 1075;  ///< a mantissa times 2^(exponent - 1075) is the number

  void raise(int top) {
    if (top <= top_) return;
    const int by = top_ < 0 ? kDigits : top - top_;
    for (int k = kDigits - 1; k >= 0; --k)
      digits_[static_cast<std::size_t>(k)] =
          k >= by ? digits_[static_cast<std::size_t>(k - by)] : 0;
    top_ = top;
  }

  std::array<std::int64_t, kDigits> digits_{};  ///< from the top downwards
  std::int32_t top_ = -1;                       ///< place of the first digit; -1: no term yet
  std::int32_t infinite_ = 0;                   ///< terms that are not finite
};

/// N sums side by side: of the entries of vectors and matrices.
template <std::size_t N>
struct ReproducibleSums {
  std::array<ReproducibleSum, N> all;
  void add(const double* entries, std::size_t count = N, std::size_t first = 0) {
    for (std::size_t k = 0; k < count; ++k) all[first + k] += entries[k];
  }
  void read(double* entries, std::size_t count = N, std::size_t first = 0) const {
    for (std::size_t k = 0; k < count; ++k) entries[k] = all[first + k].value();
  }
};

}  // namespace krater
