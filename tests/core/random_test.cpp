#include "core/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <numbers>
#include <set>

namespace tsubu {
namespace {

constexpr int samples = 100000;

// A stream is mix64 along a Weyl sequence from its key; the expected words follow from that definition alone.
TEST(Random, IsTheDocumentedSequence) {
  constexpr std::uint64_t gamma = 0x9e3779b97f4a7c15ULL;
  const std::uint64_t key = mix64(7 ^ mix64(3 ^ mix64(11)));
  Random random(7, 3, 11);
  for (std::uint64_t n = 1; n <= 5; ++n) EXPECT_EQ(random.bits(), mix64(key + n * gamma));
}

TEST(Random, SameKeySameNumbers) {
  Random a(1, 2, 3), b(1, 2, 3);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.bits(), b.bits());
}

TEST(Random, EveryPartOfTheKeyMatters) {
  std::set<std::uint64_t> first;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    for (std::uint64_t what = 0; what < 10; ++what) {
      for (std::uint64_t index = 0; index < 10; ++index) first.insert(Random(seed, what, index).bits());
    }
  }
  EXPECT_EQ(first.size(), 1000u);
}

// Pearson's chi-squared over 100 equal bins: 99 degrees of freedom, mean 99 and deviation sqrt(198) = 14; five deviations allowed.
TEST(Random, UniformFillsTheUnitIntervalEvenly) {
  std::array<int, 100> bins{};
  Random random(42, 0);
  for (int i = 0; i < samples; ++i) {
    const double u = random.uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    ++bins[static_cast<std::size_t>(u * 100)];
  }
  const double expected = samples / 100.0;
  double chiSquared = 0;
  for (const int count : bins) chiSquared += (count - expected) * (count - expected) / expected;
  EXPECT_LT(chiSquared, 99 + 5 * 14.07);
  EXPECT_GT(chiSquared, 99 - 5 * 14.07) << "too even to be random";
}

TEST(Random, UniformKeepsItsLimits) {
  Random random(42, 1);
  for (int i = 0; i < samples; ++i) {
    const double value = random.uniform(-3, 5);
    ASSERT_GE(value, -3.0);
    ASSERT_LT(value, 5.0);
  }
}

// Correlation of n independent pairs of uniforms has deviation 1/sqrt(n).
TEST(Random, StreamsOfNeighbouringKeysAreUncorrelated) {
  const std::array<std::array<Random, 2>, 3> pairs = {{{Random(1, 0, 0), Random(1, 0, 1)},    // two grains of a source
                                                       {Random(1, 0, 0), Random(1, 1, 0)},    // two sources
                                                       {Random(1, 0, 0), Random(2, 0, 0)}}};  // two seeds
  for (auto [a, b] : pairs) {
    double sum = 0;
    for (int i = 0; i < samples; ++i) sum += (a.uniform() - 0.5) * (b.uniform() - 0.5);
    EXPECT_NEAR(12 * sum / samples, 0.0, 5 / std::sqrt(samples));
  }
}

// What grains use: the first number of many streams must be as uniform as many numbers of one stream.
TEST(Random, FirstNumbersOfManyStreamsAreUniform) {
  double sum = 0, sumOfSquares = 0;
  for (int i = 0; i < samples; ++i) {
    const double u = Random(5, 9, static_cast<std::uint64_t>(i)).uniform();
    sum += u;
    sumOfSquares += u * u;
  }
  const double n = samples;
  EXPECT_NEAR(sum / n, 1.0 / 2, 5 * std::sqrt(1.0 / 12 / n));
  EXPECT_NEAR(sumOfSquares / n, 1.0 / 3, 5 * std::sqrt(4.0 / 45 / n));
}

TEST(Random, EveryBitIsFair) {
  std::array<int, 64> ones{};
  Random random(3, 1, 4);
  for (int i = 0; i < samples; ++i) {
    const std::uint64_t word = random.bits();
    for (std::size_t bit = 0; bit < 64; ++bit) ones[bit] += static_cast<int>(word >> bit & 1);
  }
  for (const int count : ones) EXPECT_NEAR(count, samples / 2.0, 5 * std::sqrt(samples / 4.0));
}

TEST(Random, ChanceExpIsTrueWithProbabilityExpOfMinusX) {
  Random random(42, 3);
  for (const double x : {0.0, 0.1, 0.5, 0.9, 1.0}) {
    int kept = 0;
    for (int i = 0; i < samples; ++i) kept += random.chanceExp(x) ? 1 : 0;
    const double p = std::exp(-x);
    EXPECT_NEAR(static_cast<double>(kept) / samples, p, 5 * std::sqrt(p * (1 - p) / samples)) << "x = " << x;
  }
}

// Chi-squared over bins of a quarter within three deviations and two tails: 25 degrees of freedom, deviation sqrt(50).
TEST(Random, NormalHasTheDistributionOfTheErrorFunction) {
  constexpr int bins = 26;
  std::array<int, bins> counts{};
  Random random(42, 4);
  for (int i = 0; i < samples; ++i) {
    const double place = std::floor((random.normal() + 3) * 4) + 1;
    ++counts[static_cast<std::size_t>(std::clamp(place, 0.0, bins - 1.0))];
  }
  const auto below = [](int bin) {  // probability of what lies below the upper edge of a bin
    return bin < 0 ? 0.0 : bin >= bins - 1 ? 1.0 : 0.5 * std::erfc(-(-3 + bin / 4.0) / std::numbers::sqrt2);
  };
  double chiSquared = 0;
  for (int bin = 0; bin < bins; ++bin) {
    const double expected = samples * (below(bin) - below(bin - 1));
    const double difference = counts[static_cast<std::size_t>(bin)] - expected;
    chiSquared += difference * difference / expected;
  }
  EXPECT_LT(chiSquared, 25 + 5 * std::sqrt(50));
}

// Moments of the standard normal distribution: 0, 1, 0, 3; the variance of x^k is E x^2k - (E x^k)^2 = 1, 2, 15, 96.
TEST(Random, NormalHasTheMomentsOfANormalDistribution) {
  const std::array<double, 4> expected = {0, 1, 0, 3}, variance = {1, 2, 15, 96};
  std::array<double, 4> sums{};
  Random random(42, 2);
  for (int i = 0; i < samples; ++i) {
    const double x = random.normal();
    double power = 1;
    for (double& sum : sums) sum += power *= x;
  }
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(sums[k] / samples, expected[k], 5 * std::sqrt(variance[k] / samples)) << "moment " << k + 1;
  }
}

}  // namespace
}  // namespace tsubu
