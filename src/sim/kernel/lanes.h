#pragma once
// Four doubles or eight single numbers at once: how rows of grains become columns of the stage and back. Compiler vectors: the same source
// for every instruction set, and only loads, sums, shuffles and conversions, so the same bits.

#include <cstring>

#include "sim/laws/arithmetic.h"

// Always inlined, so that no calling convention is involved.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace tsubu::sim {

typedef double D4 __attribute__((vector_size(32)));
typedef float F4 __attribute__((vector_size(16)));
typedef float F8 __attribute__((vector_size(32)));

template <class Real>
using Four = std::conditional_t<std::is_same_v<Real, float>, F4, D4>;

TSUBU_INLINE D4 load4(const double* from) {
  D4 value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

TSUBU_INLINE F4 load4(const float* from) {
  F4 value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

TSUBU_INLINE void store4(double* to, const D4& value) { std::memcpy(to, &value, sizeof value); }
TSUBU_INLINE void store4(float* to, const F4& value) { std::memcpy(to, &value, sizeof value); }

TSUBU_INLINE F8 load8(const float* from) {
  F8 value;
  std::memcpy(&value, from, sizeof value);
  return value;
}
TSUBU_INLINE void store8(float* to, const F8& value) { std::memcpy(to, &value, sizeof value); }

TSUBU_INLINE F8 fill8(float value) { return F8{value, value, value, value, value, value, value, value}; }

TSUBU_INLINE F4 lowHalf(const F8& both) { return __builtin_shufflevector(both, both, 0, 1, 2, 3); }
TSUBU_INLINE F4 highHalf(const F8& both) { return __builtin_shufflevector(both, both, 4, 5, 6, 7); }
TSUBU_INLINE F8 joined(const F4& low, const F4& high) { return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7); }

/// To the precision of the stage, and back to that of the rows.
template <class Real, class Vector>
TSUBU_INLINE Four<Real> as(const Vector& value) {
  if constexpr (std::is_same_v<Four<Real>, Vector>)
    return value;
  else if constexpr (std::is_same_v<Real, double>)
    return D4{value[0], value[1], value[2], value[3]};  // one instruction, of which GCC 12 makes five where it converts the vector
  else
    return __builtin_convertvector(value, F4);
}

/// Eight doubles: with AVX2 two vectors side by side, since GCC takes one that is wider than the processor's own apart into quarters.
#if defined(__AVX512F__) || !defined(__AVX__)
typedef double D8 __attribute__((vector_size(64)));

TSUBU_INLINE D4 lowHalf(const D8& both) { return __builtin_shufflevector(both, both, 0, 1, 2, 3); }
TSUBU_INLINE D4 highHalf(const D8& both) { return __builtin_shufflevector(both, both, 4, 5, 6, 7); }
TSUBU_INLINE D8 joined(const D4& low, const D4& high) { return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7); }
TSUBU_INLINE D8 load8(const double* from) {
  D8 value;
  std::memcpy(&value, from, sizeof value);
  return value;
}
TSUBU_INLINE void store8(double* to, const D8& value) { std::memcpy(to, &value, sizeof value); }
TSUBU_INLINE D8 toDouble(const F8& v) { return D8{v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7]}; }
TSUBU_INLINE F8 toSingle(const D8& value) { return __builtin_convertvector(value, F8); }
#else
struct D8 {
  D4 low, high;
};

TSUBU_INLINE D4 lowHalf(const D8& both) { return both.low; }
TSUBU_INLINE D4 highHalf(const D8& both) { return both.high; }
TSUBU_INLINE D8 joined(const D4& low, const D4& high) { return {low, high}; }
TSUBU_INLINE D8 operator+(const D8& a, const D8& b) { return {a.low + b.low, a.high + b.high}; }
TSUBU_INLINE D8 operator*(const D8& a, const D8& b) { return {a.low * b.low, a.high * b.high}; }
TSUBU_INLINE D8 operator*(const D8& a, double b) { return {a.low * b, a.high * b}; }
TSUBU_INLINE D8 load8(const double* from) { return joined(load4(from), load4(from + 4)); }
TSUBU_INLINE void store8(double* to, const D8& value) { store4(to, lowHalf(value)), store4(to + 4, highHalf(value)); }
TSUBU_INLINE D8 toDouble(const F8& value) { return {as<double>(lowHalf(value)), as<double>(highHalf(value))}; }
TSUBU_INLINE F8 toSingle(const D8& value) { return joined(as<float>(value.low), as<float>(value.high)); }
#endif

TSUBU_INLINE void add4(double* to, const D4& value) { store4(to, load4(to) + value); }
TSUBU_INLINE void subtract4(double* to, const D4& value) { store4(to, load4(to) - value); }

TSUBU_INLINE D4 fill4(double value) { return D4{value, value, value, value}; }

/// Rows become columns.
template <class Vector>
TSUBU_INLINE void transpose4(Vector& a, Vector& b, Vector& c, Vector& d) {
  const Vector ab02 = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab13 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Vector cd02 = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd13 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab02, cd02, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab13, cd13, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab02, cd02, 2, 3, 6, 7);
  d = __builtin_shufflevector(ab13, cd13, 2, 3, 6, 7);
}

/// Eight rows of eight become columns.
TSUBU_INLINE void transpose8(F8 (&r)[8]) {
  F8 a[8], b[8];
#pragma GCC unroll 4
  for (int k = 0; k < 8; k += 2) {
    a[k] = __builtin_shufflevector(r[k], r[k + 1], 0, 8, 1, 9, 4, 12, 5, 13);
    a[k + 1] = __builtin_shufflevector(r[k], r[k + 1], 2, 10, 3, 11, 6, 14, 7, 15);
  }
#pragma GCC unroll 2
  for (int k = 0; k < 8; k += 4) {
    b[k] = __builtin_shufflevector(a[k], a[k + 2], 0, 1, 8, 9, 4, 5, 12, 13);
    b[k + 1] = __builtin_shufflevector(a[k], a[k + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    b[k + 2] = __builtin_shufflevector(a[k + 1], a[k + 3], 0, 1, 8, 9, 4, 5, 12, 13);
    b[k + 3] = __builtin_shufflevector(a[k + 1], a[k + 3], 2, 3, 10, 11, 6, 7, 14, 15);
  }
#pragma GCC unroll 4
  for (int k = 0; k < 4; ++k) {
    r[k] = __builtin_shufflevector(b[k], b[k + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    r[k + 4] = __builtin_shufflevector(b[k], b[k + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

}  // namespace tsubu::sim
