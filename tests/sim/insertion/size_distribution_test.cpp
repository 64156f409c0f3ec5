#include "sim/insertion/size_distribution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace tsubu::sim {
namespace {

constexpr int samples = 200000;

struct Moments {
  double mean = 0, variance = 0, cube = 0, smallest = 1e300, largest = 0;
};

Moments momentsOf(const SizeDistribution& sizes) {
  Moments m;
  double square = 0;
  for (int i = 0; i < samples; ++i) {
    Random random(1, 2, static_cast<std::uint64_t>(i));
    const double r = sizes.draw(random);
    m.mean += r / samples;
    square += r * r / samples;
    m.cube += r * r * r / samples;
    m.smallest = std::min(m.smallest, r);
    m.largest = std::max(m.largest, r);
  }
  m.variance = square - m.mean * m.mean;
  return m;
}

TEST(SizeDistribution, Constant) {
  const SizeDistribution sizes{ConstantRadius{0.002}};
  Random random(1, 1);
  EXPECT_EQ(sizes.draw(random), 0.002);
  EXPECT_EQ(sizes.smallest(), 0.002);
  EXPECT_EQ(sizes.largest(), 0.002);
  EXPECT_DOUBLE_EQ(sizes.meanCube(), 8e-9);
}

// Uniform in [1, 3]: mean 2, variance 1/3, E r³ = (3⁴ − 1)/(4·2) = 10.
TEST(SizeDistribution, Uniform) {
  const SizeDistribution sizes{UniformRadius{1, 3}};
  const Moments m = momentsOf(sizes);
  EXPECT_NEAR(m.mean, 2, 5 * std::sqrt(1.0 / 3 / samples));
  EXPECT_NEAR(m.variance, 1.0 / 3, 0.005);
  EXPECT_NEAR(m.cube, 10, 0.1);
  EXPECT_DOUBLE_EQ(sizes.meanCube(), 10);
  EXPECT_GE(m.smallest, 1);
  EXPECT_LT(m.largest, 3);
}

// A cut far out changes nothing: mean 5, variance 1, E r³ = μ³ + 3μσ² = 140.
TEST(SizeDistribution, NormalWithAWideCut) {
  const SizeDistribution sizes{NormalRadius{5, 1, 0.1, 10}};
  const Moments m = momentsOf(sizes);
  EXPECT_NEAR(m.mean, 5, 5 / std::sqrt(samples));
  EXPECT_NEAR(m.variance, 1, 5 * std::sqrt(2.0 / samples));
  EXPECT_NEAR(m.cube, 140, 1);
  EXPECT_NEAR(sizes.meanCube(), 140, 1e-3);
}

// Cut at one deviation on both sides: variance 1 − 2 φ(1)/(2Φ(1) − 1) = 0.29112 (truncated normal distribution).
TEST(SizeDistribution, NormalWithANarrowCut) {
  const SizeDistribution sizes{NormalRadius{5, 1, 4, 6}};
  const Moments m = momentsOf(sizes);
  EXPECT_NEAR(m.mean, 5, 5 * std::sqrt(0.29112 / samples));
  EXPECT_NEAR(m.variance, 0.29112, 0.004);
  EXPECT_NEAR(sizes.meanCube(), 125 + 3 * 5 * 0.29112, 1e-3);
  EXPECT_GE(m.smallest, 4);
  EXPECT_LE(m.largest, 6);
}

// Cut at the mean on one side: mean μ + σ√(2/π), variance σ²(1 − 2/π).
TEST(SizeDistribution, NormalCutAtItsMean) {
  const Moments m = momentsOf({NormalRadius{5, 1, 5, 20}});
  EXPECT_NEAR(m.mean, 5 + std::sqrt(2 / M_PI), 5 * std::sqrt((1 - 2 / M_PI) / samples));
  EXPECT_NEAR(m.variance, 1 - 2 / M_PI, 0.01);
}

// Nothing but the mean is left when the cut is at the mean on both sides; no endless search for it.
TEST(SizeDistribution, NormalWithNoRoom) {
  const SizeDistribution sizes{NormalRadius{5, 1, 5, 5}};
  Random random(1, 1);
  EXPECT_EQ(sizes.draw(random), 5);
}

// Shares of the mass 0.2, 0.3, 0.5 on radii 1, 2, 4: numbers in proportion 0.2/1 : 0.3/8 : 0.5/64.
TEST(SizeDistribution, TableIsByMass) {
  const RadiusTable table{{1, 2, 4}, {0.2, 0.3, 0.5}};
  const SizeDistribution sizes{table};
  std::map<double, double> mass, number;
  double total = 0;
  for (int i = 0; i < samples; ++i) {
    Random random(3, 4, static_cast<std::uint64_t>(i));
    const double r = sizes.draw(random);
    mass[r] += r * r * r;
    number[r] += 1.0 / samples;
    total += r * r * r;
  }
  ASSERT_EQ(mass.size(), 3u);
  const double sum = 0.2 + 0.3 / 8 + 0.5 / 64;
  EXPECT_NEAR(number[1], 0.2 / sum, 5 * std::sqrt(0.25 / samples));
  EXPECT_NEAR(number[4], 0.5 / 64 / sum, 5 * std::sqrt(0.032 / samples));
  EXPECT_NEAR(mass[1] / total, 0.2, 0.01);
  EXPECT_NEAR(mass[2] / total, 0.3, 0.01);
  EXPECT_NEAR(mass[4] / total, 0.5, 0.01);
  EXPECT_DOUBLE_EQ(sizes.meanCube(), 1 / sum);
  EXPECT_EQ(sizes.smallest(), 1);
  EXPECT_EQ(sizes.largest(), 4);
}

// chanceExp(x) is true with probability exp(−x).
TEST(SizeDistribution, ChanceExpIsExponential) {
  for (const double x : {0.0, 0.1, 0.5, 1.0}) {
    Random random(5, 6);
    int yes = 0;
    for (int i = 0; i < samples; ++i) yes += random.chanceExp(x);
    EXPECT_NEAR(static_cast<double>(yes) / samples, std::exp(-x), 5 * std::sqrt(0.25 / samples)) << x;
  }
}

}  // namespace
}  // namespace tsubu::sim
