// Nearest points against brute force over all triangles.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "shapes.h"

namespace tsubu::sim::test {
namespace {

/// Nearest point of a triangle, by projecting onto its plane, its three sides and its three corners.
double distanceToTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  double nearest = std::numeric_limits<double>::infinity();
  const std::array<Vec3, 3> x{a, b, c};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 along = x[(k + 1) % 3] - x[k];
    const double t = std::clamp((p - x[k]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (p - x[k] - t * along).norm());
  }
  const Vec3 normal = (b - a).cross(c - a);
  bool inside = true;
  for (std::size_t k = 0; k < 3; ++k) inside = inside && (x[(k + 1) % 3] - x[k]).cross(p - x[k]).dot(normal) >= 0;
  return inside ? std::min(nearest, std::abs((p - a).dot(normal)) / normal.norm()) : nearest;
}

double distanceTo(const TriangleMesh& mesh, const Vec3& p) {
  double nearest = std::numeric_limits<double>::infinity();
  const auto at = [&](int v) { return mesh.vertices[static_cast<std::size_t>(v)]; };
  for (const auto& t : mesh.triangles) nearest = std::min(nearest, distanceToTriangle(p, at(t[0]), at(t[1]), at(t[2])));
  return nearest;
}

/// The deepest of the nearest points is the nearest point of the whole wall; no other claims to be nearer than it is.
void compare(const TriangleMesh& mesh, const Vec3& low, const Vec3& high, double radius, int samples, std::uint64_t seed) {
  const Surface surface(mesh);
  Probe probe(surface);
  Random random(seed, 11);
  const double tolerance = 1e-6 * surface.bounds().diagonal().norm();
  int touching = 0;
  for (int i = 0; i < samples; ++i) {
    const Vec3 centre = randomIn(random, low, high);
    const double expected = distanceTo(mesh, centre);
    const WallContacts& contacts = probe.nearestPoints(centre, radius);
    if (expected < radius - tolerance) {
      ASSERT_FALSE(contacts.empty()) << centre.transpose();
      ++touching;
    }
    double nearest = std::numeric_limits<double>::infinity();
    for (const WallContact& c : contacts) {
      nearest = std::min(nearest, c.distance);
      EXPECT_LT(c.distance, radius);
      EXPECT_NEAR((c.point + c.distance * c.normal - centre).norm(), 0, 1e-12);
      EXPECT_NEAR(c.normal.norm(), 1, 1e-12);
      EXPECT_NEAR(distanceTo(mesh, c.point), 0, tolerance);
    }
    if (!contacts.empty()) {
      EXPECT_NEAR(nearest, expected, tolerance) << centre.transpose();
    }
  }
  EXPECT_GT(touching, samples / 50);
}

TEST(Oracle, TriangleSoups) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed, 10);
    TriangleMesh mesh;
    for (int t = 0; t < 12; ++t) {
      const Vec3 a = randomIn(random, Vec3::Zero(), Vec3::Ones());
      addTriangle(mesh, a, a + 0.4 * randomDirection(random), a + 0.4 * randomDirection(random));
    }
    compare(mesh, Vec3::Zero(), Vec3::Ones(), 0.12, 1500, seed);
  }
}

TEST(Oracle, Solids) {
  compare(makeBox({0, 0, 0}, {1, 0.6, 0.3}), Vec3::Constant(-0.2), Vec3::Constant(1.2), 0.15, 20000, 1);
  compare(makeCone(7, 0.2, 0, 0.5, 0.6), Vec3(-0.6, -0.6, -0.2), Vec3(0.6, 0.6, 0.8), 0.1, 20000, 2);
  compare(makeCone(40, 0.01, 0, 0.5, 0.2), Vec3(-0.6, -0.6, -0.2), Vec3(0.6, 0.6, 0.4), 0.02, 20000, 3);
}

TEST(Oracle, FacesWithHolesAndNotches) {
  TriangleMesh mesh;  // a frame with a square hole, standing on a plate that it divides, and an L
  const auto ring = [&](const Vec3& at) {
    const auto p = [&](double x, double z) { return Vec3(at + Vec3(x, 0, z)); };
    addQuad(mesh, p(0, 0), p(1, 0), p(0.7, 0.3), p(0.3, 0.3));
    addQuad(mesh, p(1, 0), p(1, 1), p(0.7, 0.7), p(0.7, 0.3));
    addQuad(mesh, p(1, 1), p(0, 1), p(0.3, 0.7), p(0.7, 0.7));
    addQuad(mesh, p(0, 1), p(0, 0), p(0.3, 0.3), p(0.3, 0.7));
  };
  ring({0, 0, 0});
  addQuad(mesh, {0, -0.5, 0}, {1, -0.5, 0}, {1, 0, 0}, {0, 0, 0});
  addQuad(mesh, {0, 0, 0}, {1, 0, 0}, {1, 0.5, 0}, {0, 0.5, 0});
  addQuad(mesh, {0, -0.5, 0}, {0.4, -0.5, 0}, {0.4, -0.9, 0}, {0, -0.9, 0});
  const Surface surface(mesh);
  EXPECT_EQ(surface.faceCount(), 2u);
  compare(mesh, Vec3(-0.2, -1.1, -0.2), Vec3(1.2, 0.7, 1.2), 0.1, 40000, 5);
}

