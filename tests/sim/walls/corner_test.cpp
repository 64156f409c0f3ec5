// Convex and concave edges and corners, thin plates: which contacts there are, and that the force never jumps.

#include <gtest/gtest.h>

#include "shapes.h"

namespace tsubu::sim::test {
namespace {

enum class Kind { face, edge, corner };

Kind kindOf(const Surface& surface, std::uint32_t feature) {
  if (surface.isFace(feature)) return Kind::face;
  return feature < surface.faceCount() + surface.edgeCount() ? Kind::edge : Kind::corner;
}

TEST(Corner, ACubeHasSixFacesTwelveEdgesEightCorners) {
  const Surface cube(makeBox(Vec3::Zero(), Vec3::Ones()));
  EXPECT_EQ(cube.faceCount(), 6u);
  EXPECT_EQ(cube.edgeCount(), 12u);
  EXPECT_EQ(cube.cornerCount(), 8u);
  EXPECT_TRUE(cube.faults().empty());
  EXPECT_EQ(cube.thinnest(), 1);
}

TEST(Corner, RollingOffAConvexEdgeFeelsFaceThenEdgeThenFace) {
  const Surface cube(makeBox(Vec3::Zero(), Vec3::Ones()));
  Probe probe(cube);
  const double radius = 0.1, overlap = 0.004, arm = radius - overlap;
  std::vector<Kind> seen;
  std::uint32_t last = Surface::none;
  // Along the top, around the edge x = 1, z = 1 at constant overlap, and down the side.
  const auto visit = [&](const Vec3& centre, const Vec3& normal) {
    const WallContacts& contacts = probe.contacts(centre, radius);
    ASSERT_EQ(contacts.size(), 1);
    EXPECT_NEAR((contacts[0].normal - normal).norm(), 0, 1e-9);
    EXPECT_NEAR(contacts[0].distance, arm, 1e-12);
    EXPECT_EQ(contacts[0].weight, 1);
    if (contacts[0].feature == last) return;
    if (last != Surface::none) {
      EXPECT_TRUE(cube.neighbours(last, contacts[0].feature));
    }
    last = contacts[0].feature;
    seen.push_back(kindOf(cube, last));
  };
  for (int i = 0; i <= 1000; ++i) visit({0.9 + 1e-4 * i, 0.5, 1 + arm}, Vec3::UnitZ());
  for (int i = 0; i <= 1000; ++i) {
    const double phi = std::numbers::pi / 2 * i / 1000;
    const Vec3 normal(std::sin(phi), 0, std::cos(phi));
    visit(Vec3(1, 0.5, 1) + arm * normal, normal);
  }
  for (int i = 0; i <= 1000; ++i) visit({1 + arm, 0.5, 1 - 1e-4 * i}, Vec3::UnitX());
  EXPECT_EQ(seen, (std::vector{Kind::face, Kind::edge, Kind::face}));
}

TEST(Corner, OutsideACornerOnlyTheCornerIsFelt) {
  const Surface cube(makeBox(Vec3::Zero(), Vec3::Ones()));
  Probe probe(cube);
  const Vec3 away = Vec3(1, 2, 3).normalized();
  const WallContacts& contacts = probe.contacts(Vec3::Ones() + 0.09 * away, 0.1);
  ASSERT_EQ(contacts.size(), 1);
  EXPECT_EQ(kindOf(cube, contacts[0].feature), Kind::corner);
  EXPECT_NEAR((contacts[0].normal - away).norm(), 0, 1e-12);
}

TEST(Corner, InConcaveCornersEveryFaceCountsFully) {
  const Surface box(makeBox(Vec3::Zero(), Vec3::Ones()));
  Probe probe(box);
  const double radius = 0.1;
  const auto expect = [&](const Vec3& centre, int faces) {
    const WallContacts& contacts = probe.contacts(centre, radius);
    ASSERT_EQ(contacts.size(), faces);
    for (const WallContact& c : contacts) {
      EXPECT_EQ(kindOf(box, c.feature), Kind::face);
      EXPECT_EQ(c.weight, 1);
    }
  };
  expect({0.098, 0.5, 0.5}, 1);
  expect({0.098, 0.5, 0.097}, 2);
  expect({0.098, 0.099, 0.097}, 3);
  expect({0.5, 0.5, 0.5}, 0);
}

TEST(Corner, AThinPlateIsFeltFromBothSidesAndAroundItsBorder) {
  TriangleMesh mesh;
  addQuad(mesh, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  const Surface plate(mesh);
  Probe probe(plate);
  for (int i = 0; i <= 360; ++i) {
    const double phi = std::numbers::pi * i / 360 - std::numbers::pi / 2;  // half around the border x = 1
    const Vec3 normal(std::cos(phi), 0, std::sin(phi));
    const WallContacts& contacts = probe.contacts(Vec3(1, 0.5, 0) + 0.09 * normal, 0.1);
    ASSERT_EQ(contacts.size(), 1);
    EXPECT_NEAR((contacts[0].normal - normal).norm(), 0, 1e-9);
  }
  EXPECT_EQ(plate.thinnest(), std::numeric_limits<double>::infinity());
}

TEST(Corner, TheBackOfAThinBoxIsNotFeltThroughItsFront) {
  const Surface box(makeBox(Vec3::Zero(), {1, 1, 0.001}));
  Probe probe(box);
  const WallContacts& contacts = probe.contacts({0.5, 0.5, 0.001 + 0.095}, 0.1);
  ASSERT_EQ(contacts.size(), 1);
  EXPECT_NEAR(contacts[0].distance, 0.095, 1e-12);
  EXPECT_NEAR(box.thinnest(), 0.001, 1e-12);
}

TEST(Corner, TheNormalIsDefinedOnTheWallItself) {
  const Surface cube(makeBox(Vec3::Zero(), Vec3::Ones()));
  Probe probe(cube);
  for (const Vec3& centre : {Vec3(0.5, 0.5, 1), Vec3(1, 0.5, 1), Vec3(1, 1, 1)}) {
    const WallContacts& contacts = probe.contacts(centre, 0.1);
    ASSERT_FALSE(contacts.empty());
    for (const WallContact& c : contacts) {
      EXPECT_NEAR(c.normal.norm(), 1, 1e-12);
      EXPECT_EQ(c.distance, 0);
    }
  }
}

TEST(Corner, ThreePlatesMeetingInALineAreAllFelt) {
  TriangleMesh mesh;
  for (int k = 0; k < 3; ++k) {
    const double phi = 2 * std::numbers::pi * k / 3;
    const Vec3 out(std::cos(phi), std::sin(phi), 0);
    addQuad(mesh, Vec3::Zero(), out, out + Vec3::UnitZ(), Vec3::UnitZ());
  }
  const Surface star(mesh);
  ASSERT_EQ(star.faceCount(), 3u);
  ASSERT_EQ(star.edgeCount(), 10u);
  ASSERT_EQ(star.faults().size(), 1u);
  EXPECT_EQ(star.faults()[0].kind, MeshFaultKind::nonManifold);
  // Between two of the plates, on the bisector: distance s from the line is s·sin 60° from both; their normals are 60° apart.
  Probe probe(star);
  const double s = 0.11;
  const WallContacts& contacts = probe.contacts({s * 0.5, s * std::sqrt(0.75), 0.5}, 0.1);
  ASSERT_EQ(contacts.size(), 2);
  for (const WallContact& c : contacts) {
    EXPECT_NEAR(c.distance, s * std::sqrt(0.75), 1e-12);
    EXPECT_NEAR(c.weight, 1 / (1 + contactKinship(contacts[0].normal, contacts[1].normal)), 1e-12);
    EXPECT_GT(c.weight, 0.97);
  }
}

/// Walks along random straight lines through the neighbourhood of the wall and looks for jumps. Springs of 1 N/m: where one
/// contact acts the force cannot change faster than the place does; where n share, not faster than n times.
void expectNoJumps(const TriangleMesh& mesh, double radius, std::uint64_t seed, double deepest = 0.05) {
  const Surface surface(mesh);
  Probe probe(surface);
  Random random(seed, 5);
  const Box around(surface.bounds().min() - Vec3::Constant(radius), surface.bounds().max() + Vec3::Constant(radius));
  const double step = 2e-4 * radius;
  int compared = 0;
  for (int line = 0; line < 500; ++line) {
    Vec3 centre = randomIn(random, around.min(), around.max());
    const WallContacts& near = probe.nearestPoints(centre, 3 * radius);
    if (near.empty()) continue;
    // Start at a small overlap with the nearest feature, so that the walk stays in places where grains can be.
    const WallContact* nearest =
        std::min_element(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.distance < b.distance; });
    const Vec3 normal = nearest->normal;
    centre = nearest->point + (1 - 0.5 * deepest) * radius * normal;
    const Vec3 direction = (randomDirection(random).cross(normal) + 0.02 * randomDirection(random)).normalized();
    Vec3 before = Vec3::Zero();
    bool known = false;
    for (int i = 0; i < 300; ++i, centre += step * direction) {
      double distance = radius;
      for (const WallContact& c : probe.nearestPoints(centre, radius)) distance = std::min(distance, c.distance);
      const bool deep = distance < (1 - deepest) * radius;
      const Vec3 force = deep ? Vec3(Vec3::Zero()) : probe.force(centre, radius);
      if (known && !deep) {
        ++compared;
        ASSERT_LT((force - before).norm(), 3 * step)
            << "line " << line << " at " << centre.transpose() << " along " << direction.transpose();
      }
      before = force;
      known = !deep;
    }
  }
  EXPECT_GT(compared, 10000);
}

TEST(Continuity, Box) { expectNoJumps(makeBox(Vec3::Zero(), Vec3::Ones()), 0.1, 1); }
TEST(Continuity, FlatBox) { expectNoJumps(makeBox(Vec3::Zero(), {1, 1, 0.002}), 0.1, 2); }
TEST(Continuity, CutSquare) { expectNoJumps(makeCutSquare(50, 1), 0.1, 3); }
TEST(Continuity, CoarseCone) { expectNoJumps(makeCone(10, 0.3, 0, 0.6, 0.5), 0.1, 4); }
TEST(Continuity, Cone) { expectNoJumps(makeCone(50, 0.3, 0, 0.6, 0.5), 0.1, 5); }
TEST(Continuity, FineCone) { expectNoJumps(makeCone(200, 0.3, 0, 0.6, 0.5), 0.1, 6); }
TEST(Continuity, NarrowCone) { expectNoJumps(makeCone(24, 0.05, 0, 0.6, 0.5), 0.1, 7); }

TEST(Continuity, PlatesThatCross) {  // not welded to each other: concave corners without edges, and ends that stick out
  TriangleMesh mesh;
  addQuad(mesh, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  addQuad(mesh, {0.2, 0.5, -0.3}, {0.8, 0.5, -0.3}, {0.8, 0.7, 0.4}, {0.2, 0.7, 0.4});
  addQuad(mesh, {0.2, 0.2, 0.01}, {0.8, 0.2, 0.01}, {0.8, 0.4, 0.05}, {0.2, 0.4, 0.05});
  expectNoJumps(mesh, 0.1, 8);
}

TEST(Continuity, Terrain) {  // convex and concave edges of all angles
  constexpr int n = 8;
  double height[n + 1][n + 1];
  Random random(9, 9);
  for (auto& row : height)
    for (double& z : row) z = random.uniform(0, 0.12);
  TriangleMesh mesh;
  const auto at = [&](int i, int j) { return Vec3(i * 0.2, j * 0.2, height[i][j]); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) addQuad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  expectNoJumps(mesh, 0.07, 9);
}

}  // namespace
}  // namespace tsubu::sim::test
