#pragma once
// Four doubles at once: how rows of grains become columns of the stage and back. Compiler vectors: the same source for every
// instruction set, and only loads, sums and shuffles, so the same bits.

#include <cstring>

#include "sim/laws/arithmetic.h"

// Always inlined, so that no calling convention is involved.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace tsubu::sim {

typedef double D4 __attribute__((vector_size(32)));

TSUBU_INLINE D4 load4(const double* from) {
  D4 value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

TSUBU_INLINE void store4(double* to, const D4& value) { std::memcpy(to, &value, sizeof value); }

TSUBU_INLINE void add4(double* to, const D4& value) { store4(to, load4(to) + value); }
TSUBU_INLINE void subtract4(double* to, const D4& value) { store4(to, load4(to) - value); }

TSUBU_INLINE D4 fill4(double value) { return D4{value, value, value, value}; }

/// Rows become columns.
TSUBU_INLINE void transpose4(D4& a, D4& b, D4& c, D4& d) {
  const D4 ab02 = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab13 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const D4 cd02 = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd13 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab02, cd02, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab13, cd13, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab02, cd02, 2, 3, 6, 7);
  d = __builtin_shufflevector(ab13, cd13, 2, 3, 6, 7);
}

}  // namespace tsubu::sim
