// Coplanar triangles are one face: a grain feels the shape of a wall and not how it was cut.

#include <gtest/gtest.h>

#include "shapes.h"

namespace tsubu::sim::test {
namespace {

class CutSquare : public testing::TestWithParam<int> {};

TEST_P(CutSquare, IsOneFaceWithFourEdgesAndFourCorners) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Surface surface(makeCutSquare(GetParam(), seed));
    EXPECT_EQ(surface.faceCount(), 1u);
    if (GetParam() < 5000) {  // of thousands, a few keep a slit as narrow as the tolerance, which the next test does not feel
      EXPECT_EQ(surface.edgeCount(), 4u);
      EXPECT_EQ(surface.cornerCount(), 4u);
    }
  }
}

TEST_P(CutSquare, GivesOneContactExactlyWhereThePlaneIs) {
  const Surface surface(makeCutSquare(GetParam(), 7));
  Probe probe(surface);
  Random random(1, 2);
  for (int i = 0; i < 20000; ++i) {
    const double side = i % 2 ? 1 : -1;
    const Vec3 centre(random.uniform(), random.uniform(), side * random.uniform(0.001, 0.05));
    const WallContacts& contacts = probe.contacts(centre, 0.05);
    ASSERT_EQ(contacts.size(), 1) << centre.transpose();
    EXPECT_NEAR((contacts[0].point - Vec3(centre.x(), centre.y(), 0)).norm(), 0, 1e-12);
    EXPECT_NEAR((contacts[0].normal - Vec3(0, 0, side)).norm(), 0, 1e-12);
    EXPECT_NEAR(contacts[0].distance, std::abs(centre.z()), 1e-12);
    EXPECT_EQ(contacts[0].weight, 1);
  }
}

TEST_P(CutSquare, StaysOneFaceWhenTiltedAndRoundedToSinglePrecision) {
  // Coordinates up to 1.5 m are rounded by at most 2^-24 m in binary STL; the plane through the vertices may be off by that much
  // times the number of coordinates, and its normal by that over the size of the square.
  const double error = 4 * 0x1.0p-24;
  const Pose pose{Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())), Vec3(0.1, -0.2, 0.3)};
  const Surface surface(rounded(transformed(makeCutSquare(GetParam(), 3), pose)));
  EXPECT_EQ(surface.faceCount(), 1u);
  EXPECT_EQ(surface.edgeCount(), 4u);
  Probe probe(surface);
  Random random(1, 3);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 local(random.uniform(0.001, 0.999), random.uniform(0.001, 0.999), random.uniform(-0.05, 0.05));
    const WallContacts& contacts = probe.contacts(pose.toWorld(local), 0.05);
    ASSERT_EQ(contacts.size(), 1);
    EXPECT_NEAR(contacts[0].distance, std::abs(local.z()), error);
  }
}

INSTANTIATE_TEST_SUITE_P(Triangles, CutSquare, testing::Values(2, 50, 5000));

TEST(Seam, EvenSplintersBelowTheToleranceAreNotFelt) {
  // Half of these triangles are narrower than the tolerance for welding and are left out; what remains overlaps and gapes by as
  // much. At the overlaps that a simulation allows, a tenth of the radius, there is still one contact.
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const Surface surface(makeCutSquare(5000, seed, 0));
    Probe probe(surface);
    Random random(seed, 4);
    for (int i = 0; i < 20000; ++i) {
      const Vec3 centre(random.uniform(), random.uniform(), (i % 2 ? 1 : -1) * random.uniform(0.046, 0.05));
      const WallContacts& contacts = probe.contacts(centre, 0.05);
      ASSERT_EQ(contacts.size(), 1) << centre.transpose();
      EXPECT_NEAR((contacts[0].point - Vec3(centre.x(), centre.y(), 0)).norm(), 0, 1e-12);
      EXPECT_NEAR(contacts[0].distance, std::abs(centre.z()), 1e-12);
      EXPECT_EQ(contacts[0].weight, 1);
    }
  }
}

TEST(Seam, ASheetThatWasNotWeldedIsNotFeltEither) {
  // Two plates side by side whose common border has different vertices 1 µm apart, too far to weld: no edge may stick out.
  TriangleMesh mesh;
  addQuad(mesh, {0, 0, 0}, {0.5, 0, 0}, {0.5, 1, 0}, {0, 1, 0});
  addQuad(mesh, {0.500001, -0.1, 0}, {1, -0.1, 0}, {1, 1.1, 0}, {0.500001, 1.1, 0});
  const Surface surface(mesh);
  ASSERT_EQ(surface.faceCount(), 2u);
  Probe probe(surface);
  const double radius = 0.05;
  for (double x = 0.4; x < 0.6; x += 1.7e-5) {
    const Vec3 force = probe.force({x, 0.5, 0.99 * radius}, radius);
    EXPECT_NEAR((force - Vec3(0, 0, 0.01 * radius)).norm(), 0, 1e-10) << x;
  }
}

TEST(Seam, TwiceTheSameSheetIsOneSheet) {
  TriangleMesh mesh;
  addQuad(mesh, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  addQuad(mesh, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0});  // cut along the other diagonal: no triangle is a duplicate
  const Surface surface(mesh);
  Probe probe(surface);
  Random random(4, 4);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 centre = randomIn(random, {0, 0, 0.04}, {1, 1, 0.05});
    const WallContacts& contacts = probe.contacts(centre, 0.05);
    ASSERT_EQ(contacts.size(), 1) << centre.transpose();
    EXPECT_EQ(contacts[0].weight, 1);
  }
}

TEST(Seam, AFinelyTessellatedCylinderKeepsItsFacets) {
  for (const int n : {10, 50, 200, 1000}) {
    const Surface surface(rounded(makeCone(n, 0.05, 0, 0.05, 0.1)));
    EXPECT_EQ(surface.faceCount(), static_cast<std::uint32_t>(n));
    EXPECT_EQ(surface.edgeCount(), static_cast<std::uint32_t>(3 * n));
    EXPECT_EQ(surface.cornerCount(), static_cast<std::uint32_t>(2 * n));
  }
}

TEST(Seam, CollinearBorderVerticesAreNoCorners) {
  TriangleMesh mesh;  // a fan from one corner over a side of ten pieces
  for (int k = 0; k < 10; ++k) addTriangle(mesh, {0, 1, 0}, {0.1 * k, 0, 0}, {0.1 * (k + 1), 0, 0});
  const Surface surface(mesh);
  EXPECT_EQ(surface.faceCount(), 1u);
  EXPECT_EQ(surface.edgeCount(), 3u);
  EXPECT_EQ(surface.cornerCount(), 3u);
}

}  // namespace
}  // namespace tsubu::sim::test
