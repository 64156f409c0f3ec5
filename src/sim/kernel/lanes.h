#pragma once
// Four doubles or eight single numbers at once: how rows of grains become columns of the stage and back. Compiler vectors: the same source
// for every instruction set, with intrinsics where the compiler has no words; nothing that rounds otherwise anywhere (a product is fused
// where it is exact alone), so the same bits.

#include <cstdint>
#include <cstring>
#ifdef __AVX__
#include <immintrin.h>
#endif
#include <type_traits>
#include <utility>

#include "sim/laws/arithmetic.h"

// Always inlined, so that no calling convention is involved.
#pragma GCC diagnostic ignored "-Wpsabi"

// The contacts or bonds of a chunk do not depend on each other: the compiler need not check. (Not `omp simd`: GCC would give every lane its
// own copy of the small structs of a law and then fail to vectorise them.)
#if defined(__clang__)
#define TSUBU_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define TSUBU_INDEPENDENT _Pragma("GCC ivdep")
#endif

namespace tsubu::sim {

/// Two vectors side by side, where a processor has none that is wide enough: the compiler takes one that is too wide apart by way of
/// memory.
template <class Half>
struct Two {
  using Number = std::remove_cvref_t<decltype(std::declval<const Half&>()[0])>;
  static constexpr int lanes = 2 * static_cast<int>(sizeof(Half) / sizeof(Number));

  Half low, high;

  Two() = default;
  TSUBU_INLINE Two(const Half& l, const Half& h) : low(l), high(h) {}
  TSUBU_INLINE Two(Number a, Number b, Number c, Number d) requires(lanes == 4) : low{a, b}, high{c, d} {}
  TSUBU_INLINE Two(Number a, Number b, Number c, Number d, Number e, Number f, Number g, Number h) requires(lanes == 8)
      : low{a, b, c, d}, high{e, f, g, h} {}
  TSUBU_INLINE Number operator[](int k) const { return k < lanes / 2 ? low[k] : high[k - lanes / 2]; }

  TSUBU_INLINE friend Two operator+(const Two& a, const Two& b) { return {a.low + b.low, a.high + b.high}; }
  TSUBU_INLINE friend Two operator-(const Two& a, const Two& b) { return {a.low - b.low, a.high - b.high}; }
  TSUBU_INLINE friend Two operator*(const Two& a, const Two& b) { return {a.low * b.low, a.high * b.high}; }
  TSUBU_INLINE friend Two operator*(const Two& a, Number b) { return {a.low * b, a.high * b}; }
  TSUBU_INLINE friend Two operator*(Number a, const Two& b) { return {a * b.low, a * b.high}; }
  TSUBU_INLINE friend Two operator-(Number a, const Two& b) { return {a - b.low, a - b.high}; }
  TSUBU_INLINE friend Two operator|(const Two& a, const Two& b) { return {a.low | b.low, a.high | b.high}; }
  TSUBU_INLINE Two& operator+=(const Two& b) { return *this = *this + b; }
  TSUBU_INLINE Two& operator*=(const Two& b) { return *this = *this * b; }

