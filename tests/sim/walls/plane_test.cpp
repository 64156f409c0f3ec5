// Unbounded planes, and centres that pass through a wall.

#include <gtest/gtest.h>

#include "core/error.h"
#include "shapes.h"

namespace tsubu::sim::test {
namespace {

TEST(PlaneWall, PushesOutOnItsFrontHoweverDeep) {
  const Vec3 normal = Vec3(1, 2, 2) / 3;
  const Surface wall = Surface::plane("floor", {0.3, 0.2, 0.1}, 5 * normal);
  ASSERT_TRUE(wall.asPlane());
  Probe probe(wall);
  for (const double height : {0.09, 0.0, -0.05, -3.0}) {
    const Vec3 centre = Vec3(0.3, 0.2, 0.1) + height * normal + 7 * normal.unitOrthogonal();
    const WallContacts& contacts = probe.contacts(centre, 0.1);
    ASSERT_EQ(contacts.size(), 1);
    EXPECT_NEAR((contacts[0].normal - normal).norm(), 0, 1e-15);
    EXPECT_NEAR(contacts[0].distance, height, 1e-14);
    EXPECT_NEAR((contacts[0].point + height * normal - centre).norm(), 0, 1e-14);
    EXPECT_EQ(contacts[0].weight, 1);
  }
  EXPECT_TRUE(probe.contacts(Vec3(0.3, 0.2, 0.1) + 0.11 * normal, 0.1).empty());
}

TEST(PlaneWall, NeedsANormal) {
  EXPECT_THROW(Surface::plane("floor", Vec3::Zero(), Vec3::Zero()), Error);
  EXPECT_THROW(Surface::plane("floor", Vec3::Constant(NAN), Vec3::UnitZ()), Error);
}

TEST(Crossing, NamesTheFirstFaceOnTheWay) {
  const Surface box(makeBox(Vec3::Zero(), Vec3::Ones()));
  std::vector<std::uint32_t> all;
  box.candidates(Vec3::Zero(), 10, all);
  const auto crossed = [&](const Vec3& from, const Vec3& to) { return box.crossedFace(from, to, all); };
  const std::uint32_t top = crossed({0.5, 0.5, 1.1}, {0.5, 0.5, 0.9});
  ASSERT_NE(top, Surface::none);
  EXPECT_NEAR(std::abs(box.facePlane(top).normal.z()), 1, 1e-15);
  EXPECT_NEAR(std::abs(box.facePlane(top).offset), 1, 1e-15);
  EXPECT_EQ(crossed({0.5, 0.5, 1.1}, {0.5, 0.5, -5}), top);
  EXPECT_EQ(crossed({1.5, 0.5, 1.1}, {1.5, 0.5, 0.9}), Surface::none);  // past the face
  EXPECT_EQ(crossed({0.5, 0.5, 0.9}, {0.4, 0.5, 0.8}), Surface::none);
}

}  // namespace
}  // namespace tsubu::sim::test
