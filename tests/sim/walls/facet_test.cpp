// A wall made of more facets is smoother, not stiffer.

#include <gtest/gtest.h>

#include <algorithm>

#include "shapes.h"

namespace tsubu::sim::test {
namespace {

constexpr double cylinderRadius = 0.05, grainRadius = 0.004;

/// Inside a cylinder of n facets, a grain at the same overlap with its nearest facet everywhere around: largest force over spring
/// constant and overlap. Two facets at once give 2cos(θ/2)/(1 + kinship) in the seam, and nothing more anywhere.
double largestStiffness(int n, double overlap) {
  const Surface cylinder(makeCone(n, cylinderRadius, 0, cylinderRadius, 0.1));
  Probe probe(cylinder);
  const double theta = 2 * std::numbers::pi / n, apothem = cylinderRadius * std::cos(theta / 2);
  double largest = 0;
  for (int i = 0; i <= 20000; ++i) {
    const double fromMiddle = theta * (i / 20000.0 - 0.5);
    const double phi = theta * 1.5 + fromMiddle, out = (apothem - grainRadius + overlap) / std::cos(fromMiddle);
    const Vec3 force = probe.force({out * std::cos(phi), out * std::sin(phi), 0.05}, grainRadius);
    EXPECT_GE(force.norm(), overlap * (1 - 1e-9));
    EXPECT_NEAR(force.z(), 0, 1e-15);
    largest = std::max(largest, force.norm() / overlap);
  }
  return largest;
}

TEST(Facets, StiffnessInTheSeamsTendsToThatOfAPlane) {
  const double overlap = 0.01 * grainRadius;
  double before = 2;
  for (const int n : {10, 50, 200, 1000}) {
    const double theta = 2 * std::numbers::pi / n;
    const double kinship = contactKinship(Vec3::UnitX(), {std::cos(theta), std::sin(theta), 0});
    const double found = largestStiffness(n, overlap);
    EXPECT_NEAR(found, 2 * std::cos(theta / 2) / (1 + kinship), 1e-4) << n;
    EXPECT_LT(found, before);
    before = found;
  }
  EXPECT_LT(largestStiffness(50, overlap), 1.035);  // twice as stiff would be 2
  EXPECT_LT(largestStiffness(200, overlap), 1.0025);
  EXPECT_LT(largestStiffness(1000, overlap), 1.0001);
}

// A grain in the cylinder feels the smooth wall, but for how far the facets lie inside it: R(1 − cos(π/n)), n = 10, 50, 200: 2.4 mm,
// 99 µm, 6 µm. The work done in pushing it against the wall cannot differ by more than that times the force.
TEST(Facets, ForceDiffersFromTheSmoothWallOnlyByTheGeometry) {
  for (const int n : {50, 200, 1000}) {
    const Surface cylinder(makeCone(n, cylinderRadius, 0, cylinderRadius, 0.1));
    Probe probe(cylinder);
    Random random(static_cast<std::uint64_t>(n), 1);
    const double theta = 2 * std::numbers::pi / n, inside = cylinderRadius * (1 - std::cos(theta / 2));
    for (int i = 0; i < 10000; ++i) {
      const double phi = random.uniform(0, 7), overlap = random.uniform(0, 0.05) * grainRadius;
      const double out = cylinderRadius - grainRadius + overlap;
      const double force = probe.force({out * std::cos(phi), out * std::sin(phi), 0.05}, grainRadius).norm();
      EXPECT_GE(force, overlap * (1 - 1e-9));
      EXPECT_LE(force, (overlap + inside) * 2 / (1 + contactKinship(Vec3::UnitX(), {std::cos(theta), std::sin(theta), 0})) + 1e-12);
    }
  }
}

// A ball that fits exactly into a cone touches it all around: the number of facets must not set how hard it is held.
TEST(Facets, ABallThatPlugsAConeIsHeldAlikeByAnyNumberOfFacets) {
  const double slope = 0.5, radius = 0.03;  // dr/dz
  const double cosine = 1 / std::sqrt(1 + slope * slope), sine = slope * cosine;
  std::vector<double> lifts;
  for (const int n : {48, 96, 200, 400}) {
    const Surface funnel(makeCone(n, 0.01, 0, 0.11, 0.2));
    Probe probe(funnel);
    // Distance from the axis at height z to a facet: (0.01 + slope·z)·cos(π/n)·cosine; 2 % of the radius deep.
    const double z = (0.98 * radius / (cosine * std::cos(std::numbers::pi / n)) - 0.01) / slope;
    const Vec3 force = probe.force({0, 0, z}, radius);
    EXPECT_LT(std::hypot(force.x(), force.y()), 0.02 * force.z()) << n;
    lifts.push_back(force.z());
  }
  for (const double lift : lifts) EXPECT_NEAR(lift / lifts.back(), 1, 0.03);
  EXPECT_GT(lifts.back(), 0.02 * radius * sine);
}

}  // namespace
}  // namespace tsubu::sim::test