  TSUBU_INLINE friend auto operator<(const Two& a, const Two& b) { return Two<decltype(a.low < b.low)>(a.low < b.low, a.high < b.high); }
  TSUBU_INLINE friend auto operator>(const Two& a, const Two& b) { return Two<decltype(a.low > b.low)>(a.low > b.low, a.high > b.high); }
  TSUBU_INLINE friend auto operator<=(const Two& a, const Two& b) {
    return Two<decltype(a.low <= b.low)>(a.low <= b.low, a.high <= b.high);
  }
  TSUBU_INLINE friend auto operator>=(const Two& a, const Two& b) {
    return Two<decltype(a.low >= b.low)>(a.low >= b.low, a.high >= b.high);
  }
  TSUBU_INLINE friend auto operator!=(const Two& a, const Two& b) {
    return Two<decltype(a.low != b.low)>(a.low != b.low, a.high != b.high);
  }
};

/// a where the mask says so, b elsewhere.
template <class Mask, class Vector>
TSUBU_INLINE Vector choose(const Mask& mask, const Vector& a, const Vector& b) {
  return mask ? a : b;
}
template <class Mask, class Half>
TSUBU_INLINE Two<Half> choose(const Two<Mask>& mask, const Two<Half>& a, const Two<Half>& b) {
  return {choose(mask.low, a.low, b.low), choose(mask.high, a.high, b.high)};
}

typedef float F4 __attribute__((vector_size(16)));
#ifdef __AVX__
typedef double D4 __attribute__((vector_size(32)));
typedef float F8 __attribute__((vector_size(32)));
#else
typedef double D2 __attribute__((vector_size(16)));
using D4 = Two<D2>;
using F8 = Two<F4>;
#endif
#ifdef __AVX512F__
typedef double D8 __attribute__((vector_size(64)));
#else
using D8 = Two<D4>;
#endif

template <class Real>
using Four = std::conditional_t<std::is_same_v<Real, float>, F4, D4>;

template <class Vector, class Number>
TSUBU_INLINE Vector loaded(const Number* from) {
  Vector value;
  std::memcpy(&value, from, sizeof value);
  return value;
}
template <class Vector, class Number>
TSUBU_INLINE void stored(Number* to, const Vector& value) {
  std::memcpy(to, &value, sizeof value);
}
TSUBU_INLINE F4 load4(const float* from) { return loaded<F4>(from); }
TSUBU_INLINE void store4(float* to, const F4& value) { stored(to, value); }

#ifdef __AVX__
TSUBU_INLINE D4 load4(const double* from) { return loaded<D4>(from); }
TSUBU_INLINE void store4(double* to, const D4& value) { stored(to, value); }
TSUBU_INLINE F8 load8(const float* from) { return loaded<F8>(from); }
TSUBU_INLINE void store8(float* to, const F8& value) { stored(to, value); }
TSUBU_INLINE F4 lowHalf(const F8& both) { return __builtin_shufflevector(both, both, 0, 1, 2, 3); }
TSUBU_INLINE F4 highHalf(const F8& both) { return __builtin_shufflevector(both, both, 4, 5, 6, 7); }
TSUBU_INLINE F8 joined(const F4& low, const F4& high) { return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7); }
/// The first three of `a` with the fourth of `b`.
TSUBU_INLINE D4 withFourth(const D4& a, const D4& b) { return __builtin_shufflevector(a, b, 0, 1, 2, 7); }
#else
TSUBU_INLINE D4 load4(const double* from) { return {loaded<D2>(from), loaded<D2>(from + 2)}; }
TSUBU_INLINE void store4(double* to, const D4& value) { stored(to, value.low), stored(to + 2, value.high); }
TSUBU_INLINE F8 load8(const float* from) { return {load4(from), load4(from + 4)}; }
TSUBU_INLINE void store8(float* to, const F8& value) { store4(to, value.low), store4(to + 4, value.high); }
TSUBU_INLINE F4 lowHalf(const F8& both) { return both.low; }
TSUBU_INLINE F4 highHalf(const F8& both) { return both.high; }
TSUBU_INLINE F8 joined(const F4& low, const F4& high) { return {low, high}; }
TSUBU_INLINE D4 withFourth(const D4& a, const D4& b) { return {a.low, __builtin_shufflevector(a.high, b.high, 0, 3)}; }
#endif

TSUBU_INLINE D4 fill4(double value) { return D4{value, value, value, value}; }
TSUBU_INLINE F8 fill8(float value) { return F8{value, value, value, value, value, value, value, value}; }

/// To the precision of the stage, and back to that of the rows.
template <class Real, class Vector>
TSUBU_INLINE Four<Real> as(const Vector& value) {
  if constexpr (std::is_same_v<Four<Real>, Vector>)
    return value;
  else if constexpr (std::is_same_v<Real, double>)
    return D4{value[0], value[1], value[2], value[3]};  // one instruction, of which GCC 12 makes five where it converts the vector
  else {
#ifdef __AVX__
    return __builtin_convertvector(value, F4);
#else
    return F4{static_cast<float>(value[0]), static_cast<float>(value[1]), static_cast<float>(value[2]), static_cast<float>(value[3])};
#endif
  }
}

#ifdef __AVX512F__
TSUBU_INLINE D4 lowHalf(const D8& both) { return __builtin_shufflevector(both, both, 0, 1, 2, 3); }
TSUBU_INLINE D4 highHalf(const D8& both) { return __builtin_shufflevector(both, both, 4, 5, 6, 7); }
TSUBU_INLINE D8 joined(const D4& low, const D4& high) { return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7); }
TSUBU_INLINE D8 load8(const double* from) { return loaded<D8>(from); }
TSUBU_INLINE void store8(double* to, const D8& value) { stored(to, value); }
TSUBU_INLINE D8 toDouble(const F8& v) { return D8{v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7]}; }
TSUBU_INLINE F8 toSingle(const D8& value) { return __builtin_convertvector(value, F8); }
#else
TSUBU_INLINE D4 lowHalf(const D8& both) { return both.low; }
TSUBU_INLINE D4 highHalf(const D8& both) { return both.high; }
TSUBU_INLINE D8 joined(const D4& low, const D4& high) { return {low, high}; }
TSUBU_INLINE D8 load8(const double* from) { return {load4(from), load4(from + 4)}; }
TSUBU_INLINE void store8(double* to, const D8& value) { store4(to, value.low), store4(to + 4, value.high); }
TSUBU_INLINE D8 toDouble(const F8& value) { return {as<double>(lowHalf(value)), as<double>(highHalf(value))}; }
TSUBU_INLINE F8 toSingle(const D8& value) { return joined(as<float>(value.low), as<float>(value.high)); }
#endif

