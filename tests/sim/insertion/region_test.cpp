#include "sim/insertion/region.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace tsubu::sim {
namespace {

const Region box{BoxRegion{Vec3(-1, 0, 2), Vec3(1, 3, 6)}};
// A cylinder that lies along no axis: height 5, radius 2.
const Region cylinder{CylinderRegion{Vec3(1, 1, 1), Vec3(1, 4, 5), 2}};

TEST(Region, VolumeAndInradius) {
  EXPECT_EQ(box.volume(), 2 * 3 * 4);
  EXPECT_EQ(box.inradius(), 1);
  EXPECT_DOUBLE_EQ(cylinder.volume(), std::numbers::pi * 4 * 5);
  EXPECT_EQ(cylinder.inradius(), 2);
}

TEST(Region, BoundsOfACylinder) {
  // Along each axis the caps reach radius × √(1 − a²) beyond the ends: a = (0, 0.6, 0.8).
  const Box bounds = cylinder.bounds();
  EXPECT_TRUE(bounds.min().isApprox(Vec3(1 - 2, 1 - 1.6, 1 - 1.2)));
  EXPECT_TRUE(bounds.max().isApprox(Vec3(1 + 2, 4 + 1.6, 5 + 1.2)));
}

TEST(Region, BoundaryBelongsToIt) {
  EXPECT_TRUE(box.contains(Vec3(-1, 0, 2)));
  EXPECT_FALSE(box.contains(Vec3(-1.0000001, 0, 2)));
  EXPECT_TRUE(box.containsSphere(Vec3(0, 1, 3), 1));
  EXPECT_FALSE(box.containsSphere(Vec3(0, 1, 3), 1.0000001));
  const Vec3 axis(0, 0.6, 0.8), across(0, -0.8, 0.6), base(1, 1, 1);
  EXPECT_TRUE(cylinder.contains(base + 2.5 * axis + 1.9999 * across));
  EXPECT_FALSE(cylinder.contains(base + 2.5 * axis + 2.0001 * across));
  EXPECT_FALSE(cylinder.contains(base - 0.0001 * axis));
  EXPECT_TRUE(cylinder.containsSphere(base + 1.001 * axis + 0.999 * across, 1));
  EXPECT_FALSE(cylinder.containsSphere(base + 0.999 * axis, 1));
  EXPECT_FALSE(cylinder.containsSphere(base + 2.5 * axis + 1.001 * across, 1));
}

TEST(Region, AHalfSpaceIsABoxWithInfiniteCorners) {
  const double inf = std::numeric_limits<double>::infinity();
  const Region below{BoxRegion{Vec3::Constant(-inf), Vec3(inf, inf, -1)}};
  EXPECT_TRUE(below.contains(Vec3(1e9, -1e9, -2)));
  EXPECT_FALSE(below.contains(Vec3(0, 0, 0)));
}

// Uniform places of spheres of radius r fill the region shrunk by r evenly: its mean is the centre, and along the axis of the cylinder
// (height h) the variance is (h − 2r)²/12, across it the mean square distance is (R − r)²/2.
TEST(Region, PlacesAreUniformAndInside) {
  constexpr int samples = 20000;
  const double r = 0.5;
  Vec3 mean = Vec3::Zero();
  double along2 = 0, across2 = 0;
  Random random(1, 2);
  for (int i = 0; i < samples; ++i) {
    const Vec3 p = cylinder.randomPlace(r, random);
    ASSERT_TRUE(cylinder.containsSphere(p, r * (1 - 1e-12)));
    const Vec3 from = p - Vec3(1, 2.5, 3);
    const double h = from.dot(Vec3(0, 0.6, 0.8));
    mean += from / samples;
    along2 += h * h / samples;
    across2 += (from.squaredNorm() - h * h) / samples;
  }
  EXPECT_LT(mean.norm(), 0.04);
  EXPECT_NEAR(along2, 16.0 / 12, 0.04);
  EXPECT_NEAR(across2, 1.5 * 1.5 / 2, 0.03);
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(box.containsSphere(box.randomPlace(r, random), r * (1 - 1e-12)));
}

}  // namespace
}  // namespace tsubu::sim
