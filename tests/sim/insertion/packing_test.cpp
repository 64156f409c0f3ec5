#include "sim/insertion/packing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "sim/insertion/sphere_grid.h"

namespace tsubu::sim {
namespace {

constexpr double sphere = 4.0 / 3.0 * std::numbers::pi;

const Region unitBox{BoxRegion{Vec3::Zero(), Vec3::Ones()}};

double volumeOf(const std::vector<double>& radii) {
  double volume = 0;
  for (const double r : radii) volume += sphere * r * r * r;
  return volume;
}

// Every pair, the exact condition; and every sphere inside.
void expectClear(const Region& region, const std::vector<Vec3>& centres, const std::vector<double>& radii) {
  ASSERT_EQ(centres.size(), radii.size());
  for (std::size_t i = 0; i < centres.size(); ++i) {
    EXPECT_TRUE(region.containsSphere(centres[i], radii[i] * (1 - 1e-12))) << i;
    for (std::size_t j = 0; j < i; ++j) {
      const double reach = radii[i] + radii[j];
      ASSERT_GE((centres[i] - centres[j]).squaredNorm(), reach * reach) << i << " and " << j;
    }
  }
}

void expectPacks(const Region& region, const SizeDistribution& sizes, double fraction) {
  const std::vector<double> radii = drawRadii(sizes, {{}, fraction * region.volume()}, 1, 2);
  EXPECT_NEAR(volumeOf(radii) / region.volume(), fraction, sphere * std::pow(sizes.largest(), 3) / region.volume());
  expectClear(region, packSpheres(region, radii, 1, 2), radii);
}

TEST(Packing, EqualSpheresFromThinToDense) {
  for (const double fraction : {0.01, 0.2, 0.35, 0.45, 0.55, 0.58}) {
    SCOPED_TRACE(fraction);
    expectPacks(unitBox, {ConstantRadius{0.03}}, fraction);
  }
}

TEST(Packing, InATiltedCylinder) { expectPacks({CylinderRegion{Vec3(1, 1, 1), Vec3(1.3, 1.2, 2), 0.5}}, {ConstantRadius{0.035}}, 0.53); }

TEST(Packing, SizesOneToTen) {
  expectPacks(unitBox, {UniformRadius{0.01, 0.1}}, 0.5);
  expectPacks(unitBox, {RadiusTable{{0.015, 0.15}, {0.3, 0.7}}}, 0.55);
}

TEST(Packing, AnExactFit) {
  // One sphere as wide as its box has one place.
  const std::vector<double> one{0.5};
  EXPECT_TRUE(packSpheres(unitBox, one, 1, 1)[0].isApprox(Vec3::Constant(0.5)));
  // A layer one diameter thick.
  const Region layer{BoxRegion{Vec3::Zero(), Vec3(1, 1, 0.1)}};
  const std::vector<double> radii(40, 0.05);
  expectClear(layer, packSpheres(layer, radii, 1, 1), radii);
}

TEST(Packing, NothingIsAPackingToo) { EXPECT_TRUE(packSpheres(unitBox, {}, 1, 1).empty()); }

TEST(Packing, TheSameSeedTheSameGrainsAnotherSeedOthers) {
  const std::vector<double> radii = drawRadii({UniformRadius{0.02, 0.04}}, {{}, 0.5}, 1, 2);
  const auto a = packSpheres(unitBox, radii, 1, 2), b = packSpheres(unitBox, radii, 1, 2), c = packSpheres(unitBox, radii, 2, 2),
             d = packSpheres(unitBox, radii, 1, 3);
  EXPECT_TRUE(a == b);
  EXPECT_FALSE(a == c);
  EXPECT_FALSE(a == d);
  EXPECT_EQ(radii, drawRadii({UniformRadius{0.02, 0.04}}, {{}, 0.5}, 1, 2));
}

TEST(Packing, RadiiByCountAndByVolume) {
  EXPECT_EQ(drawRadii({UniformRadius{1, 2}}, {7, {}}, 1, 1).size(), 7u);
  // Volume of 10.4 spheres: 10 are nearer than 11; of 10.6: 11.
  EXPECT_EQ(drawRadii({ConstantRadius{0.1}}, {{}, 10.4 * sphere * 1e-3}, 1, 1).size(), 10u);
  EXPECT_EQ(drawRadii({ConstantRadius{0.1}}, {{}, 10.6 * sphere * 1e-3}, 1, 1).size(), 11u);
}

TEST(Packing, TooDenseSaysHowFarItGot) {
  try {
    packSpheres(unitBox, std::vector<double>(static_cast<std::size_t>(0.68 / (sphere * 1e-3)), 0.1), 1, 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("do not fit into the region at random"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("was reached"), std::string::npos);
  }
}

// Places are even: each half of a thin packing holds half of the grains, within five deviations of a fair coin.
TEST(Packing, FillsTheRegionEvenly) {
  const std::vector<double> radii(4000, 0.02);
  const auto centres = packSpheres(unitBox, radii, 1, 1);
  for (int k = 0; k < 3; ++k) {
    int low = 0;
    for (const Vec3& c : centres) low += c[k] < 0.5;
    EXPECT_NEAR(low, 2000, 5 * std::sqrt(4000 / 4.0));
  }
}

TEST(SphereGrid, FindsWhatAllPairsFind) {
  Random random(7, 8);
  std::vector<Vec3> centres;
  std::vector<double> radii;
  SphereGrid grid(Box(Vec3::Zero(), Vec3::Ones()), 0.2, 500);
  for (std::uint32_t i = 0; i < 500; ++i) {
    centres.push_back(unitBox.randomPlace(0, random));
    radii.push_back(random.uniform() < 0.9 ? random.uniform(0.001, 0.02) : random.uniform(0.02, 0.2));
    grid.insert(i, centres.back(), radii.back());
  }
  for (std::uint32_t i = 0; i < 500; ++i) {
    std::vector<int> seen(500);
    grid.visitNear(centres[i], radii[i], 1.1, [&](std::uint32_t j) { ++seen[j]; });
    for (std::uint32_t j = 0; j < 500; ++j) {
      EXPECT_LE(seen[j], 1);
      if ((centres[i] - centres[j]).norm() < 1.1 * (radii[i] + radii[j])) {
        EXPECT_EQ(seen[j], 1);
      }
    }
  }
}

TEST(DeepestOverlap, IsTheDeepest) {
  const std::vector<Vec3> centres{{0, 0, 0}, {1.5, 0, 0}, {0, 2.9, 0}, {9, 9, 9}};
  const std::vector<double> radii{1, 1, 2, 1};
  const auto overlap = deepestOverlap(centres, radii, 0.01);
  ASSERT_TRUE(overlap.has_value());
  EXPECT_EQ(std::min(overlap->first, overlap->second), 0u);
  EXPECT_EQ(std::max(overlap->first, overlap->second), 1u);
  EXPECT_DOUBLE_EQ(overlap->depth, 0.5);
  EXPECT_FALSE(deepestOverlap(centres, radii, 0.6).has_value());
  EXPECT_FALSE(deepestOverlap({}, {}, 0).has_value());
}

}  // namespace
}  // namespace tsubu::sim
