#pragma once
// Random numbers keyed by what is drawn, not by the order of drawing: the same scene gives the same grains on every machine,
// and adding a source of grains does not change the others. The standard library's distributions differ between libraries.

#include <cmath>
#include <cstdint>

#include "core/hash.h"

namespace tsubu {

/// The stream of numbers that belongs to (seed, what, index). Two streams with different keys are independent.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t what, std::uint64_t index = 0) : key_(mix64(seed ^ mix64(what ^ mix64(index)))) {}

  std::uint64_t bits() { return mix64(key_ + 0x9e3779b97f4a7c15ULL * ++count_); }
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// True with probability exp(−x), 0 ≤ x ≤ 1: von Neumann's falling runs. x > u1 > u2 > … has length ≥ n with probability xⁿ/n!, so
  /// an even length has probability 1 − x + x²/2! − … = exp(−x). Comparisons only: no C library has a say in the bits.
  bool chanceExp(double x) {
    bool even = true;
    for (double last = x;; even = !even) {
      const double next = uniform();
      if (next >= last) return even;
      last = next;
    }
  }
  /// Normal with mean 0 and deviation 1, without a logarithm (Karney 2016, doi:10.1145/2710016, algorithm N): k whole units with
  /// probability ∝ exp(−k²/2), then a fraction x kept with probability exp(−x(2k + x)/2).
  double normal() {
    for (;;) {
      int k = 0;
      while (chanceExp(0.5)) ++k;
      bool keep = true;
      for (int i = 0; keep && i < k * (k - 1); ++i) keep = chanceExp(0.5);
      if (!keep) continue;
      const double x = uniform();
      for (int i = 0; keep && i <= k; ++i) keep = chanceExp(x * (2 * k + x) / (2 * k + 2));
      if (keep) return bits() >> 63 ? -(k + x) : k + x;
    }
  }

 private:
  std::uint64_t key_;
  std::uint64_t count_ = 0;
};

}  // namespace tsubu
