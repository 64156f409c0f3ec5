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
  Random(std::uint64_t seed, std::uint64_t what, std::uint64_t index = 0)
      : key_(mix64(seed ^ mix64(what ^ mix64(index)))) {}

  std::uint64_t bits() { return mix64(key_ + 0x9e3779b97f4a7c15ULL * ++count_); }
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Normal with mean 0 and deviation 1, by the polar method (its logarithm may differ in the last bit between C libraries).
  double normal() {
    for (;;) {
      const double u = uniform(-1, 1), v = uniform(-1, 1), s = u * u + v * v;
      if (s > 0 && s < 1) return u * std::sqrt(-2 * std::log(s) / s);
    }
  }

 private:
  std::uint64_t key_;
  std::uint64_t count_ = 0;
};

}  // namespace tsubu
