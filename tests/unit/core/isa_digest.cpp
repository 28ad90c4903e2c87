// SPDX-License-Identifier: GPL-3.0-or-later
// A hash of the results of every arithmetic and mathematical function on fixed inputs. Compiled
// once per level with -DKRATER_ISA=...; isa_test.cpp compares the levels. Nothing of the standard
// library: see isa.hpp.
#include "krater/core/lane_math.hpp"

namespace krater::inline KRATER_ISA {
namespace {

using Word = unsigned long long;

/// FNV-1a over 64-bit words; every NaN counts as the same word.
struct Digest {
  Word state = 0xcbf29ce484222325ULL;
  void add(Word w) { state = (state ^ w) * 0x100000001b3ULL; }
  void add(double x) { add(x == x ? __builtin_bit_cast(Word, x) : 0x7ff8000000000000ULL); }
  void add(const Pack& x) {
    for (int i = 0; i < 8; ++i) add(get(x, i));
  }
  void add(const Mask& m) { add(static_cast<Word>(bits(m))); }
  void add(bool m) { add(static_cast<Word>(m)); }
};

/// splitmix64: three doubles of any sign and a chosen range of exponents, now and then a special
/// value.
struct Inputs {
  Word state = 1;
  Word next() {
    state += 0x9e3779b97f4a7c15ULL;
    Word z = (state ^ (state >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  double value(Word exponents) {
    const Word r = next();
    constexpr double special[] = {
        0.0, -0.0, 1.0, 5e-324, simd_detail::infinity, simd_detail::not_a_number, 2.5, -745};
    if ((r & 127) == 0) return special[(r >> 8) & 7];
    const Word exponent = 1023 - exponents / 2 + (r >> 8) % exponents;
    const Word sign = (r & 128) << 56;
    return __builtin_bit_cast(double, sign | (exponent << 52) | (next() >> 12));
  }
};

struct Arithmetic {
  template <class Real>
  static void run(Digest& d, Real a, Real b, Real c) {
    d.add(a + b * c);
    d.add(a / b - c);
    d.add(fma(a, b, c));
    d.add(fms(a, b, c));
    d.add(fnma(a, b, c));
    d.add(sqrt(a));
    d.add(floor(a * 0.01) + abs(b));
    d.add(min(a, b));
    d.add(max(b, c));
    d.add(clamp(a, Real(-1.0), abs(c)));
    const MaskOf<Real> m = (a < b) | !(b <= c);
    d.add(m);
    d.add(select(m, -a, c));
    d.add(sum(a));
    d.add(hmin(b));
    d.add(hmax(c));
    d.add(is_finite(c));
  }
};

struct Exponential {
  template <class Real>
  static void run(Digest& d, Real a, Real b, Real) {
    d.add(exp(a));
    d.add(exp(b * 1e-3));
  }
};

struct Logarithm {
  template <class Real>
  static void run(Digest& d, Real a, Real b, Real c) {
    d.add(log(a));
    d.add(log(abs(b)));
    d.add(log(1.0 + 0.1 * c));
  }
};

struct Power {
  template <class Real>
  static void run(Digest& d, Real a, Real b, Real c) {
    d.add(pow(abs(a), b));
    d.add(pow(abs(b), abs(c) * 1e-2));
    d.add(pow(a, c));
    d.add(rcbrt(a));
    d.add(rcbrt(abs(b)));
  }
};

/// The batch is hashed first, then its lanes as doubles.
template <class Functions>
Word digest() {
  Digest d;
  Inputs inputs;
  for (int trial = 0; trial < 4000; ++trial) {
    alignas(64) double a[64];
    alignas(64) double t[64];
    const Word exponents = trial % 4 == 0 ? 2000 : 20;
    for (double& x : a) x = inputs.value(exponents);
    transpose8(a, t);
    Functions::run(d, load(t), load(t + 8), load(t + 16));
    for (int i = 0; i < 8; ++i) Functions::run(d, t[24 + i], t[32 + i], t[40 + i]);
  }
  return d.state;
}

}  // namespace
}  // namespace krater::inline KRATER_ISA

/// Four hashes: arithmetic, exp, log, pow with rcbrt.
extern "C" void KRATER_CONCAT(krater_digest_, KRATER_ISA)(unsigned long long out[4]) {
  out[0] = krater::digest<krater::Arithmetic>();
  out[1] = krater::digest<krater::Exponential>();
  out[2] = krater::digest<krater::Logarithm>();
  out[3] = krater::digest<krater::Power>();
}