TEST(Oracle, CandidatesAreExactlyTheFeaturesWithinReach) {
  const TriangleMesh mesh = makeCone(30, 0.2, 0, 0.5, 0.6);
  const Surface surface(mesh);
  Random random(3, 3);
  std::vector<std::uint32_t> some, all;
  surface.candidates(Vec3::Zero(), 10, all);
  EXPECT_EQ(all.size(), surface.featureCount());
  for (int i = 0; i < 2000; ++i) {
    const Vec3 centre = randomIn(random, Vec3(-0.6, -0.6, -0.1), Vec3(0.6, 0.6, 0.7));
    surface.candidates(centre, 0.1, some);
    EXPECT_TRUE(std::is_sorted(some.begin(), some.end()));
    EXPECT_EQ(!some.empty(), distanceTo(mesh, centre) < 0.1);
    WallContacts fromSome, fromAll;
    surface.contacts(centre, 0.1, some, fromSome);
    surface.contacts(centre, 0.1, all, fromAll);
    ASSERT_EQ(fromSome.size(), fromAll.size());
    for (int k = 0; k < fromSome.size(); ++k) {
      EXPECT_EQ(fromSome[k].feature, fromAll[k].feature);
      EXPECT_EQ(fromSome[k].distance, fromAll[k].distance);
      EXPECT_EQ(fromSome[k].weight, fromAll[k].weight);
    }
  }
}

// What a surface refuses stays no contact for as long as it says.
TEST(Oracle, RefusalsHoldAsFarAsTheySay) {
  Random random(8, 12);
  TriangleMesh soup;
  for (int t = 0; t < 12; ++t) {
    const Vec3 a = randomIn(random, Vec3::Zero(), Vec3::Ones());
    addTriangle(soup, a, a + 0.4 * randomDirection(random), a + 0.4 * randomDirection(random));
  }
  const double radius = 0.1;
  int held = 0, touched = 0, stayed = 0;
  std::vector<std::uint32_t> near;
  for (const TriangleMesh& mesh : {soup, makeBox({0, 0, 0}, {1, 0.6, 0.3}), makeCone(20, 0.1, 0, 0.5, 0.6)}) {
    const Surface surface(mesh);
    for (int i = 0; i < 20000; ++i) {
      const Vec3 centre = randomIn(random, Vec3::Constant(-0.6), Vec3::Constant(1.1));
      surface.candidates(centre, 2 * radius, near);
      if (near.empty()) continue;
      const std::uint32_t feature = near[static_cast<std::size_t>(random.uniform() * static_cast<double>(near.size()))];
      const double room = surface.refusal(feature, centre, radius);
      WallContacts contacts;
      surface.nearestPoints(centre, radius, {&feature, 1}, contacts);
      touched += !contacts.empty();
      ASSERT_TRUE(contacts.empty() || room == 0);
      if (surface.isFace(feature)) {
        const double over = surface.stayOver(feature, centre, radius);
        const Vec3 aside = centre + random.uniform() * over * randomDirection(random);
        const std::uint32_t marked = feature | Surface::surelyOver;
        WallContacts asked, known;
        surface.nearestPoints(aside, radius, {&feature, 1}, asked);
        surface.nearestPoints(aside, radius, {&marked, 1}, known);
        ASSERT_TRUE(over == 0 || asked.size() == known.size());
        stayed += over > 0 && !asked.empty();
      }
      if (room == 0) continue;
      const Vec3 there = centre + random.uniform(0.5, 1) * std::min(room, 0.5) * randomDirection(random);
      surface.nearestPoints(there, radius, {&feature, 1}, contacts);
      ASSERT_TRUE(contacts.empty()) << "feature " << feature << " of " << mesh.name << ", room " << room;
      ++held;
    }
  }
  EXPECT_GT(held, 3000);
  EXPECT_GT(touched, 300);
  EXPECT_GT(stayed, 100);
}

}  // namespace
}  // namespace tsubu::sim::test
