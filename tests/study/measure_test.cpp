#include "study/measure.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/random.h"

namespace tsubu::study {
namespace {

std::vector<Vec3> scattered(Random& random, int count, const Vec3& size) {
  std::vector<Vec3> points;
  for (int k = 0; k < count; ++k) {
    const double x = random.uniform(0, size.x()), y = random.uniform(0, size.y()), z = random.uniform(0, size.z());
    points.emplace_back(x, y, z);
  }
  return points;
}

// Left half one kind, right half the other, cells that the border does not cut: every cell is pure.
TEST(Measure, MixingIndexIsNoughtApart) {
  Random random(5, 1);
  const std::vector<Vec3> points = scattered(random, 2000, {4, 1, 1});
  std::vector<char> kind;
  for (const Vec3& x : points) kind.push_back(x.x() < 2);
  EXPECT_NEAR(mixingIndex(points, kind, 0.5), 0, 1e-12);
}

// At random it is 1 in the mean: S² of K cells is K − 1 times p(1 − p)/N. Its deviation is √(2/K)/(N/K) here, 0.005.
TEST(Measure, MixingIndexIsOneAtRandom) {
  double sum = 0;
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    Random random(6, trial);
    const std::vector<Vec3> points = scattered(random, 3000, {3, 2, 1});
    std::vector<char> kind;
    for (std::size_t k = 0; k < points.size(); ++k) kind.push_back(random.uniform(0, 1) < 0.3);
    sum += mixingIndex(points, kind, 0.5) / 20;
  }
  EXPECT_NEAR(sum, 1, 0.01);
}

TEST(Measure, MixingIndexNeedsTwoKinds) {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  EXPECT_TRUE(std::isnan(mixingIndex(points, std::vector<char>{1, 1, 1}, 2)));
  EXPECT_TRUE(std::isnan(mixingIndex({}, {}, 1)));
}

/// Grains that fill a cone of this slope (rad) and height above a point, along an oblique axis.
Snapshot cone(double angle, const Vec3& point, const Vec3& up) {
  Snapshot snapshot;
  Random random(7, 3);
  const Vec3 z = up.normalized(), x = z.unitOrthogonal(), y = z.cross(x);
  const double radius = 0.1, height = radius * std::tan(angle);
  while (snapshot.grains() < 20000) {
    const double a = random.uniform(-radius, radius), b = random.uniform(-radius, radius), c = random.uniform(0, height);
    if (c > height - std::hypot(a, b) * std::tan(angle)) continue;
    snapshot.position.emplace_back(point + a * x + b * y + c * z);
    snapshot.radius.push_back(1e-3);
    snapshot.velocity.emplace_back(Vec3::Zero());
  }
  return snapshot;
}

// The highest grain of a square sits somewhat below the cone, everywhere alike.
TEST(Measure, AngleOfReposeOfCones) {
  const Vec3 point(0.3, -0.2, 0.1), up(0.2, 0.1, 2);
  for (const double degrees : {12.0, 25.0, 38.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    EXPECT_NEAR(angleOfRepose(cone(angle, point, up), point, up, 9.81), angle, 0.02) << degrees;
  }
}

TEST(Measure, FlyingGrainsAreNoSurface) {
  const Vec3 up(0, 0, 1);
  Snapshot snapshot = cone(0.4, Vec3::Zero(), up);
  const double before = angleOfRepose(snapshot, Vec3::Zero(), up, 9.81);
  for (int k = 0; k < 50; ++k) {
    snapshot.position.emplace_back(0.05 * std::cos(k), 0.05 * std::sin(k), 1);
    snapshot.radius.push_back(1e-3);
    snapshot.velocity.emplace_back(0, 0, 0.5);
  }
  EXPECT_NEAR(angleOfRepose(snapshot, Vec3::Zero(), up, 9.81), before, 1e-9);
  EXPECT_TRUE(std::isnan(angleOfRepose(Snapshot{}, Vec3::Zero(), up, 9.81)));
}

TEST(Measure, FrontIsThatShareOfGrainsBehind) {
  std::vector<Vec3> points;
  for (int k = 1; k <= 100; ++k) points.emplace_back(0, -k * 0.5, 7);
  EXPECT_EQ(front(points, {0, -3, 0}, 1), 50);
  EXPECT_EQ(front(points, {0, -3, 0}, 0.99), 49.5);
  EXPECT_EQ(front(points, {0, 3, 0}, 0.5), -25.5);
  EXPECT_TRUE(std::isnan(front({}, {1, 0, 0}, 1)));
}

TEST(Measure, SlopeAndFirstReach) {
  const std::vector<double> t{1, 2, 4, 7}, y{3 - 2 * 1.0, 3 - 2 * 2.0, 3 - 2 * 4.0, 3 - 2 * 7.0};
  EXPECT_NEAR(slope(t, y), -2, 1e-14);
  EXPECT_TRUE(std::isnan(slope(std::vector<double>{1}, std::vector<double>{1})));
  EXPECT_DOUBLE_EQ(firstReach(t, std::vector<double>{0, 4, 3, 9}, 3), 1.75);
  EXPECT_DOUBLE_EQ(firstReach(t, std::vector<double>{5, 6, 7, 8}, 3), 1);
  EXPECT_TRUE(std::isnan(firstReach(t, std::vector<double>{0, 1, 2, 2.5}, 3)));
}

}  // namespace
}  // namespace tsubu::study