/// Of each four.
TSUBU_INLINE D8 withFourth(const D8& a, const D8& b) {
  return joined(withFourth(lowHalf(a), lowHalf(b)), withFourth(highHalf(a), highHalf(b)));
}

/// a + s b, where s is a row of signs. A product by ±1 is exact: fused or not, the sum is the same.
template <class Vector>
TSUBU_INLINE Vector plusSigned(const Vector& a, const Vector& signs, const Vector& b) {
#ifdef __FMA__
  if constexpr (std::is_same_v<Vector, D4>) return static_cast<D4>(_mm256_fmadd_pd(signs, b, a));
  if constexpr (std::is_same_v<Vector, F8>) return static_cast<F8>(_mm256_fmadd_ps(signs, b, a));
  if constexpr (std::is_same_v<Vector, F4>) return static_cast<F4>(_mm_fmadd_ps(signs, b, a));
#endif
  return a + signs * b;
}

/// For which of eight lanes a < b, as bits.
TSUBU_INLINE unsigned whereLess(const D8& a, const D8& b) {
#ifdef __AVX512F__
  return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ);
#elif defined(__AVX__)
  const auto bits = [](const D4& x, const D4& y) __attribute__((always_inline)) {
    return static_cast<unsigned>(_mm256_movemask_pd(_mm256_cmp_pd(x, y, _CMP_LT_OQ)));
  };
  return bits(a.low, b.low) | bits(a.high, b.high) << 4;
#else
  unsigned bits = 0;
  for (int k = 0; k < 8; ++k) bits |= static_cast<unsigned>(a[k] < b[k]) << k;
  return bits;
#endif
}

/// Writes those of eight numbers that are chosen by bits and above `after`, in their order; `to` has room for eight. Returns how many.
TSUBU_INLINE int keepAbove(std::int32_t after, const std::int32_t* numbers, unsigned chosen, std::int32_t* to) {
#if defined(__AVX512F__) && defined(__AVX512VL__)
  const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(numbers));
  const __mmask8 kept = _mm256_mask_cmpgt_epi32_mask(static_cast<__mmask8>(chosen), all, _mm256_set1_epi32(after));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_maskz_compress_epi32(kept, all));
  return __builtin_popcount(kept);
#else
  // Without a branch: which they are cannot be foreseen.
  int count = 0;
  for (int k = 0; k < 8; ++k) {
    to[count] = numbers[k];
    count += static_cast<int>(chosen >> k & 1U) & static_cast<int>(numbers[k] > after);
  }
  return count;
#endif
}

TSUBU_INLINE void add4(double* to, const D4& value) { store4(to, load4(to) + value); }
TSUBU_INLINE void subtract4(double* to, const D4& value) { store4(to, load4(to) - value); }

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

#ifndef __AVX__
TSUBU_INLINE void transpose4(D4& a, D4& b, D4& c, D4& d) {
  const auto first = [](const D2& x, const D2& y) __attribute__((always_inline)) { return __builtin_shufflevector(x, y, 0, 2); };
  const auto second = [](const D2& x, const D2& y) __attribute__((always_inline)) { return __builtin_shufflevector(x, y, 1, 3); };
  const D4 columns[4] = {{first(a.low, b.low), first(c.low, d.low)},
                         {second(a.low, b.low), second(c.low, d.low)},
                         {first(a.high, b.high), first(c.high, d.high)},
                         {second(a.high, b.high), second(c.high, d.high)}};
  a = columns[0], b = columns[1], c = columns[2], d = columns[3];
}
#endif

#ifdef __AVX__
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
#else
TSUBU_INLINE void transpose8(F8 (&r)[8]) {
  for (int k = 0; k < 8; k += 4) {
    transpose4(r[k].low, r[k + 1].low, r[k + 2].low, r[k + 3].low);
    transpose4(r[k].high, r[k + 1].high, r[k + 2].high, r[k + 3].high);
  }
  for (int k = 0; k < 4; ++k) std::swap(r[k].high, r[k + 4].low);
}
#endif

/// Three columns as rows, of which the fourth number is 0.
TSUBU_INLINE void toRows(const double* x, const double* y, const double* z, D4 (&rows)[4]) {
  rows[0] = load4(x), rows[1] = load4(y), rows[2] = load4(z), rows[3] = D4{};
  transpose4(rows[0], rows[1], rows[2], rows[3]);
}

}  // namespace tsubu::sim
