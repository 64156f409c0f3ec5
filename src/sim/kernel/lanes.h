#pragma once
// Four numbers at once: how rows of grains, which are doubles, become columns of the stage and back. Compiler vectors: the same source
// for every instruction set, and only loads, sums, shuffles and conversions, so the same bits.

#include <cstring>

#include "sim/laws/arithmetic.h"

// Always inlined, so that no calling convention is involved.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace tsubu::sim {

typedef double D4 __attribute__((vector_size(32)));
typedef float F4 __attribute__((vector_size(16)));

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

/// To the precision of the stage, and back to that of the rows.
template <class Real, class Vector>
TSUBU_INLINE Four<Real> as(const Vector& value) {
  if constexpr (std::is_same_v<Four<Real>, Vector>)
    return value;
  else
    return __builtin_convertvector(value, Four<Real>);
}

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

}  // namespace tsubu::sim
