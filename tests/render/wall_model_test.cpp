#include "render/wall_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.h"
#include "scene_helpers.h"

namespace tsubu::render {
namespace {

/// The mantle of a cylinder of radius 1 from z = 0 to 1, with vertices repeated in every facet as STL files have them.
TriangleMesh cylinder(int facets) {
  TriangleMesh mesh;
  for (int k = 0; k < facets; ++k) {
    const double a = 2 * std::numbers::pi * k / facets, b = 2 * std::numbers::pi * ((k + 1) % facets) / facets;
    const int first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {Vec3(std::cos(a), std::sin(a), 0), Vec3(std::cos(b), std::sin(b), 0),
                                               Vec3(std::cos(b), std::sin(b), 1), Vec3(std::cos(a), std::sin(a), 1)});
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  return mesh;
}

TEST(WallModel, ACubeHasTwelveEdgesAndFlatFaces) {
  const WallModel model(cubeMesh(1));
  EXPECT_EQ(model.triangles().size(), 12u);
  EXPECT_EQ(model.edges().size(), 12u);
  for (const FeatureEdge& edge : model.edges()) EXPECT_NEAR((edge.a - edge.b).norm(), 2, 1e-12);
  for (const auto& triangle : model.triangles()) {
    for (const Vec3& normal : triangle.normals) EXPECT_LT((normal - triangle.normal).norm(), 1e-12);
    EXPECT_GT(triangle.normal.dot(triangle.corners[0]), 0) << "outwards";
  }
}

TEST(WallModel, WindingEitherWayMakesNoCrease) {
  TriangleMesh mesh = quadMesh({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  std::swap(mesh.triangles[1][0], mesh.triangles[1][1]);
  EXPECT_EQ(WallModel(mesh).edges().size(), 4u) << "the border, not the diagonal";
}

TEST(WallModel, AFineCylinderIsSmoothWithTwoRims) {
  const WallModel model(cylinder(36));  // 10 degrees from facet to facet
  EXPECT_EQ(model.edges().size(), 72u);
  for (const auto& triangle : model.triangles()) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 radial(triangle.corners[c].x(), triangle.corners[c].y(), 0);
      EXPECT_LT((triangle.normals[c] - radial).norm(), 1e-9);
    }
  }
}

TEST(WallModel, ACoarseCylinderKeepsItsCreases) {
  EXPECT_EQ(WallModel(cylinder(8)).edges().size(), 24u);  // 45 degrees: eight creases between sixteen rim edges
}

TEST(WallModel, BrokenTrianglesAreLeftOut) {
  TriangleMesh mesh = quadMesh({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  mesh.vertices.push_back({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  mesh.vertices.push_back({2, 0, 0});
  mesh.triangles.insert(mesh.triangles.end(), {{0, 1, 4}, {0, 0, 1}, {0, 1, 5}, {0, 1, 77}, {-1, 0, 1}});
  EXPECT_EQ(WallModel(mesh).triangles().size(), 2u);
  EXPECT_TRUE(WallModel(TriangleMesh()).triangles().empty());
}

TEST(WallModel, ClosestPointsAreThoseOfASearchThroughAll) {
  // On a plane z = 0 of many triangles, the closest point of a triangle that contains the foot is the foot.
  TriangleMesh mesh;
  for (int j = 0; j < 12; ++j) {
    for (int i = 0; i < 12; ++i) {
      const TriangleMesh quad = quadMesh(Vec3(i, j, 0), Vec3(i + 1, j, 0), Vec3(i + 1, j + 1, 0), Vec3(i, j + 1, 0));
      const int first = static_cast<int>(mesh.vertices.size());
      mesh.vertices.insert(mesh.vertices.end(), quad.vertices.begin(), quad.vertices.end());
      for (const auto& t : quad.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
  const WallModel model(mesh);
  Random random(1, 1);
  for (int k = 0; k < 200; ++k) {
    const Vec3 point(random.uniform(-1, 13), random.uniform(-1, 13), random.uniform(-1, 1));
    const Vec3 nearest(std::clamp(point.x(), 0.0, 12.0), std::clamp(point.y(), 0.0, 12.0), 0);
    std::vector<Vec3> found;
    model.closestPoints(point, 1.5, found);
    double best = 1.5;
    for (const Vec3& p : found) {
      EXPECT_LT((p - point).norm(), 1.5);
      best = std::min(best, (p - point).norm());
    }
    EXPECT_NEAR(best, std::min(1.5, (nearest - point).norm()), 1e-12);
    // Every triangle with a vertex within reach must be among them.
    std::size_t touched = 0;
    for (const auto& t : model.triangles()) {
      touched += std::any_of(t.corners.begin(), t.corners.end(), [&](const Vec3& c) { return (c - point).norm() < 1.5; });
    }
    EXPECT_GE(found.size(), touched);
  }
}

}  // namespace
}  // namespace tsubu::render
