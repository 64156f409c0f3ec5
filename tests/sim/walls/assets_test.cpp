// The meshes that ship are sound, and have the features that their shapes have.

#include <gtest/gtest.h>

#include "io/mesh_file.h"
#include "shapes.h"

namespace tsubu::sim::test {
namespace {

Surface asset(const std::string& name) { return Surface(io::readMesh(std::string(TSUBU_SOURCE_DIR "/assets/") + name)); }

struct Expected {
  const char* name;
  std::uint32_t faces, edges, corners;
  Vec3 low, high;  // corners of the circles' polygons lie on the circles, one of them on each axis
};

class Asset : public testing::TestWithParam<Expected> {};

TEST_P(Asset, HasTheFeaturesOfItsShape) {
  const Expected& expected = GetParam();
  const Surface surface = asset(expected.name);
  EXPECT_TRUE(surface.faults().empty()) << surface.faults()[0].sentence;
  EXPECT_EQ(surface.faceCount(), expected.faces);
  EXPECT_EQ(surface.edgeCount(), expected.edges);
  EXPECT_EQ(surface.cornerCount(), expected.corners);
  EXPECT_NEAR((surface.bounds().min() - expected.low).norm(), 0, 1e-3);
  EXPECT_NEAR((surface.bounds().max() - expected.high).norm(), 0, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Meshes, Asset,
                         testing::Values(Expected{"hopper.stl", 2 * 64, 5 * 64, 3 * 64, {-0.08, -0.08, 0.16}, {0.08, 0.08, 0.42}},
                                         Expected{"bin.obj", 5, 12, 8, {-0.11, -0.11, 0}, {0.11, 0.11, 0.1}},
                                         Expected{"drum.ply", 96 + 1, 3 * 96, 2 * 96, {-0.12, -0.05, -0.12}, {0.12, 0.05, 0.12}},
                                         Expected{"drum_front.ply", 1, 96, 96, {-0.12, -0.05, -0.12}, {0.12, -0.05, 0.12}},
                                         Expected{"drum_lifters.stl", 6, 6 * 4, 6 * 4, {-0.12, -0.05, -0.1058}, {0.12, 0.05, 0.1058}},
                                         Expected{"roller.stl", 72 + 2, 3 * 72, 2 * 72, {-0.008, -0.005, -0.008}, {0.008, 0.005, 0.008}},
                                         Expected{"gate.obj", 1, 4, 4, {-0.564, -0.1, 0.317}, {-0.516, 0.1, 0.393}},
                                         Expected{"block.obj", 6, 12, 8, {-0.06, -0.05, -0.06}, {0, 0.05, 0.06}},
                                         Expected{"press.obj", 64 + 2, 3 * 64, 2 * 64, {-0.02, -0.04, -0.02}, {0.02, 0.04, 0.02}},
                                         Expected{"piston.obj", 2 * 6, 2 * 12, 2 * 8, {-0.0995, -0.0045, 0}, {0.0995, 0.0045, 0.09}},
                                         Expected{"table.gltf", 5 * 6, 5 * 12, 5 * 8, {-0.25, -0.08, -0.1}, {0.25, 0.08, 0}}),
                         [](const auto& mesh) {
                           std::string name = mesh.param.name;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

TEST(Assets, TheChuteHasOneFaceForEachStraightPiece) {
  const Surface chute = asset("chute.stl");
  EXPECT_TRUE(chute.faults().empty());
  EXPECT_EQ(chute.faceCount(), 14u);
  const Surface sides = asset("chute_sides.stl");
  EXPECT_TRUE(sides.faults().empty());
  EXPECT_EQ(sides.faceCount(), 2u + 2);  // sides, back and end wall
}

TEST(Assets, ObstaclesStandOnTheSlopeWhereTheirNodePutsThem) {
  const Surface obstacles = asset("obstacles.glb"), chute = asset("chute.stl");
  EXPECT_TRUE(obstacles.faults().empty());
  EXPECT_EQ(obstacles.faceCount(), 5u * (24 + 2) + 2 * (3 + 2));
  // The feet are 4 mm below the slope, the tops 55 mm above it.
  const double angle = 32 * std::numbers::pi / 180;
  const Vec3 normal(std::sin(angle), 0, std::cos(angle)), start(-0.69962, 0, 0.40133);
  double lowest = 1, highest = -1;
  for (const Vec3& x : obstacles.mesh().vertices) {
    lowest = std::min(lowest, normal.dot(x - start));
    highest = std::max(highest, normal.dot(x - start));
  }
  EXPECT_NEAR(lowest, -0.004, 1e-4);
  EXPECT_NEAR(highest, 0.055, 1e-4);
}

TEST(Assets, AGrainInTheHopperTouchesOneFacet) {
  const Surface hopper = asset("hopper.stl");
  Probe probe(hopper);
  // 3 mm deep in the middle of the first facet of the cylinder.
  const double phi = std::numbers::pi / 64, out = 0.08 * std::cos(phi) - 0.0028;
  const WallContacts& contacts = probe.contacts({out * std::cos(phi), out * std::sin(phi), 0.35}, 0.003);
  ASSERT_EQ(contacts.size(), 1);
  EXPECT_NEAR(contacts[0].distance, 0.0028, 1e-8);
  EXPECT_NEAR((contacts[0].normal + Vec3(std::cos(phi), std::sin(phi), 0)).norm(), 0, 1e-6);
}

}  // namespace
}  // namespace tsubu::sim::test
